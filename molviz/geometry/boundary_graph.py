"""The boundary of a union of balls as a planar map on spheres (Halperin & Overmars 1994, section 4.2, step 3).

Arc k of the crease of spheres i < j is half-edge 2k on sphere j, where it runs forwards, and 2k + 1 on sphere i; the
free side is on the left of both. Where a third ball cuts a crease is a triple point, named by its three spheres and by
which of their two common points it is; in general position three arcs end there, one of each pair of the spheres. A
whole circle has a vertex of its own, so that it follows itself; a sphere that nothing touches is a face without a loop.

*General position.* Balls stay where they are unless what they bound depends on rounding: where other than three arcs
end at a triple point, or an arc is no longer than rounding. Those balls alone are displaced, by ``NUDGE`` of their
radius, each time in another direction, until the map is one.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.boundary import Boundary, free_spheres, union_boundary
from molviz.geometry.general_position import Degenerate, first_general, nudged
from molviz.geometry.planar_map import planar_map
from molviz.geometry.rims import rims_of, totals
from molviz.geometry.spherical_faces import SphericalFaces, spherical_faces
from molviz.geometry.tolerances import SHORT
from molviz.model.spheres import Spheres


class BoundaryGraph(NamedTuple):
    """The union boundary of n balls: v triple points, k arcs, f faces.

    ``faces.edges.origin`` numbers the triple points from 0, and the vertices of whole circles from v on.
    ``boundary.spheres`` are the balls as they were used, a few of them displaced.
    """

    boundary: Boundary
    displaced: Bools  # (n,) balls that were moved into general position
    faces: SphericalFaces  # of the unit spheres about the centres
    vertex_spheres: Ints  # (v, 3) ascending
    vertex: Floats  # (v, 3) ångström

    def face_area(self) -> Floats:
        """Return the area (f,) of each face in Å²."""
        return self.faces.area * self.boundary.spheres.radius[self.faces.sphere] ** 2

    def face_flux(self) -> Floats:
        """Return ``∫ n dA`` (f, 3) over each face in Å², n outward."""
        return self.faces.flux * self.boundary.spheres.radius[self.faces.sphere, None] ** 2


def boundary_graph(spheres: Spheres) -> BoundaryGraph:
    """Return the union boundary of n balls as a planar map on spheres, in time linear in n for a hard sphere model.

    Raises InternalError if (never seen) displacing balls does not bring them into general position.
    """
    times = np.zeros(len(spheres.radius), dtype=np.int64)

    def attempt(number: int) -> BoundaryGraph:
        boundary = union_boundary(nudged(spheres, times))
        name, origin, target = _vertices(boundary)
        doubtful = _doubtful(boundary, name, origin, target)
        if len(doubtful):
            times[doubtful] = number + 1
            raise Degenerate
        circle = boundary.arcs.circle
        edges = planar_map(origin, target, boundary.circles.second[circle], boundary.circles.first[circle])
        faces = spherical_faces(rims_of(boundary), edges, np.flatnonzero(free_spheres(boundary)))
        return BoundaryGraph(boundary, times > 0, faces, name[:, :3], _places(boundary, origin, target, len(name)))

    return first_general(attempt)


def _vertices(boundary: Boundary) -> tuple[Ints, Ints, Ints]:
    """Names (v, 4) of the triple points, three spheres and a side, and the vertices at which arcs start and end."""
    circles, arcs = boundary.circles, boundary.arcs
    bounded = np.flatnonzero(arcs.before >= 0)
    first, second = (column[arcs.circle[bounded]] for column in (circles.first, circles.second))
    names = [triple_names(first, second, end[bounded], side) for side, end in enumerate((arcs.before, arcs.after))]
    name, number = numbered_names(np.concatenate(names), len(boundary.spheres.radius))
    whole = np.flatnonzero(arcs.before < 0)
    origin, target = np.empty(len(arcs.circle), dtype=np.int64), np.empty(len(arcs.circle), dtype=np.int64)
    origin[bounded], target[bounded] = np.split(number, 2)
    origin[whole] = target[whole] = len(name) + np.arange(len(whole))
    return name, origin, target


def triple_names(i: Ints, j: Ints, k: Ints, side: int) -> Ints:
    """Return names (m, 4) of triple points where the crease of i < j enters ball k (side 1) or leaves it (side 0).

    The side is the sign of ``det(c_i − p, c_j − p, c_k − p)``; sorting (i, j, k) is odd exactly if k belongs between
    them, and mirrors it.
    """
    low, high = np.minimum(i, k), np.maximum(j, k)
    return np.stack([low, i + j + k - low - high, high, side ^ ((i < k) & (k < j))], axis=1)


def numbered_names(name: Ints, count: int) -> tuple[Ints, Ints]:
    """Return each name once, and the numbers of all; ``count`` is above all numbers of spheres."""
    # in two steps, as three numbers of spheres may not fit into one
    pair = np.unique(name[:, 0] * count + name[:, 1], return_inverse=True)[1]
    _, row, number = np.unique((pair * count + name[:, 2]) * 2 + name[:, 3], return_index=True, return_inverse=True)
    return name[row], number


def _doubtful(boundary: Boundary, name: Ints, origin: Ints, target: Ints) -> Ints:
    """The balls of which it is a matter of rounding what they bound."""
    circles, circle, radius = boundary.circles, boundary.arcs.circle, boundary.spheres.radius
    ends = np.bincount(np.concatenate([origin, target]), minlength=len(name))[: len(name)]
    first, second = circles.first[circle], circles.second[circle]
    length = boundary.arcs.sweep * np.linalg.norm(circles.a, axis=1)[circle]
    short = length < SHORT * np.minimum(radius[first], radius[second])
    return np.unique(np.concatenate([name[ends != 3, :3].ravel(), first[short], second[short]]))


def _places(boundary: Boundary, origin: Ints, target: Ints, count: int) -> Floats:
    """The triple points (v, 3): the middle of where their three arcs end."""
    circle, start, sweep = boundary.arcs.circle, boundary.arcs.start, boundary.arcs.sweep
    ends = np.concatenate([boundary.circles.at(circle, start), boundary.circles.at(circle, start + sweep)])
    vertex = np.concatenate([origin, target])
    triple = vertex < count
    return totals(vertex[triple], ends[triple], count) / 3
