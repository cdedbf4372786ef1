"""Place the programs of a closed loop in one workspace: once what stays, then each law."""

from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats, Ints, frozen
from gpsynth.kernels.arrange import arrange
from gpsynth.kernels.layout import Code, Rows
from gpsynth.kernels.machine import place
from gpsynth.operations import CODES, OPERATIONS

ARITIES = frozen(np.array([operation.arity for operation in OPERATIONS], dtype=np.int32))


class Instructions(NamedTuple):
    """A program as arrays: operands of code (c, 4) number inputs, parameters, constants, instructions."""

    code: Ints
    constants: Floats
    outputs: Ints


class Loop(NamedTuple):
    """The parts of a closed loop around its law, each reading what the ones before it give."""

    features: Instructions  # of state, target and, if there is any, the state's error; the law reads them
    limits: Instructions  # of the law's outputs: the controls
    rates: Instructions  # of state, controls, goal, time and the plant's parameters: derivatives and running cost
    arrival: Instructions  # of state and goal: measure and terminal costs


class Frame(NamedTuple):
    """A closed loop placed in a workspace, with room for a law after its last row."""

    rows: Rows
    features: Ints  # (f,) rows of the law's inputs
    before: Ints  # (., 5) instructions ahead of the law
    after: Ints  # (., 5) instructions behind it; the negative operand -1 - k is the law's output k
    kept: Ints  # rows of rates, arrival and controls
    read: Ints  # rows of constants, rates, arrival and controls
    code: Code  # without a law; `ends` counts from the law's last instruction


class _Placed(NamedTuple):
    code: Ints  # (c, 5)
    constant_rows: Ints
    outputs: Ints


class Extent(NamedTuple):
    """How many rows a rollout needs beside its programs."""

    states: int
    plant: int = 0  # parameters of the plant
    noise: bool = False
    acting: int = 0  # controls that come late
    slots: int = 0  # ticks whose controls are kept for that


def rows_of(extent: Extent) -> Rows:
    """Where the quantities of a rollout stand; programs follow from row `total` on, parameters after them."""
    states, late = extent.states, (extent.acting, extent.slots * extent.acting)
    fixed = (states, states, states, states, 1, states, 2 * states, *[1] * 8, 10)
    sizes = (*fixed, extent.plant, states if extent.noise else 0, *late)
    first = np.concatenate(([0], np.cumsum(sizes))).tolist()
    return Rows(*first, *first[-1:])


def frame(loop: Loop, extent: Extent, angles: Ints) -> Frame:
    """The workspace of a closed loop and everything in it but the law; angles: (a,) states to be wrapped."""
    rows, states = rows_of(extent), extent.states
    state, target, goal = (_range(first, states) for first in (rows.state, rows.target, rows.goal))
    error, plant = _range(rows.error, states if extent.noise else 0), _range(rows.plant, extent.plant)
    raw = -1 - _range(0, len(loop.limits.outputs))  # the law's outputs, in `Frame.after`
    features, free = _placed(loop.features, np.concatenate((state, target, error)), rows.total)
    limits, free = _placed(loop.limits, raw, free)
    controls = _range(rows.acting, extent.acting) if extent.acting else limits.outputs
    rates, free = _placed(
        loop.rates, np.concatenate((state, controls, goal, _range(rows.time, 1), plant)), free
    )
    rates, free = _apart(rates, state, free)
    arrival, free = _placed(loop.arrival, np.concatenate((state, goal)), free)
    parts = (features, limits, rates, arrival)
    after = np.concatenate((limits.code, rates.code, arrival.code))
    code = Code(
        instructions=features.code,
        ends=np.cumsum([len(part.code) for part in parts[1:]]).astype(np.int32),
        constant_rows=np.concatenate([part.constant_rows for part in parts]),
        constants=np.concatenate([part.constants for part in loop]),
        rates=frozen(rates.outputs),
        arrival=frozen(arrival.outputs),
        controls=frozen(limits.outputs),
        angles=frozen(angles),
    )
    placed = rows._replace(parameter=free, total=free)
    kept = frozen(np.concatenate((code.rates, code.arrival, code.controls)))
    read = frozen(np.concatenate((code.constant_rows, kept)))
    return Frame(placed, frozen(features.outputs), frozen(features.code), frozen(after), kept, read, code)


def pack(around: Frame, law: Instructions, parameters: int) -> tuple[Rows, Code]:
    """The workspace and the code of the closed loop with this law."""
    code, first = around.code, around.rows.parameter
    constant_row = first + parameters
    computed = constant_row + len(law.constants)
    length = len(around.before) + len(law.code)
    instructions = np.empty((length + len(around.after), 5), dtype=np.int32)
    ends, moved = code.ends + np.int32(length), np.empty(computed + len(law.code), dtype=np.int32)
    total = arrange(
        *(around.before, law.code, law.outputs, around.after, around.features, first, computed),
        *(around.kept, ARITIES, instructions, ends, moved),
    )
    read = np.concatenate((moved[constant_row:computed], moved[around.read]))
    constants = np.concatenate((law.constants, code.constants))
    for array in (instructions, ends, read, constants):
        array.setflags(write=False)
    rates = len(constants)
    arrival, controls = rates + len(code.rates), rates + len(code.rates) + len(code.arrival)
    return Rows(*around.rows[:-2], int(moved[first]) if parameters else 0, total), Code(
        instructions=instructions[: ends[-1]],
        ends=ends,
        constant_rows=read[:rates],
        constants=constants,
        rates=read[rates:arrival],
        arrival=read[arrival:controls],
        controls=read[controls:],
        angles=code.angles,
    )


def _placed(part: Instructions, inputs: Ints, first: int) -> tuple[_Placed, int]:
    """A program moved to the workspace rows from `first` on, and the first row after it."""
    computed = first + len(part.constants)
    free = computed + len(part.code)
    rows = np.concatenate((inputs, _range(first, free - first)))
    constant_rows = _range(first, len(part.constants))
    return _Placed(place(part.code, computed, rows), constant_rows, rows[part.outputs]), free


def _apart(rates: _Placed, state: Ints, free: int) -> tuple[_Placed, int]:
    """Derivatives that are states themselves, copied: a step writes the states one after the other."""
    shared = np.flatnonzero(np.isin(rates.outputs, state))
    copies = np.zeros((len(shared), 5), dtype=np.int32)
    copies[:, 0] = CODES["identity"]
    copies[:, 1], copies[:, 2] = _range(free, len(shared)), rates.outputs[shared]
    outputs = rates.outputs.copy()
    outputs[shared] = copies[:, 1]
    return rates._replace(code=np.concatenate((rates.code, copies)), outputs=outputs), free + len(shared)


def _range(first: int, count: int) -> Ints:
    return np.arange(first, first + count, dtype=np.int32)
