"""Regions of spheres that are bounded by loops of arcs: area and flux of each, and which of them a point is in.

*Area left of a loop.* By Gauss & Bonnet it is ``2π + Σ h Δψ − Σ turns`` on the unit sphere, h the cosine of the cap
that an arc cuts off and Δψ its angle. Where two caps overlap the corner left is narrower than π, so every turn is to
the left: ``atan2(|t0 × t1|, t0 · t1)`` has no sign to get wrong.

*Faces with several loops.* A point lies left of loop C iff ``left(C) − J(C) > 2π``, J being the sum of the ``2 J1`` of
``rims`` with the pole at that point: the difference is 0 or 4π. Loops of a sphere bound one face iff the same loops
have them on their left; its area is ``Σ left − 4π (loops − 1)``. A sphere that nothing bounds is a face without loop.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.planar_map import Loops, PlanarMap, loops
from molviz.geometry.rims import Rims, sums, totals, twice_j1, unit_flux
from molviz.geometry.rows import expand, lists_taken
from molviz.vectors import dot

WHOLE = 4 * np.pi  # area of the unit sphere


class SphericalFaces(NamedTuple):
    """f faces on numbered spheres, ordered by sphere, all as on unit spheres."""

    rims: Rims  # (2k,) the half-edges
    edges: PlanarMap  # 2k half-edges; face: rows of the columns below
    loops: Loops  # ordered by face
    left: Floats  # (loops,) area left of each loop
    sphere: Ints  # (f,) ascending
    area: Floats  # (f,)
    flux: Floats  # (f, 3) ∫ n dA, n outward


def spherical_faces(rims: Rims, by_sphere: PlanarMap, unbounded: Ints) -> SphericalFaces:
    """Return the faces of a map whose half-edges carry the number of their sphere; ``unbounded`` spheres are whole."""
    bounds = loops(by_sphere)
    left = _left_areas(rims, by_sphere, bounds)
    face, sphere = _numbered_faces(bounds, _parts(rims, bounds, left), unbounded)
    face_of_edge = np.full(len(by_sphere.face), -1)
    face_of_edge[bounds.half_edge] = np.repeat(face, np.diff(bounds.start))
    used = np.flatnonzero(face_of_edge >= 0)
    area = sums(face, left, len(sphere)) - WHOLE * (np.bincount(face, minlength=len(sphere)) - 1)
    flux = totals(face_of_edge[used], unit_flux(rims.take(used)), len(sphere))
    order = np.argsort(face, kind="stable")
    row, start = lists_taken(bounds.start, order)
    ordered = Loops(bounds.half_edge[row], start, face[order])
    return SphericalFaces(rims, by_sphere._replace(face=face_of_edge), ordered, left[order], sphere, area, flux)


def loop_counts(faces: SphericalFaces) -> Ints:
    """Return the number of loops (f,) of each face."""
    return np.bincount(faces.loops.face, minlength=len(faces.sphere))


def face_at(faces: SphericalFaces, sphere: Ints, direction: Floats) -> Ints:
    """Return the face (q,) in which the point of each sphere in a unit direction (q, 3) lies, −1 where in none.

    A face is what lies left of all its loops.
    """
    begin, end = (np.searchsorted(faces.sphere, sphere, side) for side in ("left", "right"))
    query, face = expand(begin, end)
    loop_start = np.searchsorted(faces.loops.face, np.arange(len(faces.sphere) + 1))
    case, loop = expand(loop_start[face], loop_start[face + 1])
    right = ~left_of(faces.rims, faces.loops, faces.left, loop, direction[query[case]])
    inside = np.flatnonzero(np.bincount(case[right], minlength=len(face)) == 0)
    answer = np.full(len(sphere), -1)
    answer[query[inside]] = face[inside]
    return answer


def left_of(rims: Rims, bounds: Loops, left: Floats, loop: Ints, direction: Floats) -> Bools:
    """Return whether points (q, 3) of the unit spheres lie left of the given loops (q,) of these spheres."""
    query, place = expand(bounds.start[loop], bounds.start[loop + 1])
    arc = twice_j1(rims.take(bounds.half_edge[place]), -direction[query])
    return np.asarray(left[loop] - np.bincount(query, arc, len(loop)) > WHOLE / 2)


def _left_areas(rims: Rims, by_sphere: PlanarMap, bounds: Loops) -> Floats:
    """The area left of each loop."""
    edge = bounds.half_edge
    following = by_sphere.next[edge]
    forward = np.cross(rims.middle, rims.axis)
    sine, cosine = np.sin(rims.half)[:, None] * rims.middle, np.cos(rims.half)[:, None] * forward
    arriving, leaving = (cosine - sine)[edge], (cosine + sine)[following]
    aside = np.linalg.norm(np.cross(arriving, leaving), axis=1)
    turn = np.arctan2(aside, dot(arriving, leaving))
    gain = 2 * rims.cosine[edge] * rims.half[edge] - turn
    owner = np.repeat(np.arange(len(bounds.face)), np.diff(bounds.start))
    return sums(owner, gain, len(bounds.face)) + WHOLE / 2


def _parts(rims: Rims, bounds: Loops, left: Floats) -> Ints:
    """For each loop a number that only the loops of its face share: of those left of the same loops of its sphere."""
    count = np.bincount(bounds.face, minlength=int(bounds.face.max(initial=-1)) + 1)
    start = np.cumsum(count) - count
    part = bounds.face.copy()
    several = np.flatnonzero(count[bounds.face] > 1)
    query, other = expand(start[bounds.face[several]], (start + count)[bounds.face[several]])
    loop = several[query]
    inside = loop == other
    apart = np.flatnonzero(~inside)
    point = _points_on(rims, bounds, loop[apart])
    inside[apart] = left_of(rims, bounds, left, other[apart], point)
    place = other - start[bounds.face[other]]
    for turn in range(int(place.max(initial=-1)) + 1):
        rows = np.flatnonzero(place == turn)
        finer = np.unique(2 * part[loop[rows]] + inside[rows], return_inverse=True)[1]
        part[loop[rows]] = finer + part.max() + 1
    return part


def _points_on(rims: Rims, bounds: Loops, loop: Ints) -> Floats:
    """A point (q, 3) of each loop: the middle of its first arc."""
    edge = bounds.half_edge[bounds.start[loop]]
    return rims.cosine[edge, None] * rims.axis[edge] + rims.sine[edge, None] * rims.middle[edge]


def _numbered_faces(bounds: Loops, part: Ints, unbounded: Ints) -> tuple[Ints, Ints]:
    """The face of each loop, and the sphere of each face, ascending; spheres without loops have a face, too."""
    _, first_loop, number = np.unique(part, return_index=True, return_inverse=True)
    sphere = np.concatenate([bounds.face[first_loop], unbounded])
    order = np.argsort(sphere, kind="stable")
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return rank[number], sphere[order]
