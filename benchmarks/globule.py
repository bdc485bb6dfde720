"""Balls as dense as those of a protein, as many as one likes."""

import numpy as np

from molviz.model.spheres import Spheres


def globule(count: int) -> Spheres:
    """Jittered points 2.2 Å apart, the ``count`` nearest to the origin, with radii of carbon, nitrogen and oxygen."""
    random = np.random.default_rng(1)
    half = int(np.ceil((count / 4) ** (1 / 3))) + 1
    points = 2.2 * np.array(list(np.ndindex(*[2 * half] * 3)), dtype=float) - 2.2 * half
    points += random.uniform(-0.5, 0.5, points.shape)
    nearest = np.argsort(np.linalg.norm(points, axis=1))[:count]
    return Spheres(points[nearest], random.choice([1.7, 1.55, 1.52], count))
