"""Vectors of WIDTH lanes as a type of numba.

LLVM's loop vectorizer is left out: an operation on a vector is one LLVM instruction on `<WIDTH x double>`, which
becomes as many machine instructions as it needs, two of 512 bits or four of 256. Their chains of dependent operations
overlap, rows are not tested for overlap, and no loop is compiled a second time for single lanes. Without the compiler
(NUMBA_DISABLE_JIT) a vector is a numpy array, and all of this is plain numpy.
"""

import operator
from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core import cgutils
from numba.core.typeconv.castgraph import Conversion
from numba.core.typing.templates import ConcreteTemplate, infer_global, signature
from numba.extending import (
    lower_builtin,
    lower_cast,
    models,
    register_jitable,
    register_model,
    type_callable,
)

WIDTH = 16  # lanes
LINE = 8  # numbers in a line of the cache

Build = Callable[..., Any]


class Vector(types.Type):
    """WIDTH real numbers, 64-bit words or truth values; a scalar operand is repeated."""

    def __init__(self, element: types.Type) -> None:
        self.element = element
        super().__init__(f"vector of {WIDTH} {element}")

    def can_convert_from(self, typing_context: Any, other: types.Type) -> Conversion | None:
        """A number goes where a vector is expected."""
        kind = types.Integer if self.element == types.int64 else types.Float
        return Conversion.safe if isinstance(other, kind) and self.element != types.boolean else None


REAL, WORD, MASK = Vector(types.float64), Vector(types.int64), Vector(types.boolean)


@register_model(Vector)
class _Model(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: Vector) -> None:
        elements: dict[Any, Any] = {
            types.float64: ir.DoubleType(),
            types.int64: ir.IntType(64),
            types.boolean: ir.IntType(1),
        }
        super().__init__(manager, kind, ir.VectorType(elements[kind.element], WIDTH))


@lower_cast(types.Number, Vector)
def _repeat(context: Any, builder: Any, given: Any, kind: Any, value: Any) -> Any:
    scalar = context.cast(builder, value, given, kind.element)
    nothing = ir.Constant(ir.VectorType(scalar.type, WIDTH), ir.Undefined)
    one = builder.insert_element(nothing, scalar, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(one, nothing, ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), None))


def _declare(function: Any, build: Build, result: Vector, *operands: Vector) -> None:
    """Give an operator of Python a meaning on vectors: `build(builder, *values)`."""

    class Meaning(ConcreteTemplate):
        cases = [signature(result, *operands)]  # noqa: RUF012 numba's way to say it

    infer_global(function)(Meaning)
    lower_builtin(function, *operands)(lambda context, builder, typed, values: build(builder, *values))


def _plain(name: str) -> Build:
    return lambda builder, *values: getattr(builder, name)(*values)


def _compared(name: str, symbol: str) -> Build:
    return lambda builder, *values: getattr(builder, name)(symbol, *values)


for _function, _on_reals, _on_words in (
    (operator.add, "fadd", "add"),
    (operator.sub, "fsub", "sub"),
    (operator.mul, "fmul", ""),
    (operator.truediv, "fdiv", ""),
    (operator.lshift, "", "shl"),
    (operator.rshift, "", "ashr"),
    (operator.and_, "", "and_"),
    (operator.or_, "", "or_"),
    (operator.xor, "", "xor"),
):
    if _on_reals:
        _declare(_function, _plain(_on_reals), REAL, REAL, REAL)
    if _on_words:
        _declare(_function, _plain(_on_words), WORD, WORD, WORD)
for _function, _symbol in (
    (operator.lt, "<"),
    (operator.le, "<="),
    (operator.gt, ">"),
    (operator.ge, ">="),
    (operator.eq, "=="),
):
    _declare(_function, _compared("fcmp_ordered", _symbol), MASK, REAL, REAL)
_declare(operator.ne, _compared("fcmp_unordered", "!="), MASK, REAL, REAL)
_declare(operator.ne, _compared("icmp_signed", "!="), MASK, WORD, WORD)
_declare(operator.and_, _plain("and_"), MASK, MASK, MASK)
_declare(operator.neg, _plain("fneg"), REAL, REAL)


def choose(condition: Any, yes: Any, no: Any) -> Any:
    """`yes if condition else no` in each lane."""
    return np.where(condition, yes, no) if np.ndim(condition) else (yes if condition else no)


@type_callable(choose)
def _type_of_choice(context: Any) -> Build:
    def typed(condition: Any, yes: Any, no: Any) -> Any:
        kind = REAL if REAL in (yes, no) or condition == MASK else types.float64
        return signature(kind, condition, kind, kind)

    return typed


@lower_builtin(choose, types.Any, types.Any, types.Any)
def _choose(context: Any, builder: Any, typed: Any, values: Any) -> Any:
    return builder.select(*values)


def _unary(function: Any, kinds: dict[types.Type, types.Type], build: Build) -> None:
    """Give a function of one value a meaning: `build(builder, value, LLVM's type of the result)`."""

    @type_callable(function)
    def declared(context: Any) -> Build:
        return lambda value: kinds.get(types.unliteral(value))

    @lower_builtin(function, types.Any)
    def lowered(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        return build(builder, values[0], context.get_value_type(typed.return_type))


def word_of(x: Any) -> Any:
    """The bits of real numbers."""
    return np.float64(x).view(np.int64)


def real_of(word: Any) -> Any:
    """The real numbers of these bits."""
    return np.int64(word).view(np.float64)


def root(x: Any) -> Any:
    """Square roots."""
    return np.sqrt(x)


def magnitude(x: Any) -> Any:
    """Absolute values."""
    return np.abs(x)


def _called(name: str) -> Build:
    def build(builder: Any, value: Any, kind: Any) -> Any:
        suffix = f"v{WIDTH}f64" if isinstance(kind, ir.VectorType) else "f64"
        declared = cgutils.get_or_insert_function(
            builder.module, ir.FunctionType(kind, [kind]), f"llvm.{name}.{suffix}"
        )
        return builder.call(declared, [value])

    return build


_unary(
    word_of,
    {REAL: WORD, types.float64: types.int64},
    lambda builder, value, kind: builder.bitcast(value, kind),
)
_unary(
    real_of,
    {WORD: REAL, types.int64: types.float64},
    lambda builder, value, kind: builder.bitcast(value, kind),
)
_unary(root, {REAL: REAL, types.float64: types.float64}, _called("sqrt"))
_unary(magnitude, {REAL: REAL, types.float64: types.float64}, _called("fabs"))


def take(w: Any, row: int, lane: int) -> Any:
    """Lanes [lane, lane + WIDTH) of a row of `w`."""
    return w[row, lane : lane + WIDTH].copy()


def put(w: Any, row: int, lane: int, values: Any) -> None:
    """Write lanes [lane, lane + WIDTH) of a row of `w`."""
    w[row, lane : lane + WIDTH] = values


def put_away(w: Any, row: int, lane: int, values: Any) -> None:
    """Like `put`, past the caches, for what nobody reads soon; `w` must be `aligned`, or the process ends."""
    w[row, lane : lane + WIDTH] = values


@register_jitable(error_model="numpy", forceinline=True)
def aligned(rows: int, columns: int) -> Any:
    """Memory for (rows, columns) numbers that begins with a line of the cache; columns a multiple of WIDTH."""
    numbers = np.empty(rows * columns + LINE)
    first = LINE - numbers.ctypes.data // 8 % LINE
    return numbers[first : first + rows * columns].reshape(rows, columns)


@type_callable(take)
def _type_of_take(context: Any) -> Build:
    return lambda w, row, lane: signature(REAL, w, types.int64, types.int64)


@type_callable(put)
def _type_of_put(context: Any) -> Build:
    return lambda w, row, lane, values: signature(types.void, w, types.int64, types.int64, REAL)


type_callable(put_away)(_type_of_put)


def _place(context: Any, builder: Any, typed: Any, values: Any) -> Any:
    array = context.make_array(typed.args[0])(context, builder, values[0])
    columns = builder.extract_value(array.shape, 1)
    first = builder.gep(array.data, [builder.add(builder.mul(values[1], columns), values[2])])
    return builder.bitcast(first, context.get_value_type(REAL).as_pointer())


@lower_builtin(take, types.Array, types.int64, types.int64)
def _take(context: Any, builder: Any, typed: Any, values: Any) -> Any:
    return builder.load(_place(context, builder, typed, values), align=8)


@lower_builtin(put, types.Array, types.int64, types.int64, REAL)
def _put(context: Any, builder: Any, typed: Any, values: Any) -> Any:
    builder.store(values[3], _place(context, builder, typed, values), align=8)
    return context.get_dummy_value()


@lower_builtin(put_away, types.Array, types.int64, types.int64, REAL)
def _put_away(context: Any, builder: Any, typed: Any, values: Any) -> Any:
    stored = builder.store(values[3], _place(context, builder, typed, values), align=8 * LINE)
    once = builder.module.add_metadata([ir.Constant(ir.IntType(32), 1)])
    stored.set_metadata("nontemporal", once)
    return context.get_dummy_value()
