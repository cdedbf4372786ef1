"""Builder: programs written instruction by instruction, equal values shared, dead values dropped, every bit kept."""

from collections.abc import Sequence
from typing import cast

import numpy as np

from gpsynth.checks import check_kind, check_names, check_number
from gpsynth.errors import ProgramError
from gpsynth.operations import CODES, OPERATIONS, operation
from gpsynth.program import UNUSED, Program

Reference = int  # a value inside one builder

_Key = tuple[object, ...]


class Builder:
    """Collects values; `build` makes the program of those that outputs need.

    Equal instructions on equal values are one value, and what has only constants for operands is computed at once.
    Only rewrites that keep every bit are done: x * 1, x / 1, x - 0, -(-x) and identities vanish.
    """

    def __init__(self, inputs: Sequence[str], parameters: Sequence[str] = ()) -> None:
        self._inputs = check_names("inputs", inputs, ProgramError)
        self._parameters = check_names("parameters", parameters, ProgramError)
        self._keys: list[_Key] = []
        self._known: dict[_Key, Reference] = {}
        self.inputs: list[Reference] = [self._value(("input", i)) for i in range(len(self._inputs))]
        self.parameters: list[Reference] = [
            self._value(("parameter", i)) for i in range(len(self._parameters))
        ]

    def constant(self, value: float) -> Reference:
        """A constant; distinct bits are distinct values, so -0.0 is not 0.0."""
        try:
            return self._value(("constant", float(value).hex()))
        except (TypeError, ValueError):
            raise ProgramError(f"a constant is a number, got {value!r}") from None

    def apply(self, name: str, *operands: Reference) -> Reference:
        """The value of an operation; raises OperationError or ProgramError if name or operands are wrong."""
        row = operation(name)
        if len(operands) != row.arity:
            raise ProgramError(f"{name} takes {row.arity} operands, got {len(operands)}")
        values = [self.value_of(operand) for operand in operands]
        if all(value is not None for value in values):
            from gpsynth.kernels import elementary  # numba loads on first use

            return self.constant(elementary.evaluate(name, *[value for value in values if value is not None]))
        same = self._rewritten(name, operands, values)
        if same is not None:
            return same
        return self._value((name, *(self._sorted(operands) if row.commutative else operands)))

    def inline(
        self, program: Program, inputs: Sequence[Reference], parameters: Sequence[Reference] = ()
    ) -> list[Reference]:
        """The outputs of `program` computed from values of this builder."""
        if len(inputs) != len(program.inputs) or len(parameters) != len(program.parameters):
            raise ProgramError(
                f"the program takes {len(program.inputs)} inputs and {len(program.parameters)} parameters, "
                f"got {len(inputs)} and {len(parameters)}"
            )
        leaves = {"input": inputs, "parameter": parameters}
        return list(
            program.fold(
                lambda leaf: (
                    self.constant(leaf.value) if leaf.kind == "constant" else leaves[leaf.kind][leaf.index]
                ),
                lambda row, operands: self.apply(row.name, *operands),
            )
        )

    def build(self, outputs: Sequence[Reference], names: Sequence[str] | None = None) -> Program:
        """The program of these values, without whatever they do not need."""
        for output in outputs:
            self.value_of(output)  # raises if there is none
        needed = self._needed(outputs)
        constants = [index for index in needed if self._keys[index][0] == "constant"]
        computed = [index for index in needed if self._keys[index][0] in CODES]
        order = [*self.inputs, *self.parameters, *constants, *computed]
        number = {index: position for position, index in enumerate(order)}
        return Program(
            inputs=self._inputs,
            parameters=self._parameters,
            constants=np.array(
                [float.fromhex(str(self._keys[index][1])) for index in constants], dtype=np.float64
            ),
            code=np.array([self._row(index, number) for index in computed], dtype=np.int32).reshape(-1, 4),
            outputs=np.array([number[output] for output in outputs], dtype=np.int32),
            names=tuple(names) if names is not None else tuple(f"y{k}" for k in range(len(outputs))),
        )

    def value_of(self, reference: Reference) -> float | None:
        """The number a constant stands for; None for what is not a constant."""
        if not 0 <= reference < len(self._keys):
            raise ProgramError(f"there is no value {reference}; this builder has {len(self._keys)}")
        kind, *rest = self._keys[reference]
        return float.fromhex(str(rest[0])) if kind == "constant" else None

    def _value(self, key: _Key) -> Reference:
        if key not in self._known:
            self._known[key] = len(self._keys)
            self._keys.append(key)
        return self._known[key]

    def _sorted(self, operands: Sequence[Reference]) -> list[Reference]:
        # Constants last, wherever they came in, so that building a built program again gives the same code.
        return sorted(operands, key=lambda operand: (self._keys[operand][0] == "constant", operand))

    def _operands(self, index: Reference) -> tuple[Reference, ...]:
        key = self._keys[index]
        return cast(tuple[Reference, ...], key[1:]) if key[0] in CODES else ()

    def _rewritten(
        self, name: str, operands: Sequence[Reference], values: Sequence[float | None]
    ) -> Reference | None:
        if name == "identity":
            return operands[0]
        if name == "neg" and self._keys[operands[0]][0] == "neg":
            return self._operands(operands[0])[0]
        if name == "mul" and 1.0 in values:
            return operands[1 - values.index(1.0)]
        if name == "div" and values[1] == 1.0:
            return operands[0]
        if name == "sub" and values[1] is not None and values[1].hex() == (0.0).hex():
            return operands[0]
        if name == "where" and values[0] is not None:
            return operands[2] if values[0] == 0.0 else operands[1]
        return None

    def _needed(self, outputs: Sequence[Reference]) -> list[Reference]:
        marked = set(outputs)
        for index in range(len(self._keys) - 1, -1, -1):
            if index in marked:
                marked.update(self._operands(index))
        return sorted(marked)

    def _row(self, index: Reference, number: dict[Reference, int]) -> list[int]:
        code = CODES[str(self._keys[index][0])]
        operands = [number[operand] for operand in self._operands(index)]
        return [code, *operands, *[UNUSED] * (3 - OPERATIONS[code].arity)]


def simplify(program: Program) -> Program:
    """The same function, bit for bit, without dead code, common subexpressions and constant arithmetic."""
    check_kind("program", program, Program, error=ProgramError)
    builder = Builder(program.inputs, program.parameters)
    return builder.build(builder.inline(program, builder.inputs, builder.parameters), program.names)


def compose(outer: Program, inner: Program) -> Program:
    """outer(inner(x)): the outputs of `inner` are the inputs of `outer`; parameters of inner come first."""
    check_kind("outer", outer, Program, error=ProgramError)
    check_kind("inner", inner, Program, error=ProgramError)
    builder = Builder(inner.inputs, inner.parameters + outer.parameters)
    split = len(inner.parameters)
    values = builder.inline(inner, builder.inputs, builder.parameters[:split])
    return builder.build(builder.inline(outer, values, builder.parameters[split:]), outer.names)


def bind(program: Program, parameters: Sequence[float]) -> Program:
    """The program with its parameters replaced by these numbers."""
    check_kind("program", program, Program, error=ProgramError)
    for value in parameters:
        check_number("a parameter", value, ProgramError)
    builder = Builder(program.inputs)
    values = [builder.constant(value) for value in parameters]
    return builder.build(builder.inline(program, builder.inputs, values), program.names)
