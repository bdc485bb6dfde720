"""Ink as filled shapes: each line is bounded by arcs of circles on either side, and by its ends.

A line that passes under a nearer one ends across its way under the ink of that one. Where the two leave a narrow
wedge, ink fills it as far as a small disc does not get: sides end where that disc touches them and go on along it.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import Paths, PlaneArcs, straight_pieces
from molviz.geometry.rows import expand, lists_taken, offsets
from molviz.picture.ink import THINNEST, Widths, at_places
from molviz.picture.regions import stacked
from molviz.vectors import cross, dot
from molviz.visibility.horizon_runs import HorizonRuns

OUTSIDE = 0.6  # of the width lies outside the horizon
INSIDE = OUTSIDE - 1.0
TOLERANCE = 0.01  # ångström by which a side may be off
LONGEST_TURN = 2.0  # radians of a horizon along which one arc may run
NECK = 0.4  # of the widest line: where less is left between two lines that meet, ink fills it
NARROW = 75.0  # degrees: wider wedges are left as they are
COVERS = 0.8  # of a line's width: a line so wide hides its end
OVERLAPPING = 0.97 * OUTSIDE  # of a line's width: as far outside its horizon ink beside it begins
TOUCHES = 3  # rounds in which the places are found where a disc touches two lines of varying width
NOTHING = 1e-9  # square ångström: a stroke of less ink is none, and ångström: shorter pieces are none

ALL = 0.995  # of a line that is dark: it hides its own ink
OUTER, END, INNER, START = range(4)  # the parts of a loop


class Strokes(NamedTuple):
    """Stretches of runs that are drawn in one ink; they may reach into the next turn of closed runs."""

    run: Ints  # (k,)
    first: Floats  # (k,) samples, fractional counts from the run's start
    last: Floats  # (k,)
    ends: Ints  # (2, k) rows of the runs' vertices in which they begin and end, −1 where in none
    whole: Bools  # (k,) a closed run altogether

    def take(self, rows: Ints) -> "Strokes":
        """Return the given rows, in that order."""
        return Strokes(self.run[rows], self.first[rows], self.last[rows], self.ends[:, rows], self.whole[rows])


def strokes_of(runs: HorizonRuns, drawn: Bools, ends: Ints) -> Strokes:
    """Return the stretches of ``drawn`` samples (s,), as far as the sample beyond, where their width may be nought.

    Runs have ink between ``ends`` (2, m), rows of their vertices.
    """
    owner = runs.owner()
    joined = np.append(False, drawn[1:] & drawn[:-1] & (owner[1:] == owner[:-1]))[: len(drawn)]
    first = np.flatnonzero(drawn & ~joined)
    last = np.flatnonzero(drawn & ~np.append(joined[1:], False)[: len(drawn)])
    run = owner[first]
    count = np.diff(runs.start)[run]
    low, high = first - runs.start[run], last - runs.start[run]
    from_start, to_end = low == 0, high == count - 1
    whole = runs.closed[run] & from_start & to_end
    # of a closed run that is drawn across its seam the part after it continues the one before
    split = runs.closed[run] & ~whole
    after, before = np.flatnonzero(split & from_start), np.flatnonzero(split & to_end)
    after, before = after[np.isin(run[after], run[before])], before[np.isin(run[before], run[after])]
    high[before] += high[after]
    opened = np.stack([from_start & ~runs.closed[run], to_end & ~runs.closed[run]])
    begin = np.where(opened[0], runs.vertices.place[ends[0, run]], low - 1.0 * ~whole)
    end = np.where(opened[1], runs.vertices.place[ends[1, run]], high + 1.0 * ~whole)
    rows = np.where(opened, ends[:, run], -1)
    found = Strokes(run, begin, np.maximum(begin, end), rows, whole)
    return found.take(np.setdiff1d(np.arange(len(run)), after))


class _Ends(NamedTuple):
    """The ends of k strokes, first all starts, then all ends, with what lies above them; rows (2k,)."""

    stroke: Ints
    onward: Floats  # −1 at starts, 1 at ends: the way, in samples, in which lines would go on
    place: Floats  # where it is
    point: Floats  # (2k, 2) on the page, on the horizon
    normal: Floats  # (2k, 2) of the horizon, outwards
    width: Floats
    host: Ints  # the run under which it ends, −1 if under none
    host_place: Floats
    host_width: Floats
    facing: Floats  # cosine between the two horizons' normals; 1 under none
    tip: Bools  # the line ends in the open, not in a point


class _Disc(NamedTuple):
    """How one side of each end goes on: along a disc that touches it and the line above; rows (2k,)."""

    place: Floats  # where the side stops
    fits: Bools  # there is a disc; points of other rows mean nothing
    middle: Floats  # (2k, 2) of its arc
    touched: Floats  # (2k, 2) on the line above
    way: Floats  # (2k, 2) under the line above, halfway back to the end


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
    one, one_paths = outlined(runs, strokes_of(runs, own, widths.ends), widths.width, widths.width, neck)
    other, other_paths = outlined(runs, strokes_of(runs, dark > 0, widths.ends), dark, widths.width, neck)
    is_dark = np.repeat([False, True], [len(one.run), len(other.run)])
    both = Strokes(*(np.concatenate(columns, axis=-1) for columns in zip(one, other, strict=True)))
    return both, stacked([one_paths, other_paths]), is_dark


def outlined(
    runs: HorizonRuns, strokes: Strokes, width: Floats, all_ink: Floats, neck: float
) -> tuple[Strokes, Paths]:
    """Return one shape per stroke, the ink inside; two loops where it is a ring. Strokes without ink are left out.

    ``width`` (s,) is that of the strokes, ``all_ink`` that of all inks together; wedges between lines are filled as far
    as they are narrower than ``neck`` ångström.
    """
    ends = _ends(runs, strokes, width, all_ink)
    discs = [_discs(runs, strokes, ends, width, all_ink, share, neck) for share in (OUTSIDE, INSIDE)]
    pieces, corners = [], []
    for part, (share, disc) in zip((OUTER, INNER), zip((OUTSIDE, INSIDE), discs, strict=True), strict=True):
        stroke, number, points = _side(runs, strokes, ends, width, share, disc)
        pieces.append(_along_side(stroke, number, points, part))
        first = number == 0
        corners.append(np.concatenate([points[first], points[np.roll(first, -1)]]))
    pieces += _at_ends(strokes, ends, discs, corners)
    return _with_ink(strokes, _loops(strokes, _Pieces(*map(np.concatenate, zip(*pieces, strict=True)))))


def _ends(runs: HorizonRuns, strokes: Strokes, width: Floats, all_ink: Floats) -> _Ends:
    count = len(strokes.run)
    stroke, end = np.tile(np.arange(count), 2), np.repeat([0, 1], count)
    run, place, at = strokes.run[stroke], np.append(strokes.first, strokes.last), strokes.ends.ravel()
    row = np.where(at >= 0, runs.vertices.on_other_run(at), -1)
    under = np.flatnonzero(row >= 0)
    host, host_place, facing = np.full(2 * count, -1), np.zeros(2 * count), np.ones(2 * count)
    host[under], host_place[under] = runs.vertices.run[row[under]], runs.vertices.place[row[under]]
    frames = _frames(runs, run, place)
    facing[under] = dot(frames.normal[under], _frames(runs, host[under], host_place[under]).normal)
    above = np.zeros(2 * count)
    above[under] = at_places(all_ink, runs, host[under], host_place[under])
    own = at_places(width, runs, run, place)
    vertex = runs.vertices.vertex
    corner = (at >= 0) & np.isin(vertex[at], vertex[at[(at >= 0) & (at != runs.ends[end, run])]])
    covered = np.zeros(2 * count, dtype=bool)
    covered[under] = at_places(width, runs, host[under], host_place[under]) >= COVERS * own[under]
    tip = (at >= 0) & (own > 0) & (corner | ~covered)
    return _Ends(stroke, 2.0 * end - 1.0, place, frames.point, frames.normal, own, host, host_place, above, facing, tip)


class _Frames(NamedTuple):
    """Points of horizons with their unit normals outwards, radii of curvature and ångström per sample."""

    point: Floats  # (q, 2)
    normal: Floats  # (q, 2)
    radius: Floats  # (q,)
    step: Floats  # (q,)

    def outwards(self, offset: Floats) -> Floats:
        """Return the points (q, 2) so many ångström (q,) outside."""
        return np.asarray(self.point + offset[:, None] * self.normal)

    def center(self) -> Floats:
        """Return the centres of curvature (q, 2)."""
        return self.outwards(-self.radius)

    def samples_to(self, point: Floats) -> Floats:
        """Return how many samples (q,) along its horizon each point (q, 2) is, as seen from the centre of curvature."""
        spoke, to_point = self.radius[:, None] * self.normal, point - self.center()
        return np.asarray(np.arctan2(cross(spoke, to_point), dot(spoke, to_point)) * self.radius / self.step)


def _frames(runs: HorizonRuns, run: Ints, place: Floats) -> _Frames:
    arcs, samples = runs.arcs.take(run), (np.diff(runs.start) - 1)[run]
    t = arcs.start + arcs.sweep * place / samples
    tangent = arcs.tangent(t)
    speed = np.hypot(*tangent.T)
    normal = np.column_stack([tangent[:, 1], -tangent[:, 0]]) / speed[:, None]
    return _Frames(arcs.at(t), normal, speed**3 / np.abs(cross(arcs.u, arcs.v)), speed * arcs.sweep / samples)


def _discs(
    runs: HorizonRuns, strokes: Strokes, ends: _Ends, width: Floats, all_ink: Floats, share: float, neck: float
) -> _Disc:
    """The discs as wide as the neck that touch one side of lines, on ``share`` of the width, and the lines above.

    Discs that touch a line at distance a from a horizon that curves like a circle of radius r have their centres on the
    circle of radius r + a ± neck / 2 about the same point. Widths are those at the places that are touched.
    """
    rows = np.flatnonzero((ends.host >= 0) & (ends.width > 0) & (ends.host_width > 0))
    run, host = strokes.run[ends.stroke[rows]], ends.host[rows]
    own, above = _frames(runs, run, ends.place[rows]), _frames(runs, host, ends.host_place[rows])
    place, host_place = ends.place[rows], ends.host_place[rows]
    for _ in range(TOUCHES):
        reach = own.radius + share * at_places(all_ink, runs, run, place) + np.sign(share) * neck / 2
        host_reach = above.radius + OVERLAPPING * at_places(all_ink, runs, host, host_place) + neck / 2
        center, exists = _crossing(own, above, reach, host_reach)
        place = ends.place[rows] + own.samples_to(center)
        host_place = ends.host_place[rows] + above.samples_to(center)
    one, other = at_places(all_ink, runs, run, place), at_places(all_ink, runs, host, host_place)
    touches = _frames(runs, run, place).outwards(share * one)
    touched = _frames(runs, host, host_place).outwards(OVERLAPPING * other)
    ways = _unit(touches - center), _unit(touched - center)
    cut = ends.onward[rows] * (ends.place[rows] - place)
    on_host = runs.closed[host] | ((host_place >= 0) & (host_place <= (np.diff(runs.start) - 1)[host]))
    fits = exists & on_host & (cut > 0) & (cut < (strokes.last - strokes.first)[ends.stroke[rows]] / 2)
    fits &= (share > 0) | ~ends.tip[rows]
    fits &= (dot(*ways) < -np.cos(np.radians(NARROW))) & (other > 0)
    fits &= at_places(width, runs, run, place) > 0.99 * one  # where this ink is all there is
    back = _frames(runs, host, (host_place + ends.host_place[rows]) / 2).outwards(OUTSIDE / 3 * other)
    found = _Disc(ends.place.copy(), np.zeros(len(ends.place), dtype=bool), *np.zeros((3, len(ends.place), 2)))
    columns = place, fits, center + neck / 2 * _unit(ways[0] + ways[1]), touched, back
    for column, values in zip(found, columns, strict=True):
        column[rows[fits]] = values[fits]
    return found


def _crossing(own: _Frames, above: _Frames, reach: Floats, host_reach: Floats) -> tuple[Floats, Bools]:
    """Where circles about the centres of curvature cross, the nearer of both points to the end, and whether they do."""
    apart = above.center() - own.center()
    distance = np.maximum(np.hypot(*apart.T), NOTHING)
    along = (reach**2 - host_reach**2 + distance**2) / (2 * distance)
    height = reach**2 - along**2
    unit = apart / distance[:, None]
    foot = own.center() + along[:, None] * unit
    across = np.column_stack([-unit[:, 1], unit[:, 0]]) * np.sqrt(np.maximum(height, 0.0))[:, None]
    nearer = np.where(dot(across, own.point - foot) >= 0, 1.0, -1.0)
    return foot + nearer[:, None] * across, (height > 0) & (reach > 0)


def _unit(vectors: Floats) -> Floats:
    return np.asarray(vectors / np.maximum(np.hypot(*vectors.T), NOTHING)[:, None])


def _side(
    runs: HorizonRuns, strokes: Strokes, ends: _Ends, width: Floats, share: float, disc: _Disc
) -> tuple[Ints, Ints, Floats]:
    """The points of one side of all strokes: the stroke of each, its number from 0, and where it is.

    There are two for each arc of a circle, and one more: places are equally far apart in numbers of arcs. Under a line
    that faces this one it ends where that line's inner side is at the latest.
    """
    taken, count = _arcs_taken(runs, width), len(strokes.run)
    first, last = disc.place[:count], disc.place[count:]
    low, high = _taken_at(runs, taken, strokes.run, first), _taken_at(runs, taken, strokes.run, last)
    arcs = np.maximum(np.ceil(high - low), 1 + strokes.whole).astype(np.int64)
    stroke, number = expand(np.zeros_like(arcs), 2 * arcs + 1)
    at_start, at_end = number == 0, number == 2 * arcs[stroke]
    wanted = low[stroke] + (high - low)[stroke] * number / (2 * arcs)[stroke]
    place = _place_where(runs, taken, strokes.run[stroke], wanted)
    place = np.where(at_start, first[stroke], np.where(at_end, last[stroke], place))
    offset = share * at_places(width, runs, strokes.run[stroke], place)
    facing = ~disc.fits & (ends.facing < 0) & (share > 0)
    most = np.where(facing, INSIDE * ends.host_width / np.where(facing, ends.facing, -1.0), np.inf)
    offset = np.where(at_start, np.minimum(offset, most[:count][stroke]), offset)
    offset = np.where(at_end, np.minimum(offset, most[count:][stroke]), offset)
    return stroke, number, _frames(runs, strokes.run[stroke], place).outwards(offset)


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
    return np.asarray(np.cumsum(taken) - taken)


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


def _at_ends(strokes: Strokes, ends: _Ends, discs: list[_Disc], corners: list[Floats]) -> list[_Pieces]:
    """From the outer side to the inner one at ends: along the disc, back under the line above, across, and the same
    of the inner side the other way; reversed at starts."""
    (outer, inner), (outer_corner, inner_corner) = discs, corners
    outwards = (-INSIDE * ends.width)[:, None] * ends.normal
    joint = np.where(ends.tip[:, None], ends.point + outwards, ends.point)
    one = np.where(outer.fits[:, None], joint, outer_corner)
    other = np.where(inner.fits[:, None], joint, inner_corner)
    onwards = np.column_stack([-outwards[:, 1], outwards[:, 0]]) * ends.onward[:, None]  # outwards is on the right
    ends_flat = ~strokes.whole[ends.stroke] & ~ends.tip & (np.hypot(*(one - other).T) > NOTHING)
    pieces = []
    for number, (rows, points) in enumerate((
        (outer.fits, (outer_corner, outer.middle, outer.touched)),
        (outer.fits, (outer.touched, outer.way, joint)),
        (ends.tip & ~outer.fits, (outer_corner, (outer_corner + joint) / 2, joint)),
        (ends.tip, (joint, ends.point + onwards, inner_corner)),
        (ends_flat, (one, (one + other) / 2, other)),
        (inner.fits, (joint, inner.way, inner.touched)),
        (inner.fits, (inner.touched, inner.middle, inner_corner)),
    )):  # fmt: skip
        forwards = ends.onward > 0
        for taken, part, begin, end in ((rows & forwards, END, 0, 2), (rows & ~forwards, START, 2, 0)):
            row = np.flatnonzero(taken)
            along = np.full(len(row), number if part == END else -number)
            three = points[begin][row], points[1][row], points[end][row]
            pieces.append(_Pieces(ends.stroke[row], np.full(len(row), part), along, *three))
    return pieces


def _loops(strokes: Strokes, pieces: _Pieces) -> Paths:
    """One loop for each stroke, or two where it is a ring."""
    number = 2 * pieces.stroke + (strokes.whole[pieces.stroke] & (pieces.part == INNER))
    order = np.lexsort((pieces.along, pieces.part, number))
    _, loop_first = np.unique(number[order], return_index=True)
    arcs = arcs_through(pieces.start[order], pieces.middle[order], pieces.end[order])
    shape_start = offsets(pieces.stroke[order][loop_first], len(strokes.run))
    return Paths(arcs, np.append(loop_first, len(order)), shape_start)


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
    """Return the arcs of circles through three points each, straight where these are nearly in a line."""
    a, b = middle - start, end - start
    area, size = 2 * cross(a, b), dot(b, b)
    flat = np.abs(area) <= 1e-6 * np.maximum(size, dot(a, a))
    aa, divisor = dot(a, a), np.where(flat, 1.0, area)
    center = np.column_stack([b[:, 1] * aa - a[:, 1] * size, a[:, 0] * size - b[:, 0] * aa]) / divisor[:, None]
    u = -center
    v = np.column_stack([-u[:, 1], u[:, 0]])
    to_end = b - center
    angle = np.mod(np.arctan2(dot(v, to_end), dot(u, to_end)), 2 * np.pi)
    sweep = np.where(area > 0, angle, angle - 2 * np.pi)
    line = straight_pieces(start, end)
    pick = flat[:, None]
    return PlaneArcs(
        np.where(pick, line.c, start + center), np.where(pick, line.u, u), np.where(pick, line.v, v),
        np.where(flat, line.start, 0.0), np.where(flat, line.sweep, sweep),
    )  # fmt: skip


def in_colors(paths: Paths, color: Ints) -> tuple[Paths, Ints]:
    """Return shapes of equal rows of ``color`` (k, c) as one shape each, and the distinct rows, ascending."""
    distinct, number = np.unique(color, axis=0, return_inverse=True)
    taken = _shapes_taken(paths, np.argsort(number.ravel(), kind="stable"))
    last = np.cumsum(np.bincount(number.ravel(), minlength=len(distinct)))
    return taken._replace(shape_start=taken.shape_start[np.append(0, last)]), distinct
