"""Laws to export: one per operation, random ones over the whole table, and the fixed one of the golden files."""

import ctypes
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from gpsynth.arrays import Floats
from gpsynth.builder import Builder
from gpsynth.export import to_c
from gpsynth.law import Law
from gpsynth.operations import OPERATIONS, Operation
from gpsynth.plant import Plant
from gpsynth.program import Program

FLAGS = (
    *(
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-pedantic",
        "-Wconversion",
        "-Wdouble-promotion",
        "-Wshadow",
    ),
    *("-Wmissing-prototypes", "-ffp-contract=off"),
)
COMPILER = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
needs_compiler = pytest.mark.skipif(COMPILER is None, reason="there is no C compiler (cc, gcc or clang)")

SPECIAL = (
    *(0.0, -0.0, 5e-324, -5e-324, 2.2250738585072014e-308, -1e-310, 1e-8, -1e-8, 0.01, 0.55, 1.0, -1.0),
    *(
        3.141592653589793,
        -3.141592653589793,
        18.420680743952367,
        464.1588833612782,
        1e4,
        1e8,
        -1e8,
        1e22,
        -1e22,
    ),
    *(1e308, -1e308, float("inf"), float("-inf"), float("nan")),
)
LARGEST = sys.float_info.max
LEVELS = ("-O0", "-O2", "-O3 -march=native")


def plant_of(states: Sequence[str], controls: Sequence[str], limit: float = 0.5) -> Plant:
    """A plant with these names at rest; a law needs no more of it."""
    builder = Builder((*states, *controls, "t"))
    dynamics = builder.build([builder.constant(0.0)] * len(states), states)
    return Plant(
        dynamics,
        states=dict.fromkeys(states, "m"),
        controls=dict.fromkeys(controls, ("m/s", -limit, limit)),
        name="still",
    )


def errors_of(states: Sequence[str]) -> Program:
    """The features target - state, named error_<state>."""
    builder = Builder((*states, *(f"{name}_target" for name in states)))
    size = len(states)
    outputs = [
        builder.apply("sub", builder.inputs[size + index], builder.inputs[index]) for index in range(size)
    ]
    return builder.build(outputs, [f"error_{name}" for name in states])


def states_of(states: Sequence[str]) -> Program:
    """The features that pass the states on, so that a formula sees special values as they come."""
    builder = Builder((*states, *(f"{name}_target" for name in states)))
    return builder.build(builder.inputs[: len(states)], states)


def law_of_operations(rows: Sequence[Operation] = OPERATIONS, limit: float = LARGEST) -> Law:
    """One control per operation: u_name = name(a, b, c) of the states."""
    states, controls = ("a", "b", "c"), [f"u_{row.name}" for row in rows]
    builder = Builder(states)
    outputs = [builder.apply(row.name, *builder.inputs[: row.arity]) for row in rows]
    return Law(
        plant_of(states, controls, limit), states_of(states), builder.build(outputs, controls), np.empty(0)
    )


def law_of_numbers(numbers: Sequence[float]) -> Law:
    """u_k = number_k * a: constants that are hard to write."""
    builder = Builder(("a", "b", "c"))
    controls = [f"u{index}" for index in range(len(numbers))]
    outputs = [builder.apply("mul", builder.constant(number), builder.inputs[0]) for number in numbers]
    plant = plant_of(("a", "b", "c"), controls, LARGEST)
    return Law(plant, states_of(("a", "b", "c")), builder.build(outputs, controls), np.empty(0))


def rows_to_try(count: int, width: int, seed: int) -> Floats:
    """Rows (count, width): one half ordinary, a quarter full of special values, a quarter of random bits."""
    rng = np.random.default_rng(seed)
    rows = rng.normal(size=(count, width)) * 10.0 ** rng.integers(-3, 4, size=(count, width))
    quarter = count // 4
    chosen = rng.random((quarter, width)) < 0.6
    rows[:quarter][chosen] = rng.choice(SPECIAL, size=(quarter, width))[chosen]
    rows[quarter : 2 * quarter] = rng.integers(-(2**63), 2**63, size=(quarter, width)).view(np.float64)
    return rows


def random_law(
    rng: np.random.Generator, n_instructions: int = 40, n_states: int = 3, n_controls: int = 5
) -> Law:
    """A law over the whole table: instructions with random operands, and every one of them shows in a control.

    A control is a small sum of limited values, so that a NaN in one of them does not hide the others.
    """
    states = [f"x{index}" for index in range(n_states)]
    controls = [f"u{index}" for index in range(n_controls)]
    features = errors_of(states) if rng.random() < 0.5 else states_of(states)
    builder = Builder(features.names, ("k", "gain"))
    leaves = [*builder.inputs, *builder.parameters, builder.constant(0.1), builder.constant(-2.0)]
    values = list(leaves)
    for code in rng.permutation(len(OPERATIONS))[:n_instructions]:
        row = OPERATIONS[code]
        values.append(builder.apply(row.name, *(values[rng.integers(len(values))] for _ in range(row.arity))))
    bounds = builder.constant(-1.0), builder.constant(1.0)
    outputs = [builder.constant(0.0)] * n_controls
    for index, value in enumerate(values[len(leaves) :]):
        share = builder.apply("mul", builder.apply("limit", value, *bounds), builder.constant(0.11))
        outputs[index % n_controls] = builder.apply("add", outputs[index % n_controls], share)
    program = builder.build(outputs, controls)
    return Law(plant_of(states, controls), features, program, rng.normal(size=2))


def robot_law() -> Law:
    """A small fixed law for a mobile robot, as a person would write it."""
    states, controls = ("x", "y", "theta"), ("v", "omega")
    still = Builder((*states, *controls, "t"))
    plant = Plant(
        still.build([still.constant(0.0)] * 3, states),
        states={"x": "m", "y": "m", "theta": "rad"},
        controls={"v": ("m/s", -0.5, 0.5), "omega": ("rad/s", -0.5, 0.5)},
        angles=("theta",),
        name="unicycle",
    )
    return Law(plant, _robot_features(states), _robot_program(), (3.1, 0.7, 2.25))


def _robot_features(states: Sequence[str]) -> Program:
    builder = Builder((*states, *(f"{name}_target" for name in states)))
    x, y, theta, *targets = builder.inputs
    dx, dy, turn = (builder.apply("sub", goal, now) for goal, now in zip(targets, (x, y, theta), strict=True))
    cosine, sine = builder.apply("cos", theta), builder.apply("sin", theta)
    ahead = builder.apply("add", builder.apply("mul", cosine, dx), builder.apply("mul", sine, dy))
    aside = builder.apply("sub", builder.apply("mul", cosine, dy), builder.apply("mul", sine, dx))
    return builder.build([ahead, aside, builder.apply("wrap", turn)], ["ahead", "aside", "error_theta"])


def _robot_program() -> Program:
    builder = Builder(("ahead", "aside", "error_theta"), ("k1", "k2", "k3"))
    (ahead, aside, turn), (k1, k2, k3) = builder.inputs, builder.parameters
    apply = builder.apply
    bearing = apply(
        "atan2", apply("mul", k2, aside), apply("add", apply("abs", ahead), builder.constant(1e-3))
    )
    shared = apply("tanh", apply("mul", k3, apply("sub", bearing, turn)))
    v = apply("mul", apply("mul", k1, ahead), apply("sub", builder.constant(1.0), apply("square", shared)))
    omega = apply(
        "add",
        apply("div_protected", shared, apply("sqrt_protected", ahead)),
        apply("neg", apply("cube", aside)),
    )
    return builder.build([v, omega], ["v", "omega"])


def compiled(law: Law, folder: Path, options: str, name: str = "law") -> "CompiledLaw":
    """The exported C of a law, compiled with a loop over rows."""
    source, header = to_c(law, name)
    (folder / f"{name}.c").write_text(source)
    (folder / f"{name}.h").write_text(header)
    size, controls = len(law.plant.state_names), len(law.plant.control_names)
    (folder / f"{name}_rows.c").write_text(
        f'#include "{name}.h"\n'
        "void rows(long count, const double *state, const double *target, double *control);\n"
        "void rows(long count, const double *state, const double *target, double *control)\n"
        "{\n    long i;\n    for (i = 0; i < count; i++) {\n"
        f"        {name}(state + i * {size}, target + i * {size}, control + i * {controls});\n    }}\n}}\n"
    )
    library = folder / f"{name}{''.join(options.split())}.so"
    sources = [str(folder / f"{name}.c"), str(folder / f"{name}_rows.c")]
    run([str(COMPILER), *FLAGS, *options.split(), "-shared", "-fPIC", "-o", str(library), *sources])
    return CompiledLaw(ctypes.CDLL(str(library)), controls)


class CompiledLaw:
    """Calls the compiled law over rows."""

    def __init__(self, library: ctypes.CDLL, n_controls: int) -> None:
        self.library = library
        self.n_controls = n_controls

    def __call__(self, states: Floats, targets: Floats) -> Floats:
        """The controls (N, m) at states and targets (N, n)."""
        states, targets = np.ascontiguousarray(states), np.ascontiguousarray(targets)
        controls = np.empty((len(states), self.n_controls))
        pointers = [ctypes.c_void_p(array.ctypes.data) for array in (states, targets, controls)]
        self.library.rows(ctypes.c_long(len(states)), *pointers)
        return controls


def run(command: Sequence[str]) -> subprocess.CompletedProcess[str]:
    """Run a command; a failure shows what it printed."""
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    return result


def same_bits(first: Floats, second: Floats) -> bool:
    """Whether two arrays of numbers agree in every bit, signs of zero included."""
    return bool(np.array_equal(first.view(np.int64), second.view(np.int64)))
