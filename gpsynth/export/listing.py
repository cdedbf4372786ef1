"""A law as straight-line assignments, which C and Python write in their own syntax."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from gpsynth.builder import Builder
from gpsynth.checks import check_kind
from gpsynth.errors import LawError
from gpsynth.law import Law
from gpsynth.operations import Operation
from gpsynth.program import Program

OPERATORS: Mapping[str, str] = MappingProxyType(
    {"add": "{0} + {1}", "sub": "{0} - {1}", "mul": "{0} * {1}", "neg": "-{0}"}
)


@dataclass(frozen=True)
class Assignment:
    """`name` becomes `value`, both in the syntax of the target language; the remark says what it is."""

    name: str
    value: str
    remark: str = ""


@dataclass(frozen=True)
class Syntax:
    """How a target language writes numbers, operations and elements of the state and target."""

    number: Callable[[float], str]
    operation: Callable[[Operation, tuple[str, ...]], str]
    element: str = "{0}[{1}]"


@dataclass(frozen=True)
class Listing:
    """The assignments of a law in order, what the controls are then, and which operations were used."""

    assignments: tuple[Assignment, ...]
    controls: tuple[str, ...]
    operations: tuple[str, ...]


def listing(law: Law, syntax: Syntax) -> Listing:
    """States and targets to saturated controls: each value is assigned once, and only what is needed."""
    program, remarks = _with_features(law)
    size = len(law.plant.state_names)
    places = [(vector, index) for vector in ("state", "target") for index in range(size)]
    return assigned(program, syntax, places, remarks=remarks, outputs=len(law.plant.control_names))


def assigned(
    program: Program,
    syntax: Syntax,
    places: Sequence[tuple[str, int]],
    *,
    remarks: Mapping[int, str] = MappingProxyType({}),
    outputs: int,
) -> Listing:
    """The first `outputs` outputs of a program without parameters, whose input k is element places[k] of a vector."""
    live = _live(program, outputs)
    first = len(program.leaves)
    texts: dict[int, str] = {}
    assignments: list[Assignment] = []

    def assign(index: int, value: str, remark: str) -> None:
        texts[index] = f"r{len(assignments) + 1}"
        assignments.append(Assignment(texts[index], value, remark))

    for index, leaf in enumerate(program.leaves):
        if leaf.kind == "constant":
            texts[index] = syntax.number(leaf.value)
        elif index in live:
            assign(index, syntax.element.format(*places[leaf.index]), leaf.name)
    for index, (operation, operands) in enumerate(program.instructions, start=first):
        if index in live:
            value = syntax.operation(operation, tuple(texts[operand] for operand in operands))
            assign(index, value, remarks.get(index, ""))
    return Listing(
        tuple(assignments),
        tuple(texts[output] for output in program.outputs.tolist()[:outputs]),
        tuple(
            sorted(
                {
                    row.name
                    for index, (row, _) in enumerate(program.instructions, start=first)
                    if index in live
                }
            )
        ),
    )


def _with_features(law: Law) -> tuple[Program, dict[int, str]]:
    """The complete law with its numbers; the outputs are the controls, then the features, to tell which is which."""
    check_kind("law", law, Law, error=LawError)
    builder = Builder(law.features.inputs)
    features = builder.inline(law.features, builder.inputs)
    controls = builder.inline(law.bounded, features)
    program = builder.build([*controls, *features])
    named = program.outputs.tolist()[len(controls) :]
    return program, dict(zip(named, law.features.names, strict=True))


def _live(program: Program, n_outputs: int) -> set[int]:
    live = set(program.outputs.tolist()[:n_outputs])
    first = len(program.leaves)
    for index, (_, operands) in reversed(list(enumerate(program.instructions, start=first))):
        if index in live:
            live.update(operands)
    return live
