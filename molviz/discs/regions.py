"""Hidden surfaces of discs: the visible region of every disc, bounded by visible arcs (Franklin 1980, section 1).

Where a visible arc of disc k ends, it passes under a disc l: a T-junction on the perimeter of l, which runs on. Cut
at its T-junctions, every visible arc has one disc on its inside, its own, and one on its outside. At a junction,
with a the piece of l before it and b the piece after it (counter-clockwise), going with the region on the left:

    k ends at l:     k forwards → a backwards,    b backwards → k backwards
    k starts at l:   k backwards → a backwards,   b backwards → k forwards

and l itself runs on, a forwards → b forwards. Loops close by these rules alone, without comparing coordinates.
Half-edge 2p is piece p forwards, 2p + 1 backwards.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.discs.arcs import DiscArcs
from molviz.discs.grid import NOBODY, CellLists, Grid, foremost, nearer, on_perimeter
from molviz.geometry.general_position import Degenerate
from molviz.geometry.intervals import TURN
from molviz.geometry.planar_map import cycles
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


def visible_regions(spheres: Spheres, grid: Grid, lists: CellLists, arcs: DiscArcs) -> DiscRegions:
    """Return the visible regions of discs whose visible arcs are given.

    Regions whose own perimeter is hidden are included (his Fig. 7). Raises ``Degenerate`` where arcs do
    not join, or too closely to be sure; a displaced copy of the discs has the same regions to within the displacement.
    """
    junctions = _junctions(spheres, arcs)
    pieces = _cut(arcs, junctions)
    edge, loop_start = cycles(_next_edges(arcs, junctions, pieces))
    disc = _discs_of_loops(spheres, grid, lists, arcs, pieces, edge, loop_start)
    return _assembled(arcs, pieces, edge, loop_start, disc)


def _junctions(spheres: Spheres, arcs: DiscArcs) -> _Junctions:
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


def _apart(arcs: DiscArcs, junctions: _Junctions) -> bool:
    """Tell whether junctions lie within their hosts, clear of the hosts' ends and of each other."""
    host, offset = junctions.host, junctions.offset
    inside = (offset > CLEAR) & (offset < arcs.sweep[host] - CLEAR)
    between = (np.diff(offset) > CLEAR) | (np.diff(host) > 0)
    return bool(np.all(inside) and np.all(between))


def _host(arcs: DiscArcs, circle: Ints, angle: Floats) -> Ints:
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


def _cut(arcs: DiscArcs, junctions: _Junctions) -> _Pieces:
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


def _next_edges(arcs: DiscArcs, junctions: _Junctions, pieces: _Pieces) -> Ints:
    """The half-edge that follows each half-edge along its region, by the rules of the module's first paragraph."""
    whole = arcs.before < 0
    after = _piece_after(junctions, offsets(junctions.host, len(whole)), whole, pieces.first)
    first, last = pieces.first[junctions.host], pieces.first[junctions.host + 1] - 1
    before = np.where(after > first, after - 1, last)
    arc_end = pieces.first[junctions.arc + 1] - 1
    arc_start = pieces.first[junctions.arc]

    following = np.arange(2 * len(pieces.arc))  # whole circles without a junction follow themselves
    following[2 * before] = 2 * after
    end, start = junctions.at_end, ~junctions.at_end
    following[2 * arc_end[end]] = 2 * before[end] + 1
    following[2 * after[end] + 1] = 2 * arc_end[end] + 1
    following[2 * arc_start[start] + 1] = 2 * before[start] + 1
    following[2 * after[start] + 1] = 2 * arc_start[start]
    return following


def _discs_of_loops(
    spheres: Spheres, grid: Grid, lists: CellLists, arcs: DiscArcs, pieces: _Pieces, edge: Ints, loop_start: Ints
) -> Ints:
    """The disc seen to the left of every loop, −1 for the background.

    A loop with a forward half-edge belongs to that arc's disc. A loop without one has the disc next behind the
    longest of its pieces.
    """
    circle = arcs.circle[pieces.arc[edge // 2]]
    forward = edge % 2 == 0
    lowest = np.minimum.reduceat(np.where(forward, circle, NOBODY), loop_start[:-1])
    highest = np.maximum.reduceat(np.where(forward, circle, -1), loop_start[:-1])
    if np.any((highest >= 0) & (lowest != highest)):
        raise Degenerate
    bare = np.flatnonzero(highest < 0)
    loop = np.repeat(np.arange(len(highest)), np.diff(loop_start))
    by_length = np.lexsort((spheres.radius[circle] * pieces.sweep[edge // 2], loop))
    longest = edge[by_length[loop_start[1:] - 1]][bare] // 2
    highest[bare] = _next_behind(spheres, grid, lists, arcs.circle[pieces.arc[longest]], _middle(pieces, longest))
    return highest


def _middle(pieces: _Pieces, piece: Ints) -> Floats:
    return np.asarray(pieces.start[piece] + 0.5 * pieces.sweep[piece])


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
    found = foremost(spheres.center[:, 2], disc[behind], point[behind], len(circle))[1]
    return np.where(found == NOBODY, -1, found)


def _assembled(arcs: DiscArcs, pieces: _Pieces, edge: Ints, loop_start: Ints, disc: Ints) -> DiscRegions:
    """Group the loops by disc without those of the background, and rejoin the forward pieces of each arc."""
    loops = np.flatnonzero(disc >= 0)
    loops = loops[np.argsort(disc[loops], kind="stable")]
    owner, row = expand(loop_start[loops], loop_start[loops + 1])
    piece, forward = edge[row] // 2, edge[row] % 2 == 0
    sweep = np.where(forward, pieces.sweep[piece], -pieces.sweep[piece])
    start = np.where(forward, pieces.start[piece], pieces.start[piece] + pieces.sweep[piece])
    arc = pieces.arc[piece]
    joins = np.append(False, (owner[1:] == owner[:-1]) & forward[1:] & forward[:-1] & (arc[1:] == arc[:-1]))
    kept = np.flatnonzero(~joins[: len(row)])
    region, first_loop = np.unique(disc[loops], return_index=True)
    return DiscRegions(
        arcs.circle[arc[kept]], start[kept], np.add.reduceat(sweep, kept),
        offsets(owner[kept], len(loops)), np.append(first_loop, len(loops)), region,
    )  # fmt: skip
