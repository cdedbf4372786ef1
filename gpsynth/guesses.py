"""Formulas that a search begins with, in whatever form the user has them."""

from collections.abc import Callable, Sequence
from typing import Any, Protocol, TypeVar, runtime_checkable

from gpsynth.encodings.template import TemplateEncoding
from gpsynth.errors import EncodingError, FormulaError
from gpsynth.formula_text import read_formulas
from gpsynth.law import Law
from gpsynth.program import Program
from gpsynth.tracing import trace

G_co = TypeVar("G_co", covariant=True)
Guess = str | Callable[..., Any] | Program | Law


@runtime_checkable
class ReadsPrograms(Protocol[G_co]):
    """An encoding that can tell which of its genomes a given formula is."""

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of what formulas are computed from."""
        ...

    @property
    def outputs(self) -> tuple[str, ...]:
        """Names of the formulas."""
        ...

    def from_program(self, program: Program, parameters: Sequence[float] = ()) -> G_co:
        """The genome of a formula; raises EncodingError if it has none."""
        ...


def genomes_of(guesses: Sequence[Guess], encoding: Any) -> tuple[Any, ...]:
    """The genome of each guess: text, a function of the encoding's inputs, a Program, or a Law, with its numbers.

    For a template the guesses are formulas of its holes. Raises EncodingError, FormulaError or TracingError, saying
    which guess it is about.
    """
    if not isinstance(guesses, list | tuple):
        raise FormulaError(f"guesses are formulas in a list, got {guesses!r}")
    if isinstance(encoding, TemplateEncoding):
        encoding = encoding.holes
    if guesses and not isinstance(encoding, ReadsPrograms):
        raise EncodingError(f"{type(encoding).__name__} cannot begin with given formulas; TreeEncoding can")
    return tuple(_genome(f"guess {number}", guess, encoding) for number, guess in enumerate(guesses))


def _genome(label: str, guess: Guess, encoding: ReadsPrograms[Any]) -> Any:
    try:
        if isinstance(guess, Law):
            return encoding.from_program(guess.program, guess.parameters.tolist())
        return encoding.from_program(_program(guess, encoding))
    except (EncodingError, FormulaError) as error:
        raise type(error)(f"{label}: {error}") from None


def _program(guess: str | Callable[..., Any] | Program, encoding: ReadsPrograms[Any]) -> Program:
    if isinstance(guess, Program):
        return guess
    if isinstance(guess, str):
        return read_formulas(guess, encoding.inputs, encoding.outputs)
    if callable(guess):
        return trace(guess, [("features", encoding.inputs)], encoding.outputs)
    raise FormulaError(f"expected text, a function, a Program or a Law, got {guess!r}")
