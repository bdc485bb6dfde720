"""Products of vectors, row by row."""

import numpy as np

from molviz.arrays import Floats


def dot(one: Floats, other: Floats) -> Floats:
    """Return the scalar products (m,) of vectors (m, d)."""
    return np.asarray(np.einsum("ij,ij->i", one, other))


def cross(one: Floats, other: Floats) -> Floats:
    """Return the areas (m,), counter-clockwise positive, of the parallelograms of plane vectors (m, 2)."""
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
