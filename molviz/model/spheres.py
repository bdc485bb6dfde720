"""The table that all geometry starts from."""

from collections.abc import Iterator
from typing import NamedTuple, Protocol

import numpy as np

from molviz.arrays import Floats, Ints


class Balls(Protocol):
    """What is asked of n balls, which may be too many for all their centres to be kept."""

    @property
    def radius(self) -> Floats:
        """The radii (n,) in ångström."""

    @property
    def cuts(self) -> Ints:
        """Where parts of them, which lie together, begin and end: rows (parts + 1,)."""

    def take(self, rows: Ints) -> "Spheres":
        """Return the given balls, in that order."""

    def whole(self) -> "Spheres":
        """Return all of them."""

    def parts(self) -> Iterator["Spheres"]:
        """Yield the balls of each part that has any."""


class Spheres(NamedTuple):
    """n spheres; row i is atom i everywhere."""

    center: Floats  # (n, 3) ångström
    radius: Floats  # (n,) ångström

    def __repr__(self) -> str:
        return f"<Spheres: {len(self.radius)}>"

    def take(self, rows: Ints) -> "Spheres":
        """Return the given spheres, in that order."""
        return Spheres(self.center.take(rows, axis=0), self.radius[rows])

    @property
    def cuts(self) -> Ints:
        """All are one part: they are kept anyway."""
        return np.array([0, len(self.radius)])

    def whole(self) -> "Spheres":
        """Return the spheres themselves."""
        return self

    def parts(self) -> Iterator["Spheres"]:
        """Yield all of them."""
        yield self

    def enlarged(self, scale: float, probe: float) -> "Spheres":
        """Return the spheres with ``scale`` times their radii plus ``probe`` ångström."""
        return Spheres(self.center, scale * self.radius + probe)

    def box(self) -> tuple[Floats, Floats]:
        """Return the corners (3,), (3,) of the bounding box of n ≥ 1 balls."""
        reach = self.radius[:, None]
        return np.min(self.center - reach, axis=0), np.max(self.center + reach, axis=0)


def box_of(balls: Balls) -> tuple[Floats, Floats]:
    """Return the corners (3,), (3,) of the bounding box of n ≥ 1 balls."""
    low, high = zip(*(part.box() for part in balls.parts()), strict=True)
    return np.min(low, axis=0), np.max(high, axis=0)
