"""Controlled perturbation: a copy of the spheres in which no four things meet by accident.

Files carry three decimals, ideal geometry and symmetry, so tangent spheres, coinciding outlines and four spheres
through a point are the normal case. Following Halperin & Shelton 1998 ("A perturbation scheme for spherical
arrangements with application to molecular modeling"), drawings are computed for a copy that is displaced by a
reproducible, invisible amount; whoever finds the copy degenerate after all asks for the next one.
"""

import math
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from molviz.arrays import Bools, Floats, Ints, distinct
from molviz.errors import InternalError
from molviz.model.spheres import Balls, Spheres

DISPLACEMENT = 5e-5  # of a sphere's radius: 1e-4 Å for an atom, below a file's precision and far above rounding
NUDGE = 2e-8  # of a radius, for numbers: below 1e-7 Å for balls up to 5 Å, and above COINCIDE, where ties have rules
GROWTH = 2.0  # of the displacement from one attempt to the next: in crystals along axes its square decides, too small
ATTEMPTS = 8  # copies tried; of a molecule the second is needed about once in ten thousand pictures

NONE: Ints = np.empty(0, dtype=np.int64)

T = TypeVar("T")


class Degenerate(Exception):  # noqa: N818 - not an error: the caller asks for the next copy
    """The spheres are not in general position: how curves join would be a matter of rounding.

    ``rows`` are those of what is concerned, where that is known: vertices of a map, or sticks of a scene.
    """

    def __init__(self, rows: Ints = NONE) -> None:
        super().__init__()
        self.rows = rows


def first_general(query: Callable[[int], T]) -> T:
    """Return the query's answer for the first attempt, from 0, for which it does not raise ``Degenerate``.

    Raises InternalError if (never seen) no attempt helps.
    """
    for attempt in range(ATTEMPTS):
        try:
            return query(attempt)
        except Degenerate:
            continue
    raise InternalError(f"the spheres stay in special position after {ATTEMPTS} perturbations")


def displaced(spheres: Spheres, rows: Ints, attempt: int) -> Spheres:
    """Return the spheres displaced as those of the given rows (n,) of a scene are, each within itself.

    Radii shrink by a little more than the displacement, so that spheres which touch from outside come apart instead
    of opening a sliver of a crease.
    """
    direction = _unit_vectors(rows, attempt)
    center = spheres.center + direction * (DISPLACEMENT * GROWTH**attempt * spheres.radius)[:, None]
    return Spheres(center, spheres.radius * shrinkage(attempt))


def shrinkage(attempt: int) -> float:
    """Return by what the radii of an attempt are multiplied."""
    return 1.0 - 1.01 * DISPLACEMENT * GROWTH**attempt


def nudged(spheres: Spheres, times: Ints) -> Spheres:
    """Return the n balls, those with ``times`` (n,) above 0 displaced in a direction that depends on that number."""
    center = spheres.center.copy()
    for number in np.unique(times[times > 0]).tolist():
        rows = np.flatnonzero(times == number)
        center[rows] += _unit_vectors(rows, number) * (NUDGE * spheres.radius[rows])[:, None]
    return Spheres(center, spheres.radius)


def first_of_each(balls: Balls) -> Ints:
    """Return the rows of n balls less those that are equal to an earlier one: equal ones have equal sums of columns."""
    total = np.concatenate([np.empty(0), *(_total(part) for part in balls.parts())])
    order = np.argsort(total, kind="stable")
    again = np.flatnonzero(total[order][1:] == total[order][:-1])
    rows = distinct(order[np.append(again, again + 1)])
    first: Bools = np.ones(len(total), dtype=bool)
    first[rows] = False
    table = np.column_stack(balls.take(rows))
    first[rows[np.unique(table, axis=0, return_index=True)[1]]] = True
    return np.flatnonzero(first)


def _total(spheres: Spheres) -> Floats:
    x, y, z = spheres.center.T
    return np.asarray(x + math.pi * y + math.e * z + spheres.radius)


def _unit_vectors(rows: Ints, attempt: int) -> Floats:
    """Directions (n, 3), uniform on the sphere by Archimedes' map, from a hash of the row number."""
    height = 2.0 * _hash_to_unit(rows, 2 * attempt) - 1.0
    angle = 2.0 * np.pi * _hash_to_unit(rows, 2 * attempt + 1)
    around = np.sqrt(1.0 - height**2)
    return np.stack([around * np.cos(angle), around * np.sin(angle), height], axis=1)


def _hash_to_unit(rows: Ints, stream: int) -> Floats:
    """Numbers in [0, 1) by the finaliser of SplitMix64 (Steele, Lea & Flood 2014): the same on every machine."""
    seed = (stream + 1) * 0x9E3779B97F4A7C15 % 2**64
    x = (rows.astype(np.uint64) + np.uint64(1)) * np.uint64(0xD1342543DE82EF95) + np.uint64(seed)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return np.asarray((x ^ (x >> np.uint64(31))) >> np.uint64(11), dtype=np.float64) / 2.0**53
