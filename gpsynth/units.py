"""Units checked: where a law or a plant adds, compares or exponentiates what does not belong together.

Inputs and outputs have the units that the plant says; parameters, and numbers in formulas, may have any. What each
parameter's unit must be follows from linear equations between exponents, which are solved as they come up.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import count

from gpsynth.checks import check_kind
from gpsynth.dimensions import Dimension, alike, dimension, powers, product, pure, text
from gpsynth.errors import UnitError
from gpsynth.formula import TEXT
from gpsynth.law import Law
from gpsynth.plant import Plant
from gpsynth.program import Program

LONGEST = 60  # characters of a formula in a message
ANY = "any"
_UNKNOWN = "?"  # bases that begin with it stand for what is not known yet


@dataclass(frozen=True)
class UnitReport:
    """What a check has found."""

    conflicts: tuple[str, ...]  # one sentence each
    parameters: Mapping[str, str]  # the unit of each parameter, "any" where nothing says

    @property
    def consistent(self) -> bool:
        """Whether all units fit."""
        return not self.conflicts

    def __str__(self) -> str:
        units = [f"{name} in {unit}" for name, unit in self.parameters.items()]
        return "\n".join(self.conflicts or ["the units fit"]) + (
            "\nwith " + ", ".join(units) if units else ""
        )


def check_units(source: Law | Plant) -> UnitReport:
    """Whether a law's features and formula, or a plant's dynamics, are consistent with the units of the plant.

    Raises UnitError for a unit that cannot be read.
    """
    check_kind("what check_units is given", source, Law, Plant, error=UnitError)
    equations = _Equations()
    if isinstance(source, Plant):
        known = _of_plant(source)
        rates = [product((known[name], 1), (dimension("s"), -1)) for name in source.state_names]
        _check(equations, source.dynamics, known, rates)
        return UnitReport(tuple(equations.conflicts), {})
    known = _of_plant(source.plant)
    known |= {f"{name}_target": known[name] for name in source.plant.state_names}
    seen = dict(zip(source.features.names, _check(equations, source.features, known), strict=True))
    numbers = {name: equations.unknown() for name in source.program.parameters}
    _check(
        equations, source.program, {**seen, **numbers}, [known[name] for name in source.plant.control_names]
    )
    parameters = {name: equations.shown(number) for name, number in numbers.items()}
    return UnitReport(tuple(equations.conflicts), parameters)


def _of_plant(plant: Plant) -> dict[str, Dimension]:
    controls = {name: unit for name, (unit, _, _) in plant.controls.items()}
    parameters = {name: unit for name, (unit, *_) in plant.parameters.items()}
    units = {**plant.states, **controls, **parameters, "t": "s"}
    return {name: dimension(unit) for name, unit in units.items()}


@dataclass
class _Equations:
    """Equations between dimensions; an unknown that one of them settles is put in wherever it stands."""

    conflicts: list[str] = field(default_factory=list)
    settled: dict[str, Dimension] = field(default_factory=dict)
    numbers: "count[int]" = field(default_factory=count)

    def unknown(self) -> Dimension:
        return {f"{_UNKNOWN}{next(self.numbers)}": Fraction(1)}

    def reduced(self, of: Dimension) -> Dimension:
        while known := [base for base in of if base in self.settled]:
            base = known[0]
            of = product((of, 1), ({base: Fraction(1)}, -of[base]), (self.settled[base], of[base]))
        return of

    def equate(self, a: Dimension, b: Dimension, place: str) -> None:
        """Note a = b; where nothing unknown is left to make it true, that is a conflict at `place`."""
        rest = self.reduced(product((a, 1), (b, -1)))
        free = [base for base in rest if base.startswith(_UNKNOWN)]
        if free:
            base = free[0]
            others = product((rest, 1), ({base: Fraction(1)}, -rest[base]))
            self.settled[base] = product((others, Fraction(-1) / rest[base]))
        elif rest:
            left, right = self.shown(a), self.shown(b)
            if ANY in (left, right):
                self.conflicts.append(f"{place}: the units differ by {text(rest)}")
            else:
                self.conflicts.append(f"{place}: {left} does not fit {right}")

    def shown(self, of: Dimension) -> str:
        reduced = self.reduced(of)
        return ANY if any(base.startswith(_UNKNOWN) for base in reduced) else text(reduced)


def _check(
    equations: _Equations, program: Program, known: Mapping[str, Dimension], wanted: Sequence[Dimension] = ()
) -> list[Dimension]:
    """The dimensions of the outputs, which are to be those `wanted`; known are inputs and parameters by name."""
    leaves, spelled = program.leaves, _spelled(program)
    found = [known.get(leaf.name, {}) for leaf in leaves]

    def of(index: int) -> Dimension:
        is_number = index < len(leaves) and leaves[index].kind == "constant"
        return (
            equations.unknown() if is_number else found[index]
        )  # a number may mean something else at each use

    for index, (row, operands) in enumerate(program.instructions, start=len(leaves)):
        values = [of(operand) for operand in operands]
        same = alike(row.name)
        for other in same[1:]:
            equations.equate(values[other], values[same[0]], spelled[index])
        for operand in pure(row.name):
            equations.equate(values[operand], {}, spelled[index])
        found.append(equations.reduced(product(*zip(values, powers(row.name), strict=True))))
    results = [of(output) for output in program.outputs.tolist()]
    for result, want, name in zip(results, wanted, program.names, strict=False):
        equations.equate(result, want, name)
    return results


def _spelled(program: Program) -> list[str]:
    """Each value as a formula, shortened."""
    values = [TEXT.leaf(leaf) for leaf in program.leaves]
    for row, operands in program.instructions:
        piece = TEXT.node(row, tuple(values[operand] for operand in operands))
        shown = piece.text if len(piece.text) <= LONGEST else f"{piece.text[: LONGEST - 3]}..."
        values.append(type(piece)(shown, piece.level, piece.is_number))
    return [value.text for value in values]
