"""Program: the one intermediate form. Every law, plant, cost and goal test is straight-line code over the table."""

import hashlib
import json
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, TypeVar

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, Ints, frozen
from gpsynth.errors import ProgramError
from gpsynth.operations import CODES, OPERATIONS, Operation

FORMAT = "gpsynth-program/1"
MOST_INSTRUCTIONS = 10_000
UNUSED = -1
NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")

Value = TypeVar("Value")


@dataclass(frozen=True)
class Leaf:
    """An operand that is not computed: an input, a parameter or a constant."""

    kind: Literal["input", "parameter", "constant"]
    index: int
    name: str = ""
    value: float = 0.0


@dataclass(frozen=True, eq=False)
class Program:
    """Straight-line code. Operands number inputs, parameters, constants and earlier instructions, in this order.

    Equality and hash go by content, so programs can be dictionary keys. Raises ProgramError if not well formed.
    """

    inputs: tuple[str, ...]
    parameters: tuple[str, ...]
    constants: Floats  # (c,)
    code: Ints  # (n, 4) operation, then operands, UNUSED where the operation takes fewer than three
    outputs: Ints  # (m,) operands
    names: tuple[str, ...]  # of the outputs

    def __post_init__(self) -> None:
        for field in ("inputs", "parameters", "names"):
            object.__setattr__(self, field, _names(field, getattr(self, field)))
        object.__setattr__(self, "constants", _array("constants", self.constants, np.float64))
        object.__setattr__(self, "code", _array("code", self.code, np.int32, 4))
        object.__setattr__(self, "outputs", _array("outputs", self.outputs, np.int32))
        _check(self)

    def __reduce__(self) -> tuple[Any, ...]:
        # Through the constructor, since numpy's arrays come out of a pickle or a deep copy writable.
        fields = (self.inputs, self.parameters, self.constants, self.code, self.outputs, self.names)
        return type(self), fields

    def fold(
        self, leaf: Callable[[Leaf], Value], node: Callable[[Operation, tuple[Value, ...]], Value]
    ) -> tuple[Value, ...]:
        """The value of each output, `leaf` and `node` being called once for each leaf and instruction, in order."""
        values = [leaf(item) for item in self.leaves]
        for operation, operands in self.instructions:
            values.append(node(operation, tuple(values[operand] for operand in operands)))
        return tuple(values[output] for output in self.outputs)

    @property
    def leaves(self) -> tuple[Leaf, ...]:
        """Inputs, parameters and constants in the order of their operand numbers."""
        return (
            *(Leaf("input", index, name) for index, name in enumerate(self.inputs)),
            *(Leaf("parameter", index, name) for index, name in enumerate(self.parameters)),
            *(Leaf("constant", index, value=float(value)) for index, value in enumerate(self.constants)),
        )

    @property
    def instructions(self) -> tuple[tuple[Operation, tuple[int, ...]], ...]:
        """Each instruction as its operation and operand numbers."""
        rows = self.code.tolist()
        return tuple((OPERATIONS[row[0]], tuple(row[1 : 1 + OPERATIONS[row[0]].arity])) for row in rows)

    @property
    def complexity(self) -> int:
        """The number of instructions; shared values count once."""
        return len(self.code)

    @property
    def depth(self) -> int:
        """The longest chain of instructions from a leaf to an output."""
        return max(self.fold(lambda leaf: 0, lambda operation, depths: 1 + max(depths)), default=0)

    @cached_property
    def hash(self) -> str:
        """SHA-256 of the content; equal for equal programs on every machine."""
        return hashlib.sha256(json.dumps(self._content(), sort_keys=True).encode()).hexdigest()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Program) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    @cached_property
    def _key(self) -> tuple[tuple[str, ...] | bytes, ...]:
        """The content as what Python compares and hashes at once: searches ask for it all the time."""
        numbers = (self.constants.tobytes(), self.code.tobytes(), self.outputs.tobytes())
        return self.inputs, self.parameters, self.names, *numbers

    def __call__(self, inputs: Floats, parameters: Floats | Sequence[float] = ()) -> Floats:
        """Outputs (N, m) of inputs (N, n), computed by the lane machine.

        `parameters` is one vector (p,) for all rows, or (N, p). Raises ProgramError if a shape does not fit.
        """
        from gpsynth.kernels import machine  # numba loads on first use

        rows = _numbers("inputs", inputs)
        if np.ndim(inputs) != 2 or rows.shape[1] != len(self.inputs):
            raise ProgramError(f"inputs have shape {np.shape(inputs)}; expected (N, {len(self.inputs)})")
        values = np.atleast_2d(_numbers("parameters", parameters))
        fits = (
            values.ndim == 2 and values.shape[0] in (1, len(rows)) and values.shape[1] == len(self.parameters)
        )
        if np.ndim(parameters) == 0 or not fits:
            raise ProgramError(
                f"parameters have shape {np.shape(parameters)}; expected ({len(self.parameters)},) "
                f"or ({len(rows)}, {len(self.parameters)})"
            )
        return machine.evaluate(self.code, self.constants, self.outputs, rows, values)

    def to_dict(self) -> dict[str, Any]:
        """A JSON-ready description; constants are hexadecimal, operations stand by name."""
        return {**self._content(), "hash": self.hash}

    @classmethod
    def from_dict(cls, document: Any) -> "Program":
        """The program of a `to_dict` document; raises ProgramError if the document is not one."""
        if not isinstance(document, dict) or document.get("format") != FORMAT:
            raise ProgramError(f"a program document has format {FORMAT!r}")
        expected = {"format", "inputs", "parameters", "constants", "code", "outputs", "names", "hash"}
        if set(document) != expected:
            raise ProgramError(
                f"a program document has the fields {sorted(expected)}, not {sorted(map(str, document))}"
            )
        wrong = [
            field for field in sorted(expected - {"format", "hash"}) if not isinstance(document[field], list)
        ]
        if wrong:
            raise ProgramError(
                f"the field {wrong[0]} of a program document is a list, not {document[wrong[0]]!r}"
            )
        try:
            program = cls(
                inputs=tuple(document["inputs"]),
                parameters=tuple(document["parameters"]),
                constants=np.array([float.fromhex(text) for text in document["constants"]], dtype=np.float64),
                code=np.array([_row(instruction) for instruction in document["code"]], dtype=np.int32),
                outputs=np.array([_integer(output) for output in document["outputs"]], dtype=np.int32),
                names=tuple(document["names"]),
            )
        except (TypeError, ValueError, KeyError, IndexError, OverflowError) as error:
            raise ProgramError(f"the program document is malformed: {error}") from None
        if program.hash != document["hash"]:
            raise ProgramError("the program document does not match its hash; it was changed or damaged")
        return program

    def _content(self) -> dict[str, Any]:
        return {
            "format": FORMAT,
            "inputs": list(self.inputs),
            "parameters": list(self.parameters),
            "constants": [float(value).hex() for value in self.constants],
            "code": [[operation.name, *operands] for operation, operands in self.instructions],
            "outputs": self.outputs.tolist(),
            "names": list(self.names),
        }


def _integer(value: Any) -> int:
    if type(value) is not int:
        raise ValueError(f"expected an integer, got {value!r}")
    return value


def _row(instruction: Any) -> list[int]:
    if not isinstance(instruction, list) or not instruction or instruction[0] not in CODES:
        raise ValueError(f"expected the name of an operation and its operands, got {instruction!r}")
    name, *operands = instruction
    if len(operands) != OPERATIONS[CODES[name]].arity:
        raise ValueError(f"{name} takes {OPERATIONS[CODES[name]].arity} operands, got {len(operands)}")
    padding = [UNUSED] * (3 - len(operands))
    return [CODES[name], *(_integer(operand) for operand in operands), *padding]


def _names(field: str, names: Any) -> tuple[str, ...]:
    if not isinstance(names, tuple | list):
        raise ProgramError(f"the {field} of a program are a tuple of names, not {names!r}")
    for name in names:
        if not isinstance(name, str) or not NAME.match(name):
            raise ProgramError(f"{name!r} is not a name: a letter or _, then letters, digits and _")
    return tuple(names)


def _numbers(what: str, values: Any) -> Floats:
    try:
        return np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ProgramError(f"{what} must hold numbers in rows of equal length, got {values!r}") from None


def _array(field: str, values: Any, dtype: type[np.generic], *width: int) -> npt.NDArray[Any]:
    """A read-only array (any number, *width) that holds exactly these values."""
    given = np.asarray(values) if np.size(values) else np.empty((0, *width), dtype)
    kinds = "iu" if dtype is np.int32 else "iuf"
    if given.dtype.kind not in kinds or given.ndim != 1 + len(width) or given.shape[1:] != width:
        expected = ", ".join(("any number", *map(str, width)))
        raise ProgramError(
            f"{field} of a program: expected {'integers' if kinds == 'iu' else 'numbers'} of shape ({expected}), "
            f"got {given.dtype} of shape {given.shape}"
        )
    converted = frozen(given.astype(dtype))
    if dtype is np.int32 and given.dtype != dtype and np.any(converted != given):
        raise ProgramError(f"the {field} of a program are 32-bit integers, got {given.tolist()}")
    return converted


def _check(program: Program) -> None:
    if len(set(program.inputs + program.parameters)) < len(program.inputs) + len(program.parameters):
        raise ProgramError("inputs and parameters need different names")
    if len(program.names) != len(program.outputs):
        raise ProgramError(f"{len(program.outputs)} outputs have {len(program.names)} names")
    if len(set(program.names)) < len(program.names):
        raise ProgramError(f"the outputs need different names, not {', '.join(program.names)}")
    if len(program.code) > MOST_INSTRUCTIONS:
        raise ProgramError(f"{len(program.code)} instructions; at most {MOST_INSTRUCTIONS} are allowed")
    known = len(program.inputs) + len(program.parameters) + len(program.constants)
    for index, (code, *operands) in enumerate(program.code.tolist()):
        if not 0 <= code < len(OPERATIONS):
            raise ProgramError("the code names an operation that is not in the table")
        arity = OPERATIONS[code].arity
        used, unused = operands[:arity], operands[arity:]
        if not all(0 <= operand < known + index for operand in used) or unused != [UNUSED] * len(unused):
            name = OPERATIONS[code].name
            raise ProgramError(f"instruction {index} ({name}) uses a value that is not computed before it")
    if not all(0 <= output < known + len(program.code) for output in program.outputs.tolist()):
        raise ProgramError("an output names a value that does not exist")
