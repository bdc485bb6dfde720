"""Ink as filled shapes: each line is bounded by arcs of circles on either side, and by its ends."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import Paths, PlaneArcs, straight_pieces
from molviz.geometry.rows import expand, lists_taken, offsets
from molviz.picture.ink import BLOCK_SAMPLES, THINNEST, Widths, at_places
from molviz.picture.ink_ends import INSIDE, OUTSIDE, Disc, Ends, Mitre, discs, ends_of, mitres
from molviz.picture.ink_strokes import Strokes, frames_at, strokes_of
from molviz.picture.regions import stacked
from molviz.threads import both, in_threads
from molviz.vectors import cross, dot
from molviz.visibility.horizon_runs import HorizonRuns

TOLERANCE = 0.01  # ångström by which a side may be off
FLAT = 2e-4  # ångström by which an arc may differ from its chord to be drawn as that
LONGEST_TURN = 2.0  # radians of a horizon along which one arc may run
MOST_TURN = 1.05 * np.pi  # radians of an arc: round tips are half circles
GROWTH = 1.5  # by which arcs may be longer, of how far they are from shorter ones
BLOCK_ARCS = 1 << 13  # at a time, some forty columns each
NECK = 0.4  # of the widest line: where less is left between two lines that meet, ink fills it
NOTHING = 1e-9  # square ångström: a stroke of less ink is none, and ångström: shorter pieces are none
ALL = 0.995  # of a line that is dark: it hides its own ink
OUTER, END, INNER, START = range(4)  # the parts of a loop


class _Pieces(NamedTuple):
    """Arcs through three points each, and where in which loop they stand."""

    stroke: Ints  # (q,)
    part: Ints  # (q,) outer side, end, inner side, start
    along: Ints  # (q,) within the part
    start: Floats  # (q, 2)
    middle: Floats
    end: Floats


def inked(runs: HorizonRuns, widths: Widths, neck: float) -> tuple[Strokes, Paths, Bools]:
    """Return all lines, their shapes and which are of the dark ink; others lie under these and go on below them."""
    own = widths.width > 0
    own &= widths.dark < ALL
    dark = np.where(widths.width * widths.dark >= THINNEST, widths.width * widths.dark, 0.0)
    one, one_paths = outlined(runs, strokes_of(runs, own, widths.ends), widths.width, widths, neck)
    other, other_paths = outlined(runs, strokes_of(runs, dark > 0, widths.ends), dark, widths, neck)
    is_dark = np.repeat([False, True], [len(one.run), len(other.run)])
    strokes = Strokes(*(np.concatenate(columns, axis=-1) for columns in zip(one, other, strict=True)))
    return strokes, stacked([one_paths, other_paths]), is_dark


def outlined(
    runs: HorizonRuns, strokes: Strokes, width: Floats, all_ink: Widths, neck: float
) -> tuple[Strokes, Paths]:
    """Return one shape per stroke, the ink inside; two loops where it is a ring. Strokes without ink are left out.

    ``width`` (s,) is that of the strokes, ``all_ink`` that of all inks together; wedges between lines are filled as far
    as they are narrower than ``neck`` ångström.
    """
    ends, taken = ends_of(runs, strokes, width, all_ink), _arcs_taken(runs, width)

    def side(part: int, share: float) -> tuple[_Pieces, _Turn]:
        disc, mitre = discs(runs, ends, width, all_ink.width, share, neck), mitres(runs, ends, share)
        most = np.where(disc.fits | mitre.cut | (share < 0), np.inf, _most_outside(ends))
        stops = np.where(disc.fits, disc.place, mitre.place)
        stroke, number, points = _side(runs, strokes, taken, share * width, stops, most)
        corner = np.concatenate([points[number == 0], points[np.roll(number == 0, -1)]])
        return _along_side(stroke, number, points, part), _Turn(corner, disc, mitre)

    (outer, outer_turn), (inner, inner_turn) = both(
        lambda: side(OUTER, OUTSIDE), lambda: side(INNER, INSIDE), len(width) > BLOCK_SAMPLES
    )
    pieces = [outer, inner, *_at_ends(strokes, ends, outer_turn, inner_turn)]
    return _with_ink(strokes, _loops(strokes, _Pieces(*map(np.concatenate, zip(*pieces, strict=True)))))


class _Turn(NamedTuple):
    """Where one side of each end stops, and how it goes on; rows (2k,)."""

    corner: Floats  # (2k, 2)
    disc: Disc
    mitre: Mitre

    def joint(self, ends: Ends) -> Floats:
        """Return the points (2k, 2) from which the line goes across to the other side."""
        joint = np.where(self.mitre.beyond[:, None], self.mitre.point, self.corner)
        on_host = np.where(self._barred(ends), self.mitre.point, ends.frame.point)
        return np.where(self.disc.fits[:, None], on_host, joint)

    def way(self, ends: Ends) -> Floats:
        """Return the points (2k, 2) halfway back to there from where discs touch."""
        straight = (self.disc.touched + self.joint(ends)) / 2
        return np.where(self._barred(ends), straight, self.disc.way)

    def _barred(self, ends: Ends) -> Bools:
        """Whether ends (2k, 1) are cut off by ink below them, rather than hidden."""
        return np.asarray((self.mitre.cut & (ends.bars() > 0))[:, None])


def _most_outside(ends: Ends) -> Floats:
    """How far outside its horizon a line may end under one that faces it: where that line's inner side is."""
    facing = np.where(ends.facing < 0, ends.facing, -1.0)
    return np.where(ends.facing < 0, INSIDE * ends.host_width / facing, np.inf)


def _side(
    runs: HorizonRuns, strokes: Strokes, taken: Floats, outside: Floats, stops: Floats, most: Floats
) -> tuple[Ints, Ints, Floats]:
    """The points of one side of all strokes: the stroke of each, its number from 0, and where it is.

    There are two for each arc of a circle, and one more: places are equally far apart in numbers of arcs ``taken`` (s,)
    so far. Points lie ``outside`` (s,) of the horizon, and where sides start and stop (2k,) at ``most`` (2k,) so far.
    """
    count = len(strokes.run)
    first, last = stops[:count], stops[count:]
    low, high = _taken_at(runs, taken, strokes.run, first), _taken_at(runs, taken, strokes.run, last)
    arcs = np.maximum(np.ceil(high - low), 1 + strokes.whole).astype(np.int64)
    stroke, number = expand(np.zeros_like(arcs), 2 * arcs + 1)
    at_start, at_end = number == 0, number == 2 * arcs[stroke]
    wanted = low[stroke] + (high - low)[stroke] * number / (2 * arcs)[stroke]
    place = _place_where(runs, taken, strokes.run[stroke], wanted)
    place = np.where(at_start, first[stroke], np.where(at_end, last[stroke], place))
    offset = at_places(outside, runs, strokes.run[stroke], place)
    offset = np.where(at_start, np.minimum(offset, most[:count][stroke]), offset)
    offset = np.where(at_end, np.minimum(offset, most[count:][stroke]), offset)
    return stroke, number, frames_at(runs, strokes.run[stroke], place).outwards(offset)


def _arcs_taken(runs: HorizonRuns, width: Floats) -> Floats:
    """How many arcs the sides of all lines take up to each sample (s,).

    Where the distance from a circle bends by w″, the middle of a chord of length h is off by at most ``w″ h² / 8``, and
    an arc through three points stands for two chords. An ellipse of half axes a and b bends by ``2 (a − b) / a²``.
    """
    owner = runs.owner()
    step = (runs.length() / (np.diff(runs.start) - 1))[owner]
    within = np.append(owner[2:] == owner[:-2], [False, False])[: len(owner)]
    change = np.where(within, np.abs(width - 2 * np.roll(width, -1) + np.roll(width, -2)), 0.0)
    change = np.maximum(np.maximum(change, np.roll(change, 1)), np.roll(change, 2))  # any of the three samples' own
    major, area = runs.arcs.major(), np.abs(cross(runs.arcs.u, runs.arcs.v))
    bend = OUTSIDE * change / step**2 + (2 * np.maximum(major - area / major, 0.0) / major**2)[owner]
    taken = step * (np.sqrt(bend / (8 * TOLERANCE)) / 2 + 1 / (LONGEST_TURN * major[owner]))
    taken = 1.0 / _graded(1.0 / taken, runs)
    return np.asarray(np.cumsum(taken) - taken)


def _graded(size: Floats, runs: HorizonRuns) -> Floats:
    """The sizes of arcs, in samples, less where smaller ones are near: the least of ``size + GROWTH · samples away``.

    An arc through three points is near to what lies between them only if its two chords are about equally long.
    """
    owner, place = runs.owner(), GROWTH * np.arange(len(size))
    apart = (1.0 + GROWTH) * len(size) * owner  # so far that no run's sizes count in another
    least = np.minimum(size, len(size))
    least = np.minimum.accumulate(least - place - apart) + place + apart
    least = np.minimum.accumulate((least + place + apart)[::-1])[::-1] - place - apart
    return np.asarray(least)


def _taken_at(runs: HorizonRuns, taken: Floats, run: Ints, place: Floats) -> Floats:
    """The arcs taken at places, which may lie in other turns of closed runs."""
    turns = np.where(runs.closed[run], np.floor(place / (np.diff(runs.start) - 1)[run]), 0.0)
    whole = taken[runs.start[run + 1] - 1] - taken[runs.start[run]]
    return at_places(taken, runs, run, place) + turns * whole


def _place_where(runs: HorizonRuns, taken: Floats, run: Ints, value: Floats) -> Floats:
    """The inverse: the places at which so many arcs are taken."""
    begin, end = runs.start[run], runs.start[run + 1] - 1
    whole = taken[end] - taken[begin]
    turns = np.where(runs.closed[run], np.floor((value - taken[begin]) / whole), 0.0)
    sample = np.interp(value - turns * whole, taken, np.arange(len(taken)))
    return np.asarray(np.clip(sample, begin, end) - begin + turns * (end - begin))


def _along_side(stroke: Ints, number: Ints, points: Floats, part: int) -> _Pieces:
    """The arcs of a side, forwards or, of the inner one, backwards."""
    row = np.flatnonzero((number[:-1] % 2 == 0) & (number[1:] > number[:-1]))
    begin, end = (row, row + 2) if part == OUTER else (row + 2, row)
    along = number[row] if part == OUTER else -number[row]
    return _Pieces(stroke[row], np.full(len(row), part), along, points[begin], points[row + 1], points[end])


def _at_ends(strokes: Strokes, ends: Ends, outer: _Turn, inner: _Turn) -> list[_Pieces]:
    """From the outer side to the inner one at ends, or the other way at starts.

    Along the disc and back under the line above, or on to the mitre; across; and the same of the inner side, backwards.
    """
    one, other = outer.joint(ends), inner.joint(ends)
    across = (one + other) / 2 + _bulge(ends, inner.mitre)
    pieces = []
    for number, (rows, points) in enumerate((
        (outer.disc.fits, (outer.corner, outer.disc.middle, outer.disc.touched)),
        (outer.disc.fits, (outer.disc.touched, outer.way(ends), one)),
        (outer.mitre.beyond & ~outer.disc.fits, (outer.corner, outer.mitre.middle, one)),
        (~strokes.whole[ends.stroke], (one, across, other)),
        (inner.mitre.beyond & ~inner.disc.fits, (other, inner.mitre.middle, inner.corner)),
        (inner.disc.fits, (other, inner.way(ends), inner.disc.touched)),
        (inner.disc.fits, (inner.disc.touched, inner.disc.middle, inner.corner)),
    )):  # fmt: skip
        forwards, rows = ends.onward > 0, rows & (np.hypot(*(points[0] - points[2]).T) > NOTHING)
        for taken, part, begin, end in ((rows & forwards, END, 0, 2), (rows & ~forwards, START, 2, 0)):
            row = np.flatnonzero(taken)
            along = np.full(len(row), number if part == END else -number)
            three = points[begin][row], points[1][row], points[end][row]
            pieces.append(_Pieces(ends.stroke[row], np.full(len(row), part), along, *three))
    return pieces


def _bulge(ends: Ends, inner: Mitre) -> Floats:
    """By how much (2k, 2) ends go on in their middle: tips that meet no line's side are round."""
    alone = ends.tip & ~(inner.cut | inner.beyond) & ((ends.mate_width > 0) | (ends.mate < 0))
    return np.asarray(np.where(alone, -INSIDE * ends.width, 0.0)[:, None] * ends.onwards())


def _loops(strokes: Strokes, pieces: _Pieces) -> Paths:
    """One loop for each stroke, or two where it is a ring."""
    number = 2 * pieces.stroke + (strokes.whole[pieces.stroke] & (pieces.part == INNER))
    along = pieces.along - pieces.along.min(initial=0)
    order = np.argsort((4 * number + pieces.part) * (along.max(initial=0) + 1) + along, kind="stable")
    loop_first = np.flatnonzero(np.diff(number[order], prepend=-1))
    arcs = _arcs_of(pieces, order)
    shape_start = offsets(pieces.stroke[order][loop_first], len(strokes.run))
    return Paths(arcs, np.append(loop_first, len(order)), shape_start)


def _arcs_of(pieces: _Pieces, rows: Ints) -> PlaneArcs:
    """The arcs of the given pieces, in blocks that stay in cache, shared by threads."""
    parts = np.array_split(rows, len(rows) // BLOCK_ARCS + 1)
    found = in_threads(lambda row: arcs_through(*(column.take(row, axis=0) for column in pieces[3:])), parts)
    return PlaneArcs(*(np.concatenate(column) for column in zip(*found, strict=True)))


def _with_ink(strokes: Strokes, paths: Paths) -> tuple[Strokes, Paths]:
    """The strokes and shapes with ink inside: where a cut reaches across the other end, a shape is inside out."""
    area = np.add.reduceat(paths.arcs.signed_area(), paths.loop_start[:-1])[paths.shape_start[:-1]]
    kept = np.flatnonzero(area > NOTHING)
    return strokes.take(kept), _shapes_taken(paths, kept)


def _shapes_taken(paths: Paths, shapes: Ints) -> Paths:
    loop, shape_start = lists_taken(paths.shape_start, shapes)
    arc, loop_start = lists_taken(paths.loop_start, loop)
    return Paths(paths.arcs.take(arc), loop_start, shape_start)


def arcs_through(start: Floats, middle: Floats, end: Floats) -> PlaneArcs:
    """Return the arcs of circles through three points each, straight where these are nearly in a line.

    No line turns by more than half a turn between them: where an arc would, a line crosses its own end there, and the
    middle point lies beyond both others.
    """
    a, b = middle - start, end - start
    area, size = 2 * cross(a, b), dot(b, b)
    between = dot(a, b) * (size - dot(a, b)) > 0  # the middle point, as seen from the chord
    flat = np.abs(area) <= np.where(between, 2 * FLAT * np.sqrt(size), 1e-6 * np.maximum(size, dot(a, a)))
    aa, divisor = dot(a, a), np.where(flat, 1.0, area)
    center = np.column_stack([b[:, 1] * aa - a[:, 1] * size, a[:, 0] * size - b[:, 0] * aa]) / divisor[:, None]
    u = -center
    v = np.column_stack([-u[:, 1], u[:, 0]])
    to_end = b - center
    angle = np.mod(np.arctan2(dot(v, to_end), dot(u, to_end)), 2 * np.pi)
    sweep = np.where(area > 0, angle, angle - 2 * np.pi)
    flat |= np.abs(sweep) > MOST_TURN
    line = straight_pieces(start, end)
    pick = flat[:, None]
    return PlaneArcs(
        np.where(pick, line.c, start + center), np.where(pick, line.u, u), np.where(pick, line.v, v),
        np.where(flat, line.start, 0.0), np.where(flat, line.sweep, sweep),
    )  # fmt: skip


def in_colors(paths: Paths, color: Ints) -> tuple[Paths, Ints]:
    """Return shapes of equal rows of ``color`` (k, c) as one shape each, and the distinct rows, ascending."""
    order = np.lexsort(color.T[::-1])
    first = np.flatnonzero(np.append(True, (color[order][1:] != color[order][:-1]).any(axis=1))[: len(order)])
    taken = _shapes_taken(paths, order)
    return taken._replace(shape_start=taken.shape_start[np.append(first, len(order))]), color[order[first]]
