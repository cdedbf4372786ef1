"""Free numbers inside formulas, fitted on a part of the rows."""

import numpy as np

from gpsynth.regression.library import enumerate_formulas
from gpsynth.regression.loosening import templates
from gpsynth.regression.polish import data_of
from gpsynth.regression.state import State
from gpsynth.regression.targets import plain

FUNCTIONS = frozenset(("mul",))


def test_rows_on_which_the_target_is_constant_have_no_template() -> None:
    rng = np.random.default_rng(2)
    inputs, y = rng.normal(size=(1000, 1)), np.eye(1, 1000)[0]
    state = State(data_of(inputs, y, np.ones(1000)), FUNCTIONS, rng)
    library = enumerate_formulas(inputs[state.rows], FUNCTIONS, 30, lambda: False)
    templates(state, library, plain(state.y))
    assert state.found == []
