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

    def take(self, rows: Ints) -> "Spheres":
        """Return the given spheres, in that order."""
        return Spheres(self.center[rows], self.radius[rows])

    def box(self) -> tuple[Floats, Floats]:
        """Return the corners (3,), (3,) of the bounding box of n ≥ 1 balls."""
        reach = self.radius[:, None]
        return np.min(self.center - reach, axis=0), np.max(self.center + reach, axis=0)


def spheres_of(
    molecule: Molecule, table: str = DEFAULT, scale: float = 1.0, probe: float = 0.0
) -> tuple[Spheres, tuple[str, ...]]:
    """Return a sphere per atom, of ``scale`` times its radius in the table plus ``probe`` ångström, and warnings."""
    radius, warnings = radii(molecule, table)
    return Spheres(molecule.position, scale * radius + probe), warnings
