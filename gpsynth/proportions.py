"""What a number of successes says about the probability of one (Clopper & Pearson 1934)."""

from scipy.special import betaincinv


def lower_bound(successes: int, runs: int, confidence: float = 0.95) -> float:
    """What the probability of success is at least, one-sided; the runs must be independent."""
    if successes == 0:
        return 0.0
    return float(betaincinv(successes, runs - successes + 1, 1.0 - confidence))
