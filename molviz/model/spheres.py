"""The table that all geometry starts from."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.model.molecule import Molecule
from molviz.model.radii import DEFAULT, radii


class Spheres(NamedTuple):
    """n spheres; row i is atom i everywhere."""

    center: Floats  # (n, 3) ångström
    radius: Floats  # (n,) ångström

    def __repr__(self) -> str:
        return f"<Spheres: {len(self.radius)}>"

    def take(self, rows: Ints) -> "Spheres":
        """Return the given spheres, in that order."""
        return Spheres(self.center.take(rows, axis=0), self.radius[rows])

    def enlarged(self, scale: float, probe: float) -> "Spheres":
        """Return the spheres with ``scale`` times their radii plus ``probe`` ångström."""
        return Spheres(self.center, scale * self.radius + probe)

    def box(self) -> tuple[Floats, Floats]:
        """Return the corners (3,), (3,) of the bounding box of n ≥ 1 balls."""
        reach = self.radius[:, None]
        return np.min(self.center - reach, axis=0), np.max(self.center + reach, axis=0)


def spheres_of(molecule: Molecule, table: str = DEFAULT) -> tuple[Spheres, tuple[str, ...]]:
    """Return a sphere per atom, of its radius in the table, and warnings."""
    radius, warnings = radii(molecule, table)
    return Spheres(molecule.position, radius), warnings
