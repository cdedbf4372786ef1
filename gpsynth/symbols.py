"""Symbols: stand-ins for numbers that write down, in a Builder, what a Python function does with them.

Operators and numpy functions arrive through numpy's own protocols, so a function that runs on numbers runs on symbols.
"""

import functools
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from gpsynth.builder import Builder, Reference
from gpsynth.errors import TracingError
from gpsynth.numpy_functions import FUNCTIONS, REARRANGEMENTS, REDUCTIONS, unsupported

_COMPARISONS = frozenset({"lt", "le", "eq", "not"})
_DEFAULTS = MappingProxyType({"where": True, "keepdims": False})  # of a ufunc's settings; the others are None
_LARGEST = float(np.finfo(np.float64).max)


def _universal(self: Any, ufunc: np.ufunc, method: str, *inputs: Any, **settings: Any) -> Any:
    """`__array_ufunc__` of everything traced."""
    name = ufunc.__name__
    targets = settings.pop("out", (None,))
    axis = settings.pop("axis", 0)
    if any(value is not _DEFAULTS.get(key) for key, value in settings.items()):
        raise TracingError(f"np.{name} can be traced only without {', '.join(settings)}")
    if method == "reduce" and name in FUNCTIONS:
        return _reduced(ufunc, inputs[0], axis)
    if method == "__call__" and name == "matmul":
        return _as_symbols(np.matmul(*map(_plain, inputs)))
    if method != "__call__" or name not in FUNCTIONS:
        raise unsupported(name if method == "__call__" else f"{name}.{method}")
    result = elementwise(name, *inputs)
    if isinstance(targets[0], Symbols):
        targets[0][...] = result
        return targets[0]
    if isinstance(targets[0], np.ndarray):
        raise TracingError("an array of floats cannot take a traced value; write x = x + 1 and not x += 1")
    return result  # after x += 1 as well, which gives x another value as it does with numbers


def _array_function(self: Any, function: Any, types: Any, args: Any, settings: dict[str, Any]) -> Any:
    """`__array_function__` of everything traced."""
    name = function.__name__
    if name in ("where", "clip"):
        if len(args) != 3 or settings:
            raise TracingError(f"np.{name} can be traced with three arguments, by position, only")
        return elementwise(name, *args)
    if name in REDUCTIONS and len(args) <= 2 and set(settings) <= {"axis"}:
        return _reduced(REDUCTIONS[name], args[0], args[1] if len(args) == 2 else settings.get("axis"))
    if name not in REARRANGEMENTS:
        raise unsupported(name)
    plain = {key: _without_symbols(value) for key, value in settings.items()}
    return _as_symbols(function(*map(_without_symbols, args), **plain))


class Symbol(NDArrayOperatorsMixin):
    """A value known by its place in a Builder; a comparison is the number 1 or 0."""

    __slots__ = ("builder", "is_truth", "reference")
    __array_ufunc__ = _universal
    __array_function__ = _array_function

    def __init__(self, builder: Builder, reference: Reference, is_truth: bool = False) -> None:
        self.builder = builder
        self.reference = reference
        self.is_truth = is_truth

    def lifted(self, value: Any) -> "Symbol":
        """A number as a constant beside this symbol; raises TracingError if it is none, NaN or infinite."""
        if isinstance(value, Symbol):
            if value.builder is not self.builder:
                raise TracingError("a value of another function's run was kept and used here")
            return value
        if not isinstance(value, bool | int | float | np.bool_ | np.integer | np.floating):
            raise TracingError(f"expected a number, got {value!r}")
        if not -_LARGEST <= value <= _LARGEST:  # an integer may be beyond it as well
            raise TracingError(f"the constant {str(value)[:24]} is not a finite float64")
        reference = self.builder.constant(float(value))
        return Symbol(self.builder, reference, isinstance(value, bool | np.bool_))

    def apply(self, name: str, *others: "Symbol") -> "Symbol":
        """The operation of the table called `name`, this symbol being its first operand."""
        references = [other.reference for other in others]
        return Symbol(
            self.builder, self.builder.apply(name, self.reference, *references), name in _COMPARISONS
        )

    def as_truth(self) -> "Symbol":
        """The same value, known to be 1 or 0."""
        return Symbol(self.builder, self.reference, is_truth=True)

    @property
    def number(self) -> float | None:
        """The number, if the value is a constant."""
        return self.builder.value_of(self.reference)

    def __getattr__(self, name: str) -> Any:
        # numpy calls sin(), sqrt(), arctan2() ... of what plain object arrays hold.
        if name not in FUNCTIONS:
            raise AttributeError(f"a value has no {name!r}")
        return functools.partial(elementwise, name, self)

    def __repr__(self) -> str:
        return "<a traced value>" if self.number is None else repr(self.number)

    def __bool__(self) -> bool:
        raise TracingError(
            "a choice (if, while, and, or, not, min, max, comparing an array made from a list) cannot depend on a "
            "traced value; use gpsynth.where, np.minimum, np.maximum, & or |"
        )

    def __float__(self) -> float:
        raise TracingError(
            "float(), functions of math and arrays of floats cannot take a traced value; use numpy's functions "
            "and lists"
        )

    def __int__(self) -> int:
        raise TracingError("int() cannot be traced; use np.floor")

    def __index__(self) -> int:
        raise TracingError("an index or the length of a range cannot be a traced value; use gpsynth.where")

    def __round__(self, digits: int | None = None) -> int:
        raise TracingError("round() cannot be traced; use np.floor(x + 0.5)")

    def __complex__(self) -> complex:
        raise TracingError("complex() cannot be traced; write real and imaginary part as two values")


class Symbols(np.ndarray[Any, np.dtype[np.object_]]):
    """An object array of symbols and numbers on which numpy functions work elementwise."""

    __array_ufunc__ = _universal
    __array_function__ = _array_function  # type: ignore[assignment]  # numpy's stub names the arguments otherwise


class Vector(NDArrayOperatorsMixin):
    """An argument of a traced function: its values by name, by index, sliced, unpacked or as an array."""

    __slots__ = ("_label", "_values")
    __array_ufunc__ = _universal
    __array_function__ = _array_function

    def __init__(self, label: str, values: Mapping[str, Symbol]) -> None:
        self._label = label
        self._values = values

    def __getattr__(self, name: str) -> Symbol:
        if name.startswith("_"):
            raise AttributeError(name)  # numpy and copy ask for protocols
        if name not in self._values:
            raise TracingError(f"{self._label} has no {name!r}; its names are {', '.join(self._values)}")
        return self._values[name]

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, int) and not -len(self) <= index < len(self):
            raise IndexError(
                f"{self._label} has {len(self)} values, {', '.join(self._values)}; no index {index}"
            )
        return _plain(self).view(Symbols)[index]

    def __iter__(self) -> Iterator[Symbol]:
        return iter(self._values.values())

    def __len__(self) -> int:
        return len(self._values)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Any:
        return _plain(self).astype(object if dtype is None else dtype)

    def __repr__(self) -> str:
        return f"{self._label}({', '.join(self._values)})"


def is_traced(value: Any) -> bool:
    """Whether a value is a symbol or holds one."""
    if isinstance(value, list | tuple):
        return any(map(is_traced, value))
    if isinstance(value, np.ndarray) and value.dtype == object:
        return any(isinstance(item, Symbol) for item in value.flat)
    return isinstance(value, Symbol | Vector)


def elementwise(name: str, *operands: Any) -> Any:
    """The function called `name` of numbers, symbols or arrays of them, broadcast as numpy does."""
    arrays = [_plain(operand) for operand in operands]
    known = next((item for array in arrays for item in array.flat if isinstance(item, Symbol)), None)
    if known is None:
        return getattr(np, name)(*(array.astype(np.float64) for array in arrays))
    function, lifted = FUNCTIONS[name], known.lifted
    of_scalars = np.frompyfunc(lambda *scalars: function(*map(lifted, scalars)), len(arrays), 1)
    return _as_symbols(of_scalars(*arrays))


def _reduced(ufunc: np.ufunc, operand: Any, axis: int | None) -> Any:
    array = _plain(operand).view(Symbols)
    return functools.reduce(
        ufunc, array.ravel() if axis is None else np.moveaxis(array.view(np.ndarray), axis, 0)
    )


def _plain(value: Any) -> np.ndarray[Any, Any]:
    """An object array without protocols of its own."""
    array = np.asarray(list(value) if isinstance(value, Vector) else value, dtype=object)
    return array.view(np.ndarray)


def _as_symbols(value: Any) -> Any:
    return value.view(Symbols) if isinstance(value, np.ndarray) and value.dtype == object else value


def _without_symbols(value: Any) -> Any:
    if isinstance(value, list | tuple):
        return [_without_symbols(item) for item in value]
    return _plain(value) if isinstance(value, Symbol | Symbols | Vector) else value
