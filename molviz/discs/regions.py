"""Hidden surfaces of discs: the visible region of every disc, bounded by visible arcs (Franklin 1980, section 1).

Where a visible arc of disc k ends, it passes under a disc l: a T-junction on the perimeter of l, which runs on. Cut
at its T-junctions, every visible arc has one disc on its inside, its own, and one on its outside, the next behind it:
with them it is an arc of a planar map, whose vertices are the junctions and whose loops bound the regions.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.discs.grid import NOBODY, CellLists, Grid, foremost, nearer, on_perimeter
from molviz.geometry.circles import CircleArcs
from molviz.geometry.general_position import Degenerate
from molviz.geometry.intervals import TURN
from molviz.geometry.planar_map import Loops, loops, planar_map
from molviz.geometry.rows import expand, offsets
from molviz.model.spheres import Spheres

CLEAR = 1e-11  # radians, or of a radius: far more than rounding, far less than a displacement makes of a coincidence
DISPLACEMENT = 1e-6  # of the smallest radius: no line is so thin


class DiscRegions(NamedTuple):
    """The visible region of each disc that has one; its arcs run with the region on their left.

    Arcs ``loop_start[l] : loop_start[l + 1]`` form loop l, loops ``region_start[s] : region_start[s + 1]`` bound the
    region of ``disc[s]``.
    """

    circle: Ints  # (k,)
    start: Floats  # (k,) radians
    sweep: Floats  # (k,) radians in [−2π, 2π]; negative where the arc belongs to a disc in front
    loop_start: Ints  # (loops + 1,)
    region_start: Ints  # (regions + 1,)
    disc: Ints  # (regions,) ascending


class _Junctions(NamedTuple):
    """One end of a visible arc on the visible arc ``host`` of the disc in front, ordered along the hosts."""

    host: Ints
    offset: Floats  # radians from the host's start
    arc: Ints
    at_end: Bools


class _Pieces(NamedTuple):
    """Visible arcs cut at the junctions on them."""

    arc: Ints
    start: Floats
    sweep: Floats
    first: Ints  # (arcs + 1,) the first piece of each arc


def displaced(spheres: Spheres, seed: int) -> Spheres:
    """Return a copy whose centres are moved by up to 10⁻⁶ of the smallest radius, reproducibly."""
    reach = DISPLACEMENT * float(spheres.radius.min())
    shift = np.random.default_rng(seed).uniform(-reach, reach, (len(spheres.radius), 2))
    return Spheres(spheres.center + np.column_stack([shift, np.zeros(len(shift))]), spheres.radius)


def visible_regions(spheres: Spheres, grid: Grid, lists: CellLists, arcs: CircleArcs) -> DiscRegions:
    """Return the visible regions of discs whose visible arcs are given.

    Regions whose own perimeter is hidden are included (his Fig. 7). Raises ``Degenerate`` where arcs do
    not join, or too closely to be sure; a displaced copy of the discs has the same regions to within the displacement.
    """
    junctions = _junctions(spheres, arcs)
    pieces = _cut(arcs, junctions)
    circle = arcs.circle[pieces.arc]
    behind = _next_behind(spheres, grid, lists, circle, pieces.start + 0.5 * pieces.sweep)
    edges = planar_map(*_vertices(arcs, junctions, pieces), circle, behind)
    return _assembled(arcs, pieces, loops(edges))


def _junctions(spheres: Spheres, arcs: CircleArcs) -> _Junctions:
    """The T-junctions at both ends of every arc that is not a whole circle."""
    open_arcs = np.flatnonzero(arcs.before >= 0)
    arc = np.concatenate([open_arcs, open_arcs])
    at_end = np.arange(len(arc)) >= len(open_arcs)
    over = np.where(at_end, arcs.after[arc], arcs.before[arc])
    angle = arcs.start[arc] + np.where(at_end, arcs.sweep[arc], 0.0)
    x, y = on_perimeter(spheres, arcs.circle[arc], angle)
    around = np.mod(np.arctan2(y - spheres.center[over, 1], x - spheres.center[over, 0]), TURN)

    host = _host(arcs, over, around)
    offset = np.mod(around - arcs.start[host], TURN)
    order = np.lexsort((offset, host))
    junctions = _Junctions(host[order], offset[order], arc[order], at_end[order])
    if np.any(arcs.circle[host] != over) or not _apart(arcs, junctions):
        raise Degenerate
    return junctions


def _apart(arcs: CircleArcs, junctions: _Junctions) -> bool:
    """Tell whether junctions lie within their hosts, clear of the hosts' ends and of each other."""
    host, offset = junctions.host, junctions.offset
    inside = (offset > CLEAR) & (offset < arcs.sweep[host] - CLEAR)
    between = (np.diff(offset) > CLEAR) | (np.diff(host) > 0)
    return bool(np.all(inside) and np.all(between))


def _host(arcs: CircleArcs, circle: Ints, angle: Floats) -> Ints:
    """The arc of each circle that starts last before an angle, by one sort of starts and angles together."""
    count = len(arcs.circle)
    both = np.lexsort((np.concatenate([arcs.start, angle]), np.concatenate([arcs.circle, circle])))
    latest = np.maximum.accumulate(np.where(both < count, both, -1))
    host = np.empty(len(circle), dtype=np.int64)
    asked = both >= count
    host[both[asked] - count] = latest[asked]
    through_zero = (host < 0) | (arcs.circle[host] != circle)  # the angle lies on an arc that began a turn earlier
    last = np.searchsorted(arcs.circle, circle, side="right") - 1
    return np.where(through_zero, last, host)


def _cut(arcs: CircleArcs, junctions: _Junctions) -> _Pieces:
    """Cut arcs at their junctions; a whole circle is cut open at the first of its own."""
    junction_start = offsets(junctions.host, len(arcs.circle))
    met = np.diff(junction_start)
    whole = arcs.before < 0
    first = np.concatenate([[0], np.cumsum(np.where(whole, np.maximum(met, 1), met + 1))])
    arc = np.repeat(np.arange(len(met)), np.diff(first))
    begin = np.zeros(len(arc))
    begin[_piece_after(junctions, junction_start, whole, first)] = junctions.offset
    cut_open = whole & (met > 0)
    end = np.append(begin[1:], 0.0)
    end[first[1:] - 1] = arcs.sweep + np.where(cut_open, begin[first[:-1]], 0.0)
    return _Pieces(arc, arcs.start[arc] + begin, end - begin, first)


def _piece_after(junctions: _Junctions, junction_start: Ints, whole: Bools, first: Ints) -> Ints:
    rank = np.arange(len(junctions.host)) - junction_start[junctions.host]
    return first[junctions.host] + rank + np.where(whole[junctions.host], 0, 1)


def _vertices(arcs: CircleArcs, junctions: _Junctions, pieces: _Pieces) -> tuple[Ints, Ints]:
    """The vertices at which pieces start and end: the junctions, and one for every whole circle without any."""
    whole, number = arcs.before < 0, np.arange(len(junctions.host))
    own_end = np.full((2, len(whole)), -1)
    own_end[junctions.at_end.astype(int), junctions.arc] = number
    first, last = pieces.first[:-1], pieces.first[1:] - 1
    origin = np.empty(len(pieces.arc), dtype=np.int64)
    origin[first] = np.where(whole, len(number) + np.arange(len(whole)), own_end[0])
    after = _piece_after(junctions, offsets(junctions.host, len(whole)), whole, pieces.first)
    origin[after] = number
    target = np.append(origin[1:], 0)
    target[last] = np.where(whole, origin[first], own_end[1])
    return origin, target


def _next_behind(spheres: Spheres, grid: Grid, lists: CellLists, circle: Ints, angle: Floats) -> Ints:
    """The foremost disc behind a visible point of a perimeter, −1 for none: the cell's blocker or one on its list."""
    x, y = on_perimeter(spheres, circle, angle)
    cell = grid.cell_at(x, y)
    point, place = expand(lists.start[cell], lists.start[cell + 1])
    blocked = np.flatnonzero(lists.blocker[cell] != NOBODY)
    point = np.concatenate([point, blocked])
    disc = np.concatenate([lists.item[place], lists.blocker[cell[blocked]]])
    depth = spheres.radius[disc] - np.hypot(spheres.center[disc, 0] - x[point], spheres.center[disc, 1] - y[point])
    if np.any((np.abs(depth) < CLEAR * spheres.radius[disc]) & (disc != circle[point])):
        raise Degenerate
    behind = (depth > 0) & nearer(spheres, circle[point], disc)
    behind_it = foremost(spheres.center[:, 2], disc[behind], point[behind], len(circle))[1]
    return np.where(behind_it == NOBODY, -1, behind_it)


def _assembled(arcs: CircleArcs, pieces: _Pieces, boundary: Loops) -> DiscRegions:
    """The loops of all discs without those of the background; forward pieces of one arc are rejoined."""
    kept_loops = np.flatnonzero(boundary.face >= 0)
    owner, row = expand(boundary.start[kept_loops], boundary.start[kept_loops + 1])
    half_edge = boundary.half_edge[row]
    piece, forward = half_edge // 2, half_edge % 2 == 0
    sweep = np.where(forward, pieces.sweep[piece], -pieces.sweep[piece])
    start = np.where(forward, pieces.start[piece], pieces.start[piece] + pieces.sweep[piece])
    arc = pieces.arc[piece]
    joins = np.append(False, (owner[1:] == owner[:-1]) & forward[1:] & forward[:-1] & (arc[1:] == arc[:-1]))
    kept = np.flatnonzero(~joins[: len(row)])
    region, first_loop = np.unique(boundary.face[kept_loops], return_index=True)
    return DiscRegions(
        arcs.circle[arc[kept]], start[kept], np.add.reduceat(sweep, kept),
        offsets(owner[kept], len(kept_loops)), np.append(first_loop, len(kept_loops)), region,
    )  # fmt: skip
