"""Scenes of discs, as tables and as the oracle's rows."""

import numpy as np

from molviz.model.spheres import Spheres
from tests import disc_oracle


def scene_of(discs: list[disc_oracle.Disc]) -> Spheres:
    table = np.array(discs, dtype=float).reshape(-1, 4)
    return Spheres(table[:, :3], table[:, 3])


def discs_of(scene: Spheres) -> list[disc_oracle.Disc]:
    return [(*map(float, center), float(radius)) for center, radius in zip(*scene, strict=True)]


def random_discs(rng: np.random.Generator) -> Spheres:
    """Up to 60 discs: of one size, of sizes 50 to 1, or on a lattice with equal depths, touching and coincident."""
    n, kind = int(rng.integers(1, 60)), rng.integers(3)
    if kind == 2:
        return Spheres(rng.integers(0, 6, (n, 3)).astype(float), rng.integers(1, 4, n) / 2.0)
    radius = np.full(n, 0.15) if kind == 0 else 0.5 * 50.0 ** -rng.random(n)
    return Spheres(rng.random((n, 3)), radius)
