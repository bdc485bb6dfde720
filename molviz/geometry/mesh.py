"""Meshes of the boundary of a union of balls and of the smooth surface, with all vertices exactly on them.

First the curves are divided: arcs of creases or of contact circles, profiles of saddles, and the circles in which the
concave triangles of two probes cut each other. Points are known by what they are, so that what shares a curve shares
its points and the mesh is closed. Then regions of spheres are triangulated between their curves, saddles on a grid of
their own.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, distinct
from molviz.errors import InternalError
from molviz.geometry.boundary_graph import BoundaryGraph
from molviz.geometry.components import component_labels
from molviz.geometry.planar_map import Loops
from molviz.geometry.rows import expand, lists_taken
from molviz.geometry.spherical_faces import SphericalFaces, loop_counts
from molviz.geometry.triangulation import Coarse, Regions, Triangles, triangulated
from molviz.vectors import dot

WIDEST = np.pi / 6  # of a piece of a curve: coarser polygons would cut across each other
FINER = 2  # times as many pieces where a polygon meets itself all the same
BEYOND = 1e-10  # of a radius: inner points that are deeper in a cap are not on the surface
STRICT = (True,) * 4 + (False,) * 6  # whether polygons may not meet themselves: those next to no width always do
WELD = 1e-4  # of the longest edge: points as near as that are one in the single precision of files
NO_MESH = "some regions of the surface have no triangles that fit together"


class Mesh(NamedTuple):
    """A closed surface of t triangles, counter-clockwise seen from outside."""

    vertex: Floats  # (v, 3) ångström
    triangle: Ints  # (t, 3)
    ball: Ints  # (v,) the ball whose part of the surface each vertex is on

    def area(self) -> float:
        """Return the area of the triangles in Å²."""
        a, b, c = (self.vertex[self.triangle[:, k]] for k in range(3))
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)

    def volume(self) -> float:
        """Return the volume that they enclose in Å³."""
        a, b, c = (self.vertex[self.triangle[:, k]] for k in range(3))
        return float(dot(np.cross(a, b), c).sum() / 6)


class Points:
    """A growing table of points and their balls."""

    def __init__(self) -> None:
        self._place, self._ball, self._count = [np.empty((0, 3))], [np.empty(0, dtype=np.int64)], 0

    def add(self, place: Floats, ball: Ints) -> Ints:
        """Append points (k, 3) and return their rows."""
        self._place.append(place)
        self._ball.append(ball)
        self._count += len(ball)
        return np.arange(self._count - len(ball), self._count)

    def place(self) -> Floats:
        """Return all points (v, 3)."""
        return np.concatenate(self._place)

    def ball(self) -> Ints:
        """Return the balls (v,) of all points."""
        return np.concatenate(self._ball)


class Divided(NamedTuple):
    """c curves divided into pieces; point k of a curve is at k / pieces of it."""

    origin: Ints  # (c,) rows of points
    target: Ints  # (c,)
    pieces: Ints  # (c,)
    inner: Ints  # (c,) row of point 1; those after it follow

    def point(self, curve: Ints, number: Ints) -> Ints:
        """Return the row of a point of each given curve."""
        between = np.where(number == self.pieces[curve], self.target[curve], self.inner[curve] + number - 1)
        return np.where(number == 0, self.origin[curve], between)


def pieces_of(length: Floats, angle: Floats, longest: float, least: int) -> Ints:
    """Return into how many pieces curves of these lengths (c,), which turn by these angles (c,), are divided."""
    wanted = np.maximum(np.ceil(length / longest), np.ceil(angle / WIDEST))
    return np.maximum(wanted, least).astype(np.int64)


def inner_fractions(pieces: Ints) -> tuple[Ints, Floats]:
    """Return for all inner points of curves, in order, the curve and how far along it they are, from 0 to 1."""
    curve, number = expand(np.ones_like(pieces), pieces)
    return curve, number / pieces[curve]


def around(loops: Loops, divided: Divided, curve: Ints, backward: Bools) -> tuple[Ints, Ints]:
    """Return the points of each loop, and where each begins; half-edge h is ``curve[h]``, backwards or not."""
    edge = loops.half_edge
    count = divided.pieces[curve[edge]]
    owner, number = expand(np.zeros_like(count), count)
    back = backward[edge][owner]
    number = np.where(back, count[owner] - number, number)
    total = np.concatenate([[0], np.cumsum(count)])
    return divided.point(curve[edge][owner], number), total[loops.start]


def poles(faces: SphericalFaces) -> Floats:
    """Return a direction (f, 3) outside of each face with loops: the middle of the largest cap that bounds it."""
    rims, edge = faces.rims, faces.loops.half_edge
    face = np.repeat(faces.loops.face, np.diff(faces.loops.start))
    order = np.lexsort((rims.cosine[edge], face))
    first = order[np.diff(face[order], prepend=-1) > 0]
    pole = np.zeros((len(faces.sphere), 3))
    pole[face[first]] = rims.axis[edge[first]]
    return pole


def regions_of(faces: SphericalFaces, kept: Ints, points: Ints, start: Ints, center: Floats, radius: Floats) -> Regions:
    """Return the kept faces, which have loops, as regions; ``points`` and ``start`` are those of all their loops."""
    number = np.full(len(faces.sphere), -1)
    number[kept] = np.arange(len(kept))
    loop = np.flatnonzero(number[faces.loops.face] >= 0)
    row, begin = lists_taken(start, loop)
    sphere, face = faces.sphere[kept], number[faces.loops.face[loop]]
    return Regions(points[row], begin, face, center[sphere], radius[sphere], poles(faces)[kept])


def boundary_mesh(graph: BoundaryGraph, face: Bools, longest: float) -> Mesh:
    """Return the mesh of the chosen faces (f,) of a union boundary, whole shells of them.

    Edges are no longer than ``longest`` ångström, and shorter where that is much of a ball's radius.
    """
    finer = np.ones(len(graph.boundary.arcs.circle), dtype=np.int64)
    for strict in STRICT:
        try:
            return _boundary_mesh(graph, face, longest, finer, strict)
        except Coarse as coarse:
            bad = np.isin(graph.faces.edges.face, coarse.region)
            finer[np.flatnonzero(bad) >> 1] *= FINER
    raise InternalError(NO_MESH)


def _boundary_mesh(graph: BoundaryGraph, face: Bools, longest: float, finer: Ints, strict: bool) -> Mesh:
    """The same with arcs (k,) that are divided into so many times more pieces; Coarse names faces."""
    points = Points()
    spheres = graph.boundary.spheres
    divided = _divided_arcs(graph, points, longest, finer)
    half_edge = np.arange(2 * len(divided.pieces))
    rows, start = around(graph.faces.loops, divided, half_edge >> 1, half_edge % 2 == 1)
    bounded = loop_counts(graph.faces) > 0
    kept = np.flatnonzero(face & bounded)
    regions = regions_of(graph.faces, kept, rows, start, spheres.center, spheres.radius)
    whole = graph.faces.sphere[face & ~bounded]
    triangles = [face_triangles(points, regions, graph.faces, kept, longest, strict)]
    triangles += whole_spheres(points, whole, spheres.center[whole], spheres.radius[whole], longest)
    return finished(points, triangles, longest)


def _divided_arcs(graph: BoundaryGraph, points: Points, longest: float, finer: Ints) -> Divided:
    """The arcs of the creases; points on them are said to be of the first ball."""
    arcs, circles, edges = graph.boundary.arcs, graph.boundary.circles, graph.faces.edges
    points.add(graph.vertex, graph.vertex_spheres[:, 0])
    whole = np.flatnonzero(edges.origin[::2] >= len(graph.vertex))
    points.add(circles.at(arcs.circle[whole], arcs.start[whole]), circles.first[arcs.circle[whole]])
    length = np.linalg.norm(circles.a, axis=1)[arcs.circle] * arcs.sweep
    pieces = finer * pieces_of(length, arcs.sweep, longest, 2)
    arc, share = inner_fractions(pieces)
    place = circles.at(arcs.circle[arc], arcs.start[arc] + share * arcs.sweep[arc])
    rows = points.add(place, circles.first[arcs.circle[arc]])
    return Divided(edges.origin[::2], edges.origin[1::2], pieces, first_rows(rows, pieces))


def first_rows(rows: Ints, pieces: Ints) -> Ints:
    """Return the row of each curve's first inner point, given the rows of all."""
    begin = int(rows[0]) if len(rows) else 0
    return begin + np.cumsum(pieces - 1) - (pieces - 1)


def face_triangles(
    points: Points, regions: Regions, faces: SphericalFaces, kept: Ints, longest: float, strict: bool
) -> Ints:
    """Return triangles (t, 3) of the kept faces, which the regions are; raises Coarse naming faces."""
    try:
        found = triangulated(regions, points.place(), longest, strict)
    except Coarse as coarse:
        raise Coarse(kept[coarse.region]) from None
    beyond = _beyond_rims(regions, faces, kept, found) if strict else kept[:0]
    if len(beyond):
        raise Coarse(distinct(beyond))
    points.add(found.inner, faces.sphere[kept[found.inner_region]])
    return found.point


def _beyond_rims(regions: Regions, faces: SphericalFaces, kept: Ints, found: Triangles) -> Ints:
    """The faces (k,) of inner points that lie between a chord and its arc, in the cap that the arc's rim cuts off."""
    region = found.inner_region
    away = (found.inner - regions.center[region]) / regions.radius[region, None]
    loop = np.searchsorted(faces.loops.face, np.arange(len(faces.sphere) + 1))
    begin = faces.loops.start[loop][kept[region]]
    point, place = expand(begin, faces.loops.start[loop][kept[region] + 1])
    edge = faces.loops.half_edge[place]
    deep = dot(faces.rims.axis.take(edge, axis=0), away.take(point, axis=0)) - faces.rims.cosine[edge]
    return kept[region[point[deep > BEYOND]]]


def whole_spheres(points: Points, ball: Ints, center: Floats, radius: Floats, longest: float) -> list[Ints]:
    """Return triangles of whole spheres: of both halves that an equator makes of each."""
    if len(ball) == 0:
        return []
    pieces = pieces_of(2 * np.pi * radius, np.full(len(ball), 2 * np.pi), longest, 3)
    owner, number = expand(np.zeros_like(pieces), pieces)
    turn = 2 * np.pi * number / pieces[owner]
    across = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(len(turn))])
    rows = points.add(center[owner] + radius[owner, None] * across, ball[owner])
    start = np.concatenate([[0], np.cumsum(pieces)])
    back = rows[start[owner] + (pieces[owner] - number) % pieces[owner]]
    up, region = np.array([0.0, 0.0, 1.0]), np.arange(len(ball))
    halves = [
        Regions(loop, start, region, center, radius, np.tile(pole, (len(ball), 1)))
        for loop, pole in ((rows, -up), (back, up))
    ]
    triangles = []
    for half in halves:
        found = triangulated(half, points.place(), longest)
        points.add(found.inner, ball[found.inner_region])
        triangles.append(found.point)
    return triangles


def finished(points: Points, triangles: list[Ints], longest: float) -> Mesh:
    """Return the mesh without points that nothing uses, and with points that are next to each other made one."""
    triangle = np.concatenate(triangles)
    used, number = np.unique(triangle, return_inverse=True)
    mesh = Mesh(points.place()[used], number.reshape(-1, 3), points.ball()[used])
    welded = _welded(mesh, WELD * longest)
    return welded if _is_closed(welded.triangle) else mesh


def _welded(mesh: Mesh, least: float) -> Mesh:
    """Contract edges shorter than ``least``; triangles that become lines, and pairs that become one, are left out."""
    one, other = mesh.triangle.ravel(), np.roll(mesh.triangle, -1, axis=1).ravel()
    short = np.linalg.norm(mesh.vertex[one] - mesh.vertex[other], axis=1) < least
    if not short.any():
        return mesh
    label = component_labels(one[short], other[short], len(mesh.vertex))
    first = np.unique(label, return_index=True)[1]
    triangle = label[mesh.triangle]
    triangle = triangle[np.all(triangle != np.roll(triangle, 1, axis=1), axis=1)]
    _, number, times = np.unique(np.sort(triangle, axis=1), axis=0, return_inverse=True, return_counts=True)
    triangle = triangle[times[number.ravel()] == 1]
    used, row = np.unique(triangle, return_inverse=True)
    return Mesh(mesh.vertex[first[used]], row.reshape(-1, 3), mesh.ball[first[used]])


def _is_closed(triangle: Ints) -> bool:
    """Whether each edge has one triangle on either side."""
    one, other = triangle.ravel(), np.roll(triangle, -1, axis=1).ravel()
    count = int(triangle.max(initial=0)) + 1
    here, back = np.sort(one * count + other), np.sort(other * count + one)
    return bool(np.all(np.diff(here) > 0)) and np.array_equal(here, back)
