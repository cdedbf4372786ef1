"""What differences between searches say: how likely ones so large are if there were none."""

from collections.abc import Mapping, Sequence
from statistics import median

import numpy as np
from scipy.stats import mannwhitneyu, norm, rankdata

Runs = Sequence[float]  # a cost for each seed


def chances(found: Mapping[str, Runs]) -> dict[str, float]:
    """Of each search's runs against those of the best median: Mann-Whitney U, two-sided, corrected."""
    best = min(found, key=lambda name: median(found[name]))
    raw = {name: mannwhitneyu(found[best], runs).pvalue for name, runs in found.items() if name != best}
    return {best: 1.0, **corrected(raw)}


def paired(problems: Sequence[tuple[Runs, Runs]]) -> float:
    """Of two searches' runs on the same seeds of some problems: signed ranks (Wilcoxon 1945), two-sided.

    What is ranked, problem by problem, is the ratio of two costs; the sums of the problems are added. Under the
    hypothesis of no difference every rank has either sign, which gives the sum's variance; it is taken as normal.
    """
    signed = np.concatenate([_signed_ranks(*pair) for pair in problems])
    spread = np.sqrt(np.sum(signed**2))
    return float(2.0 * norm.sf(abs(signed.sum()) / spread)) if spread else 1.0


def corrected(raw: Mapping[str, float]) -> dict[str, float]:
    """The probabilities of several tests, so that one in twenty of all of them together is below 0.05 (Holm 1979)."""
    found, least = {}, 0.0
    for rank, name in enumerate(sorted(raw, key=raw.__getitem__)):
        least = max(least, min(1.0, (len(raw) - rank) * float(raw[name])))
        found[name] = least
    return found


def _signed_ranks(ours: Runs, theirs: Runs) -> np.ndarray:
    """Of the differences that are not zero."""
    ratios = np.log(theirs) - np.log(ours)
    ratios = ratios[ratios != 0.0]
    ranks: np.ndarray = np.sign(ratios) * rankdata(np.abs(ratios))
    return ranks
