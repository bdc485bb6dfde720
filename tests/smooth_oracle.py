"""The distance to the free space of a probe, by trying whatever may be its nearest point; and points of patches."""

from itertools import combinations

import numpy as np

from molviz.geometry.boundary_graph import BoundaryGraph
from molviz.geometry.smooth import cut_triangles, probes_of, saddles_of
from molviz.geometry.spherical_faces import face_at
from molviz.model.spheres import Spheres

KINDS = ("convex", "saddle", "singular saddle", "concave", "cut concave")
FREE = 1e-9  # Å, by which a candidate may be inside a ball


def distance_to_free_space(spheres: Spheres, points: np.ndarray) -> np.ndarray:
    """Of points (q, 3) inside the union of n balls to what is outside of all of them."""
    best = np.full(len(points), np.inf)
    for candidate in candidates(spheres, points):
        depth = spheres.radius - np.linalg.norm(candidate[:, None] - spheres.center, axis=2)
        gap = np.linalg.norm(candidate - points, axis=1)
        best = np.where((depth.max(axis=1) < FREE) & (gap < best), gap, best)
    return best


def candidates(spheres: Spheres, points: np.ndarray) -> list[np.ndarray]:
    """The nearest points of each sphere, of each circle of two spheres, and the common points of three.

    All points of a circle are as near to a point of its axis, where the nearest one would be a matter of rounding: one
    point of every circle is a candidate as well.
    """
    center, radius, count = spheres.center, spheres.radius, len(spheres.radius)
    found = [center[i] + radius[i] * unit(points - center[i]) for i in range(count)]
    for i, j in combinations(range(count), 2):
        between = center[j] - center[i]
        d = np.linalg.norm(between)
        t = (d**2 + radius[i] ** 2 - radius[j] ** 2) / (2 * d)
        if abs(radius[i] - radius[j]) < d < radius[i] + radius[j]:
            middle, axis = center[i] + t / d * between, between / d
            across = points - middle - np.outer((points - middle) @ axis, axis)
            rho = np.sqrt(radius[i] ** 2 - t**2)
            some = unit(np.cross(axis, np.eye(3)[[np.argmin(np.abs(axis))]]))
            aside = np.linalg.norm(across, axis=1)[:, None] > 0
            found.append(middle + rho * np.where(aside, unit(np.where(aside, across, some)), some))
            found.append(np.broadcast_to(middle + rho * some, points.shape))
    for triple in combinations(range(count), 3):
        found += [np.broadcast_to(point, points.shape) for point in common_points(spheres, list(triple))]
    return found


def common_points(spheres: Spheres, triple: list[int]) -> list[np.ndarray]:
    """At most two points, by linear algebra."""
    center, radius = spheres.center[triple], spheres.radius[triple]
    sides = center[1:] - center[0]
    level = (np.sum(sides**2, axis=1) + radius[0] ** 2 - radius[1:] ** 2) / 2
    offset = sides.T @ np.linalg.solve(sides @ sides.T, level)
    normal = np.cross(sides[0], sides[1])
    rest = radius[0] ** 2 - offset @ offset
    if rest <= 0:
        return []
    step = np.sqrt(rest) * normal / np.linalg.norm(normal)
    return [center[0] + offset + step, center[0] + offset - step]


def unit(vectors: np.ndarray) -> np.ndarray:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1)[:, None])


def points_of_patches(
    graph: BoundaryGraph, probe: float, count: int, random: np.random.Generator
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """By kind: random points (q, 3) of whole patches, and whether they are said to be left of them.

    Singular saddles cross their axis; cut concave patches are cut by other probes.
    """
    convex, saddles = convex_points(graph, probe, count, random), saddle_points(graph, probe, count, random)
    return dict(zip(KINDS, [convex, *saddles, *concave_points(graph, probe, count, random)], strict=True))


def convex_points(
    graph: BoundaryGraph, probe: float, count: int, random: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    spheres = graph.boundary.spheres
    ball = random.integers(0, len(spheres.radius), count)
    direction = unit(random.normal(size=(count, 3)))
    points = spheres.center[ball] + (spheres.radius[ball] - probe)[:, None] * direction
    return points, face_at(graph.faces, ball, direction) >= 0


def saddle_points(
    graph: BoundaryGraph, probe: float, count: int, random: np.random.Generator
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Of saddles that keep away from their axis, and of those that cross it."""
    arcs = graph.boundary.arcs
    singular = saddles_of(graph, probe, np.arange(len(arcs.circle))).waist > 0
    return [points_of_saddles(graph, probe, some(rows, count, random), random) for rows in (~singular, singular)]


def some(wanted: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
    """Random rows of those that are wanted; none where none are."""
    rows = np.flatnonzero(wanted)
    return random.choice(rows, count) if len(rows) else rows


def points_of_saddles(
    graph: BoundaryGraph, probe: float, row: np.ndarray, random: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    arcs, saddle, count = graph.boundary.arcs, saddles_of(graph, probe, row), len(row)
    angle = arcs.start[row] + random.random(count) * arcs.sweep[row]
    spoke = graph.boundary.circles.spoke(arcs.circle[row], angle) / saddle.radius[:, None]
    theta = saddle.low + random.random(count) * (saddle.high - saddle.low)
    out = (saddle.radius - probe * np.cos(theta))[:, None] * spoke + probe * np.sin(theta)[:, None] * saddle.axis
    return saddle.middle + out, np.abs(theta) >= saddle.waist


def concave_points(
    graph: BoundaryGraph, probe: float, count: int, random: np.random.Generator
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Of probes that no other cuts, and of those that others cut."""
    probes = probes_of(graph, probe, np.arange(len(graph.vertex)))
    cut = cut_triangles(probes, probe)
    is_cut = np.isin(np.arange(len(probes.vertex)), cut.probe)
    row = np.concatenate([some(~is_cut, count, random), some(is_cut, count, random)])
    weight = random.dirichlet(np.ones(3), len(row))
    direction = unit(np.einsum("qk,qki->qi", weight, probes.corner[row]))
    left = np.ones(len(row), dtype=bool)
    for k, vertex in enumerate(cut.probe.tolist()):
        mine = np.flatnonzero(row == vertex)
        caps = slice(cut.caps.start[k] + 3, cut.caps.start[k + 1])
        left[mine] = np.all(direction[mine] @ cut.caps.axis[caps].T <= cut.caps.cosine[caps], axis=1)
    points = probes.center[row] + probe * direction
    return [(points[rows], left[rows]) for rows in (~is_cut[row], is_cut[row])]


def wrong_points(
    graph: BoundaryGraph, probe: float, count: int, random: np.random.Generator
) -> dict[str, tuple[int, int]]:
    """By kind: how many points of patches there are, and how many are not where they are said to be."""
    found = {}
    for kind, (points, left) in points_of_patches(graph, probe, count, random).items():
        excess = distance_to_free_space(graph.boundary.spheres, points) - probe
        beyond = -excess if kind == "convex" else excess  # what is covered is deep inside, what is cut off too far out
        found[kind] = len(points), int(np.sum(np.where(left, np.abs(excess) > 1e-9, beyond > 1e-12)))
    return found
