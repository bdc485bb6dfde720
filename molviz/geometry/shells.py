"""Shells: the connected parts of a union boundary, which of them bound cavities, and what lies inside what.

A shell is a set of faces that are connected over arcs. It is the outer shell of a component (a set of balls connected
by overlapping) or the wall of a cavity in it; each component has exactly one outer shell, that with the largest signed
volume. With V triple points, E arcs that are no whole circles and faces of as many loops each,

    χ = V − E + Σ (2 − loops),    genus = 1 − χ / 2,    volume = ⅓ Σ (r_i A + (c_i − o) · N),

where a whole circle would be a vertex and an edge; A is a face's area and N its ``∫ n dA``. Volumes of cavities come
out negative.

Nesting: straight up from the topmost point of a component, the first face of the union tells by its shell in which
cavity the component lies, or beside which other component (which reaches higher, so that this ends).
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.boundary_graph import BoundaryGraph
from molviz.geometry.climb import FacesAbove
from molviz.geometry.components import component_labels
from molviz.geometry.rims import sums
from molviz.geometry.spherical_faces import loop_counts
from molviz.vectors import dot


class Shells(NamedTuple):
    """s shells of f faces: first the outer ones by falling volume, then the walls of cavities by falling volume.

    Given a point of the boundary, ``face_at`` tells its face, ``of_face`` the shell, and the columns the rest.
    """

    of_face: Ints  # (f,) the shell of each face of the graph
    outer: Bools  # (s,) the outer shell of a component (positive), or the wall of a cavity (negative)
    component: Ints  # (s,) number of the set of overlapping balls; that of outer shell k is k
    parent: Ints  # (s,) of a cavity its component's outer shell; of an outer shell the cavity it lies in, or −1
    area: Floats  # (s,) Å²
    volume: Floats  # (s,) Å³, enclosed: negative for cavities
    faces: Ints  # (s,) numbers of
    arcs: Ints  # (s,) with whole circles
    whole_circles: Ints  # (s,)
    vertices: Ints  # (s,)
    genus: Ints  # (s,)


def shells_of(graph: BoundaryGraph) -> Shells:
    """Return the shells of a union boundary."""
    faces = graph.faces
    of_face = component_labels(faces.edges.face[::2], faces.edges.face[1::2], len(faces.sphere))
    count = int(of_face.max(initial=-1)) + 1
    area, volume = sums(of_face, graph.face_area(), count), _volumes(graph, of_face, count)
    of_ball = ball_components(graph)  # also of balls inside others, which have no shell
    component = np.unique(of_ball[faces.sphere[_first_face(of_face, count)]], return_inverse=True)[1]
    outer = np.zeros(count, dtype=bool)
    by_volume = np.lexsort((-volume, component))
    outer[by_volume[np.append(True, np.diff(component[by_volume]) > 0)[:count]]] = True
    order = np.lexsort((-np.abs(volume), ~outer))
    rank = np.empty(count, dtype=np.int64)
    rank[order] = np.arange(count)
    own = np.empty(count, dtype=np.int64)  # the outer shell of a component
    own[component[outer]] = rank[outer]
    of_face, of_component = rank[of_face], own[component][order]
    numbers = _counts(graph, of_face, count)
    shells = Shells(of_face, outer[order], of_component, of_component, area[order], volume[order], *numbers)
    return shells._replace(parent=np.where(shells.outer, _surroundings(graph, shells), shells.parent))


def lining(graph: BoundaryGraph, shells: Shells) -> tuple[Ints, Ints]:
    """Return which balls line which shells: rows of shells, ascending, and of balls, each pair once."""
    balls = len(graph.boundary.spheres.radius)
    pair = np.unique(shells.of_face * balls + graph.faces.sphere)
    return pair // balls, pair % balls


def reached_from_outside(shells: Shells) -> Bools:
    """Return (f,) whether a face is one of the outer cell: of an outer shell whose component lies in no cavity."""
    return np.asarray((shells.outer & (shells.parent < 0))[shells.of_face])


def _first_face(of_face: Ints, count: int) -> Ints:
    first = np.empty(count, dtype=np.int64)
    first[of_face[::-1]] = np.arange(len(of_face))[::-1]
    return first


def _volumes(graph: BoundaryGraph, shell: Ints, count: int) -> Floats:
    """Signed volumes (s,); the origin is one of the shell's own balls, so that nothing large cancels."""
    spheres, sphere = graph.boundary.spheres, graph.faces.sphere
    origin = spheres.center[sphere[_first_face(shell, count)]]
    field = dot(spheres.center[sphere] - origin[shell], graph.face_flux())
    return sums(shell, spheres.radius[sphere] * graph.face_area() + field, count) / 3


def ball_components(graph: BoundaryGraph) -> Ints:
    """Return the number (n,) of the set of overlapping balls that each ball belongs to."""
    start, item = graph.boundary.crossing
    owner = np.repeat(np.arange(len(start) - 1), np.diff(start))
    once = owner < item
    return component_labels(owner[once], item[once], len(start) - 1)


def _counts(graph: BoundaryGraph, shell: Ints, count: int) -> tuple[Ints, Ints, Ints, Ints, Ints]:
    """Faces, arcs, whole circles, triple points and genus of each shell."""
    edges, triple_points = graph.faces.edges, len(graph.vertex)
    of_arc = shell[edges.face[::2]]
    whole = np.bincount(of_arc[edges.origin[::2] >= triple_points], minlength=count)
    arcs = np.bincount(of_arc, minlength=count)
    of_vertex = np.empty(triple_points, dtype=np.int64)
    bounded = edges.origin < triple_points
    of_vertex[edges.origin[bounded]] = shell[edges.face[bounded]]
    vertices = np.bincount(of_vertex, minlength=count)
    discs = np.bincount(shell, 2 - loop_counts(graph.faces), count)
    euler = vertices - (arcs - whole) + discs.astype(np.int64)
    return np.bincount(shell, minlength=count), arcs, whole, vertices, 1 - euler // 2


def _surroundings(graph: BoundaryGraph, shells: Shells) -> Ints:
    """For each shell, if it is an outer one, the cavity that its component lies in, or −1."""
    around = np.full(len(shells.outer), -1)
    if shells.outer.all():
        return around
    outer = np.flatnonzero(shells.outer)
    face = FacesAbove(graph)(_tops(graph, shells)[outer])
    met = np.where(face >= 0, shells.of_face[face], -1)
    cavity = (met >= 0) & ~shells.outer[met]
    around[outer[cavity]] = met[cavity]
    beside = np.where((met >= 0) & shells.outer[met], met, outer)  # the component to ask instead, or none
    while not np.array_equal(beside[beside], beside):  # outer shells come first: their rows are 0, 1, …
        beside = beside[beside]
    around[outer] = around[beside]
    return around


def _tops(graph: BoundaryGraph, shells: Shells) -> Floats:
    """The topmost point (s, 3) of each shell's spheres."""
    spheres, sphere = graph.boundary.spheres, graph.faces.sphere
    height = spheres.center[:, 2] + spheres.radius
    order = np.lexsort((height[sphere], shells.of_face))
    last = np.append(np.diff(shells.of_face[order]) > 0, True)[: len(order)]
    ball = sphere[order[last]]
    return np.column_stack([spheres.center[ball, :2], height[ball]])
