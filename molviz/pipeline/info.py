"""What was read, and whether the hard sphere model holds (Halperin & Overmars 1994, Theorem 2.1)."""

from typing import Any

import numpy as np

from molviz.arrays import Floats
from molviz.geometry.grid import Neighbours, neighbours
from molviz.model.spheres import Spheres
from molviz.pipeline.inputs import Loaded


def info(loaded: Loaded) -> dict[str, Any]:
    """Return what ``molviz info --json`` prints of one model."""
    near = neighbours(loaded.spheres)
    count = np.diff(near.start)
    symbols, numbers = np.unique(loaded.molecule.element, return_counts=True)
    ratio = closest_ratio(loaded.spheres, near)
    return {
        "file": loaded.source,
        "format": loaded.format,
        "model": loaded.model,
        "models": loaded.models,
        "title": loaded.molecule.name,
        "atoms": len(loaded.molecule),
        "elements": dict(zip(symbols.tolist(), numbers.tolist(), strict=True)),
        "k": float(loaded.spheres.radius.max() / loaded.spheres.radius.min()),
        "rho": None if np.isinf(ratio) else ratio,
        "max_neighbours": int(count.max()),
        "mean_neighbours": float(count.mean()),
        "components": components(near),
    }


def closest_ratio(spheres: Spheres, near: Neighbours) -> float:
    """Return ρ: the least distance of a sphere's centre to another centre, in units of its own radius.

    Only intersecting spheres are looked at; where none intersect, ρ is infinite (above 1 in any case).
    """
    owner = np.repeat(np.arange(len(near.start) - 1), np.diff(near.start))
    if len(owner) == 0:
        return float("inf")
    gap: Floats = np.linalg.norm(spheres.center[near.item] - spheres.center[owner], axis=1)
    return float(np.min(gap / spheres.radius[owner]))


def components(near: Neighbours) -> int:
    """Return the number of connected components of the union of the balls.

    Each sphere takes the least label of its neighbours, and labels are shortened by following them, until nothing
    changes: few rounds even for long chains.
    """
    count = len(near.start) - 1
    owner = np.repeat(np.arange(count), np.diff(near.start))
    label = np.arange(count)
    while True:
        least = label.copy()
        np.minimum.at(least, owner, label[near.item])
        np.minimum.at(least, label, least.copy())
        least = least[least]
        if np.array_equal(least, label):
            return len(np.unique(label))
        label = least
