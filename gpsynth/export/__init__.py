"""Every form of a law or program that leaves the package; numba, sympy, casadi and control load when needed."""

from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from gpsynth.export.c import to_c
    from gpsynth.export.casadi_form import to_casadi
    from gpsynth.export.control_form import to_control
    from gpsynth.export.folder import write
    from gpsynth.export.formula import to_text
    from gpsynth.export.fronts import latex_table
    from gpsynth.export.latex import to_document, to_latex
    from gpsynth.export.programs import program_to_c, program_to_latex, program_to_python
    from gpsynth.export.python_form import to_python
    from gpsynth.export.sympy_form import SympyForm, to_sympy

__all__ = [
    "SympyForm",
    "latex_table",
    "program_to_c",
    "program_to_latex",
    "program_to_python",
    "to_c",
    "to_casadi",
    "to_control",
    "to_document",
    "to_latex",
    "to_python",
    "to_sympy",
    "to_text",
    "write",
]

_MODULES = MappingProxyType(
    {
        "SympyForm": "sympy_form",
        "latex_table": "fronts",
        "program_to_c": "programs",
        "program_to_latex": "programs",
        "program_to_python": "programs",
        "to_c": "c",
        "to_casadi": "casadi_form",
        "to_control": "control_form",
        "to_document": "latex",
        "to_latex": "latex",
        "to_python": "python_form",
        "to_sympy": "sympy_form",
        "to_text": "formula",
        "write": "folder",
    }
)


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
