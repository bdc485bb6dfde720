"""Slow and obvious answers to compare with."""

import numpy as np

from molviz.model.spheres import Spheres


def random_spheres(seed: int, count: int, extent: float = 6.0, spread: float = 2.0) -> Spheres:
    """Uniform centres in a cube, radii over a factor of ``spread``."""
    random = np.random.default_rng(seed)
    return Spheres(random.uniform(0, extent, (count, 3)), random.uniform(1.0, spread, count))


def all_pairs(spheres: Spheres) -> set[tuple[int, int]]:
    gap = np.linalg.norm(spheres.center[:, None] - spheres.center, axis=2)
    meets = gap < spheres.radius[:, None] + spheres.radius
    return {(int(i), int(j)) for i, j in np.argwhere(meets) if i < j}


def seen_at(spheres: Spheres, page: np.ndarray) -> np.ndarray:
    """The row of the sphere seen from +z at each page point (m, 2), −1 for none."""
    height = heights(spheres, page)
    return np.where(height.max(axis=1) > -np.inf, height.argmax(axis=1), -1)


def heights(spheres: Spheres, page: np.ndarray) -> np.ndarray:
    """z of each sphere's surface above each page point, −∞ beside it."""
    flat = np.sum((page[:, None] - spheres.center[:, :2]) ** 2, axis=2)
    with np.errstate(invalid="ignore"):
        z = spheres.center[:, 2] + np.sqrt(spheres.radius**2 - flat)
    return np.where(np.isnan(z), -np.inf, z)


def winding(x: np.ndarray, y: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Winding number of the closed polygon x, y (k,) about each point (m, 2): crossings of the ray to its right."""
    px, py = points[:, :1], points[:, 1:]
    next_x, next_y = np.roll(x, -1), np.roll(y, -1)
    below = y <= py
    crosses = below != (next_y <= py)
    point, edge = np.nonzero(crosses)
    dx, dy = next_x[edge] - x[edge], next_y[edge] - y[edge]
    right = (x[edge] - px[point, 0]) * np.abs(dy) + dx * np.sign(dy) * (py[point, 0] - y[edge]) > 0
    turn = np.where(below[point, edge], 1, -1)
    return np.bincount(point[right], turn[right], len(points)).astype(int)
