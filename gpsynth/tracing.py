"""Tracing: a plain Python function becomes a Program by running once on symbols."""

import inspect
import re
import traceback
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from gpsynth.builder import Builder, Reference
from gpsynth.checks import check_kind
from gpsynth.errors import GpsynthError, ProgramError, TracingError
from gpsynth.program import NAME, Program
from gpsynth.symbols import Symbol, Vector, elementwise, is_traced

_MATH_CALL = re.compile(r"\bmath\.(\w+)\(")
_NUMPY_SPELLINGS = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2", "pow": "power"}

# What an argument holds: values by name; an attribute and the input it reads; or one plain number.
Names = Sequence[str] | Mapping[str, str] | str


def trace(
    function: Callable[..., Any],
    arguments: Sequence[tuple[str, Names]],
    names: Sequence[str] | None = None,
    *,
    unread: Sequence[str] = (),
) -> Program:
    """The program of `function`, whose arguments are vectors of named symbols (or one symbol, if given one name).

    Its inputs are all names in order, and then those called `unread`, which the function does not see. Outputs are
    called `names`, to which a returned dictionary must have the values, or by the keys of a dictionary, or after the
    function. Raises TracingError, naming file and line, for what cannot be traced.
    """
    builder = Builder([*(name for _, group in arguments for name in input_names(group)), *unread])
    symbols = _symbols(builder, arguments)
    if not accepts(function, len(symbols)):
        expected = ", ".join(label for label, _ in arguments)
        raise TracingError(f"{described(function)} must take {len(symbols)} arguments: {expected}")
    result = _run(function, symbols)
    if names is not None and isinstance(result, Mapping):
        result = _in_order(function, result, names)
    outputs = _outputs(function, builder, result)
    names = _output_names(function, result, len(outputs)) if names is None else names
    if len(names) != len(outputs):
        raise TracingError(
            f"{described(function)} returns {len(outputs)} values; expected {len(names)}: {', '.join(names)}"
        )
    try:
        return builder.build(outputs, names)
    except ProgramError as error:
        raise TracingError(f"{described(function)}: {error}") from None


def where(condition: Any, chosen: Any, otherwise: Any) -> Any:
    """`chosen` where the condition holds (is not 0), else `otherwise`: numbers, arrays or traced values."""
    if any(map(is_traced, (condition, chosen, otherwise))):
        return elementwise("where", condition, chosen, otherwise)
    return np.where(condition, chosen, otherwise)[()]


def wrap_angle(angle: Any) -> Any:
    """The angle (rad) moved by whole turns to [-pi, pi): numbers, arrays or traced values; NaN beyond 1e8."""
    if is_traced(angle):
        return elementwise("wrap_angle", angle)
    builder = Builder(("angle",))
    program = builder.build([builder.apply("wrap", builder.inputs[0])])
    try:
        angles = np.asarray(angle, dtype=np.float64)
    except (TypeError, ValueError):
        raise TracingError(f"wrap_angle takes numbers, arrays or traced values, not {angle!r}") from None
    return program(angles.reshape(-1, 1)).reshape(angles.shape)[()]


def inline(program: Program, values: Sequence[Any]) -> tuple[Symbol, ...]:
    """The outputs of `program`, a law's `bounded` for one, where its inputs are traced values or numbers.

    So a function that is traced may use what was found before. Raises TracingError if no value is traced, ProgramError
    if their number is not that of the inputs, or the program has parameters.
    """
    check_kind("program", program, Program, error=TracingError)
    check_kind("values", values, list, tuple, Vector, error=TracingError)
    known = next((value for value in values if isinstance(value, Symbol)), None)
    if known is None:
        raise TracingError(
            f"inline takes traced values; got {values!r}; call the program with arrays instead"
        )
    references = [known.lifted(_scalar(value)).reference for value in values]
    return tuple(Symbol(known.builder, output) for output in known.builder.inline(program, references))


def input_names(group: Names) -> tuple[str, ...]:
    """The inputs that an argument stands for."""
    return tuple(_by_attribute(group).values())


def accepts(function: Callable[..., Any], count: int) -> bool:
    """Whether a function can be called with `count` arguments by position."""
    try:
        inspect.signature(function).bind(*[None] * count)
    except TypeError:
        return False
    except ValueError:  # some built-in functions have no signature
        return True
    return True


def takes_time(function: Callable[..., Any], count: int) -> bool:
    """Whether a function wants the time after its first `count` arguments: one more is required, or is called t."""
    try:
        parameters = list(inspect.signature(function).parameters.values())
    except (TypeError, ValueError):
        return False
    further = [
        item for item in parameters[count:] if item.kind in (item.POSITIONAL_ONLY, item.POSITIONAL_OR_KEYWORD)
    ]
    return bool(further) and (further[0].name == "t" or further[0].default is further[0].empty)


def described(function: Callable[..., Any]) -> str:
    """Name, file and line of a function, for messages."""
    code = getattr(inspect.unwrap(function), "__code__", None)
    name = getattr(function, "__name__", repr(function))
    return name if code is None else f"{name} ({code.co_filename}, line {code.co_firstlineno})"


def _symbols(builder: Builder, arguments: Sequence[tuple[str, Names]]) -> list[Any]:
    references = iter(builder.inputs)
    vectors = [
        Vector(label, {attribute: Symbol(builder, next(references)) for attribute in _by_attribute(group)})
        for label, group in arguments
    ]
    pairs = zip(vectors, arguments, strict=True)
    return [vector[0] if isinstance(group, str) else vector for vector, (_, group) in pairs]


def _by_attribute(group: Names) -> Mapping[str, str]:
    if isinstance(group, str):
        return {group: group}
    return group if isinstance(group, Mapping) else {name: name for name in group}


def _run(function: Callable[..., Any], arguments: Sequence[Any]) -> Any:
    try:
        return function(*arguments)
    except Exception as error:  # noqa: BLE001 whatever a user's function does wrong is the user's to read about
        place = _place(function, traceback.extract_tb(error.__traceback__))
        text = str(error) if isinstance(error, GpsynthError) else f"{type(error).__name__}: {error}"
        call = _MATH_CALL.search(place.line or "") if "functions of math" in text else None
        if call:
            text = f"math.{call[1]} cannot be traced; use numpy's {_NUMPY_SPELLINGS.get(call[1], call[1])}"
        raise TracingError(f"{place.filename}, line {place.lineno}: {text}") from None


def _place(function: Callable[..., Any], frames: Iterable[traceback.FrameSummary]) -> traceback.FrameSummary:
    """The innermost frame in the function's own file, or else below this one."""
    frames = list(frames)
    code = getattr(inspect.unwrap(function), "__code__", None)
    own = [frame for frame in frames if code is not None and frame.filename == code.co_filename]
    return own[-1] if own else frames[min(1, len(frames) - 1)]


def _in_order(function: Callable[..., Any], result: Mapping[Any, Any], names: Sequence[str]) -> list[Any]:
    if set(result) != set(names):
        returned = ", ".join(map(str, result)) or "no value"
        raise TracingError(f"{described(function)} returns {returned}; expected {', '.join(names)}")
    return [result[name] for name in names]


def _outputs(function: Callable[..., Any], builder: Builder, result: Any) -> list[Reference]:
    first = Symbol(builder, builder.constant(0.0))
    values = list(result.values()) if isinstance(result, Mapping) else result
    if isinstance(values, Vector | list | tuple) or (isinstance(values, np.ndarray) and values.ndim == 1):
        values = list(values)
    else:
        values = [values]
    if not values:
        raise TracingError(f"{described(function)} returns no value; expected a number or several")
    try:
        return [first.lifted(_scalar(value)).reference for value in values]
    except TracingError as error:
        raise TracingError(f"{described(function)} returns something else than numbers: {error}") from None


def _scalar(value: Any) -> Any:
    return value[()] if isinstance(value, np.ndarray) and value.ndim == 0 else value


def _output_names(function: Callable[..., Any], result: Any, count: int) -> tuple[str, ...]:
    if isinstance(result, Mapping):
        return tuple(result)
    name = getattr(function, "__name__", "")
    stem = name if NAME.match(name) else "y"
    return (stem,) if count == 1 else tuple(f"{stem}_{index}" for index in range(count))
