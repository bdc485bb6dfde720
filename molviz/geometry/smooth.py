"""The smooth surface of a probe (Richards 1977; Connolly 1983), exact where it cuts itself as well.

Let F be the points outside all balls of radius R_i = r_i + p: where the centre of the probe may be. The body is
``{x: dist(x, F) > p}``, its surface the points at distance p from F. The points of F nearest to them are on faces, arcs
or vertices of the boundary of F, which gives three kinds of patches, and exactly what is left of them; n points out of
the body.

*Convex*, of a face of sphere i: scaled by r_i / R_i about the centre. Never cut.

*Saddle*, of an arc of the circle with centre m, axis e from i to j, radius ρ, over an angle α; its plane is t_i beyond
c_i and t_j before c_j. With w(ψ) the unit vector from m to the point of the arc,

    x = m + (ρ − p cos θ) w + p sin θ e,    −atan2(t_i, ρ) ≤ θ ≤ atan2(t_j, ρ),    area αp [ρθ − p sin θ].

It is cut at its own axis only: where ρ < p, |θ| < arccos(ρ / p) is dropped, a *spindle* with two cusps. (Away from the
axis the nearest point of the complement of the two balls is unique.) A profile that does not hold θ = 0 never reaches
the axis, as its end is R_i > p from it. With W = ∫ w dψ = 2 sin(α / 2) · (w in the middle), S = sin θ,
C = (θ + sin θ cos θ) / 2 and Q = ρ cos θ + p sin² θ / 2 between the limits,

    ∫ n dA = p [W (ρS − pC) + e αQ],
    ∫ x · n dA = p [(m · W) (ρS − pC) + (m · e) αQ + α (ρ²S − pρC − pρθ + p²S)].

*Concave*, of a vertex y: the directions v, with x = y + p v, in which no point of F is nearer than y: outside the three
hemispheres ``v · t > 0``, t along each arc that leaves y, and outside the cap about y' − y of cosine |y' − y| / 2p for
every other vertex y' nearer than 2p. (Inner points of arcs and faces never cut it, and spindles ask for no more: the
probe at the far end passes through both cusps.) Without caps it is the spherical triangle between the directions g of
the three balls, whose area and flux have closed forms; with caps, ``cap_regions`` knows them. As n = −v,

    ∫ n dA = −p² f,    ∫ x · n dA = y · (−p² f) − p A,    f = ∫ v over the unit sphere.

The volume is ``⅓ Σ ∫ x · n dA``. Two identities hold, singularities and all: ``∫ n dA = 0``, and, as r_i + ε and p − ε
leave F alone and surfaces are level sets of one distance, ``dV / dε = A``.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.boundary_graph import BoundaryGraph
from molviz.geometry.cap_regions import CapSets, area_and_flux, free_arcs, rims_of_caps
from molviz.geometry.circles import radical_planes
from molviz.geometry.components import component_labels
from molviz.geometry.grid import intersecting_pairs
from molviz.geometry.rims import sums
from molviz.geometry.rows import offsets
from molviz.geometry.tolerances import CLUSTER
from molviz.model.spheres import Spheres
from molviz.vectors import dot


class Kept(NamedTuple):
    """The part of a boundary on which a probe rolls: rows of faces, arcs and triple points."""

    faces: Ints
    arcs: Ints
    vertices: Ints


class Saddles(NamedTuple):
    """The saddles of k arcs; lengths in ångström."""

    arc: Ints  # (k,) of the graph
    middle: Floats  # (k, 3) m
    axis: Floats  # (k, 3) e, from the first ball to the second
    radius: Floats  # (k,) ρ
    along: Floats  # (k, 3) w in the middle of the arc
    angle: Floats  # (k,) α
    low: Floats  # (k,) θ at the first ball
    high: Floats  # (k,) θ at the second ball
    waist: Floats  # (k,) |θ| up to which a spindle is dropped, 0 where there is none


class Probes(NamedTuple):
    """The concave triangles of v probes that touch three balls, k = 0, 1, 2; arc k is between balls k and k + 1."""

    vertex: Ints  # (v,) of the graph
    center: Floats  # (v, 3) y
    cluster: Ints  # (v,) number shared by those that arcs next to no length connect
    balls: Ints  # (v, 3) counter-clockwise
    corner: Floats  # (v, 3, 3) unit vectors from y to their centres
    away: Floats  # (v, 3, 3) t, the directions in which the arcs leave


class SmoothSurface(NamedTuple):
    """Areas (Å²) by kind and by ball, and what cuts itself."""

    convex: Floats  # (n,) of each ball
    saddle: Floats  # (n,) of each ball: up to the plane of the circle between two balls
    concave: Floats  # (n,) of each ball: a third of each triangle
    volume: float  # Å³
    leak: Floats  # (3,) ∫ n dA, nought but for rounding
    spindles: Ints  # rows of arcs whose saddle cuts itself
    cut_triangles: Ints  # rows of triple points whose triangle is cut by other probes

    def area(self) -> float:
        """Return the whole area in Å²."""
        return float(self.convex.sum() + self.saddle.sum() + self.concave.sum())


class _Patches(NamedTuple):
    """Integrals over patches: area, ``∫ n dA`` and ``∫ x · n dA``."""

    area: Floats  # (m,)
    normal: Floats  # (m, 3)
    moment: Floats  # (m,)


def whole_boundary(graph: BoundaryGraph) -> Kept:
    """Return everything: the voids into which the probe fits have a surface, too."""
    sizes = len(graph.faces.sphere), len(graph.boundary.arcs.circle), len(graph.vertex)
    return Kept(*(np.arange(size) for size in sizes))


def part_of_boundary(graph: BoundaryGraph, face: Bools) -> Kept:
    """Return the chosen faces (f,), whole shells of them, with their arcs and triple points."""
    edges = graph.faces.edges
    chosen = face[edges.face]
    vertices = np.unique(edges.origin[chosen])
    return Kept(np.flatnonzero(face), np.flatnonzero(chosen[::2]), vertices[vertices < len(graph.vertex)])


def smooth_surface(graph: BoundaryGraph, probe: float, kept: Kept) -> SmoothSurface:
    """Return the exact areas and volume of the surface of a probe (Å) that rolls over balls r.

    ``graph`` is that of the balls r + ``probe``, and ``kept`` the part of its boundary that the probe's centre reaches.
    """
    count = len(graph.boundary.spheres.radius)
    origin = np.sum(graph.boundary.spheres.center, axis=0) / max(count, 1)
    saddles, probes = saddles_of(graph, probe, kept.arcs), probes_of(graph, probe, kept.vertices)
    convex = _convex(graph, probe, kept.faces, origin)
    sides = [_saddle(saddles, probe, origin, *limits) for limits in _both_sides(saddles)]
    concave, cut = _concave(probes, probe, origin)
    patches = [convex, *sides, concave]
    circle = graph.boundary.arcs.circle[saddles.arc]
    balls = (graph.boundary.circles.first[circle], graph.boundary.circles.second[circle])
    thirds = graph.vertex_spheres[probes.vertex]
    return SmoothSurface(
        convex=sums(graph.faces.sphere[kept.faces], convex.area, count),
        saddle=sums(balls[0], sides[0].area, count) + sums(balls[1], sides[1].area, count),
        concave=sums(thirds.ravel(), np.repeat(concave.area / 3, 3), count),
        volume=float(sum(patch.moment.sum() for patch in patches)) / 3,
        leak=np.sum([patch.normal.sum(axis=0) for patch in patches], axis=0),
        spindles=saddles.arc[saddles.waist > 0],
        cut_triangles=probes.vertex[cut],
    )


def saddles_of(graph: BoundaryGraph, probe: float, arc: Ints) -> Saddles:
    """Return the saddles of the given arcs."""
    spheres, circles, arcs = graph.boundary.spheres, graph.boundary.circles, graph.boundary.arcs
    circle = arcs.circle[arc]
    first, second = circles.first[circle], circles.second[circle]
    axis, before = radical_planes(spheres, first, second)
    _, behind = radical_planes(spheres, second, first)
    radius = np.linalg.norm(circles.a[circle], axis=1)
    along = circles.spoke(circle, arcs.start[arc] + arcs.sweep[arc] / 2) / radius[:, None]
    low, high = -np.arctan2(before, radius), np.arctan2(behind, radius)
    cut = (radius < probe) & (low < 0) & (high > 0)
    waist = np.where(cut, np.arccos(np.minimum(radius / probe, 1.0)), 0.0)
    return Saddles(arc, circles.center[circle], axis, radius, along, arcs.sweep[arc], low, high, waist)


def probes_of(graph: BoundaryGraph, probe: float, vertex: Ints) -> Probes:
    """Return the probes of the given radius at the given triple points."""
    center, balls = graph.vertex[vertex], graph.vertex_spheres[vertex]
    corner = graph.boundary.spheres.center[balls] - center[:, None]
    corner /= np.linalg.norm(corner, axis=2)[:, :, None]
    clockwise = np.flatnonzero(dot(np.cross(corner[:, 0], corner[:, 1]), corner[:, 2]) < 0)
    corner[clockwise], balls[clockwise] = corner[clockwise][:, [0, 2, 1]], balls[clockwise][:, [0, 2, 1]]
    across = np.cross(corner, corner[:, [1, 2, 0]])  # an arc leaves perpendicularly to the plane of y and its two balls
    away = -across / np.linalg.norm(across, axis=2)[:, :, None]
    return Probes(vertex, center, _clusters(graph, probe)[vertex], balls, corner, away)


def _clusters(graph: BoundaryGraph, probe: float) -> Ints:
    """For each triple point a number shared by those that arcs of next to no length, none a spindle's, connect."""
    circle, sweep = graph.boundary.arcs.circle, graph.boundary.arcs.sweep
    radius = np.linalg.norm(graph.boundary.circles.a, axis=1)[circle]
    bounded = graph.faces.edges.origin[::2] < len(graph.vertex)
    joined = np.flatnonzero((radius * sweep < CLUSTER * probe) & (radius > probe) & bounded)
    origin = graph.faces.edges.origin
    return component_labels(origin[2 * joined], origin[2 * joined + 1], len(graph.vertex))


def _convex(graph: BoundaryGraph, probe: float, face: Ints, origin: Floats) -> _Patches:
    spheres, sphere = graph.boundary.spheres, graph.faces.sphere[face]
    radius = spheres.radius[sphere] - probe
    area, normal = radius**2 * graph.faces.area[face], radius[:, None] ** 2 * graph.faces.flux[face]
    return _Patches(area, normal, radius * area + dot(spheres.center[sphere] - origin, normal))


def _both_sides(saddles: Saddles) -> tuple[tuple[Floats, Floats], tuple[Floats, Floats]]:
    """Limits of θ on either side of the plane of the circle, without what a spindle drops; equal where nothing is."""
    low, high, waist = saddles.low, saddles.high, saddles.waist
    return (np.minimum(low, 0.0), np.minimum(high, -waist)), (np.maximum(low, waist), np.maximum(high, 0.0))


def _saddle(saddles: Saddles, probe: float, origin: Floats, low: Floats, high: Floats) -> _Patches:
    """The saddles between the given limits of θ."""
    sine = np.sin(high) - np.sin(low)
    across = (high - low + np.sin(high) * np.cos(high) - np.sin(low) * np.cos(low)) / 2
    falls = saddles.radius * (np.cos(high) - np.cos(low)) + probe * (np.sin(high) ** 2 - np.sin(low) ** 2) / 2
    by_spoke = saddles.radius * sine - probe * across
    spoke = 2 * np.sin(saddles.angle / 2)[:, None] * saddles.along  # W
    by_axis = saddles.angle * falls
    turn = high - low
    area = saddles.angle * probe * (saddles.radius * turn - probe * sine)
    normal = probe * (spoke * by_spoke[:, None] + saddles.axis * by_axis[:, None])
    own = saddles.angle * (saddles.radius * by_spoke - probe * saddles.radius * turn + probe**2 * sine)
    return _Patches(area, normal, dot(saddles.middle - origin, normal) + probe * own)


def _concave(probes: Probes, probe: float, origin: Floats) -> tuple[_Patches, Ints]:
    """The triangles, and the rows of those that other probes cut."""
    area, flux = triangles(probes)
    cut = cut_triangles(probes, probe)
    rims = rims_of_caps(cut.caps, free_arcs(cut.caps))
    area[cut.probe], flux[cut.probe] = area_and_flux(cut.caps, rims)
    area *= probe**2
    normal = -(probe**2) * flux
    return _Patches(area, normal, dot(probes.center - origin, normal) - probe * area), cut.probe


class CutTriangles(NamedTuple):
    """The m triangles that other probes cut, as what some caps leave of unit spheres."""

    probe: Ints  # (m,) row of the probes
    caps: CapSets  # of m spheres: three hemispheres first, then a cap for each probe that cuts
    other: Ints  # (c,) row of the probe that cuts; −1 − k for the hemisphere of arc k


def cut_triangles(probes: Probes, probe: float) -> CutTriangles:
    """Return which triangles are cut, and by what."""
    one, other = intersecting_pairs(Spheres(probes.center, np.full(len(probes.center), probe)))
    apart = probes.cluster[one] != probes.cluster[other]
    one, other = np.concatenate([one[apart], other[apart]]), np.concatenate([other[apart], one[apart]])
    toward = probes.center[other] - probes.center[one]
    distance = np.linalg.norm(toward, axis=1)
    axis, cosine = toward / distance[:, None], distance / (2 * probe)
    reaches = np.flatnonzero(_reaches(probes, one, axis, cosine))
    one, other, axis, cosine = one[reaches], other[reaches], axis[reaches], cosine[reaches]
    cut = np.unique(one)
    sphere = np.concatenate([np.repeat(np.arange(len(cut)), 3), np.searchsorted(cut, one)])
    order = np.argsort(sphere, kind="stable")
    axes = np.concatenate([probes.away[cut].reshape(-1, 3), axis])[order]
    cosines = np.concatenate([np.zeros(3 * len(cut)), cosine])[order]
    name = np.concatenate([np.tile([-1, -2, -3], len(cut)), other])[order]
    return CutTriangles(cut, CapSets(sphere[order], offsets(sphere, len(cut)), axes, cosines), name)


def _reaches(probes: Probes, row: Ints, axis: Floats, cosine: Floats) -> Bools:
    """Whether caps (q,) cover a part of the triangles of the given probes: a corner, the middle, or part of a side."""
    near = np.flatnonzero(_may_reach(probes, row, axis, cosine))
    corner, away = probes.corner[row[near]], probes.away[row[near]]
    to_corner, to_side = np.einsum("qki,qi->qk", corner, axis[near]), np.einsum("qki,qi->qk", away, axis[near])
    level = cosine[near, None]
    covers_corner, contains_axis = np.any(to_corner > level, axis=1), np.all(to_side < 0, axis=1)
    foot = axis[near, None] - to_side[:, :, None] * away  # on the side's great circle, nearest to the axis
    after = np.einsum("qki,qki->qk", np.cross(foot, corner), away) > 0
    before = np.einsum("qki,qki->qk", np.cross(corner[:, [1, 2, 0]], foot), away) > 0
    covers_side = np.any(after & before & (np.linalg.norm(foot, axis=2) > level), axis=1)
    answer = np.zeros(len(row), dtype=bool)
    answer[near] = covers_corner | contains_axis | covers_side
    return answer


def _may_reach(probes: Probes, row: Ints, axis: Floats, cosine: Floats) -> Bools:
    """Whether caps meet the cap through the three corners; a cap about their mean may be more than half a sphere."""
    g = probes.corner
    normal = np.cross(g[:, 0], g[:, 1]) + np.cross(g[:, 1], g[:, 2]) + np.cross(g[:, 2], g[:, 0])
    length = np.linalg.norm(normal, axis=1)
    middle = normal / length[:, None]
    least = np.clip(dot(middle, g[:, 0]), 0.0, 1.0)[row]
    sines = np.sqrt((1 - cosine) * (1 + cosine)) * np.sqrt((1 - least) * (1 + least))
    return np.asarray(dot(middle[row], axis) > cosine * least - sines)


def triangles(probes: Probes) -> tuple[Floats, Floats]:
    """Return area (v,) and flux (v, 3) of the whole triangles on unit spheres (Van Oosterom & Strackee 1983)."""
    g = probes.corner
    volume = np.abs(dot(np.cross(g[:, 0], g[:, 1]), g[:, 2]))
    cosines = np.einsum("vki,vki->vk", g, g[:, [1, 2, 0]])
    area = 2 * np.arctan2(volume, 1 + cosines.sum(axis=1))
    sides = np.arctan2(np.linalg.norm(np.cross(g, g[:, [1, 2, 0]]), axis=2), cosines)
    return area, -np.einsum("vk,vki->vi", sides, probes.away) / 2
