"""Functions on a curve ``p(θ) = m + a cos θ + b sin θ``: what a plane or a quadric makes of it."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints


class Linear(NamedTuple):
    """A function ``a cos θ + b sin θ + c`` on each of m curves."""

    a: Floats
    b: Floats
    c: Floats

    def take(self, rows: Ints) -> "Linear":
        """Return the given rows, in that order."""
        return Linear(*(column[rows] for column in self))

    def at(self, angle: Floats) -> Floats:
        """Return the values at angles (m, …)."""
        a, b, c = (column.reshape(-1, *[1] * (angle.ndim - 1)) for column in self)
        return np.asarray(a * np.cos(angle) + b * np.sin(angle) + c)


class Quadratic(NamedTuple):
    """A function ``aa cos² θ + 2 ab cos θ sin θ + bb sin² θ + 2 a cos θ + 2 b sin θ + c`` on each of m curves."""

    aa: Floats
    ab: Floats
    bb: Floats
    a: Floats
    b: Floats
    c: Floats
