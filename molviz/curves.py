"""Exact plane curves: arcs of ellipses in conjugate half-diameters, and the paths they form."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.vectors import cross, dot


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
        return PlaneArcs(*(column.take(rows, axis=0) for column in self))

    def at(self, t: Floats) -> Floats:
        """Return the points (k, 2) at one parameter per arc."""
        return self.c + self.u * np.cos(t)[:, None] + self.v * np.sin(t)[:, None]

    def tangent(self, t: Floats) -> Floats:
        """Return the derivatives (k, 2) at one parameter per arc, in the direction of growing t."""
        return self.v * np.cos(t)[:, None] - self.u * np.sin(t)[:, None]

    def at_with_tangent(self, t: Floats) -> tuple[Floats, Floats]:
        """Return both of these, for less than each alone."""
        cosine, sine = np.cos(t)[:, None], np.sin(t)[:, None]
        return self.c + self.u * cosine + self.v * sine, self.v * cosine - self.u * sine

    def stop(self) -> Floats:
        """Return the parameters (k,) at which the arcs end."""
        return self.start + self.sweep

    def middle(self) -> Floats:
        """Return the parameters (k,) halfway along the arcs."""
        return self.start + self.sweep / 2

    def starts(self) -> Floats:
        """Return the points (k, 2) at which the arcs start."""
        return self.at(self.start)

    def ends(self) -> Floats:
        """Return the points (k, 2) at which the arcs end."""
        return self.at(self.stop())

    def reversed(self, back: Bools) -> "PlaneArcs":
        """Return the arcs, those that are to run ``back`` (k,) from their ends to their starts."""
        start = np.where(back, self.stop(), self.start)
        return self._replace(start=start, sweep=np.where(back, -self.sweep, self.sweep))

    def split(self, owner: Ints, start: Floats, sweep: Floats) -> "PlaneArcs":
        """Return pieces (m,) of the arcs: piece j is part of arc ``owner[j]``."""
        return self.take(owner)._replace(start=start, sweep=sweep)

    def signed_area(self) -> Floats:
        """Return ``½ ∫ x dy − y dx`` over each arc (k,): ``½ (c × (p1 − p0) + (u × v) sweep)``."""
        chord = self.ends() - self.starts()
        return np.asarray((cross(self.c, chord) + cross(self.u, self.v) * self.sweep) / 2)

    def half_extent(self) -> Floats:
        """Return the half-widths (k, 2) of the bounding boxes of the whole ellipses about their centres."""
        return np.hypot(self.u, self.v)

    def major(self) -> Floats:
        """Return the major semi-axes (k,): the root of the larger eigenvalue of ``u uᵀ + v vᵀ``."""
        uu, vv, uv = (dot(x, y) for x, y in ((self.u, self.u), (self.v, self.v), (self.u, self.v)))
        return np.asarray(np.sqrt((uu + vv) / 2 + np.hypot((uu - vv) / 2, uv)))

    def lengths(self) -> Floats:
        """Return the lengths (k,) of arcs of circles with the same mean square of the half axes."""
        return np.asarray(np.abs(self.sweep) * np.sqrt((dot(self.u, self.u) + dot(self.v, self.v)) / 2))

    def moved(self, scale: float, shift: Floats) -> "PlaneArcs":
        """Return the arcs after ``x → scale x + shift``."""
        return PlaneArcs(self.c * scale + shift, self.u * scale, self.v * scale, self.start, self.sweep)


def straight_pieces(start: Floats, end: Floats) -> PlaneArcs:
    """Return the straight pieces from start to end (k, 2): half turns, from −u to u, of ellipses without width."""
    half_turn = np.full(len(start), np.pi)
    half = (end - start) / 2
    return PlaneArcs((start + end) / 2, half, np.zeros_like(half), half_turn, half_turn)


class Paths(NamedTuple):
    """Shapes made of loops made of arcs: CSR in two levels.

    Arcs ``loop_start[l] : loop_start[l + 1]`` follow each other end to start and form loop l; loops
    ``shape_start[s] : shape_start[s + 1]`` form shape s. Loops of a filled shape are closed and its interior is
    on their left (holes run clockwise, y up); loops of a stroked shape may be open.
    """

    arcs: PlaneArcs
    loop_start: Ints  # (loops + 1,)
    shape_start: Ints  # (shapes + 1,)
