"""The scalar functions carried over to vectors: the same source, each conditional expression a choice in every lane."""

import ast
import inspect
from functools import cache
from types import FunctionType
from typing import Any

from gpsynth.kernels import arithmetic, bits
from gpsynth.kernels.compile import part
from gpsynth.kernels.vectors import choose, magnitude, real_of, root, word_of

_BUILT_IN: dict[Any, Any] = {bits.bits_of: word_of, bits.float_of: real_of, arithmetic.sqrt: root}


@cache
def on_vectors(function: Any) -> Any:
    """The function for vectors; what it calls is carried over as well, and what only Python has is built in."""
    if function in _BUILT_IN:
        return _BUILT_IN[function]
    source, line = inspect.getsourcelines(function)
    tree = _Choices().visit(ast.parse("".join(source)))
    tree.body[0].decorator_list = []
    names = {**function.__globals__, "choose": choose, "abs": magnitude}
    for name in function.__code__.co_names:
        if isinstance(function.__globals__.get(name), FunctionType):
            names[name] = on_vectors(names[name])
    ast.increment_lineno(ast.fix_missing_locations(tree), line - 1)
    exec(compile(tree, inspect.getfile(function), "exec"), names)  # noqa: S102 our own source, nobody's input
    return part(names[function.__name__])


class _Choices(ast.NodeTransformer):
    def visit_IfExp(self, node: ast.IfExp) -> ast.Call:
        self.generic_visit(node)
        return ast.Call(ast.Name("choose", ast.Load()), [node.test, node.body, node.orelse], [])
