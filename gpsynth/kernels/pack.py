"""Place the programs of a closed loop in one workspace."""

from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels.layout import Code, Rows
from gpsynth.kernels.machine import place


class Instructions(NamedTuple):
    """A program as arrays: operands of code (c, 4) number inputs, parameters, constants, instructions."""

    code: Ints
    constants: Floats
    outputs: Ints


def rows_of(states: int, parameters: int, stages: int) -> Rows:
    """Where the quantities of a rollout stand; programs follow from row `count` on."""
    sizes = (states, states, states, states, 1, parameters, stages * (states + 1), 1, 1, 1, 1, 1, 4, 0)
    return Rows(*np.concatenate(([0], np.cumsum(sizes)[:-1])).tolist())


class Loop(NamedTuple):
    """The parts of a closed loop, each reading what the ones before it give."""

    features: Instructions  # of state and target
    law: Instructions  # of the features and the parameters
    limits: Instructions  # of the law's outputs: the controls
    rates: Instructions  # of state, controls, goal and time: derivatives and running cost
    arrival: Instructions  # of state and goal: measure and terminal costs


def pack(rows: Rows, loop: Loop, *, states: int, parameters: int, angles: Ints) -> tuple[Rows, Code]:
    """The workspace of a closed loop and its code."""
    state, target = np.arange(states) + rows.state, np.arange(states) + rows.target
    goal, vector = np.arange(states) + rows.goal, np.arange(parameters) + rows.parameter
    features, free = _placed(loop.features, np.concatenate((state, target)), rows.count)
    law, free = _placed(loop.law, np.concatenate((features.outputs, vector)), free)
    limits, free = _placed(loop.limits, law.outputs, free)
    rates, free = _placed(loop.rates, np.concatenate((state, limits.outputs, goal, [rows.time])), free)
    arrival, free = _placed(loop.arrival, np.concatenate((state, goal)), free)
    parts = (features, law, limits, rates, arrival)
    ends = np.cumsum([len(part.code) for part in parts])
    code = Code(
        instructions=np.concatenate([part.code for part in parts]),
        ends=ends[2:].astype(np.int32),
        constant_rows=np.concatenate([part.constant_rows for part in parts]),
        constants=np.concatenate([part.constants for part in loop]),
        rates=rates.outputs,
        arrival=arrival.outputs,
        controls=limits.outputs,
        angles=angles,
    )
    return rows._replace(count=free), code


class _Placed(NamedTuple):
    code: Ints  # (c, 5)
    constant_rows: Ints
    outputs: Ints


def _placed(part: Instructions, inputs: Ints, first: int) -> tuple[_Placed, int]:
    """A program moved to the workspace rows from `first` on, and the first row after it."""
    computed = first + len(part.constants)
    free = computed + len(part.code)
    rows = np.concatenate((inputs, np.arange(first, free))).astype(np.int32)
    constant_rows = np.arange(first, computed, dtype=np.int32)
    return _Placed(place(part.code, computed, rows), constant_rows, rows[part.outputs]), free
