"""T-junctions: horizons are split where other visible curves pass under them."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.geometry.general_position import Degenerate
from molviz.geometry.intervals import TURN
from molviz.geometry.rows import expand
from molviz.visibility.curves import Curves
from molviz.visibility.named_arcs import ENTRY, TEE, WHOLE, NamedArcs, vertex_numbers
from molviz.visibility.occluders.sphere import SphereOccluders

SNAP = 1e-9  # radians by which rounding may put a junction outside the arc it lies on


class CurveArcs(NamedTuple):
    """Arcs of curves between numbered vertices."""

    curve: Ints  # (k,)
    start: Floats  # (k,) radians
    sweep: Floats  # (k,) radians
    origin: Ints  # (k,)
    target: Ints  # (k,)

    def take(self, rows: Ints) -> "CurveArcs":
        """Return the given rows, in that order."""
        return CurveArcs(self.curve[rows], self.start[rows], self.sweep[rows], self.origin[rows], self.target[rows])


class _Junctions(NamedTuple):
    """Points at which arcs are to be split, by arc and offset from its start."""

    arc: Ints
    offset: Floats
    vertex: Ints


def split_at_junctions(
    named: NamedArcs, curves: Curves, horizons: Curves, spheres: SphereOccluders
) -> tuple[CurveArcs, Ints]:
    """Return the arcs as those of the map, and for each vertex the ball that a horizon enters there, −1 if none.

    ``horizons`` are the last of the ``curves``. Raises ``Degenerate`` where a junction lies on no visible horizon.
    """
    origin, target = vertex_numbers(named.origin, named.target)
    tees = [
        _junctions(named, curves, horizons, spheres, name, vertex, fraction)
        for name, vertex, fraction in ((named.origin, origin, 0.0), (named.target, target, 1.0))
    ]
    junctions = _Junctions(*(np.concatenate(column) for column in zip(*tees, strict=True)))
    entered = np.full(int(max(origin.max(initial=-1), target.max(initial=-1))) + 1, -1)
    for name, vertex in ((named.origin, origin), (named.target, target)):
        rows = np.flatnonzero(name[:, 0] >> 1 == ENTRY)
        entered[vertex[rows]] = name[rows, 2]
    return _split(named, origin, target, junctions), entered


def _junctions(
    named: NamedArcs,
    curves: Curves,
    horizons: Curves,
    spheres: SphereOccluders,
    name: Ints,
    vertex: Ints,
    fraction: float,
) -> _Junctions:
    """Where the arcs that end in a TEE, at their starts (fraction 0) or ends (1), meet the horizon above them."""
    rows = np.flatnonzero(name[:, 0] >> 1 == TEE)
    above = name[rows, 2]
    points = curves.at(named.curve[rows], named.start[rows] + fraction * named.sweep[rows])
    angle = spheres.horizon_angle(horizons, above, points)
    arc, offset = _located(named, len(curves.first) - len(horizons.first) + above, angle)
    return _Junctions(arc, offset, vertex[rows])


def _located(named: NamedArcs, curve: Ints, angle: Floats) -> tuple[Ints, Floats]:
    """The arc of each given curve on which the angle lies, and the offset from its start."""
    begin, end = (np.searchsorted(named.curve, curve, side=side) for side in ("left", "right"))
    row, arc = expand(begin, end)
    offset = np.mod(angle[row] - named.start[arc], TURN)
    sweep = named.sweep[arc]
    outside = np.where(offset <= sweep, 0.0, np.minimum(offset - sweep, TURN - offset))
    order = np.lexsort((-outside, row))
    best = np.full(len(curve), -1)
    best[row[order]] = order  # the last one written is the closest
    if np.any(best < 0) or np.any(outside[best] > SNAP):
        raise Degenerate
    inside = np.where(outside[best] == 0, offset[best], np.where(offset[best] - sweep[best] < SNAP, sweep[best], 0.0))
    return arc[best], inside


def _split(named: NamedArcs, origin: Ints, target: Ints, tees: _Junctions) -> CurveArcs:
    """Cut every arc at its junctions; a whole circle begins and ends at its first one."""
    count = len(origin)
    first = np.full(count, np.inf)
    np.minimum.at(first, tees.arc, tees.offset)
    opened = (named.origin[:, 0] >> 1 == WHOLE) & np.isfinite(first)
    first_vertex = target.copy()
    at_first = tees.offset == first[tees.arc]
    first_vertex[tees.arc[at_first]] = tees.vertex[at_first]
    begins = np.flatnonzero(~opened)
    end = np.where(opened, first + TURN, named.sweep)
    arc = np.concatenate([begins, tees.arc, np.arange(count)])
    offset = np.concatenate([np.zeros(len(begins)), tees.offset, end])
    vertex = np.concatenate([origin[begins], tees.vertex, np.where(opened, first_vertex, target)])
    place = np.repeat([0, 1, 2], [len(begins), len(tees.arc), count])
    order = np.lexsort((offset, place, arc))
    arc, offset, vertex = arc[order], offset[order], vertex[order]
    piece = np.flatnonzero(arc[1:] == arc[:-1])
    return CurveArcs(
        named.curve[arc[piece]],
        named.start[arc[piece]] + offset[piece],
        offset[piece + 1] - offset[piece],
        vertex[piece],
        vertex[piece + 1],
    )
