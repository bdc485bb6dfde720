"""Triangulation of regions of spheres between given boundary points: their vertices are exactly on the spheres.

A region is projected from a pole outside of it onto a plane, where circles stay circles: what is Delaunay there is
Delaunay on the sphere. Its boundary polygon, with holes, is triangulated by ears; then flips make it Delaunay, and the
longest edges are halved until none is longer than wanted. Boundary edges stay as they are, so that neighbours fit.

All regions are worked on at once: triangles of all of them in one table, and in each turn those edges that are the
first choice of both their triangles.
"""

from typing import NamedTuple

import mapbox_earcut
import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.errors import InternalError
from molviz.geometry.circles import perpendicular
from molviz.vectors import cross, dot

TURNS = 1000  # of flips or splits, never reached: each turn flips or splits what it can
ROUNDING = 1e-12  # of the fourth power of lengths: four points on a circle stay as they are


class Regions(NamedTuple):
    """p regions of spheres, bounded by l loops of m boundary points that have the region on their left."""

    point: Ints  # (m,) row of a table of points
    start: Ints  # (l + 1,) rows of each loop's points
    region: Ints  # (l,) ascending
    center: Floats  # (p, 3)
    radius: Floats  # (p,)
    pole: Floats  # (p, 3) unit direction, outside of the region


class Triangles(NamedTuple):
    """t triangles, counter-clockwise seen from outside, with k points more than the regions had."""

    point: Ints  # (t, 3) rows of the given points, and after these of ``inner``
    region: Ints  # (t,)
    inner: Floats  # (k, 3)
    inner_region: Ints  # (k,)


class Coarse(Exception):  # noqa: N818 - not an error: the caller divides the curves around these regions again
    """The boundaries of some regions are so coarse that their polygons meet themselves."""

    def __init__(self, region: Ints) -> None:
        super().__init__()
        self.region = region


class _Net(NamedTuple):
    """Triangles (t, 3) of v points, each of one region: boundary points have one row in each region."""

    triangle: Ints  # (t, 3)
    flat: Floats  # (v, 2) in the plane of the region
    region: Ints  # (v,)
    point: Ints  # (v,) row of the given points, −1 for new ones


class _Edges(NamedTuple):
    """The e edges between two triangles: a → b → c of one, b → a → d of the other."""

    one: Ints  # (e,) rows of triangles
    other: Ints  # (e,)
    a: Ints
    b: Ints
    c: Ints
    d: Ints


def triangulated(regions: Regions, place: Floats, longest: float, strict: bool = True) -> Triangles:
    """Return triangles with no edge inside a region longer than ``longest``; ``place`` (q, 3) are the points.

    Raises Coarse where boundaries are so coarse that their polygons meet themselves; unless ``strict``, only where that
    leaves no triangles that fit together.
    """
    limit = np.minimum(longest, 0.6 * regions.radius)
    owner = np.repeat(regions.region, np.diff(regions.start))
    flat = _projected(regions, owner, place[regions.point])
    net = _Net(_ears(regions, flat, strict), flat, owner, regions.point)
    net = _unique_edges(_refined(_delaunay(net), regions, limit), regions)
    new = np.flatnonzero(net.point < 0)
    number = net.point.copy()
    number[new] = len(place) + np.arange(len(new))
    inner = _lifted(regions, net.region[new], net.flat[new])
    return Triangles(number[net.triangle], net.region[net.triangle[:, 0]], inner, net.region[new])


def _projected(regions: Regions, region: Ints, place: Floats) -> Floats:
    """Stereographic coordinates (m, 2) of points, right-handed as seen from outside the sphere."""
    e, f = perpendicular(regions.pole)
    x = (place - regions.center[region]) / regions.radius[region, None]
    rest = 1 - dot(x, regions.pole[region])
    return np.column_stack([dot(x, f[region]), dot(x, e[region])]) / rest[:, None]


def _lifted(regions: Regions, region: Ints, flat: Floats) -> Floats:
    """The points (m, 3) of the spheres with these coordinates."""
    e, f = perpendicular(regions.pole)
    square = np.sum(flat**2, axis=1)[:, None]
    across = flat[:, :1] * f[region] + flat[:, 1:] * e[region]
    unit = (2 * across + (square - 1) * regions.pole[region]) / (square + 1)
    unit /= np.linalg.norm(unit, axis=1)[:, None]
    return np.asarray(regions.center[region] + regions.radius[region, None] * unit)


# ---- the first triangles


def _ears(regions: Regions, flat: Floats, strict: bool) -> Ints:
    """Triangles (t, 3) between the boundary points of each region."""
    first_loop = np.searchsorted(regions.region, np.arange(len(regions.radius) + 1)).tolist()
    start = regions.start.tolist()
    parts, coarse = [np.empty((0, 3), dtype=np.int64)], []
    for region, (begin, end) in enumerate(zip(first_loop[:-1], first_loop[1:], strict=True)):
        loops = [np.arange(start[loop], start[loop + 1]) for loop in range(begin, end)]
        loops.sort(key=lambda loop: -_signed_area(flat[loop]))  # the outer one is counter-clockwise, holes are not
        triangle, area = _cut(loops, flat)
        if (strict and area.min() < 0) or not _fits(loops, triangle):
            coarse.append(region)
        parts.append(triangle)
    if coarse:
        raise Coarse(np.array(coarse))
    return np.concatenate(parts)


def _signed_area(polygon: Floats) -> float:
    return float(np.sum(cross(polygon, np.roll(polygon, -1, axis=0)))) / 2


def _cut(loops: list[Ints], flat: Floats) -> tuple[Ints, Floats]:
    """Triangles, the more of them counter-clockwise, and their areas: a polygon that meets itself has both kinds."""
    corner = np.concatenate(loops)
    ends = np.cumsum([len(loop) for loop in loops]).astype(np.uint32)
    triangle = corner[mapbox_earcut.triangulate_float64(flat[corner], ends).astype(np.int64).reshape(-1, 3)]
    sides = [flat[triangle[:, k]] - flat[triangle[:, 0]] for k in (1, 2)]
    area = cross(*sides)
    return (triangle, area) if np.sum(area) >= 0 else (triangle[:, ::-1], -area)


def _fits(loops: list[Ints], triangle: Ints) -> bool:
    """Whether the sides of the triangles are the loops once, and all others once in either direction."""
    sides = np.stack([triangle.ravel(), np.roll(triangle, -1, axis=1).ravel()], axis=1)
    around = np.concatenate([np.stack([np.roll(loop, -1), loop], axis=1) for loop in loops])
    both = np.concatenate([sides, around])
    here, back = (np.unique(pairs, axis=0) for pairs in (both, both[:, ::-1]))
    return len(here) == len(both) and np.array_equal(here, back)


# ---- flips and splits


def _delaunay(net: _Net) -> _Net:
    """Flip edges until no triangle's circle holds the point beyond one of its edges."""
    for _ in range(TURNS):
        edges = _edges(net.triangle)
        wrong = np.flatnonzero(_wrong(net.flat, edges))
        chosen = wrong[_first_choice(edges, wrong, np.arange(len(wrong)), len(net.triangle))]
        if len(chosen) == 0:
            return net
        one, other = edges.one[chosen], edges.other[chosen]
        a, b, c, d = edges.a[chosen], edges.b[chosen], edges.c[chosen], edges.d[chosen]
        net.triangle[one] = np.stack([a, d, c], axis=1)
        net.triangle[other] = np.stack([d, b, c], axis=1)
    raise InternalError("flips of edges do not end")


def _edges(triangle: Ints) -> _Edges:
    """The edges that two triangles share."""
    begin, end, apex = triangle.ravel(), triangle[:, [1, 2, 0]].ravel(), triangle[:, [2, 0, 1]].ravel()
    key = np.minimum(begin, end) * (int(triangle.max(initial=0)) + 1) + np.maximum(begin, end)
    order = np.argsort(key, kind="stable")
    twice = np.flatnonzero(np.diff(key[order]) == 0)
    here, there = order[twice], order[twice + 1]
    return _Edges(here // 3, there // 3, begin[here], end[here], apex[here], apex[there])


def _wrong(flat: Floats, edges: _Edges) -> Bools:
    """Whether d lies in the circle of a, b, c, and the two triangles may be exchanged for a, d, c and d, b, c."""
    a, b, c = (flat[corner] - flat[edges.d] for corner in (edges.a, edges.b, edges.c))
    squares = [np.sum(side**2, axis=1) for side in (a, b, c)]
    depth = squares[0] * cross(b, c) + squares[1] * cross(c, a) + squares[2] * cross(a, b)
    scale = squares[0] + squares[1] + squares[2]
    convex = (cross(a, c) < 0) & (cross(b, c) > 0)
    return np.asarray((depth > ROUNDING * scale**2) & convex)


def _first_choice(edges: _Edges, row: Ints, rank: Ints, count: int) -> Bools:
    """Of the given edges those that come before all others (by ``rank``) of both their triangles."""
    best = np.full(count, np.iinfo(np.int64).max)
    for side in (edges.one, edges.other):
        np.minimum.at(best, side[row], rank)
    return np.asarray((best[edges.one[row]] == rank) & (best[edges.other[row]] == rank))


def _refined(net: _Net, regions: Regions, limit: Floats) -> _Net:
    """Halve the longest edges and flip, until no edge inside a region is longer than its limit."""
    for _ in range(TURNS):
        edges = _edges(net.triangle)
        region, begin = net.region[edges.a], net.flat[edges.a]
        middle = _lifted(regions, region, _middles(net.flat, edges.a, edges.b))
        half = np.linalg.norm(middle - _lifted(regions, region, begin), axis=1)  # ends may be near over the far side
        length = 2 * half / limit[region]
        long = np.flatnonzero(length > 1)
        rank = np.empty(len(long), dtype=np.int64)
        rank[np.argsort(-length[long], kind="stable")] = np.arange(len(long))
        chosen = long[_first_choice(edges, long, rank, len(net.triangle))]
        if len(chosen) == 0:
            return net
        net = _delaunay(_split(net, edges, chosen))
    raise InternalError("halving of edges does not end")


def _middles(flat: Floats, a: Ints, b: Ints) -> Floats:
    """The points (e, 2) of straight edges that are as far from either end on the sphere."""
    shrink = [np.sqrt(1 + np.sum(flat[end] ** 2, axis=1)) for end in (a, b)]
    share = (shrink[0] / (shrink[0] + shrink[1]))[:, None]
    return np.asarray(flat[a] + share * (flat[b] - flat[a]))


def _split(net: _Net, edges: _Edges, row: Ints) -> _Net:
    """Put a point on each of the given edges: four triangles for two."""
    one, other = edges.one[row], edges.other[row]
    a, b, c, d = edges.a[row], edges.b[row], edges.c[row], edges.d[row]
    new = len(net.point) + np.arange(len(row))
    middle = _middles(net.flat, a, b)
    net.triangle[one] = np.stack([a, new, c], axis=1)
    net.triangle[other] = np.stack([b, new, d], axis=1)
    more = [np.stack([new, b, c], axis=1), np.stack([new, a, d], axis=1)]
    return _Net(
        np.concatenate([net.triangle, *more]),
        np.concatenate([net.flat, middle]),
        np.concatenate([net.region, net.region[a]]),
        np.concatenate([net.point, np.full(len(row), -1)]),
    )


def _unique_edges(net: _Net, regions: Regions) -> _Net:
    """Halve edges inside a region whose two ends are connected elsewhere as well: no edge has more than two sides."""
    following = regions.point[_next_in_loop(regions)]
    for _ in range(TURNS):
        edges = _edges(net.triangle)
        ends = np.sort(np.stack([net.point[edges.a], net.point[edges.b]], axis=1), axis=1)
        across = np.flatnonzero(ends[:, 0] >= 0)
        around = np.sort(np.stack([regions.point, following], axis=1), axis=1)
        count = int(regions.point.max(initial=0)) + 1
        key, known = ends[across] @ [count, 1], np.unique(around @ [count, 1])
        _, number, times = np.unique(key, return_inverse=True, return_counts=True)
        doubled = across[(times[number] > 1) | np.isin(key, known)]
        chosen = doubled[_first_choice(edges, doubled, np.arange(len(doubled)), len(net.triangle))]
        if len(chosen) == 0:
            return net
        net = _split(net, edges, chosen)
    raise InternalError("edges stay doubled")


def _next_in_loop(regions: Regions) -> Ints:
    """For each boundary point the row of the next one of its loop."""
    row = np.arange(1, len(regions.point) + 1)
    row[regions.start[1:] - 1] = regions.start[:-1]
    return row
