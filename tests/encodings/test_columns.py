from dataclasses import replace

import numpy as np
import pytest

from gpsynth.encodings.columns import Columns, basic_columns
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.symbols import function_of, symbol_of
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.errors import EncodingError
from gpsynth.kernels import elementary
from gpsynth.operations import operation
from gpsynth.optimizers import minimize
from gpsynth.seeds import stream
from gpsynth.structure_search import StructureSearch
from tests.encodings.helpers import ENCODINGS, PLAIN, check_weighted_sum

SIN, ADD = symbol_of("sin"), symbol_of("add")


@pytest.mark.parametrize("name", ["columns", "columns-no-numbers"])
def test_programs_equal_the_calls_made_one_by_one(name):
    encoding = ENCODINGS[name]
    rng = stream(1)
    for _ in range(50):
        genome = encoding.random(rng)
        columns = encoding.rebased(genome).basis
        x = rng.uniform(-1, 1, len(encoding.inputs))
        values = [*x.tolist(), *genome.values]
        for symbol, *operands in columns.entries.tolist():
            function = function_of(symbol)
            arguments = [values[operand] for operand in operands[: operation(function).arity]]
            values.append(elementary.evaluate(function, *arguments))
        result = encoding.decode(genome)(x[None], genome.values)[0]
        assert np.array_equal(result, values[-len(encoding.outputs) :])


@pytest.mark.parametrize("counts", [(1, 0, 1), (1, 3, 2), (3, 3, 2), (5, 2, 3)])
def test_the_basic_columns_weight_and_sum(counts):
    check_weighted_sum(basic_columns(*counts), counts)


def test_variations_reach_every_row_and_nothing_to_the_right():
    columns = basic_columns(2, 1, 1, n_calls=6)
    functions = columns.functions(("sin", "add"))
    rng = stream(2)
    drawn = {columns.draw(columns.entries, functions, rng) for _ in range(5000)}
    assert {value for _, row, value in drawn if row == 0} == {SIN, ADD}
    assert {(call, value) for call, row, value in drawn if row > 0} == {
        (call, value) for call in range(6) for value in range(3 + call)
    }


@pytest.mark.parametrize(
    ("entries", "sentence"),
    [
        ([[ADD, 0, 2]], "call 0 has operand 2"),
        ([[ADD, 0, -1]], "call 0 has operand -1"),
        ([[0, 0, 0]], "call 0 has symbol 0"),
        ([[symbol_of("where"), 0, 0]], "call 0 has symbol"),
        ([[ADD]], "2 to 4 rows"),
        (np.empty((0, 3), dtype=np.int32), "0 calls; expected 1 outputs"),
    ],
)
def test_columns_that_are_none_are_refused(entries, sentence):
    with pytest.raises(EncodingError, match=sentence):
        Columns(np.array(entries), 1, 1, 1)


def test_more_operands_than_rows_are_refused():
    with pytest.raises(EncodingError, match="where takes 3 operands; the columns have room for 2"):
        VariationalEncoding(("x",), ("u",), ("add", "where"), basis=basic_columns(1, 0, 1))


@pytest.mark.parametrize("variation", [(0, 0, 99), (99, 1, 0), (0, 1, 9), (0, 4, 0), (0, 1), (0, 1, 0.0)])
def test_foreign_variations_are_refused(variation):
    encoding = ENCODINGS["columns"]
    genome = encoding.basic()
    with pytest.raises(EncodingError, match="variation 0 is"):
        encoding.check(replace(genome, variations=(variation, *genome.variations[1:])))


def test_a_search_finds_more_than_the_slope_of_a_curve():
    space = ParameterSpace(2, -4, 4)
    encoding = VariationalEncoding(("x",), ("u",), PLAIN, space, basic_columns(1, 2, 1), n_variations=12)
    x = np.linspace(-1.5, 1.5, 21)
    wanted = x**3 - 2.0 * x
    line = np.mean((wanted - np.polyval(np.polyfit(x, wanted, 1), x)) ** 2)

    def costs(batch):
        return np.array([(each.program(x[:, None], each.values)[:, 0] - wanted) ** 2 for each in batch])

    search = StructureSearch(encoding, population=60, offspring=30)
    assert minimize(costs, search, seed=1, budget=2_000, target=line / 6).cost < line / 5
