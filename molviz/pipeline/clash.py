"""``molviz clash``: two models → the pairs of their atoms that overlap, by name, the deepest first."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Ints
from molviz.geometry.clashes import STAYS, Placements, clashes
from molviz.geometry.cubes import BallIndex
from molviz.pipeline.inputs import Loaded
from molviz.pipeline.measure import ids

MOST_PAIRS = 1_000_000  # in a table, 3 GB of text and objects as JSON


class Pair(NamedTuple):
    """Two atoms that overlap: rows of the models that they were read from, and names as ``measure`` has them."""

    a: int
    a_id: str
    b: int
    b_id: str
    distance: float  # ångström, of the centres
    overlap: float  # ångström, the sum of the radii less the distance


def clash(a: Loaded, b: Loaded, placement: Placements | None, tolerance: float) -> tuple[Pair, ...]:
    """Return the atoms of ``a`` and ``b``, where it is put, that overlap by more than ``tolerance`` ångström.

    The deepest go first, equal ones by row. Raises InputError where there are more than ``MOST_PAIRS``.
    """
    found = clashes(BallIndex(a.spheres), b.spheres, placement or STAYS, tolerance, MOST_PAIRS)
    order = np.lexsort((found.b, found.a, -found.overlap))
    rows = found.a[order], found.b[order]
    named = (column for one, row in zip((a, b), rows, strict=True) for column in _named(one, row))
    return tuple(map(Pair, *named, found.distance[order].tolist(), found.overlap[order].tolist()))


def _named(loaded: Loaded, row: Ints) -> tuple[list[int], list[str]]:
    return loaded.molecule.row[row].tolist(), ids(loaded.molecule, "atom")[row].tolist()
