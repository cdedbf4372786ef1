"""A law as C99: one source file and its header, no libm, no memory allocation, no state between calls.

The source computes what the kernels compute, to the last bit, where a double is IEEE 754 binary64 and the compiler
keeps to the standard; what it can check of that, it checks.
"""

import math
import re
from textwrap import indent

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.errors import LawError
from gpsynth.export.elementary_c import HEADERS, c_name, c_number, functions
from gpsynth.export.listing import OPERATORS, Listing, Syntax, listing
from gpsynth.export.reading import header_lines
from gpsynth.export.vectors import trial_states
from gpsynth.law import Law
from gpsynth.operations import Operation

FLAGS = "-std=c99 -Wall -Wextra -Werror -pedantic -Wconversion -ffp-contract=off"
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}\Z", re.ASCII)
_RESERVED = (
    "auto break case char const continue default do double else enum extern float for goto if inline int long "
    "register restrict return short signed sizeof static struct switch typedef union unsigned void volatile while "
    "alignas alignof asm bool constexpr false nullptr static_assert thread_local true typeof "
    "and bitand bitor catch class compl delete explicit export friend mutable namespace new not operator or private "
    "protected public template this throw try typename using virtual xor "
    "main state target control abort exit free malloc memchr memcmp memcpy memmove memset printf puts stderr stdin "
    "stdout strcpy strlen"
)
CHECKS = """\
#ifdef __FAST_MATH__
#error "compile without -ffast-math: the law was checked in IEEE arithmetic"
#endif
#if !defined(FLT_EVAL_METHOD) || FLT_EVAL_METHOD != 0
#error "compile for arithmetic in double, on x86 with -msse2 -mfpmath=sse"
#endif
#if FLT_RADIX != 2 || DBL_MANT_DIG != 53 || DBL_MAX_EXP != 1024
#error "double is not IEEE 754 binary64"
#endif
#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif
"""


def to_c(law: Law, name: str = "law", vectors: tuple[Floats, Floats] | None = None) -> tuple[str, str]:
    """Source and header of `void NAME(const double state[N], const double target[N], double control[M])`.

    `vectors` are states and targets (V, N) each, on which the self-test (compile with -DNAME_SELF_TEST) compares all
    bits of the controls with those of the law. Raises LawError if `name` cannot name a C function
    or `vectors` are something else.
    """
    check_name(name)
    lines = listing(law, Syntax(number=c_number, operation=written))
    remarks = "\n".join(f" * {line}" for line in header_lines(law, name))
    source = _SOURCE.format(
        remarks=remarks,
        flags=FLAGS,
        self_test_macro=f"{name.upper()}_SELF_TEST",
        name=name,
        headers=HEADERS,
        checks=CHECKS,
        functions=used_functions(lines),
        prototype=_prototype(law, name),
        body=indent(_body(law, lines), "    "),
        self_test=_self_test(law, name, *_checked(trial_states(law, 32) if vectors is None else vectors)),
    )
    header = _HEADER.format(remarks=remarks, guard=f"{name.upper()}_H", prototype=_prototype(law, name))
    return source, header


def check_name(name: str) -> None:
    """Raise LawError unless `name` can name a C function beside ours."""
    if (
        not isinstance(name, str)
        or not _NAME.match(name)
        or name.startswith("gp_")
        or name in _RESERVED.split()
        or re.match(r"r\d+\Z", name)
    ):
        raise LawError(
            f"{name!r} cannot name a C function here: a letter, then at most 30 letters, digits and _, "
            "neither reserved nor beginning with gp_"
        )


def _prototype(law: Law, name: str) -> str:
    size, controls = len(law.plant.state_names), len(law.plant.control_names)
    return f"void {name}(const double state[{size}], const double target[{size}], double control[{controls}])"


def written(operation: Operation, operands: tuple[str, ...]) -> str:
    """An operation of these operands in C."""
    if operation.name in OPERATORS:
        return OPERATORS[operation.name].format(*operands)
    if operation.name == "div":
        return "{} / {}".format(*operands)
    return f"{c_name(operation.name)}({', '.join(operands)})"


def used_functions(lines: Listing) -> str:
    """The C functions that a listing calls, behind an empty line."""
    names = [name for name in lines.operations if name not in OPERATORS and name != "div"]
    return f"\n{functions(names)}" if names else ""


def _body(law: Law, lines: Listing) -> str:
    """The statements of the function; an argument that the law does not need is named to keep compilers quiet."""
    used = " ".join(item.value for item in lines.assignments)
    return "\n".join(
        [
            *(
                f"const double {item.name} = {item.value};" + (f" /* {item.remark} */" if item.remark else "")
                for item in lines.assignments
            ),
            *(f"control[{index}] = {value};" for index, value in enumerate(lines.controls)),
            *(f"(void){argument};" for argument in ("state", "target") if f"{argument}[" not in used),
        ]
    )


def _checked(vectors: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
    if (
        not isinstance(vectors, tuple | list)
        or [np.ndim(part) for part in vectors] != [2, 2]
        or not len(vectors[0])
    ):
        raise LawError("vectors are states and targets, (V, n) each, with V at least 1")
    return vectors


def _self_test(law: Law, name: str, states: Floats, targets: Floats) -> str:
    controls = law(states, targets)
    rows = np.concatenate([*np.broadcast_arrays(states, targets), controls], axis=1)
    return _SELF_TEST.format(
        name=name,
        macro=f"{name.upper()}_SELF_TEST",
        size=len(law.plant.state_names),
        start=2 * len(law.plant.state_names),
        n_controls=len(law.plant.control_names),
        width=rows.shape[1],
        count=len(rows),
        rows=",\n".join(
            "        {" + ", ".join(_hexadecimal(value) for value in row) + "}" for row in rows.tolist()
        ),
    )


def _hexadecimal(value: float) -> str:
    return re.sub(r"\.?0*p", "p", value.hex(), count=1) if math.isfinite(value) else c_number(value)


_HEADER = """\
/*
{remarks}
 */
#ifndef {guard}
#define {guard}

#ifdef __cplusplus
extern "C" {{
#endif

/* The saturated control at a state and a target; no state between calls, so any number of threads may call it. */
{prototype};

#ifdef __cplusplus
}}
#endif

#endif
"""

_SOURCE = """\
/*
{remarks}
 *
 * cc {flags} -c {name}.c
 * cc {flags} -D{self_test_macro} {name}.c -o {name}_test && ./{name}_test
 */
#include "{name}.h"

#include <float.h>
{headers}
{checks}{functions}
{prototype}
{{
{body}
}}
{self_test}"""

_SELF_TEST = """
#ifdef {macro}
#include <stdio.h>

/* Each row: state, target, and the control the law has there. */
int main(void)
{{
    static const double rows[{count}][{width}] = {{
{rows}
    }};
    int row, index;
    for (row = 0; row < {count}; row++) {{
        double control[{n_controls}];
        {name}(rows[row], rows[row] + {size}, control);
        for (index = 0; index < {n_controls}; index++) {{
            const double expected = rows[row][{start} + index];
            if (memcmp(&control[index], &expected, sizeof expected) != 0) {{
                printf("row %d: control[%d] is %a, expected %a\\n", row, index, control[index], expected);
                return 1;
            }}
        }}
    }}
    printf("ok: %d rows\\n", row);
    return 0;
}}
#endif
"""
