"""Programs without parameters, such as regression finds, as C99, Python and LaTeX; `to_sympy` takes programs, too.

What holds for exported laws holds here: the C and the Python compute the same bits as the program.
"""

from textwrap import indent

from gpsynth.checks import check_kind
from gpsynth.errors import ProgramError
from gpsynth.export import c, python_form
from gpsynth.export.elementary_c import HEADERS, c_number
from gpsynth.export.latex import notation, symbol, symbols
from gpsynth.export.listing import OPERATORS, Listing, Syntax, assigned
from gpsynth.notation import fresh_names, spell
from gpsynth.program import Program


def program_to_c(program: Program, name: str = "formula") -> str:
    """The source of `void NAME(const double x[N], double y[M])`; raises LawError if `name` cannot name a C function."""
    c.check_name(name)
    lines = _listing(program, Syntax(number=c_number, operation=c.written))
    body = [
        *(
            f"const double {item.name} = {item.value};" + (f" /* {item.remark} */" if item.remark else "")
            for item in lines.assignments
        ),
        *(f"y[{k}] = {value};" for k, value in enumerate(lines.controls)),
        *([] if any("x[" in item.value for item in lines.assignments) else ["(void)x;"]),
    ]
    return _SOURCE.format(
        flags=c.FLAGS,
        name=name,
        headers=HEADERS,
        checks=c.CHECKS,
        functions=c.used_functions(lines),
        inputs=max(1, len(program.inputs)),
        outputs=len(program.outputs),
        body=indent("\n".join(body), "    "),
    )


def program_to_python(program: Program, name: str = "formula") -> str:
    """A module with one function, NAME(x), that gives the tuple of outputs; it needs the standard library alone.

    Raises LawError if `name` cannot name it.
    """
    c.check_name(name)
    lines = _listing(
        program, Syntax(python_form.python_number, python_form.written, element="float({0}[{1}])")
    )
    called = [operation for operation in lines.operations if operation not in OPERATORS]
    definitions = python_form.definitions(called)
    python_form.check_name(name, definitions)
    body = [
        *(
            f"{item.name} = {item.value}" + (f"  # {item.remark}" if item.remark else "")
            for item in lines.assignments
        ),
        f"return ({', '.join(lines.controls)},)",
    ]
    return "\n".join(
        [
            f'"""{", ".join(program.names)} of {", ".join(program.inputs)}."""',
            "",
            python_form.IMPORTS,
            *definitions,
            "",
            f"def {name}(x: Sequence[float]) -> tuple[float, ...]:",
            indent("\n".join(body), "    "),
            "",
        ]
    )


def program_to_latex(program: Program) -> str:
    """The program as an align* environment (it needs amsmath), one line for each intermediate value and output."""
    check_kind("program", program, Program, error=ProgramError)
    lines = " \\\\\n".join(f"  {left} &= {right}" for left, right in latex_lines(program))
    return f"\\begin{{align*}}\n{lines}\n\\end{{align*}}\n"


def latex_lines(program: Program) -> list[tuple[str, str]]:
    """Both sides of the equation of each intermediate value and output."""
    names = symbols((*program.inputs, *program.parameters, *program.names))
    rows = spell(program, notation(names), fresh_names("z", program), largest=10)
    return [(names.get(left, symbol(left)), right.text) for left, right in rows]


def _listing(program: Program, syntax: Syntax) -> Listing:
    check_kind("program", program, Program, error=ProgramError)
    if program.parameters:
        raise ProgramError(
            f"the program has parameters, {', '.join(program.parameters)}; bind them to numbers first"
        )
    places = [("x", k) for k in range(len(program.inputs))]
    remarks = {k: program.inputs[k] for k in range(len(program.inputs))}
    return assigned(program, syntax, places, remarks=remarks, outputs=len(program.outputs))


_SOURCE = """\
/* cc {flags} -c {name}.c */
#include <float.h>
{headers}
{checks}{functions}
void {name}(const double x[{inputs}], double y[{outputs}]);

void {name}(const double x[{inputs}], double y[{outputs}])
{{
{body}
}}
"""
