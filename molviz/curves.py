"""Exact plane curves: arcs of ellipses in conjugate half-diameters, and the paths they form."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.vectors import dot


class PlaneArcs(NamedTuple):
    """k arcs ``c + u cos t + v sin t``, t running from ``start`` to ``start + sweep``.

    A negative sweep runs the arc backwards. Where u and v are parallel the arc is a straight piece (run to and fro
    if it turns in between); a sweep of ±2π is the whole ellipse.
    """

    c: Floats  # (k, 2)
    u: Floats  # (k, 2)
    v: Floats  # (k, 2)
    start: Floats  # (k,) radians
    sweep: Floats  # (k,) radians in [−2π, 2π]

    def take(self, rows: Ints) -> "PlaneArcs":
        """Return the given rows, in that order."""
        return PlaneArcs(*(column[rows] for column in self))

    def at(self, t: Floats) -> Floats:
        """Return the points (k, 2) at one parameter per arc."""
        return self.c + self.u * np.cos(t)[:, None] + self.v * np.sin(t)[:, None]

    def half_extent(self) -> Floats:
        """Return the half-widths (k, 2) of the bounding boxes of the whole ellipses about their centres."""
        return np.hypot(self.u, self.v)

    def major(self) -> Floats:
        """Return the major semi-axes (k,): the root of the larger eigenvalue of ``u uᵀ + v vᵀ``."""
        uu, vv, uv = (dot(x, y) for x, y in ((self.u, self.u), (self.v, self.v), (self.u, self.v)))
        return np.asarray(np.sqrt((uu + vv) / 2 + np.hypot((uu - vv) / 2, uv)))

    def moved(self, scale: float, shift: Floats) -> "PlaneArcs":
        """Return the arcs after ``x → scale x + shift``."""
        return PlaneArcs(self.c * scale + shift, self.u * scale, self.v * scale, self.start, self.sweep)


class Paths(NamedTuple):
    """Shapes made of loops made of arcs: CSR in two levels.

    Arcs ``loop_start[l] : loop_start[l + 1]`` follow each other end to start and form loop l; loops
    ``shape_start[s] : shape_start[s + 1]`` form shape s. Loops of a filled shape are closed and its interior is
    on their left (holes run clockwise, y up); loops of a stroked shape may be open.
    """

    arcs: PlaneArcs
    loop_start: Ints  # (loops + 1,)
    shape_start: Ints  # (shapes + 1,)
