"""Random balls and sticks without clashes, and what a line of sight hits of them."""

import numpy as np

from molviz.model.spheres import Spheres
from molviz.model.sticks import Sticks


def random_skeleton(seed: int, count: int, least: float = 2.1) -> tuple[np.ndarray, np.ndarray]:
    """Centres of a branched chain with bonds of about 1.5, angles above 95 degrees and no other two nearer than
    ``least``; and its bonds."""
    rng = np.random.default_rng(seed)
    centers, bonds = [np.zeros(3)], []
    for _ in range(200 * count):
        if len(centers) == count:
            break
        parent = int(rng.integers(len(centers)))
        step = rng.normal(size=3)
        step *= rng.uniform(1.4, 1.6) / np.linalg.norm(step)
        place = centers[parent] + step
        others = [other for row, other in enumerate(centers) if row != parent]
        if all(np.linalg.norm(place - other) > least for other in others):
            bonds.append((parent, len(centers)))
            centers.append(place)
    return np.array(centers), np.array(bonds, dtype=np.int64).reshape(-1, 2)


def ball_and_stick(seed: int, count: int) -> tuple[Spheres, Sticks]:
    centers, bonds = random_skeleton(seed, count)
    rng = np.random.default_rng(seed + 1)
    radius = rng.uniform(0.28, 0.5, len(centers))
    return Spheres(centers, radius), plain_sticks(bonds, np.full(len(bonds), 0.12))


def licorice(seed: int, count: int, width: float = 0.22) -> tuple[Spheres, Sticks]:
    centers, bonds = random_skeleton(seed, count)
    return Spheres(centers, np.full(len(centers), width)), plain_sticks(bonds, np.full(len(bonds), width))


def plain_sticks(bonds: np.ndarray, radius: np.ndarray) -> Sticks:
    return Sticks(bonds[:, 0], bonds[:, 1], radius, np.zeros((len(bonds), 3)))


def seen_solids(
    spheres: Spheres, sticks: Sticks, origin: np.ndarray, ray: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The solid (half sticks after the spheres) that each ray (m, 3) meets first, −1 for none, and by how much it is
    nearer than the next."""
    ray = ray / np.linalg.norm(ray, axis=1)[:, None]
    far = np.concatenate([_into_balls(spheres, origin, ray), *_into_sticks(spheres, sticks, origin, ray)])
    number = np.append(np.arange(len(spheres.radius)), len(spheres.radius) + np.arange(2 * len(sticks.radius)))
    order = np.argsort(far, axis=0)
    first, second = np.take_along_axis(far, order[:2], axis=0) if len(far) > 1 else (far[0], np.full(len(ray), np.inf))
    with np.errstate(invalid="ignore"):
        margin = np.where(np.isinf(first), np.inf, second - first)
    return np.where(np.isinf(first), -1, number[order[0]]), margin


def _into_balls(spheres: Spheres, origin: np.ndarray, ray: np.ndarray) -> np.ndarray:
    offset = spheres.center[:, None] - origin
    along = np.sum(offset * ray, axis=2)
    square = spheres.radius[:, None] ** 2 - np.sum((offset - along[..., None] * ray) ** 2, axis=2)
    return np.where(square > 0, along - np.sqrt(np.maximum(square, 0)), np.inf)


def _into_sticks(spheres: Spheres, sticks: Sticks, origin: np.ndarray, ray: np.ndarray) -> list[np.ndarray]:
    rows = []
    for first, second, radius, offset in zip(*sticks, strict=True):
        start = spheres.center[first] + offset
        length = np.linalg.norm(spheres.center[second] - spheres.center[first])
        u = (spheres.center[second] - spheres.center[first]) / length
        a, b = ray - np.outer(ray @ u, u), (origin - start) - np.outer((origin - start) @ u, u)
        aa, ab, bb = np.sum(a * a, axis=1), np.sum(a * b, axis=1), np.sum(b * b, axis=1) - radius**2
        square = ab**2 - aa * bb
        far = np.where(square > 0, (-ab - np.sqrt(np.maximum(square, 0))) / aa, np.inf)
        known = np.isfinite(far)
        place = origin - start + np.where(known, far, 0)[:, None] * ray
        along = np.where(known, np.sum(place * u, axis=1), -1)
        for low, high in ((0, length / 2), (length / 2, length)):
            rows.append(np.where((along >= low) & (along < high), far, np.inf)[None])
    return rows


def parallel_bonds(seed: int, count: int) -> tuple[Spheres, Sticks]:
    """Single, double and triple bonds between balls that hold them."""
    centers, bonds = random_skeleton(seed, count)
    rng = np.random.default_rng(seed + 2)
    rows = []
    for first, second in bonds:
        u = (centers[second] - centers[first]) / np.linalg.norm(centers[second] - centers[first])
        across = np.cross(u, rng.normal(size=3))
        across /= np.linalg.norm(across)
        for offset in ([0.0], [-0.12, 0.12], [-0.18, 0.0, 0.18])[int(rng.integers(3))]:
            rows.append((first, second, 0.06, offset * across))
    first, second, radius, offset = zip(*rows, strict=True) if rows else ([], [], [], np.empty((0, 3)))
    spheres = Spheres(centers, rng.uniform(0.38, 0.5, len(centers)))
    return spheres, Sticks(np.array(first, int), np.array(second, int), np.array(radius, float), np.array(offset))
