"""Franklin's SPHERES (1980): the visible arcs of opaque discs ordered by depth, exactly, in linear expected time.

A disc is opaque and closed: it hides whatever of farther discs lies on or within its perimeter. Larger z is farther;
of discs with equal z the one with the lower row is nearer. Discs need not come in any order.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Ints, distinct
from molviz.discs.grid import NOBODY, CellLists, Grid, nearer, on_perimeter
from molviz.geometry.circles import CircleArcs
from molviz.geometry.intervals import Intervals, gaps
from molviz.geometry.rows import blocks, expand
from molviz.model.spheres import Spheres
from molviz.threads import in_threads

BLOCK_ROWS = 1 << 16  # pairs, intervals or tests at a time: keeps memory flat and the columns in cache
TANGENT = 4.0 * np.finfo(float).eps  # of the lengths compared: perimeters this close to tangent touch and do not cross
SHORTEST = 1e-12  # radians: a shorter arc lies between two ends that rounding has torn apart


class Work(NamedTuple):
    """What the grid spared and what it did not, counted as in the paper's Fig. 8."""

    cell_entries: int
    cells_blocked: int
    pairs_tested: int
    pairs_intersecting: int
    pairs_touching: int  # tangent, or coincident


class Pairs(NamedTuple):
    """Pairs of discs that share a cell list, each once, ordered by the farther disc."""

    far: Ints  # (m,)
    near: Ints  # (m,)


def arcs_on_lists(
    spheres: Spheres, grid: Grid, lists: CellLists, own: Bools, cells: slice
) -> tuple[CircleArcs, Work]:
    """Return the visible arcs of the perimeters of ``own`` discs (n,), whose cells all have their lists.

    An arc's ``before`` and ``after`` are the discs that hide the perimeter beyond its ends; angles run
    counter-clockwise from the x axis. The work is that of those discs, and of ``cells``.

    Steps 4 and 5 of Franklin's section 5. Every change between visible and hidden along a perimeter happens where
    a pair on a common cell list crosses, so each arc that such pairs leave is wholly visible or wholly hidden, and
    its midpoint decides. Arcs do not depend on the grid, but for rounding.
    """
    pairs, tested = pairs_on_lists(spheres, lists, own, cells)
    nobody = pairs.far[:0]
    visible, crossing, touching = [_remaining_arcs(spheres, nobody, Pairs(nobody, nobody))[0]], 0, 0
    for remaining, crossings, touches in _arcs_of_blocks(spheres, grid, lists, pairs, own):
        visible.append(remaining)
        crossing, touching = crossing + crossings, touching + touches
    columns = (np.concatenate(column) for column in zip(*visible, strict=True))
    entries = int(lists.start[cells.stop] - lists.start[cells.start])
    blocked = int(np.count_nonzero(lists.blocker[cells] != NOBODY))
    return CircleArcs(*columns), Work(entries, blocked, tested, crossing, touching)


def pairs_on_lists(spheres: Spheres, lists: CellLists, own: Bools, cells: slice) -> tuple[Pairs, int]:
    """Return the pairs that meet on a cell list and whose farther disc is one of ``own``.

    And how often any meet in ``cells``: pairs with several common cells do so several times.
    """
    count = len(spheres.radius)
    end = np.repeat(lists.start[1:], np.diff(lists.start))
    after = np.arange(1, len(lists.item) + 1)

    def keys_of(block: slice) -> Ints:
        owner, place = expand(after[block], end[block])
        one, other = lists.item[block][owner], lists.item[place]
        ahead = nearer(spheres, one, other)
        far, near = np.where(ahead, other, one), np.where(ahead, one, other)
        mine = np.flatnonzero(own[far])
        return distinct(far[mine] * count + near[mine])

    keys = np.concatenate([after[:0], *in_threads(keys_of, blocks(end - after, BLOCK_ROWS))])
    inside = slice(int(lists.start[cells.start]), int(lists.start[cells.stop]))
    return Pairs(*np.divmod(distinct(keys), count)), int(np.sum((end - after)[inside]))


def _arcs_of_blocks(
    spheres: Spheres, grid: Grid, lists: CellLists, pairs: Pairs, own: Bools
) -> list[tuple[CircleArcs, int, int]]:
    """The visible arcs of every own disc on some list, in blocks of discs; crossing and touching pairs."""
    listed = np.zeros(len(spheres.radius), dtype=bool)
    listed[lists.item] = True
    disc = np.flatnonzero(listed & own)
    begin, end = np.searchsorted(pairs.far, disc), np.searchsorted(pairs.far, disc, side="right")

    def visible_in(block: slice) -> tuple[CircleArcs, int, int]:
        rows = slice(int(begin[block][0]), int(end[block][-1]))
        arcs, crossing, touching = _remaining_arcs(spheres, disc[block], Pairs(pairs.far[rows], pairs.near[rows]))
        return arcs.take(~_midpoint_hidden(spheres, grid, lists, arcs)), crossing, touching

    return in_threads(visible_in, blocks(end - begin + 1, BLOCK_ROWS))


def _remaining_arcs(spheres: Spheres, disc: Ints, pairs: Pairs) -> tuple[CircleArcs, int, int]:
    """The complement of the hidden arcs of some discs, and how many of the pairs cross and touch."""
    hidden, near, crossing, touching = hidden_intervals(spheres, pairs)
    numbered = Intervals(np.searchsorted(disc, hidden.circle), hidden.start, hidden.sweep)
    free = gaps(numbered, len(disc))
    long = free.sweep > SHORTEST
    near = np.append(near, -1)
    arcs = CircleArcs(disc[free.circle], free.start, free.sweep, near[free.before], near[free.after])
    return arcs.take(long), crossing, touching


def hidden_intervals(spheres: Spheres, pairs: Pairs) -> tuple[Intervals, Ints, int, int]:
    """Return what the nearer disc hides of each farther perimeter, and that disc; crossing and touching pairs.

    With f and n the radii of the farther and the nearer disc and d the distance of their centres, the perimeters
    cross if |f − n| < d < f + n; the nearer disc then hides φ ± h, φ the direction of its centre, and by the half
    angle formula tan² h/2 = (n − d + f)(n + d − f) / ((d + f − n)(d + f + n)), which loses nothing near h = 0 or π.
    The farther perimeter is hidden whole if d ≤ n − f, and not at all otherwise.
    """
    x, y = (spheres.center[pairs.near, axis] - spheres.center[pairs.far, axis] for axis in (0, 1))
    far, near = spheres.radius[pairs.far], spheres.radius[pairs.near]
    distance = np.hypot(x, y)
    touch = TANGENT * (far + near)
    apart, beyond, within = far + near - distance, distance + near - far, distance + far - near
    crosses = (apart > touch) & (beyond > touch) & (within > touch)
    covered = (within <= touch) & (near >= far)
    touches = np.minimum(np.abs(apart), np.minimum(np.abs(beyond), np.abs(within))) <= touch

    rows = np.flatnonzero(crosses | covered)
    with np.errstate(divide="ignore", invalid="ignore"):
        tangent = np.sqrt(apart[rows] * beyond[rows] / (within[rows] * (distance + far + near)[rows]))
    half = np.where(crosses[rows], 2.0 * np.arctan(tangent), np.pi)
    start = np.arctan2(y[rows], x[rows]) - half
    hidden = Intervals(pairs.far[rows], start, 2.0 * half)
    return hidden, pairs.near[rows], int(np.count_nonzero(crosses)), int(np.count_nonzero(touches))


def _midpoint_hidden(spheres: Spheres, grid: Grid, lists: CellLists, arcs: CircleArcs) -> Bools:
    """Tell whether the midpoint of each arc is hidden: whether its disc is blocked in the midpoint's cell.

    The discs on the cell's list need no test, unlike in the paper, which stops forming pairs of a perimeter once it
    is known to be hidden: a disc that is not blocked is on the list, its pairs there were tested, and what they
    hide of it is gone.
    """
    middle = arcs.start + 0.5 * arcs.sweep
    blocker = lists.blocker[grid.cell_at(*on_perimeter(spheres, arcs.circle, middle))]
    known = np.flatnonzero(blocker != NOBODY)
    hidden = np.zeros(len(blocker), dtype=bool)
    hidden[known] = nearer(spheres, blocker[known], arcs.circle[known])
    return hidden
