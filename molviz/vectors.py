"""Products of vectors, row by row: sums in one order, so that they are the same to the last bit on every machine.

BLAS, and what numpy makes of ``@``, ``dot`` and ``einsum``, add up in an order, and with a rounding, of each processor.
"""

import numpy as np

from molviz.arrays import Floats


def dot(one: Floats, other: Floats) -> Floats:
    """Return the scalar products (m,) of vectors (m, d)."""
    return _added(one * other)


def length(vectors: Floats) -> Floats:
    """Return the lengths (m,) of vectors (m, d)."""
    return np.asarray(np.sqrt(dot(vectors, vectors)))


def transformed(vectors: Floats, matrix: Floats) -> Floats:
    """Return ``matrix · v`` (..., k) of vectors v (..., d); matrix (k, d)."""
    return np.stack([_added(vectors * row) for row in matrix], axis=-1)


def cross(one: Floats, other: Floats) -> Floats:
    """Return the areas (m,), counter-clockwise positive, of the parallelograms of plane vectors (m, 2)."""
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])


def _added(terms: Floats) -> Floats:
    """Return the sums (...) over the last axis, from left to right."""
    total = terms[..., 0]
    for k in range(1, terms.shape[-1]):
        total = total + terms[..., k]
    return np.asarray(total)
