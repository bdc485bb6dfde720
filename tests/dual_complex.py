"""Topology of a union of balls by its dual complex (Edelsbrunner 1995), which shares nothing with ``molviz.geometry``.

The lower hull of the centres, lifted to ``|c|² − r²``, is their regular triangulation. A simplex of it belongs to the
dual complex if the balls of its corners meet where no other ball is nearer: the smallest sphere orthogonal to them has
a radius squared not above 0, and is farther than orthogonal to every other corner beside it; or else if a simplex that
it is a side of belongs to it.
"""

from itertools import combinations
from typing import NamedTuple

import numpy as np
from scipy.spatial import ConvexHull

from molviz.model.spheres import Spheres


class Topology(NamedTuple):
    components: int
    cavities: int
    euler: int  # of the solid: half of its boundary's


def topology(spheres: Spheres) -> Topology:
    """Of n ≥ 5 balls in general position, not all centres in a plane."""
    tetrahedra = regular_tetrahedra(spheres)
    inside = dual_simplices(spheres, tetrahedra)
    euler = sum((-1) ** (len(simplex) - 1) for simplex in inside)
    points = [simplex[0] for simplex in inside if len(simplex) == 1]
    edges = [simplex for simplex in inside if len(simplex) == 2]
    return Topology(parts(points, edges), outside_parts(tetrahedra, inside) - 1, euler)


def regular_tetrahedra(spheres: Spheres) -> list[tuple[int, ...]]:
    center = spheres.center - spheres.center.mean(axis=0)
    hull = ConvexHull(np.column_stack([center, np.sum(center**2, axis=1) - spheres.radius**2]))
    lower = hull.simplices[hull.equations[:, 3] < 0]
    return [tuple(sorted(simplex)) for simplex in lower.tolist()]


def dual_simplices(spheres: Spheres, tetrahedra: list[tuple[int, ...]]) -> set[tuple[int, ...]]:
    inside: set[tuple[int, ...]] = set()
    beside: dict[tuple[int, ...], set[int]] = {}
    for tetrahedron in tetrahedra:
        if orthogonal_sphere(spheres, tetrahedron)[1] <= 0:
            inside.add(tetrahedron)
    cofaces = tetrahedra
    for size in (3, 2, 1):
        beside = {}
        for coface in cofaces:
            for side in combinations(coface, size):
                beside.setdefault(side, set()).update(set(coface) - set(side))
        for side, others in beside.items():
            by_coface = any(tuple(sorted((*side, other))) in inside for other in others)
            center, power = orthogonal_sphere(spheres, side)
            rows = list(others)
            distance = np.sum((spheres.center[rows] - center) ** 2, axis=1) - spheres.radius[rows] ** 2
            if by_coface or (power <= 0 and np.all(distance > power)):
                inside.add(side)
        cofaces = list(beside)
    return inside


def orthogonal_sphere(spheres: Spheres, simplex: tuple[int, ...]) -> tuple[np.ndarray, float]:
    """Centre and radius squared of the smallest sphere orthogonal to those of the corners."""
    first, rest = simplex[0], list(simplex[1:])
    origin, radius = spheres.center[first], spheres.radius[first]
    if not rest:
        return origin, -(radius**2)
    sides = spheres.center[rest] - origin
    level = (np.sum(sides**2, axis=1) + radius**2 - spheres.radius[rest] ** 2) / 2
    offset = sides.T @ np.linalg.solve(sides @ sides.T, level)
    return origin + offset, float(offset @ offset - radius**2)


def parts(members: list, pairs: list) -> int:
    """Connected components, by following parents."""
    parent = {member: member for member in members}

    def root(member: object) -> object:
        while parent[member] != member:
            member = parent[member]
        return member

    for one, other in pairs:
        parent[root(one)] = root(other)
    return len({root(member) for member in members})


def outside_parts(tetrahedra: list[tuple[int, ...]], inside: set[tuple[int, ...]]) -> int:
    """Parts of the complement: tetrahedra that are not in the complex, over triangles that are not; −1 is far away."""
    outside = [tetrahedron for tetrahedron in tetrahedra if tetrahedron not in inside]
    sides: dict[tuple[int, ...], list] = {}
    for tetrahedron in tetrahedra:
        for triangle in combinations(tetrahedron, 3):
            sides.setdefault(triangle, []).append(tetrahedron)
    open_sides = [both if len(both) == 2 else [*both, -1] for side, both in sides.items() if side not in inside]
    return parts([*outside, -1], open_sides)
