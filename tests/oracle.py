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
