import numpy as np
import pytest

from gpsynth.encodings.cartesian import CartesianEncoding
from gpsynth.encodings.template import TemplateEncoding
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.errors import EncodingError, FormulaError
from gpsynth.guesses import genomes_of
from gpsynth.law import Law
from gpsynth.synthesis import synthesize
from gpsynth.tracing import trace
from tests.test_synthesis import PLANT, encoding, quadratic

PROBLEM = quadratic()
NAMES = PROBLEM.features.names
ENCODING = encoding(PROBLEM)


def linear(features):
    return 1.0 * features.error_place + 1.5 * features.error_speed


def test_every_form_of_a_formula_is_the_same_guess():
    program = trace(lambda f: f.error_place + 1.5 * f.error_speed, [("f", NAMES)], ("force",))
    given = (
        "error_place + 1.5 * error_speed",
        linear,
        program,
        Law(PLANT, PROBLEM.features, program, np.empty(0)),
    )
    assert len(set(genomes_of(given, ENCODING))) == 1


def test_the_search_begins_with_the_guess():
    result = synthesize(
        PROBLEM, ENCODING, seed=1, budget=210, tuning=0, guesses=["error_place + 1.5*error_speed"]
    )
    law = result.law
    assert law.complexity == 2
    assert float(law((0.1, 0.0), (0.0, 0.0))[0]) == pytest.approx(-0.1)
    assert result.best.cost < synthesize(PROBLEM, ENCODING, seed=1, budget=210, tuning=0).best.cost


def test_guesses_for_a_template_fill_its_holes():
    holes = TreeEncoding(NAMES, ("gain",), ("add", "mul"), ENCODING.space)
    template = TemplateEncoding(holes, lambda f, gain: f.error_place + gain * f.error_speed, ("force",))
    (genome,) = genomes_of(["1.5"], template)
    rows = np.array([[2.0, 4.0]])
    assert template.decode(genome)(rows, template.parameters(genome))[0, 0] == 8.0
    result = synthesize(PROBLEM, template, seed=1, budget=400, tuning=0, guesses=["1.5"])
    slopes = [entry.law.formulas()[-1] for entry in result.front]
    assert all("error_place" in text for text in slopes)


@pytest.mark.parametrize(
    ("guess", "error", "sentence"),
    [
        ("error_place +", FormulaError, "guess 1: the text is not a formula"),
        ("tanh(error_place)", EncodingError, "guess 1: the formula uses tanh"),
        (3, FormulaError, "guess 1: expected text, a function, a Program or a Law, got 3"),
    ],
)
def test_a_wrong_guess_is_named_by_its_number(guess, error, sentence):
    with pytest.raises(error, match=sentence):
        genomes_of(["error_place", guess], ENCODING)


def test_an_encoding_that_cannot_read_formulas_says_so():
    cartesian = CartesianEncoding(NAMES, ("force",), ("add",))
    with pytest.raises(EncodingError, match="CartesianEncoding cannot begin with given formulas"):
        genomes_of(["error_place"], cartesian)
    assert genomes_of([], cartesian) == ()
