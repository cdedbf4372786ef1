"""Formulas of a fixed form: the search fills holes in a skeleton that a person has written."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats
from gpsynth.builder import Builder
from gpsynth.checks import check_names
from gpsynth.encodings.checks import checked_names
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.protocol import Encoding
from gpsynth.errors import EncodingError
from gpsynth.program import Program
from gpsynth.tracing import trace

G = TypeVar("G")


@dataclass(frozen=True, init=False)
class TemplateEncoding(Generic[G]):
    """The outputs of `skeleton(features, *holes)`, where the formulas of another encoding are the holes.

    `skeleton` is a function like `lambda f, g1, g2: (g1, f.error_x * g2)`, or a Program of the inputs and the holes.
    The holes' encoding may see fewer inputs than the skeleton; genomes are its own. Raises EncodingError if names do
    not fit, TracingError if the function cannot become a Program.
    """

    holes: Encoding[G]
    skeleton: Program
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]

    def __init__(
        self,
        holes: Encoding[G],
        skeleton: Callable[..., Any] | Program,
        outputs: Sequence[str],
        *,
        inputs: Sequence[str] | None = None,
    ) -> None:
        if not isinstance(holes, Encoding):
            raise EncodingError(
                f"the holes of a template are an encoding such as TreeEncoding(...), got {holes!r}"
            )
        outputs = check_names("outputs", outputs, EncodingError)
        inputs = check_names("inputs", holes.inputs if inputs is None else inputs, EncodingError)
        checked_names(inputs, outputs)
        unseen = [name for name in holes.inputs if name not in inputs]
        if unseen:
            raise EncodingError(
                f"the holes see {unseen[0]!r}, which is not one of the inputs {', '.join(inputs)}"
            )
        both = [name for name in holes.outputs if name in inputs]
        if both:
            raise EncodingError(f"{both[0]!r} is the name of a hole and of an input")
        object.__setattr__(self, "holes", holes)
        object.__setattr__(self, "inputs", inputs)
        object.__setattr__(self, "outputs", outputs)
        object.__setattr__(self, "skeleton", _skeleton(self, skeleton))

    @property
    def space(self) -> ParameterSpace:
        """The numbers are those in the holes."""
        return self.holes.space

    def random(self, rng: np.random.Generator) -> G:
        """Holes filled from anywhere in their space."""
        return self.holes.random(rng)

    def mutate(self, genome: G, rng: np.random.Generator) -> G:
        """The holes' encoding decides."""
        return self.holes.mutate(genome, rng)

    def crossover(self, a: G, b: G, rng: np.random.Generator) -> tuple[G, G]:
        """The holes' encoding decides."""
        return self.holes.crossover(a, b, rng)

    def decode(self, genome: G) -> Program:
        """The skeleton with the formulas put in."""
        formulas = self.holes.decode(genome)
        builder = Builder(self.inputs, formulas.parameters)
        of = dict(zip(self.inputs, builder.inputs, strict=True))
        filled = builder.inline(formulas, [of[name] for name in formulas.inputs], builder.parameters)
        return builder.build(builder.inline(self.skeleton, [*builder.inputs, *filled]), self.outputs)

    def parameters(self, genome: G) -> Floats:
        """The numbers in the holes, (p,)."""
        return self.holes.parameters(genome)

    def with_parameters(self, genome: G, values: npt.ArrayLike) -> G:
        """The same formulas with other numbers."""
        return self.holes.with_parameters(genome, values)

    def check(self, genome: G) -> None:
        """Raises EncodingError unless the genome is one of the holes' encoding."""
        self.holes.check(genome)


def _skeleton(encoding: TemplateEncoding[Any], given: Callable[..., Any] | Program) -> Program:
    holes = encoding.holes.outputs
    if isinstance(given, Program):
        program = given
    else:
        arguments = [("features", encoding.inputs), *((name, name) for name in holes)]
        program = trace(given, arguments, encoding.outputs)
    if (
        program.inputs != (*encoding.inputs, *holes)
        or program.parameters
        or program.names != encoding.outputs
    ):
        raise EncodingError(
            f"the skeleton maps {', '.join(program.inputs + program.parameters)} to {', '.join(program.names)}; "
            f"expected {', '.join((*encoding.inputs, *holes))} to {', '.join(encoding.outputs)}"
        )
    first = len(encoding.inputs)
    used = {*program.outputs.tolist(), *program.code[:, 1:].ravel().tolist()}
    unused = [name for number, name in enumerate(holes, start=first) if number not in used]
    if unused:
        raise EncodingError(f"the skeleton does not use the hole {unused[0]!r}")
    return program
