"""A law in its closed loop takes no more rows than are alive, and no instruction more than it needs."""

import numpy as np
import pytest

from gpsynth.arrays import Floats
from gpsynth.builder import Builder
from gpsynth.evaluate import Evaluator
from gpsynth.kernels.layout import Code, Rows
from gpsynth.kernels.machine import SINE_AND_COSINE
from gpsynth.kernels.pack import pack
from gpsynth.kernels.pairs import ABS, FIRST_NUMBERS, JOINED
from gpsynth.loop_arrays import instructions
from gpsynth.operations import CODES, OPERATIONS
from gpsynth.plant import Plant
from gpsynth.problem import Problem
from gpsynth.program import Program

NONE = np.empty((1, 0))
FEATURES = ("error_q", "error_p", "error_r")


def _problem(starts: Floats, hold: bool = True) -> Problem:
    """A derivative that is a state, one that is a constant, and one with a sine and a cosine of the same angle."""
    plant = Plant(
        lambda x, u: (x.p, np.sin(x.q) + 0.5 * np.cos(x.q) + u.f, 0.25),
        states={"q": "rad", "p": "rad/s", "r": "1"},
        controls={"f": ("1/s2", -5.0, 5.0)},
    )
    return Problem(
        plant, starts, [0.1, 0.2, 0.3], tolerance=0.01, horizon=0.1, period=0.1, method="euler", hold=hold,
        running=lambda x, u, goal: (x.q - goal.q) ** 2 + u.f**2, terminal=lambda x, goal: (x.q - x.p,),
    )  # fmt: skip


def _random_law(rng: np.random.Generator, length: int) -> Program:
    builder = Builder(FEATURES, ("k",))
    values = [*builder.inputs, *builder.parameters, builder.constant(0.75)]
    for _ in range(length):
        row = OPERATIONS[rng.integers(len(OPERATIONS))]
        values.append(builder.apply(row.name, *(int(v) for v in rng.choice(values[-12:], row.arity))))
    return builder.build([values[-1]], ("f",))


def _chain(length: int) -> Program:
    builder = Builder(FEATURES)
    value = builder.inputs[0]
    for _ in range(length):
        value = builder.apply("tanh", builder.apply("add", value, builder.inputs[0]))
    return builder.build([value], ("f",))


def _wide(count: int) -> Program:
    """A sum of `count` terms that are all there before the first two are added."""
    builder = Builder(FEATURES)
    terms = [builder.apply("tanh", builder.apply("mul", 0, builder.constant(k + 1.0))) for k in range(count)]
    value = terms.pop()
    while terms:
        value = builder.apply("min", value, terms.pop())
    return builder.build([value], ("f",))


def _packed(law: Program, hold: bool = True) -> tuple[Rows, Code]:
    return pack(Evaluator(_problem(np.zeros((1, 3)), hold)).frame, instructions(law), len(law.parameters))


def _count(code: Code, operation: int) -> int:
    return int(np.sum(code.instructions[:, 0] == operation))


def test_the_workspace_does_not_grow_with_the_length_of_the_law() -> None:
    assert _packed(_chain(200))[0].total == _packed(_chain(2))[0].total


def test_what_no_output_needs_is_left_out() -> None:
    _, code = _packed(_chain(1))  # of the three errors it reads one
    assert code.ends[0] == len(("error_q", "add", "tanh", "limit"))


@pytest.mark.parametrize("hold", [True, False])
def test_sine_and_cosine_of_one_value_are_one_instruction(hold: bool) -> None:
    _, code = _packed(_chain(1), hold)
    assert [_count(code, number) for number in (CODES["sin"], CODES["cos"], SINE_AND_COSINE)] == [0, 0, 1]


def test_a_value_that_one_instruction_reads_goes_to_it_without_a_row() -> None:
    builder = Builder(FEATURES)
    error = builder.inputs[0]  # goal - state
    once, twice = (
        _packed(builder.build([builder.apply(name, *operands)], ("f",)))[1]
        for name, operands in (("abs", (error,)), ("mul", (error, error)))
    )
    assert once.ends[0] == len(("sub abs", "limit"))
    assert once.instructions[0, 0] == JOINED + FIRST_NUMBERS * ABS + CODES["sub"]
    assert twice.ends[0] == len(("sub", "mul", "limit"))


@pytest.mark.parametrize("hold", [True, False])
def test_a_step_is_what_the_programs_say_bit_for_bit(hold: bool) -> None:
    rng = np.random.default_rng(7)
    starts = rng.uniform(-2.0, 2.0, (21, 3))
    problem = _problem(starts, hold)
    goal = np.tile(problem.goal, (len(starts), 1))
    for length in (1, 5, 20, 80):
        for _ in range(5):
            law = _random_law(rng, length)
            features = problem.features(np.hstack((starts, goal)))
            controls = problem.plant.saturation(law(features, [0.6]))
            rates = problem.rates(np.hstack((starts, controls, goal, np.zeros((len(starts), 1)))))
            rolled = Evaluator(problem).of_program(law, np.array([[0.6]]))
            end = starts + 0.1 * rates[:, :3]
            assert rolled.final[0].tobytes() == end.tobytes()
            assert rolled.cost[0].tobytes() == (0.1 * rates[:, 3]).tobytes()
            terminal = problem.arrival(np.hstack((end, goal)))[:, 1:]
            assert rolled.terminal[0].tobytes() == terminal.tobytes()


def test_a_law_computed_after_the_end_leaves_the_terminal_costs_alone() -> None:
    starts = np.random.default_rng(9).uniform(-2.0, 2.0, (21, 3))
    problem = _problem(starts)
    rolled = Evaluator(problem).of_program(_wide(30), NONE)
    goal = np.tile(problem.goal, (len(starts), 1))
    terminal = problem.arrival(np.hstack((rolled.final[0], goal)))[:, 1:]
    assert rolled.terminal[0].tobytes() == terminal.tobytes()
