"""Defects of public implementations of the network operator that ours must not have.

Those that a test beside its module already excludes are listed with it in docs/encodings.md.
"""

import numpy as np
import pytest

import gpsynth as gs
from gpsynth.encodings.gray import value_to_gray
from gpsynth.encodings.network_operator_matrix import Matrix, decode_matrix
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.errors import ProblemError
from gpsynth.seeds import stream
from gpsynth.variational_ga import VariationalGA, mean_and_worst

ENCODING = VariationalEncoding(("a", "b"), ("y",), ("add", "nop_mul", "sin"), ParameterSpace(2, -4.0, 4.0))


def costs(batch):
    """Three costs that differ between any two candidates."""
    rows = np.array([[0.3, -1.2], [1.7, 0.4], [-0.9, 2.1]])
    return np.array([np.abs(each.program(rows, each.values)[:, 0] - 3.0) for each in batch])


@pytest.mark.parametrize("strict", [True, False])
def test_the_eighth_binary_function_is_the_larger_operand_and_not_always_zero(strict):
    psi = np.array([[0, 0, 1], [0, 0, 1], [0, 0, 8]], dtype=np.int32)
    program = decode_matrix(Matrix(psi, (0, 1), (), (2,)), strict=strict)
    assert program(np.array([[-3.0, 2.0], [-0.5, 0.2], [4.0, -1.0]]))[:, 0].tolist() == [-3.0, -0.5, 4.0]


def test_a_start_inside_an_obstacle_is_named_and_no_loop_skips_it():
    plant = gs.Plant(lambda x, u: (u.v, u.v), states={"x": "m", "y": "m"}, controls={"v": ("m/s", -1.0, 1.0)})
    circle = gs.Obstacles(circles=[(0.0, 3.0, 0.0, 0.0, 0.5)])
    starts = [(2.0, 0.0), (0.1, 3.0)]
    with pytest.raises(ProblemError, match=r"start 1 at \(0.1, 3.0\) is inside obstacle 0"):
        gs.Problem(plant, starts, goal=(4.0, 0.0), tolerance=0.1, horizon=9.0, period=0.1, obstacles=circle)


@pytest.mark.parametrize(("mutation", "least", "most"), [(0.0, 0.0, 0.0), (0.7, 0.6, 0.8), (1.0, 0.98, 1.0)])
def test_couples_are_crossed_and_children_mutated_as_often_as_set(mutation, least, most):
    ga = VariationalGA(ENCODING, population=100, couples=60, mutation=mutation)
    batch, waiting = ga.ask(ga.init(stream(1)), stream(2))
    state = ga.tell(waiting, batch, costs(batch))
    children, _ = ga.ask(state, stream(3))
    numbers = {value for member in state.population for value in member.genome.values}
    structures = {member.genome.variations for member in state.population}
    crossed = sum(child.genome.variations not in structures for child in children) / len(children)
    mutated = sum(not numbers.issuperset(child.genome.values) for child in children) / len(children)
    assert 0.4 * 60 < len(children) / 4 <= 60  # at least 0.4 of the couples whatever their ranks
    assert crossed > 0.3
    assert least <= mutated <= most


def test_each_child_is_decoded_from_its_own_structure():
    ga = VariationalGA(ENCODING, population=30, couples=20)
    batch, waiting = ga.ask(ga.init(stream(1)), stream(2))
    children, _ = ga.ask(ga.tell(waiting, batch, costs(batch)), stream(3))
    for child in children:
        assert child.program == ENCODING.decode(child.genome)
        assert tuple(child.values) == child.genome.values


def test_a_child_replaces_by_its_own_rank_and_all_ranks_follow():
    ga = VariationalGA(ENCODING, population=30, couples=20)
    batch, waiting = ga.ask(ga.init(stream(1)), stream(2))
    state = ga.tell(waiting, batch, costs(batch))
    for generation in range(3, 9):
        children, waiting = ga.ask(state, stream(generation))
        rows = [tuple(row) for row in state.functionals]
        for row in map(tuple, mean_and_worst(costs(children))):
            ranks = [_rank(other, rows) for other in rows]
            worst = max(range(1, 30), key=lambda k, ranks=ranks: (ranks[k], -k))
            if _rank(row, rows) < ranks[worst]:
                rows[worst] = row
        state = ga.tell(waiting, children, costs(children))
        assert [tuple(row) for row in state.functionals] == rows
        assert state.ranks.tolist() == [_rank(row, rows) for row in rows]


def _rank(row, rows):
    return sum(other != row and all(a <= b for a, b in zip(other, row, strict=True)) for other in rows)


@pytest.mark.parametrize("gray_bits", [0, 16])
def test_negative_parameters_stay_negative(gray_bits):
    encoding = VariationalEncoding(("a",), ("y",), space=ParameterSpace(2, -4.0, 4.0), gray_bits=gray_bits)
    genome = encoding.basic([-3.0, -0.5])
    assert genome.values == (-3.0, -0.5)
    for seed in range(20):
        for child in encoding.children(genome, genome, stream(seed)):
            assert child.values == (-3.0, -0.5)  # both are numbers that 16 bits can write


def test_bits_after_the_cut_are_the_other_parents_and_no_bit_is_lost():
    encoding = VariationalEncoding(("a",), ("y",), space=ParameterSpace(2, 0.0, 16.0), gray_bits=8)
    a, b = encoding.basic([0.0, 0.0]), encoding.basic([10.625, 10.625])
    ours, theirs = (bits(genome) for genome in (a, b))
    cuts = set()
    for seed in range(200):
        family = [bits(child) for child in encoding.children(a, b, stream(seed))]
        (cut,) = [k for k in range(17) if family[0] == ours[:k] + theirs[k:]] or [None]
        assert family[1] == theirs[:cut] + ours[cut:]
        assert family[2:] == family[:2]
        cuts.add(cut)
    assert cuts == set(range(17))


def bits(genome):
    return sum((value_to_gray(value, 8, 0.0, 16.0) for value in genome.values), ())


def test_an_angle_wraps_for_the_law_and_for_the_arrival_alike():
    plant = gs.Plant(
        lambda x, u: (u.omega,),
        states={"theta": "rad"},
        controls={"omega": ("rad/s", -1.0, 1.0)},
        angles=("theta",),
    )
    problem = gs.Problem(plant, [(3.0,)], goal=(-3.0,), tolerance=0.05, horizon=2.0, period=0.05)
    builder = gs.Builder(problem.features.names)
    toward = builder.build([builder.inputs[0]], ["omega"])
    arrival = gs.Evaluator(problem).of_program(toward, np.empty((1, 0))).arrival[0, 0]
    assert arrival == pytest.approx(-np.log(0.05 / (2 * np.pi - 6.0)), abs=0.06)  # the short way, across pi
