"""Rollouts: what became of many candidates from many starts, as the kernel reports it."""

from dataclasses import dataclass

from gpsynth.arrays import Floats
from gpsynth.kernels import rollout


@dataclass(frozen=True)
class Paths:
    """What N candidates passed through from S starts, in K control periods at most; NaN after the end of a rollout."""

    t: Floats  # (K + 1,) s
    x: Floats  # (N, S, K + 1, n)
    u: Floats  # (N, S, K + 1, m) computed at each tick; the last one would be applied next
    target: Floats  # (N, S, K + 1, n)


@dataclass(frozen=True)
class Rollouts:
    """What became of N candidates from S starts."""

    arrival: Floats  # (N, S) s, infinity where the goal was not reached
    end: Floats  # (N, S) s, when the rollout ended
    cost: Floats  # (N, S) running cost, infinity where the rollout diverged
    clearance: Floats  # (N, S) m, smallest along the path, robot radius deducted; infinity without obstacles
    exposure: Floats  # (N, S) s with less clearance than the margin
    depth: Floats  # (N, S) m s, integral of what was missing of the margin
    diverged: Floats  # (N, S) 1.0 where the rollout diverged
    share: (
        Floats  # (N, S) of the period before `arrival` that lies behind it, were the measure linear in time
    )
    terminal: Floats  # (N, S, q)
    final: Floats  # (N, S, n)
    paths: Paths | None = None  # where they were asked for


def rollouts_of(result: Floats, shape: tuple[int, int], terminals: int) -> Rollouts:
    """What the kernel wrote (N S, ...) about N candidates from S starts, with this number of terminal costs."""
    table = result.reshape(*shape, result.shape[1])
    first = rollout.TERMINAL
    return Rollouts(
        arrival=table[..., rollout.ARRIVAL],
        end=table[..., rollout.END],
        cost=table[..., rollout.COST],
        clearance=table[..., rollout.CLEARANCE],
        exposure=table[..., rollout.EXPOSURE],
        depth=table[..., rollout.DEPTH],
        diverged=table[..., rollout.DIVERGED],
        share=table[..., rollout.SHARE],
        terminal=table[..., first : first + terminals],
        final=table[..., first + terminals :],
    )
