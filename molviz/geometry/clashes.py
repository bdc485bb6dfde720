"""Which balls of one scene overlap those of another, wherever the other is put."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.errors import InputError
from molviz.geometry.cubes import BLOCK_ROWS, BallIndex
from molviz.geometry.rows import offsets
from molviz.model.spheres import Spheres

MOST_PAIRS = 20_000_000  # in one answer: 800 MB, and as much again while it is put together
SLACK = 1e-9  # by which balls reach farther, in radii: rounding in a tolerance then loses no pair


class Placements(NamedTuple):
    """m rigid motions: a point x comes to lie at R x + t."""

    rotation: Floats  # (m, 3, 3)
    translation: Floats  # (m, 3) ångström


@dataclass(frozen=True, eq=False, repr=False)
class Clashes:
    """Pairs of balls that overlap, ordered by placement, then by b, then by a."""

    placement: Ints  # (k,)
    a: Ints  # (k,) row of the ball that stays
    b: Ints  # (k,) row of the ball that is placed
    distance: Floats  # (k,) ångström, of their centres
    overlap: Floats  # (k,) ångström, r_a + r_b − distance
    start: Ints  # (m + 1,) pairs of placement q: start[q] up to start[q + 1]

    def __repr__(self) -> str:
        return f"<Clashes: {len(self.a)} pairs in {len(self.start) - 1} placements>"

    @property
    def count(self) -> Ints:
        """Return the number of pairs of each placement (m,)."""
        return np.diff(self.start)

    @property
    def deepest(self) -> Floats:
        """Return the largest overlap of each placement (m,) in ångström, −∞ where nothing overlaps."""
        largest = np.full(len(self.start) - 1, -np.inf)
        np.maximum.at(largest, self.placement, self.overlap)
        return largest


class _Pairs(NamedTuple):
    """The columns of ``Clashes`` that have a row for each pair."""

    placement: Ints
    a: Ints
    b: Ints
    distance: Floats
    overlap: Floats


STAYS = Placements(np.eye(3)[None], np.zeros((1, 3)))


def clashes(
    index: BallIndex, other: Spheres, placements: Placements = STAYS, tolerance: float = 0.0, most: int = MOST_PAIRS
) -> Clashes:
    """Return the pairs that overlap by more than ``tolerance`` ångström; a negative one finds gaps narrower than that.

    Each placement takes time linear in the number of ``other``'s balls, however many the index has. Raises InputError
    where there are more pairs than ``most``.
    """
    none, nothing = np.empty(0, dtype=np.int64), np.empty(0)
    parts: list[_Pairs] = [_Pairs(none, none, none, nothing, nothing)]
    total = 0
    for part in _overlapping(index, other, placements, tolerance):
        total += len(part.a)
        if total > most:
            raise InputError(f"tolerance: {tolerance:g} Å leaves more than {most:,} pairs; expected a larger one")
        parts.append(part)
    pairs = _Pairs(*(np.concatenate(column) for column in zip(*parts, strict=True)))
    return Clashes(**pairs._asdict(), start=offsets(pairs.placement, len(placements.rotation)))


def _overlapping(index: BallIndex, other: Spheres, placements: Placements, tolerance: float) -> Iterator[_Pairs]:
    """The pairs in blocks."""
    count = len(other.radius)
    largest = float(other.radius.max())
    reach = largest - tolerance + SLACK * (largest + abs(tolerance) + index.largest)
    step = max(BLOCK_ROWS // count, 1)
    for begin in range(0, len(placements.rotation), step):
        rotation, translation = (column[begin : begin + step] for column in placements)
        center = (other.center @ rotation.transpose(0, 2, 1) + translation[:, None]).reshape(-1, 3)
        for near in index.meetings(center, np.full(len(center), reach)):
            placement, b = np.divmod(near.query, count)
            distance = np.sqrt(near.gap)
            overlap = other.radius[b] + index.spheres.radius[near.ball] - distance
            deep = overlap > tolerance
            yield _Pairs(begin + placement[deep], near.ball[deep], b[deep], distance[deep], overlap[deep])
