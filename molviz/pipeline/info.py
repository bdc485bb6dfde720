"""What was read, and whether the hard sphere model holds (Halperin & Overmars 1994, Theorem 2.1)."""

from typing import Any

import numpy as np

from molviz.arrays import Floats
from molviz.geometry.components import components
from molviz.geometry.grid import intersecting_pairs, neighbours
from molviz.model.spheres import Spheres
from molviz.pipeline.inputs import Loaded
from molviz.vectors import length


def info(loaded: Loaded) -> dict[str, Any]:
    """Return what ``molviz info --json`` prints of one model."""
    near = neighbours(loaded.spheres)
    count = np.diff(near.start)
    symbols, numbers = np.unique(loaded.molecule.element, return_counts=True)
    return {
        "file": loaded.source,
        "format": loaded.format,
        "model": loaded.model,
        "models": loaded.models,
        "title": loaded.molecule.name,
        "atoms": len(loaded.molecule),
        "bonds": len(loaded.molecule.bonds),
        "elements": dict(zip(symbols.tolist(), numbers.tolist(), strict=True)),
        "k": float(loaded.spheres.radius.max() / loaded.spheres.radius.min()),
        "rho": closest_ratio(loaded.spheres),
        "max_neighbours": int(count.max()),
        "mean_neighbours": float(count.mean()),
        "components": components(np.repeat(np.arange(len(count)), count), near.item, len(count)),
    }


def closest_ratio(spheres: Spheres) -> float | None:
    """Return ρ: the least distance of a sphere's centre to another centre, in units of its own radius; None for one.

    Pairs nearer than 2 s give it once it is no more than 2 s / r_max, which pairs farther apart cannot undercut.
    """
    largest, reach = float(spheres.radius.max()), float(spheres.radius.max())
    while len(spheres.radius) > 1:
        first, second = intersecting_pairs(Spheres(spheres.center, np.full(len(spheres.radius), reach)))
        gap: Floats = length(spheres.center[second] - spheres.center[first])
        larger = np.maximum(spheres.radius[first], spheres.radius[second])
        ratio = float(np.min(gap / larger, initial=np.inf))
        if ratio <= 2 * reach / largest:
            return ratio
        reach *= 2
    return None
