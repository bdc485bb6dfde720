"""What was read, and whether the hard sphere model holds (Halperin & Overmars 1994, Theorem 2.1)."""

from typing import Any

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.geometry.components import component_labels
from molviz.geometry.grid import meeting_pairs
from molviz.geometry.slabs import slabs
from molviz.model.spheres import Spheres
from molviz.pipeline.inputs import Loaded
from molviz.vectors import length


def info(loaded: Loaded) -> dict[str, Any]:
    """Return what ``molviz info --json`` prints of one model."""
    molecule, spheres = loaded.molecule, loaded.spheres
    count, parts = touching(spheres)
    symbols, numbers = np.unique(molecule.element, return_counts=True)
    return {
        "file": loaded.source,
        "format": loaded.format,
        "model": loaded.model,
        "models": loaded.models,
        "title": molecule.name,
        "atoms": len(molecule),
        "bonds": len(molecule.bonds),
        "elements": dict(zip(symbols.tolist(), numbers.tolist(), strict=True)),
        "k": float(spheres.radius.max() / spheres.radius.min()),
        "rho": closest_ratio(spheres),
        "max_neighbours": int(count.max()),
        "mean_neighbours": float(count.mean()),
        "components": parts,
    }


def touching(spheres: Spheres) -> tuple[Ints, int]:
    """Return how many spheres each of n intersects (n,), and how many components they are, slab by slab."""
    count, label = np.zeros(len(spheres.radius), dtype=np.int64), np.arange(len(spheres.radius))
    for rows, own in slabs(spheres):
        one, other = meeting_pairs(spheres.take(rows))
        many = np.bincount(one, minlength=len(rows)) + np.bincount(other, minlength=len(rows))
        count[rows[own]] = many[own]
        label = component_labels(label[rows[one]], label[rows[other]], len(label))[label]
    return count, int(label.max()) + 1


def closest_ratio(spheres: Spheres) -> float | None:
    """Return ρ: the least distance of a sphere's centre to another centre, in units of its own radius; None for one.

    Pairs nearer than 2 s give it once it is no more than 2 s / r_max, which pairs farther apart cannot undercut.
    """
    largest, reach = float(spheres.radius.max()), float(spheres.radius.max())
    while len(spheres.radius) > 1:
        wide = Spheres(spheres.center, np.full(len(spheres.radius), reach))
        ratio = min(_least_ratio(spheres.take(rows), reach) for rows, _ in slabs(wide))
        if ratio <= 2 * reach / largest:
            return ratio
        reach *= 2
    return None


def _least_ratio(spheres: Spheres, reach: float) -> float:
    """The same of pairs nearer than twice the reach, infinite where there are none."""
    first, second = meeting_pairs(Spheres(spheres.center, np.full(len(spheres.radius), reach)))
    gap: Floats = length(spheres.center[second] - spheres.center[first])
    return float(np.min(gap / np.maximum(spheres.radius[first], spheres.radius[second]), initial=np.inf))
