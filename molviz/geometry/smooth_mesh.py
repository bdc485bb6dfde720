"""Meshes of the smooth surface, with every self-intersection as an edge of it.

Points and curves have names, so that patches which meet share them:

* a *corner* is where a probe at a triple point touches one of its three balls; between two corners run the contact arcs
  on a ball and the *profiles* of saddles, in the plane of a probe and two balls;
* a *cusp* is where a spindle's saddles reach its axis, on either side. The probes at all triple points of that circle
  pass through it, so that the circles in which these cut each other end there, whatever rounding says else;
* a *cut* is a free arc of the circle in which the probes y and y' meet; it ends at cusps, and where it enters a third
  probe y'', at a triple point of the probes, named as in ``boundary_graph``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.errors import InternalError
from molviz.geometry.boundary_graph import BoundaryGraph, numbered_names, triple_names
from molviz.geometry.cap_regions import free_arcs
from molviz.geometry.circles import perpendicular
from molviz.geometry.general_position import Degenerate
from molviz.geometry.mesh import (
    FINER,
    NO_MESH,
    STRICT,
    Divided,
    Mesh,
    Points,
    around,
    face_triangles,
    finished,
    first_rows,
    inner_fractions,
    pieces_of,
    regions_of,
    whole_spheres,
)
from molviz.geometry.planar_map import UNUSED, directed, planar_map
from molviz.geometry.rims import Rims
from molviz.geometry.rows import expand
from molviz.geometry.smooth import CutTriangles, Kept, Probes, Saddles, cut_triangles, probes_of, saddles_of
from molviz.geometry.spherical_faces import SphericalFaces, loop_counts, spherical_faces
from molviz.geometry.triangulation import Coarse, triangulated
from molviz.vectors import dot

HALF_TURN = np.pi  # arcs from a point to itself are shorter, where rounding makes one, or a whole circle


class _Rolled(NamedTuple):
    """What a mesh is made of; rows of saddles are those of arcs that are kept, rows of probes those of vertices."""

    graph: BoundaryGraph
    probe: float
    saddles: Saddles
    probes: Probes
    cut: CutTriangles


class _Finer(NamedTuple):
    """Into how many times more pieces curves are divided."""

    arcs: Ints  # of the graph
    pieces: Ints  # of saddles
    caps: Ints  # of probes that cut each other


class _CoarseCurves(Exception):  # noqa: N818 - not an error: these curves are divided again
    """The curves, in the order of ``_Finer``, around regions whose polygons meet themselves."""

    def __init__(self, arcs: Ints, pieces: Ints, caps: Ints) -> None:
        super().__init__()
        self.curves = arcs, pieces, caps


class _Pieces(NamedTuple):
    """The p pieces of saddles, one each or two of a spindle; rows of points where a piece ends in a cusp."""

    saddle: Ints  # (p,)
    low: Floats  # (p,) θ
    high: Floats  # (p,) θ
    low_cusp: Ints  # (p,) −1 where it ends at the contact arc of the first ball
    high_cusp: Ints  # (p,) −1 where it ends at that of the second


class _Cuts(NamedTuple):
    """The c arcs in which two probes cut each other, counter-clockwise about the axis from one to the other."""

    one: Ints  # (c,) row of the probe with the smaller number
    other: Ints  # (c,)
    axis: Floats  # (c, 3)
    cosine: Floats  # (c,) of the cap that the other covers
    start: Floats  # (c,)
    sweep: Floats  # (c,)
    cap: Ints  # (c,) row of the cap
    origin: Ints  # (c,) rows of points
    target: Ints  # (c,)

    def take(self, rows: Ints) -> _Cuts:
        """Return the given arcs."""
        real = (self.axis[rows], self.cosine[rows], self.start[rows], self.sweep[rows])
        return _Cuts(self.one[rows], self.other[rows], *real, self.cap[rows], self.origin[rows], self.target[rows])

    def direction(self, row: Ints, angle: Floats) -> Floats:
        """Return unit vectors (k, 3) in the plane of the circle."""
        e, f = perpendicular(self.axis)
        return np.asarray(np.cos(angle)[:, None] * e[row] + np.sin(angle)[:, None] * f[row])


def smooth_mesh(graph: BoundaryGraph, probe: float, kept: Kept, longest: float) -> Mesh:
    """Return the mesh of the smooth surface; arguments as of ``smooth_surface``.

    Edges are no longer than ``longest`` ångström, and shorter where that is much of a radius.
    """
    probes = probes_of(graph, probe, kept.vertices)
    rolled = _Rolled(graph, probe, saddles_of(graph, probe, kept.arcs), probes, cut_triangles(probes, probe))
    finer = _Finer(*(np.ones(size, dtype=np.int64) for size in _sizes(rolled)))
    for strict in STRICT:
        try:
            return _smooth_mesh(rolled, kept, longest, finer, strict)
        except _CoarseCurves as coarse:
            for times, rows in zip(finer, coarse.curves, strict=True):
                times[rows] *= FINER
    raise InternalError(NO_MESH)


def _smooth_mesh(rolled: _Rolled, kept: Kept, longest: float, finer: _Finer, strict: bool) -> Mesh:
    points = Points()
    contacts = _contact_arcs(rolled, points, longest, finer)
    cusps = _cusps(rolled, points)
    pieces = _pieces(rolled, cusps)
    profiles = _profiles(rolled, pieces, contacts, points, longest, finer)
    cuts = _cuts(rolled, cusps, points)
    divided_cuts = _divided_cuts(rolled, cuts, points, longest, finer)
    triangles = [_grid(rolled, pieces, contacts, profiles, points)]
    triangles += _convex(rolled, kept.faces, contacts, points, longest, strict)
    triangles.append(_concave(rolled, pieces, profiles, cuts, divided_cuts, points, longest, strict))
    return finished(points, triangles, longest)


def _sizes(rolled: _Rolled) -> tuple[int, int, int]:
    """How many arcs of the graph, pieces of saddles and caps that probes cut off each other there are."""
    pieces = len(rolled.saddles.arc) + int(np.sum(rolled.saddles.waist > 0))
    return len(rolled.graph.boundary.arcs.circle), pieces, len(rolled.cut.other)


# ---- points and curves


def _contact_arcs(rolled: _Rolled, points: Points, longest: float, finer: _Finer) -> Divided:
    """The arcs on the balls, one for each half-edge, in the direction of the arc; corner k of vertex v is 3v + k."""
    graph, arcs, circles = rolled.graph, rolled.graph.boundary.arcs, rolled.graph.boundary.circles
    count, ball = len(graph.vertex), graph.faces.rims.sphere
    vertex, corner = np.repeat(np.arange(count), 3), graph.vertex_spheres.ravel()
    points.add(_touched(rolled, corner, graph.vertex[vertex]), corner)
    half_edge = np.arange(len(ball))
    arc = half_edge >> 1
    whole = np.flatnonzero(graph.faces.edges.origin >= count)
    ends = [np.empty(len(ball), dtype=np.int64) for _ in range(2)]
    seam = circles.at(arcs.circle[arc[whole]], arcs.start[arc[whole]])
    ends[0][whole] = ends[1][whole] = points.add(_touched(rolled, ball[whole], seam), ball[whole])
    bounded = np.flatnonzero(graph.faces.edges.origin < count)
    for end, rows in enumerate(ends):
        at = graph.faces.edges.origin[2 * arc[bounded] + end]
        rows[bounded] = 3 * at + np.argmax(graph.vertex_spheres[at] == ball[bounded, None], axis=1)
    length = (
        np.linalg.norm(circles.a, axis=1)[arcs.circle] * arcs.sweep * _shrink(rolled, ball).reshape(-1, 2).max(axis=1)
    )
    pieces = np.repeat(finer.arcs * pieces_of(length, arcs.sweep, longest, 2), 2)
    curve, share = inner_fractions(pieces)
    place = circles.at(arcs.circle[curve >> 1], arcs.start[curve >> 1] + share * arcs.sweep[curve >> 1])
    rows = points.add(_touched(rolled, ball[curve], place), ball[curve])
    return Divided(ends[0], ends[1], pieces, first_rows(rows, pieces))


def _shrink(rolled: _Rolled, ball: Ints) -> Floats:
    """r / R of each ball."""
    return np.asarray(1 - rolled.probe / rolled.graph.boundary.spheres.radius[ball])


def _touched(rolled: _Rolled, ball: Ints, center: Floats) -> Floats:
    """Where a probe at the given place touches the given ball."""
    own = rolled.graph.boundary.spheres.center[ball]
    return np.asarray(own + _shrink(rolled, ball)[:, None] * (center - own))


def _pieces(rolled: _Rolled, cusps: Ints) -> _Pieces:
    """The pieces of saddles."""
    graph, saddles = rolled.graph, rolled.saddles
    cusp = cusps[graph.boundary.arcs.circle[saddles.arc]]
    whole, cut = np.flatnonzero(saddles.waist == 0), np.flatnonzero(saddles.waist > 0)
    none = np.full(len(whole), -1), np.full(len(cut), -1)
    return _Pieces(
        saddle=np.concatenate([whole, cut, cut]),
        low=np.concatenate([saddles.low[whole], saddles.low[cut], saddles.waist[cut]]),
        high=np.concatenate([saddles.high[whole], -saddles.waist[cut], saddles.high[cut]]),
        low_cusp=np.concatenate([none[0], none[1], cusp[cut, 1]]),
        high_cusp=np.concatenate([none[0], cusp[cut, 0], none[1]]),
    )


def _cusps(rolled: _Rolled, points: Points) -> Ints:
    """Rows (m, 2) of the cusps of each circle, towards its first and its second ball; −1 where there are none."""
    circles, probe = rolled.graph.boundary.circles, rolled.probe
    square = np.sum(circles.a**2, axis=1)
    rows = np.full((len(square), 2), -1)
    narrow = np.flatnonzero(square < probe**2)
    axis = np.cross(circles.a[narrow], circles.b[narrow]) / square[narrow, None]
    height = np.sqrt(probe**2 - square[narrow])[:, None]
    rows[narrow, 0] = points.add(circles.center[narrow] - height * axis, circles.first[narrow])
    rows[narrow, 1] = points.add(circles.center[narrow] + height * axis, circles.second[narrow])
    return rows


def _profiles(
    rolled: _Rolled, pieces: _Pieces, contacts: Divided, points: Points, longest: float, finer: _Finer
) -> Divided:
    """The two profiles that bound each piece, 2p at the start of the arc and 2p + 1 at its end: one, if it is whole."""
    graph, saddles = rolled.graph, rolled.saddles
    arcs, circles = graph.boundary.arcs, graph.boundary.circles
    arc = saddles.arc[pieces.saddle]
    whole = graph.faces.edges.origin[2 * arc] >= len(graph.vertex)
    turn = pieces.high - pieces.low
    count = np.repeat(finer.pieces * pieces_of(rolled.probe * turn, turn, longest, 1), 2)
    low, high = (np.where(cusp >= 0, cusp, ends) for cusp, ends in _ends(pieces, contacts, arc))
    curve, share = inner_fractions(count)
    own = np.flatnonzero(~(whole[curve >> 1] & (curve % 2 == 1)))
    piece, end = curve[own] >> 1, curve[own] & 1
    circle = arcs.circle[arc[piece]]
    spoke = circles.spoke(circle, arcs.start[arc[piece]] + end * arcs.sweep[arc[piece]])
    theta = pieces.low[piece] + share[own] * turn[piece]
    ball = np.where(theta < 0, circles.first[circle], circles.second[circle])
    place = _on_saddle(rolled, pieces.saddle[piece], spoke / np.linalg.norm(spoke, axis=1)[:, None], theta)
    rows = np.full(len(curve), -1)
    rows[own] = points.add(place, ball)
    inner = np.full(len(count), -1)
    first = np.flatnonzero(np.diff(curve, prepend=-1))
    inner[curve[first]] = rows[first]
    inner[1::2][whole] = inner[::2][whole]
    return Divided(low.T.ravel(), high.T.ravel(), count, inner)


def _ends(pieces: _Pieces, contacts: Divided, arc: Ints) -> list[tuple[Ints, Ints]]:
    """The cusps of pieces and the corners (2, p) at which their profiles begin (first ball) and end (second)."""
    sides = ((pieces.low_cusp, 2 * arc + 1), (pieces.high_cusp, 2 * arc))
    return [(cusp, np.stack([contacts.origin[edge], contacts.target[edge]])) for cusp, edge in sides]


def _on_saddle(rolled: _Rolled, saddle: Ints, along: Floats, theta: Floats) -> Floats:
    """Points (k, 3) of saddles, ``along`` being w."""
    saddles = rolled.saddles
    out = saddles.radius[saddle] - rolled.probe * np.cos(theta)
    up = rolled.probe * np.sin(theta)
    return np.asarray(saddles.middle[saddle] + out[:, None] * along + up[:, None] * saddles.axis[saddle])


# ---- where probes cut each other


def _cuts(rolled: _Rolled, cusps: Ints, points: Points) -> _Cuts:
    """The arcs in which two probes cut each other, from the one with the smaller number."""
    cut = rolled.cut
    free = free_arcs(cut.caps)
    one, other = cut.probe[cut.caps.sphere[free.circle]], cut.other[free.circle]
    once = np.flatnonzero(other > one)
    free, one, other = free.take(once), one[once], other[once]
    axis, cosine = cut.caps.axis[free.circle], cut.caps.cosine[free.circle]
    none = np.full(len(one), -1)
    arcs = _Cuts(one, other, axis, cosine, free.start, free.sweep, free.circle, none, none)
    arcs = _with_ends(rolled, arcs, (free.before, free.after), cusps, points)
    return arcs.take(np.flatnonzero((arcs.origin != arcs.target) | (arcs.sweep > HALF_TURN)))


def _with_ends(rolled: _Rolled, arcs: _Cuts, caps: tuple[Ints, Ints], cusps: Ints, points: Points) -> _Cuts:
    """The arcs with the points at which they begin and end, given the caps that bound them there."""
    ends, names, open_ends = [], [], []
    for side, cap in enumerate(caps):
        row, third = np.full(len(cap), -1), np.append(rolled.cut.other, 0)[cap]
        at_cusp, pair = _shared_pairs(rolled.probes, arcs, third)
        at_cusp &= cap >= 0
        place = _on_cut(rolled, arcs, np.arange(len(cap)), arcs.start + side * arcs.sweep)
        row[at_cusp] = _nearest_cusps(rolled, cusps, pair[at_cusp], place[at_cusp])
        triple = np.flatnonzero(~at_cusp & (cap >= 0))
        names.append(triple_names(arcs.one[triple], arcs.other[triple], third[triple], side))
        open_ends.append((triple, place[triple]))
        ends.append(row)
    whole = np.flatnonzero(caps[0] < 0)
    seam = points.add(_on_cut(rolled, arcs, whole, arcs.start[whole]), rolled.probes.balls[arcs.one[whole], 0])
    ends[0][whole] = ends[1][whole] = seam
    known, number = numbered_names(np.concatenate(names), len(rolled.probes.vertex))
    place = np.empty((len(known), 3))
    place[number] = np.concatenate([there for _, there in open_ends])
    rows = points.add(place, rolled.probes.balls[known[:, 0], 0])
    numbers = np.split(number, [len(names[0])])
    for row, (triple, _), own in zip(ends, open_ends, numbers, strict=True):
        row[triple] = rows[own]
    return arcs._replace(origin=ends[0], target=ends[1])


def _shared_pairs(probes: Probes, arcs: _Cuts, third: Ints) -> tuple[Bools, Ints]:
    """Whether what ends an arc meets it on the axis of a circle, and the two balls (c, 2) of that circle.

    ``third`` is a probe on the same circle as the arc's own two, or −1 − k for the plane of balls k and k + 1.
    """
    own = probes.balls[arcs.one]
    shared = np.any(own[:, :, None] == probes.balls[arcs.other][:, None], axis=2)
    shared &= np.any(own[:, :, None] == probes.balls[np.maximum(third, 0)][:, None], axis=2)
    plane = third < 0
    slot = np.maximum(-1 - third, 0)[:, None]
    shared[plane] = ((np.arange(3) == slot) | (np.arange(3) == (slot + 1) % 3))[plane]
    pair = np.sort(np.where(shared, own, -1), axis=1)[:, 1:]
    return np.asarray(shared.sum(axis=1) == 2), pair


def _nearest_cusps(rolled: _Rolled, cusps: Ints, pair: Ints, place: Floats) -> Ints:
    """The rows of the cusps of pairs of balls, on the side of the given places."""
    circles, count = rolled.graph.boundary.circles, len(rolled.graph.boundary.spheres.radius)
    known = circles.first * count + circles.second
    circle = np.minimum(np.searchsorted(known, pair @ np.array([count, 1])), len(known) - 1)
    axis = np.cross(circles.a[circle], circles.b[circle])
    row: Ints = cusps[circle, (dot(place - circles.center[circle], axis) > 0).astype(np.int64)]
    if np.any(row < 0):
        raise Degenerate
    return row


def _on_cut(rolled: _Rolled, arcs: _Cuts, row: Ints, angle: Floats) -> Floats:
    """Points (k, 3) of arcs at the given angles."""
    sine = np.sqrt((1 - arcs.cosine[row]) * (1 + arcs.cosine[row]))
    unit = arcs.cosine[row, None] * arcs.axis[row] + sine[:, None] * arcs.direction(row, angle)
    return np.asarray(rolled.probes.center[arcs.one[row]] + rolled.probe * unit)


def _divided_cuts(rolled: _Rolled, arcs: _Cuts, points: Points, longest: float, finer: _Finer) -> Divided:
    length = rolled.probe * np.sqrt((1 - arcs.cosine) * (1 + arcs.cosine)) * arcs.sweep
    pieces = finer.caps[arcs.cap] * pieces_of(length, arcs.sweep, longest, 2)
    curve, share = inner_fractions(pieces)
    place = _on_cut(rolled, arcs, curve, arcs.start[curve] + share * arcs.sweep[curve])
    rows = points.add(place, rolled.probes.balls[arcs.one[curve], 0])
    return Divided(arcs.origin, arcs.target, pieces, first_rows(rows, pieces))


# ---- patches


def _grid(rolled: _Rolled, pieces: _Pieces, contacts: Divided, profiles: Divided, points: Points) -> Ints:
    """Triangles (t, 3) of the saddles: row i of a piece's points at one θ, column j at one angle of the arc."""
    arc = rolled.saddles.arc[pieces.saddle]
    tall, wide = profiles.pieces[::2], contacts.pieces[2 * arc]
    piece, node = expand(np.zeros_like(tall), (tall + 1) * (wide + 1))
    row, column = node // (wide[piece] + 1), node % (wide[piece] + 1)
    at_first = np.where(pieces.low_cusp[piece] >= 0, pieces.low_cusp[piece], contacts.point(2 * arc[piece] + 1, column))
    at_second = np.where(pieces.high_cusp[piece] >= 0, pieces.high_cusp[piece], contacts.point(2 * arc[piece], column))
    point = np.where(row == 0, at_first, at_second)
    between = (row > 0) & (row < tall[piece])
    for end, here in enumerate((column == 0, column == wide[piece])):
        side = np.flatnonzero(between & here)
        point[side] = profiles.point(2 * piece[side] + end, row[side])
    inner = np.flatnonzero(between & (column > 0) & (column < wide[piece]))
    up, along = row[inner] / tall[piece[inner]], column[inner] / wide[piece[inner]]
    point[inner] = _inside_saddles(rolled, pieces, points, piece[inner], up, along)
    return _cells(point, tall, wide)


def _cells(point: Ints, tall: Ints, wide: Ints) -> Ints:
    """Two triangles for each cell of grids whose points are listed row by row; none where a row is but a cusp."""
    begin = np.cumsum((tall + 1) * (wide + 1)) - (tall + 1) * (wide + 1)
    cell_piece, cell = expand(np.zeros_like(tall), tall * wide)
    corner = begin[cell_piece] + (cell // wide[cell_piece]) * (wide[cell_piece] + 1) + cell % wide[cell_piece]
    above = corner + wide[cell_piece] + 1
    a, b, c, d = (point[at] for at in (corner, corner + 1, above + 1, above))
    triangle = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    flat = np.any(triangle == np.roll(triangle, 1, axis=1), axis=1)
    return np.asarray(triangle[~flat])


def _inside_saddles(rolled: _Rolled, pieces: _Pieces, points: Points, piece: Ints, up: Floats, along: Floats) -> Ints:
    """New points inside pieces, as far up and along as these fractions say."""
    arcs, circles = rolled.graph.boundary.arcs, rolled.graph.boundary.circles
    saddle = pieces.saddle[piece]
    arc = rolled.saddles.arc[saddle]
    circle = arcs.circle[arc]
    theta = pieces.low[piece] + up * (pieces.high - pieces.low)[piece]
    spoke = circles.spoke(circle, arcs.start[arc] + along * arcs.sweep[arc])
    place = _on_saddle(rolled, saddle, spoke / np.linalg.norm(spoke, axis=1)[:, None], theta)
    return points.add(place, np.where(theta < 0, circles.first[circle], circles.second[circle]))


def _convex(rolled: _Rolled, face: Ints, contacts: Divided, points: Points, longest: float, strict: bool) -> list[Ints]:
    """Triangles of the given faces' parts of their balls."""
    faces, spheres = rolled.graph.faces, rolled.graph.boundary.spheres
    half_edge = np.arange(len(contacts.pieces))
    rows, start = around(faces.loops, contacts, half_edge, half_edge % 2 == 1)
    bounded = loop_counts(faces)[face] > 0
    kept, whole = face[bounded], faces.sphere[face[~bounded]]
    regions = regions_of(faces, kept, rows, start, spheres.center, spheres.radius - rolled.probe)
    try:
        triangles = [face_triangles(points, regions, faces, kept, longest, strict)]
    except Coarse as coarse:
        none = np.empty(0, dtype=np.int64)
        raise _CoarseCurves(half_edge[np.isin(faces.edges.face, coarse.region)] >> 1, none, none) from None
    radius = spheres.radius[whole] - rolled.probe
    return triangles + whole_spheres(points, whole, spheres.center[whole], radius, longest)


def _concave(
    rolled: _Rolled,
    pieces: _Pieces,
    profiles: Divided,
    cuts: _Cuts,
    divided: Divided,
    points: Points,
    longest: float,
    strict: bool,
) -> Ints:
    """Triangles of what is left of the probes' triangles, turned to the side of the probe."""
    both = Divided(*(np.concatenate(column) for column in zip(profiles, divided, strict=True)))
    faces, curve = _concave_faces(rolled, pieces, profiles, cuts)
    half_edge = np.arange(len(curve))
    rows, start = around(faces.loops, both, curve, half_edge % 2 == 1)
    probes = rolled.probes
    radius = np.full(len(probes.vertex), rolled.probe)
    regions = regions_of(faces, np.arange(len(faces.sphere)), rows, start, probes.center, radius)
    try:
        found = triangulated(regions, points.place(), longest, strict)
    except Coarse as coarse:
        around_it = np.unique(curve[np.isin(faces.edges.face, coarse.region)])
        own, none = around_it < 2 * len(pieces.saddle), np.empty(0, dtype=np.int64)
        raise _CoarseCurves(none, around_it[own] >> 1, cuts.cap[around_it[~own] - 2 * len(pieces.saddle)]) from None
    points.add(found.inner, _owners(rolled, faces.sphere[found.inner_region], found.inner))
    return found.point[:, ::-1]


def _owners(rolled: _Rolled, probe: Ints, place: Floats) -> Ints:
    """The ball of each point of a triangle: of its three that in whose power cell it lies."""
    balls, spheres = rolled.probes.balls[probe], rolled.graph.boundary.spheres
    power = np.sum((place[:, None] - spheres.center[balls]) ** 2, axis=2) - spheres.radius[balls] ** 2
    return np.asarray(balls[np.arange(len(balls)), np.argmin(power, axis=1)])


def _concave_faces(rolled: _Rolled, pieces: _Pieces, profiles: Divided, cuts: _Cuts) -> tuple[SphericalFaces, Ints]:
    """What is left of the triangles, as faces of the probes, and the curve (2k,) that each half-edge is."""
    own, row, slot, forward = _profile_sides(rolled, pieces)
    origin = np.concatenate([profiles.origin[own], cuts.origin])
    target = np.concatenate([profiles.target[own], cuts.target])
    left = np.concatenate([np.where(forward, row, UNUSED), cuts.other])
    right = np.concatenate([np.where(forward, UNUSED, row), cuts.one])
    theta = ((pieces.low + pieces.high) / 2)[own >> 1]
    middle = _on_saddle(rolled, pieces.saddle[own >> 1], _end_spokes(rolled, pieces, own), theta)
    middle = (middle - rolled.probes.center[row]) / rolled.probe
    angle = cuts.start + cuts.sweep / 2
    one, count = np.ones(len(own)), len(cuts.one)
    sine = np.sqrt((1 - cuts.cosine) * (1 + cuts.cosine))
    axis = np.concatenate([np.repeat(rolled.probes.away[row, slot], 2, axis=0), np.repeat(cuts.axis, 2, axis=0)])
    axis[2 * len(own) :: 2] *= -1
    spoke = np.concatenate([middle, cuts.direction(np.arange(count), angle)])
    half = np.concatenate([((pieces.high - pieces.low) / 2)[own >> 1], cuts.sweep / 2])
    cosine, sines = np.concatenate([0 * one, cuts.cosine]), np.concatenate([one, sine])
    rims = Rims(directed(left, right), axis, *(np.repeat(column, 2, axis=0) for column in (cosine, sines, spoke, half)))
    faces = spherical_faces(rims, planar_map(origin, target, left, right), np.empty(0, dtype=np.int64))
    curve = np.concatenate([own, 2 * len(pieces.saddle) + np.arange(count)])
    return faces, np.repeat(curve, 2)


def _profile_sides(rolled: _Rolled, pieces: _Pieces) -> tuple[Ints, Ints, Ints, Bools]:
    """The profiles that bound triangles, and of each the probe, its side, and whether the triangle is on the left."""
    graph, probes = rolled.graph, rolled.probes
    number = np.full(len(graph.vertex) + 1, -1)
    number[probes.vertex] = np.arange(len(probes.vertex))
    profile = np.arange(2 * len(pieces.saddle))
    arc = rolled.saddles.arc[pieces.saddle[profile >> 1]]
    vertex = graph.faces.edges.origin[2 * arc + (profile & 1)]
    own = np.flatnonzero(vertex < len(graph.vertex))
    row, circle = number[vertex[own]], graph.boundary.arcs.circle[arc[own]]
    first, second = graph.boundary.circles.first[circle], graph.boundary.circles.second[circle]
    balls = probes.balls[row]
    third = np.argmax((balls != first[:, None]) & (balls != second[:, None]), axis=1)
    slot = (third + 1) % 3
    return own, row, slot, balls[np.arange(len(own)), slot] == first


def _end_spokes(rolled: _Rolled, pieces: _Pieces, profile: Ints) -> Floats:
    """w at the ends of the arcs where the given profiles are."""
    arcs, circles = rolled.graph.boundary.arcs, rolled.graph.boundary.circles
    arc = rolled.saddles.arc[pieces.saddle[profile >> 1]]
    spoke = circles.spoke(arcs.circle[arc], arcs.start[arc] + (profile & 1) * arcs.sweep[arc])
    return np.asarray(spoke / np.linalg.norm(spoke, axis=1)[:, None])
