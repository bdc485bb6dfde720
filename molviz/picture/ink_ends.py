"""Where strokes of ink end: what lies above their ends, and how their sides go on to the lines that they meet.

Where two lines end together they make a corner and are mitred: their outer sides meet, and so do their inner ones. A
line that passes under a nearer one ends on the horizon of that one. Where the two leave a narrow wedge, ink fills it as
far as a small disc does not get: sides end where that disc touches them and go on along it.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.picture.ink import Widths, at_places
from molviz.picture.ink_strokes import Frames, Strokes, frames_at
from molviz.vectors import dot
from molviz.visibility.horizon_runs import HorizonRuns

OUTSIDE = 0.6  # of the width lies outside the horizon
INSIDE = OUTSIDE - 1.0
NARROW = 75.0  # degrees: wider wedges are left as they are
NEARLY_NARROW = 0.4  # cosine between the sides where lines meet, from which on no wedge gets narrow farther on
COVERS = 0.8  # of a line's width: a line so wide hides its end
OVERLAPPING = 0.97 * OUTSIDE  # of a line's width: as far outside its horizon ink beside it begins
LONGEST_MITRE = 1.5  # of the width of the wider line: sides that would meet farther away make a spike so long
OVERLAP = 0.1  # of a line's width by which lines that make a corner lie on each other: no seam shows between them
ALONG = 0.75  # cosine between the normals of two lines that run along each other rather than meet
SMOOTH = 0.99  # cosine between the normals of two lines that go on in each other: no side crosses that of the other
HIDDEN = 0.9  # of the inner part of a line under which others end
TOUCHES = 3  # rounds in which the places are found where a disc touches two lines of varying width
NOTHING = 1e-9  # ångström: shorter vectors have no direction


class Ends(NamedTuple):
    """The ends of k strokes, first all starts, then all ends, with what lies above them; rows (2k,)."""

    stroke: Ints
    run: Ints
    onward: Floats  # −1 at starts, 1 at ends: the way, in samples, in which lines would go on
    place: Floats  # where it is
    most: Floats  # samples by which a side may end before it: half the stroke
    frame: Frames  # there
    width: Floats
    host: Ints  # the run under which it ends, −1 if under none
    host_place: Floats
    host_width: Floats
    facing: Floats  # cosine between the two horizons' normals; 1 under none
    barred: Floats  # how far outside the host's horizon its ink, another one, goes on across the end; 0 where none does
    tip: Bools  # the line ends in the open, not in a point
    mate: Ints  # the run with which it makes a corner, or else the host
    mate_place: Floats
    mate_width: Floats  # 0 where there is no corner

    def bars(self) -> Floats:
        """Return how far outside of their hosts' horizons ends (2k,) stop, at ink drawn below them; 0 without."""
        return np.where(self.tip & (self.mate_width == 0), self.barred, 0.0)

    def onwards(self) -> Floats:
        """Return the unit vectors (2k, 2) in which lines would go on."""
        normal = self.frame.normal
        return np.column_stack([-normal[:, 1], normal[:, 0]]) * self.onward[:, None]


class Disc(NamedTuple):
    """How one side of each end goes on: along a disc that touches it and the line above; rows (2k,)."""

    place: Floats  # where the side stops
    fits: Bools  # there is a disc; points of other rows mean nothing
    middle: Floats  # (2k, 2) of its arc
    touched: Floats  # (2k, 2) on the line above
    way: Floats  # (2k, 2) under the line above, halfway back to the end


class Mitre(NamedTuple):
    """Where one side of each end meets that of its mate, or the horizon of its host; rows (2k,)."""

    place: Floats  # where the side stops
    cut: Bools  # it stops there, before the end
    beyond: Bools  # it goes on beyond the end of a tip
    middle: Floats  # (2k, 2) halfway on from the end
    point: Floats  # (2k, 2) to here


def ends_of(runs: HorizonRuns, strokes: Strokes, width: Floats, all_ink: Widths) -> Ends:
    """Return the ends of strokes whose ink is as wide as ``width`` (s,); ``all_ink`` is that of all inks together."""
    count = len(strokes.run)
    stroke, end = np.tile(np.arange(count), 2), np.repeat([0, 1], count)
    run, place, at = strokes.run[stroke], np.append(strokes.first, strokes.last), strokes.ends.ravel()
    row = np.where(at >= 0, runs.vertices.partner[at], -1)
    under = np.flatnonzero(row >= 0)
    host, host_place, facing = np.full(2 * count, -1), np.zeros(2 * count), np.ones(2 * count)
    host[under], host_place[under] = runs.vertices.run[row[under]], runs.vertices.place[row[under]]
    frame = frames_at(runs, run, place)
    facing[under] = dot(frame.normal[under], frames_at(runs, host[under], host_place[under]).normal)
    above, covers, barred = np.zeros((3, 2 * count))
    above[under] = at_places(all_ink.width, runs, host[under], host_place[under])
    covers[under] = at_places(width, runs, host[under], host_place[under])
    own = at_places(width, runs, run, place)
    other_ink = all_ink._replace(width=np.where(width > 0, 0.0, all_ink.width))
    barred[under] = OVERLAPPING * _least_past(runs, other_ink, host[under], host_place[under], own[under])
    barred[np.abs(facing) > ALONG] = 0.0
    vertex = runs.vertices.vertex
    corner = (at >= 0) & np.isin(vertex[at], vertex[at[(at >= 0) & (at != runs.ends[end, run])]])
    tip = (at >= 0) & (own > 0) & (corner | (covers < COVERS * own))
    mates = _Mates(host.copy(), host_place.copy(), np.where(tip & corner, above, 0.0))
    _pair(mates, np.flatnonzero(tip & (above == 0)), runs.vertices.node[at], _Mates(run, place, own))
    return Ends(
        stroke, run, 2.0 * end - 1.0, place, (strokes.last - strokes.first)[stroke] / 2, frame, own,
        host, host_place, above, facing, barred, tip, *mates,
    )  # fmt: skip


def _least_past(runs: HorizonRuns, ink: Widths, run: Ints, place: Floats, reach: Floats) -> Floats:
    """The least width (q,) at places of runs and so many ångström (q,) before and behind them, 0 where ink ended."""
    least, samples = at_places(ink.width, runs, run, place), reach / frames_at(runs, run, place).step
    first, last = runs.vertices.place[ink.ends[:, run]]
    for past in (place - samples, place + samples):
        drawn = runs.closed[run] | ((past >= first) & (past <= last))
        least = np.where(drawn, np.minimum(least, at_places(ink.width, runs, run, past)), 0.0)
    return least


class _Mates(NamedTuple):
    """What ends make corners with."""

    run: Ints
    place: Floats
    width: Floats


def _pair(mates: _Mates, alone: Ints, node: Ints, own: _Mates) -> None:
    """Make each other's mates of two tips that meet no line and end in one node, a shred of a horizon between them."""
    alone = alone[np.argsort(node[alone], kind="stable")]
    _, first, count = np.unique(node[alone], return_index=True, return_counts=True)
    two = first[count == 2]
    pair = np.stack([alone[two], alone[two + 1]])
    mates.run[pair], mates.place[pair], mates.width[pair] = (column[pair[::-1]] for column in own)


def mitres(runs: HorizonRuns, ends: Ends, share: float) -> Mitre:
    """Return where sides, on ``share`` of the width, stop.

    Mates' sides lie on circles about the centres of curvature. Inner ones that would meet far away make a spike.
    """
    count = len(ends.place)
    found = Mitre(ends.place.copy(), *np.zeros((2, count), dtype=bool), *np.zeros((2, count, 2)))
    rows = np.flatnonzero((ends.mate >= 0) & (ends.width > 0))
    own, above = ends.frame.take(rows), frames_at(runs, ends.mate[rows], ends.mate_place[rows])
    width, mate_width = ends.width[rows], ends.mate_width[rows]
    reach = own.radius + share * width
    point, exists = _crossing(own, above, reach, above.radius + _level(ends, share)[rows])
    away = np.where(exists[:, None], point - own.point, -own.normal - above.normal)
    longest = LONGEST_MITRE * np.maximum(width, mate_width)
    smooth = dot(own.normal, above.normal) > SMOOTH
    near = exists & ~smooth & (np.hypot(*away.T) <= longest)
    spike = ~near & ~smooth & (mate_width > 0) & (share < 0)
    end, smooth = own.outwards(share * width), smooth & (mate_width > 0)
    point = np.where(spike[:, None], own.point + longest[:, None] * _unit(away), point)
    point = np.where(smooth[:, None], end + OVERLAP * width[:, None] * ends.onwards()[rows], point)
    before = -ends.onward[rows] * own.samples_to(point)
    near &= before < ends.most[rows]
    found.cut[rows] = near & (before > 0)
    found.beyond[rows] = ends.tip[rows] & (spike | smooth | near & (before <= 0))
    before -= (OVERLAP * width / own.step if share > 0 else 0.0) * (mate_width > 0)
    found.place[rows] = ends.place[rows] - np.where(found.cut[rows], ends.onward[rows] * np.maximum(before, 0.0), 0.0)
    half = (end + point) / 2
    round_half = own.center() + reach[:, None] * _unit(half - own.center())
    found.middle[rows], found.point[rows] = np.where((spike | smooth)[:, None], half, round_half), point
    return found


def _level(ends: Ends, share: float) -> Floats:
    """How far outside the horizon of the mate sides stop: where its own side is, or else on the horizon.

    Ends that it hides go on under its ink where their sides would cross the horizon far away; tips that it does not
    hide, of another ink or wider than it, stop at its ink where that goes on past them.
    """
    hidden = ~ends.tip & ((ends.facing < 0) | (share < 0))
    return np.asarray(share * ends.mate_width + ends.bars() + np.where(hidden, HIDDEN * INSIDE * ends.host_width, 0.0))


def discs(runs: HorizonRuns, ends: Ends, width: Floats, all_ink: Floats, share: float, neck: float) -> Disc:
    """Return the discs as wide as the neck that touch lines, on ``share`` of their width, and the lines above.

    Discs that touch a line at distance a from a horizon that curves like a circle of radius r have their centres on the
    circle of radius r + a ± neck / 2 about the same point. Widths are those at the places that are touched.
    """
    narrow = np.sign(share) * ends.facing < NEARLY_NARROW
    rows = np.flatnonzero((ends.host >= 0) & (ends.width > 0) & (ends.host_width > 0) & narrow)
    run, host = ends.run[rows], ends.host[rows]
    own, above = ends.frame.take(rows), frames_at(runs, host, ends.host_place[rows])
    place, host_place = ends.place[rows], ends.host_place[rows]
    for _ in range(TOUCHES):
        reach = own.radius + share * at_places(all_ink, runs, run, place) + np.sign(share) * neck / 2
        host_reach = above.radius + OVERLAPPING * at_places(all_ink, runs, host, host_place) + neck / 2
        center, exists = _crossing(own, above, reach, host_reach)
        place = ends.place[rows] + own.samples_to(center)
        host_place = ends.host_place[rows] + above.samples_to(center)
    one, other = at_places(all_ink, runs, run, place), at_places(all_ink, runs, host, host_place)
    touches = frames_at(runs, run, place).outwards(share * one)
    touched = frames_at(runs, host, host_place).outwards(OVERLAPPING * other)
    ways = _unit(touches - center), _unit(touched - center)
    cut = ends.onward[rows] * (ends.place[rows] - place)
    on_host = runs.closed[host] | ((host_place >= 0) & (host_place <= (np.diff(runs.start) - 1)[host]))
    fits = exists & on_host & (cut > 0) & (cut < ends.most[rows])
    fits &= (share > 0) | ~ends.tip[rows]
    fits &= (dot(*ways) < -np.cos(np.radians(NARROW))) & (other > 0)
    fits &= at_places(width, runs, run, place) > 0.99 * one  # where this ink is all there is
    back = frames_at(runs, host, (host_place + ends.host_place[rows]) / 2).outwards(OUTSIDE / 3 * other)
    found = Disc(ends.place.copy(), np.zeros(len(ends.place), dtype=bool), *np.zeros((3, len(ends.place), 2)))
    columns = place, fits, center + neck / 2 * _unit(ways[0] + ways[1]), touched, back
    for column, values in zip(found, columns, strict=True):
        column[rows[fits]] = values[fits]
    return found


def _crossing(own: Frames, above: Frames, reach: Floats, host_reach: Floats) -> tuple[Floats, Bools]:
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
