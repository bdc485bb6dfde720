"""T-junctions: contours are split where other visible curves pass under them, and where their colours change."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.intervals import TURN
from molviz.geometry.rows import expand, ordered
from molviz.threads import both
from molviz.vectors import dot
from molviz.visibility.curves import HORIZON, Curves
from molviz.visibility.named_arcs import MANY, NamedArcs, vertex_numbers
from molviz.visibility.names import EDGE, ELBOW, ENTRY, HALF, TEE, WHOLE
from molviz.visibility.solids import Solids

SNAP = 1e-9  # radians by which rounding may put a junction outside the arc it lies on
SNAP_BESIDE = 0.1  # the same where a stick beside the line of centres comes out of its ball through a plane


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


def split_at_junctions(named: NamedArcs, curves: Curves, solids: Solids, central: bool) -> tuple[CurveArcs, Ints]:
    """Return the arcs as those of the map, and for each vertex the solid that a contour enters there, −1 if none.

    Horizons and lines are numbered together as contours, in the order of the ``curves``. Raises ``Degenerate`` where a
    junction lies on no visible contour.
    """
    origin, target = vertex_numbers(named.origin, named.target)
    tees = both(
        lambda: _junctions(named, curves, solids, central, named.origin, origin, 0.0),
        lambda: _junctions(named, curves, solids, central, named.target, target, 1.0),
        len(named.curve) > MANY,
    )
    junctions = _Junctions(*(np.concatenate(column) for column in zip(*tees, strict=True)))
    entered = np.full(int(max(origin.max(initial=-1), target.max(initial=-1))) + 1, -1)
    for name, vertex in ((named.origin, origin), (named.target, target)):
        _enter(entered, name, vertex, solids)
    return _split(named, origin, target, junctions), entered


def _enter(entered: Ints, name: Ints, vertex: Ints, solids: Solids) -> None:
    """Write the solids that contours enter: a ball or stick in an ENTRY, another stick in an ELBOW, its ball in an EDGE
    but for joints."""
    kind = name[:, 0] >> 1
    rows = np.flatnonzero((kind == ENTRY) | (kind == ELBOW))
    entered[vertex[rows]] = name[rows, 2]
    rows = np.flatnonzero(kind == EDGE)
    end = name[rows, 1] - solids.balls
    entered[vertex[rows]] = np.where(solids.sticks.ends.joint[end], -1, solids.sticks.ends.sphere[end])


def _junctions(
    named: NamedArcs, curves: Curves, solids: Solids, central: bool, name: Ints, vertex: Ints, fraction: float
) -> _Junctions:
    """Where the arcs that end in a TEE or a HALF, at their starts (fraction 0) or ends (1), meet the contour there.

    In special position some meet no visible arc of it: they end nowhere, and no map closes there.
    """
    kind, count = name[:, 0] >> 1, solids.balls
    rows = np.flatnonzero((kind == TEE) | (kind == HALF))
    above = np.where(kind[rows] == TEE, name[rows, 2], name[rows, 1] + (name[rows, 0] & 1))
    rows, above = rows[above >= 0], above[above >= 0]
    points = curves.at(named.curve[rows], named.start[rows] + fraction * named.sweep[rows])
    angle = np.empty(len(rows))
    line = above >= count
    horizons = curves.of_kind(HORIZON)
    angle[~line] = solids.spheres.horizon_angle(horizons, above[~line], points[~line])
    angle[line] = solids.sticks.line_angle(above[line] - count, points[line], central)
    angle[kind[rows] == HALF] = np.pi / 2
    contour = np.flatnonzero(curves.is_contour())
    snap = np.where(_beside_centres(curves, solids, named.curve[rows], above), SNAP_BESIDE, SNAP)
    known, arc, offset = _located(named, contour[above], angle, snap)
    return _Junctions(arc, offset, vertex[rows[known]])


def _beside_centres(curves: Curves, solids: Solids, curve: Ints, above: Ints) -> Bools:
    """Whether a junction is one of a ball's horizon and the line of its stick beside the line of centres."""
    own = curves.first[curve]
    ends = solids.sticks.ends
    aside = np.append(dot(ends.offset, ends.offset) > 0, False)
    sphere = np.append(ends.sphere, -2)
    beside = np.zeros(len(curve), dtype=bool)
    for line, ball in ((own, above), (above, own)):
        stick = np.where(line >= solids.balls, (line - solids.balls) >> 1, len(ends.sphere) >> 1)
        for end in (2 * stick, np.minimum(2 * stick + 1, len(ends.sphere))):
            beside |= aside[end] & (sphere[end] == ball)
    return beside


def _located(named: NamedArcs, curve: Ints, angle: Floats, snap: Floats) -> tuple[Ints, Ints, Floats]:
    """The rows for which an arc of the given curve has the angle, or misses it by ``snap``; it, and offsets there."""
    begin, end = (np.searchsorted(named.curve, curve, side=side) for side in ("left", "right"))
    row, arc = expand(begin, end)
    offset = np.mod(angle[row] - named.start[arc], TURN)
    sweep = named.sweep[arc]
    outside = np.where(offset <= sweep, 0.0, np.minimum(offset - sweep, TURN - offset))
    order = ordered(row, -outside)
    best = np.full(len(curve), -1)
    best[row[order]] = order  # the last one written is the closest
    known = np.flatnonzero(best >= 0)
    known = known[outside[best[known]] <= snap[known]]
    best = best[known]
    beyond = offset[best] - sweep[best]
    inside = np.where(beyond <= 0, offset[best], np.where(beyond < snap[known], sweep[best], 0.0))
    return known, arc[best], inside


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
    order = ordered(3 * arc + place, offset)
    arc, offset, vertex = arc[order], offset[order], vertex[order]
    piece = np.flatnonzero(arc[1:] == arc[:-1])
    return CurveArcs(
        named.curve[arc[piece]],
        named.start[arc[piece]] + offset[piece],
        offset[piece + 1] - offset[piece],
        vertex[piece],
        vertex[piece + 1],
    )
