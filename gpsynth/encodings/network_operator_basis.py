"""The basic solution that a variational network operator starts from."""

import numpy as np

from gpsynth.encodings.checks import checked_at_least
from gpsynth.encodings.network_operator_matrix import ADD, IDENTITY_EDGE, Matrix

MULTIPLY = 2  # number of a binary function


def basic_operator(n_inputs: int, n_parameters: int, n_outputs: int, n_nodes: int | None = None) -> Matrix:
    """The usual start: every output is q0 x0 + q1 x1 + ...; a chain of sums is left for variations to fill.

    An input without a parameter enters the sum as it is, a parameter without an input not at all. With three inputs,
    three parameters and two outputs this is the operator of 24 nodes that the robot programs start from.
    """
    checked_at_least("n_inputs", n_inputs, 1)
    checked_at_least("n_parameters", n_parameters, 0)
    checked_at_least("n_outputs", n_outputs, 1)
    products = n_inputs + n_parameters
    sums = products + n_inputs
    least = sums + n_inputs + n_outputs - 1
    size = least + 11 if n_nodes is None else n_nodes
    checked_at_least("n_nodes", size, least)
    psi = np.zeros((size, size), dtype=np.int32)
    for k in range(n_inputs):
        psi[k, products + k] = IDENTITY_EDGE
        psi[products + k, sums + k] = IDENTITY_EDGE
        if k < n_parameters:
            psi[n_inputs + k, products + k] = IDENTITY_EDGE
    for node in range(products, size):
        psi[node, node] = MULTIPLY if node < sums else ADD
    for node in range(sums, size - 1):
        psi[node, node + 1] = IDENTITY_EDGE
    sources = tuple(range(products))
    return Matrix(psi, sources[:n_inputs], sources[n_inputs:], tuple(range(size - n_outputs, size)))
