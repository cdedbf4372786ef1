"""The encodings that the contract tests cross, and slow evaluators that share nothing with the package's decoders."""

import math
from collections.abc import Callable

import numpy as np

from gpsynth.encodings.cartesian import CartesianEncoding, CartesianGenome
from gpsynth.encodings.columns import basic_columns
from gpsynth.encodings.complete_tree import basic_tree
from gpsynth.encodings.layers import basic_layers
from gpsynth.encodings.network_operator_matrix import Matrix
from gpsynth.encodings.parameters import ParameterSpace
from gpsynth.encodings.rules import Rules
from gpsynth.encodings.template import TemplateEncoding
from gpsynth.encodings.tree import TreeEncoding
from gpsynth.encodings.variational import VariationalEncoding
from gpsynth.operations import GP_NAMES, operation

PLAIN = ("add", "sub", "mul", "square", "sin", "tanh")
NETWORK = ("nop_square", "neg", "sin", "tanh_half", "nop_cube", "add", "nop_mul")
UNARY = ("sin", "neg", "atan")
NUMBERS = ParameterSpace(3, -4.0, 4.0)

ENCODINGS = {
    "network-operator": VariationalEncoding(("x", "y", "z"), ("u", "v"), space=NUMBERS),
    "network-operator-gray": VariationalEncoding(("x", "y"), ("u",), NETWORK, NUMBERS, gray_bits=16),
    "network-operator-no-numbers": VariationalEncoding(("x", "y"), ("u", "v"), NETWORK),
    "network-operator-all": VariationalEncoding(
        ("x",),
        ("u",),
        (*NETWORK, "max", "min", "prob_sum", "signed_hypot", "signed_abs_max", "nop_exp"),
        NUMBERS,
        n_variations=20,
    ),
    "network-operator-unary": VariationalEncoding(("x",), ("u",), UNARY),
    "layers": VariationalEncoding(
        ("x", "y", "z"), ("u", "v"), NETWORK, NUMBERS, basic_layers(3, 3, 2, per_layer=2)
    ),
    "layers-no-numbers": VariationalEncoding(("x",), ("u",), NETWORK, basis=basic_layers(1, 0, 1)),
    "complete-tree": VariationalEncoding(
        ("x", "y", "z"), ("u", "v"), (*PLAIN, "max"), NUMBERS, basic_tree(3, 3, 2, (*PLAIN, "max"))
    ),
    "complete-tree-unary": VariationalEncoding(("x",), ("u",), UNARY, basis=basic_tree(1, 0, 1)),
    "columns": VariationalEncoding(
        ("x", "y", "z"), ("u", "v"), GP_NAMES, NUMBERS, basic_columns(3, 3, 2, operands=3)
    ),
    "columns-no-numbers": VariationalEncoding(("x",), ("u", "v"), PLAIN, basis=basic_columns(1, 0, 2)),
    "cartesian": CartesianEncoding(("x", "y", "z"), ("u", "v"), GP_NAMES, NUMBERS),
    "cartesian-rate": CartesianEncoding(
        ("x", "y"), ("u",), PLAIN, NUMBERS, columns=20, gene_rate=0.05, cut="one_point"
    ),
    "cartesian-no-numbers": CartesianEncoding(("x",), ("u", "v"), PLAIN),
    "cartesian-unary": CartesianEncoding(("x",), ("u",), UNARY, columns=1),
    "tree": TreeEncoding(("x", "y", "z"), ("u", "v"), GP_NAMES, NUMBERS),
    "tree-one-output": TreeEncoding(("x", "y"), ("u",), PLAIN, ParameterSpace(12, -4.0, 4.0)),
    "tree-no-numbers": TreeEncoding(("x",), ("u", "v"), PLAIN),
    "tree-rules": TreeEncoding(
        ("x", "y"),
        ("u", "v"),
        PLAIN,
        NUMBERS,
        rules=Rules(
            forbid={"sin": ("sin", "tanh"), "tanh": ("square",)},
            limits={"tanh": 1, "mul": 3},
            weights={"sin": 4},
        ),
    ),
    "tree-units": TreeEncoding(
        ("x", "y", "phi"),
        ("u", "v"),
        PLAIN,
        ParameterSpace(8, -4.0, 4.0),
        units={"x": "m", "y": "m/s", "phi": "rad", "u": "m", "v": "m/s^2"},
    ),
    "tree-symmetries": TreeEncoding(
        ("x", "y", "z"),
        ("u", "v"),
        PLAIN,
        ParameterSpace(8, -4.0, 4.0),
        symmetries={"x": "+-", "y": "--", "z": "-+", "u": "+-", "v": "-+"},
    ),
    "tree-symmetries-units": TreeEncoding(
        ("x", "y"),
        ("u",),
        PLAIN,
        ParameterSpace(8, -4.0, 4.0),
        symmetries={"x": "-", "y": "+", "u": "-"},
        units={"x": "m", "y": "s", "u": "m/s"},
    ),
    "tree-unary": TreeEncoding(("x",), ("u",), UNARY, max_size=6),
    "template": TemplateEncoding(
        TreeEncoding(("x", "y"), ("g", "h"), PLAIN, NUMBERS), lambda f, g, h: (g, f.x * h), ("u", "v")
    ),
}


def evaluate_matrix(
    matrix: Matrix, x: list[float], q: list[float], rho: Callable[..., float], chi: Callable[..., float]
) -> list[float]:
    """The published rule: all nodes from their units, rows from top to bottom, columns from left to right."""
    units = (0.0, 0.0, 1.0, -1e8, 1e8, 0.0, 0.0, 0.0, 0.0)
    psi = matrix.psi.tolist()
    z = [units[psi[j][j]] for j in range(len(psi))]
    for node, value in zip(matrix.inputs + matrix.parameters, [*x, *q], strict=True):
        z[node] = value
    for i in range(len(psi)):
        for j in range(i + 1, len(psi)):
            if psi[i][j] != 0:
                z[j] = chi(psi[j][j], z[j], rho(psi[i][j], z[i]))
    return z


def evaluate_cartesian(
    encoding: CartesianEncoding, genome: CartesianGenome, x: list[float], compute: Callable[..., float]
) -> list[float]:
    """Each output by recursion to its leaves."""
    leaves = [*x, *genome.values]
    width = 1 + max(operation(name).arity for name in encoding.operations)

    def value(node: int) -> float:
        if node < len(leaves):
            return leaves[node]
        gene, *connections = genome.genes[(node - len(leaves)) * width :][:width]
        name = encoding.operations[gene]
        return compute(name, *[value(c) for c in connections[: operation(name).arity]])

    return [value(node) for node in genome.genes[-len(encoding.outputs) :]]


def sgn(z: float) -> float:
    return -1.0 if z < 0 else 1.0


LN = 18.420680743952367  # -ln 1e-8
PLAIN_UNARY: dict[int, Callable[[float], float]] = {  # the published table, in plain Python
    1: lambda z: z,
    2: lambda z: 1e8 if abs(z) > 1e4 else z * z,
    3: lambda z: -z,
    4: lambda z: sgn(z) * math.sqrt(abs(z)),
    5: lambda z: sgn(z) * 1e8 if abs(z) <= 1e-8 else 1 / z,
    6: lambda z: LN if z > LN else math.exp(z),
    7: lambda z: -LN if abs(z) < math.exp(-8) else math.log(abs(z)),
    8: lambda z: sgn(z) if abs(z) > LN else (1 - math.exp(-z)) / (1 + math.exp(-z)),
    9: lambda z: 1.0 if z >= 0 else 0.0,
    10: sgn,
    11: math.cos,
    12: math.sin,
    13: math.atan,
    14: lambda z: sgn(z) * 1e8 if abs(z) > 464.1588833612782 else z * z * z,
    15: lambda z: sgn(z) * 1e-8 if abs(z) < 1e-8 else sgn(z) * math.exp(math.log(abs(z)) / 3),
    16: lambda z: z if abs(z) < 1 else sgn(z),
    17: lambda z: sgn(z) * math.log(abs(z) + 1),
    18: lambda z: sgn(z) * 1e8 if abs(z) > LN else sgn(z) * (math.exp(abs(z)) - 1),
    19: lambda z: sgn(z) * 1e-8 if abs(z) > 1e8 else sgn(z) * math.exp(-abs(z)),
    20: lambda z: z / 2,
    21: lambda z: 2 * z,
    22: lambda z: math.exp(z) - 1 if z < 0 else 1 - math.exp(-abs(z)),
    23: lambda z: -sgn(z) * 1e8 if abs(z) > 1e8 else z - z * (z * z),
    24: lambda z: 1.0 if z > 1e8 else 0.0 if z < -LN else 1 / (1 + math.exp(-z)),
    25: lambda z: 1.0 if z > 0 else 0.0,
    26: lambda z: 0.0 if abs(z) < 0.01 else sgn(z),
    27: lambda z: sgn(z) if abs(z) > 1 else sgn(z) * (1 - math.sqrt(1 - z * z)),
    28: lambda z: z * (1 - 1e-8) if z * z > LN else z * (1 - math.exp(-z * z)),
}
PLAIN_BINARY: dict[int, Callable[[float, float], float]] = {
    1: lambda a, b: a + b,
    2: lambda a, b: sgn(a * b) * 1e8 if abs(a * b) > 1e8 else a * b,
    3: lambda a, b: a if a >= b else b,
    4: lambda a, b: a if a < b else b,
    5: lambda a, b: a + b - a * b,
    6: lambda a, b: sgn(a + b) * math.sqrt(a * a + b * b),
    7: lambda a, b: sgn(a + b) * (abs(a) + abs(b)),
    8: lambda a, b: sgn(a + b) * max(abs(a), abs(b)),
}


def plain_rho(number: int, z: float) -> float:
    return PLAIN_UNARY[number](z)


def plain_chi(number: int, a: float, b: float) -> float:
    return PLAIN_BINARY[number](a, b)


def wide(rng: np.random.Generator, *shape: int) -> np.ndarray:
    """Numbers of either sign, log-uniform from 1e-12 to 1e12."""
    return 10.0 ** rng.uniform(-12, 12, shape) * rng.choice([-1.0, 1.0], shape)


def check_weighted_sum(solution, counts):
    """Every output of a basic solution is q0 x0 + q1 x1 + ..., and what has no parameter weighs 1."""
    n_inputs, n_parameters, n_outputs = counts
    x, q = np.arange(1.0, n_inputs + 1), np.arange(2.0, n_parameters + 2)
    weights = np.append(q, np.ones(n_inputs))[:n_inputs]
    weights[n_parameters:] = 1.0
    inputs, outputs = [f"x{k}" for k in range(n_inputs)], [f"u{k}" for k in range(n_outputs)]
    program = solution.program(solution.entries, tuple(inputs), tuple(outputs))
    assert np.array_equal(program(x[None], q), np.full((1, n_outputs), weights @ x))
    assert program.complexity == min(n_inputs, n_parameters) + n_inputs - 1  # zeros leave nothing behind
