"""A molecule: named atoms in space, as a file described them."""

from dataclasses import dataclass, fields

import numpy as np

from molviz.arrays import Floats, Ints, Strings


@dataclass(frozen=True)
class Molecule:
    """n atoms in columns; row k of every column is the same atom.

    ``residue`` holds number and insertion code as one text (``"56A"``), ``residue_name`` the name (``"CYS"``); both
    are empty where the format has no residues. ``element`` is the symbol as usually written (``"Fe"``), ``"X"``
    where unknown; D is kept apart from H. ``radius`` is NaN where the radii table decides, else the file's own.
    ``water`` is not stored: see ``molviz.model.selection``. ``row`` is the atom's row in the model it was read from.
    """

    name: str
    position: Floats  # (n, 3) ångström
    element: Strings  # (n,)
    atom_name: Strings  # (n,)
    residue_name: Strings  # (n,)
    residue: Strings  # (n,)
    chain: Strings  # (n,)
    bfactor: Floats  # (n,) Å², NaN where the format has none
    radius: Floats  # (n,) ångström or NaN
    row: Ints  # (n,)

    def __len__(self) -> int:
        return len(self.position)

    def take(self, rows: Ints) -> "Molecule":
        """Return the molecule of the given atoms, in that order."""
        columns = {field.name: getattr(self, field.name)[rows] for field in fields(self) if field.name != "name"}
        return Molecule(name=self.name, **columns)

    @staticmethod
    def of(name: str, position: Floats, element: Strings, **columns: object) -> "Molecule":
        """Return a molecule whose missing columns are empty texts, NaN and the natural row numbers."""
        n = len(position)
        text, number = np.full(n, ""), np.full(n, np.nan)
        default: dict[str, object] = {
            "atom_name": element, "residue_name": text, "residue": text, "chain": text,
            "bfactor": number, "radius": number, "row": np.arange(n),
        }  # fmt: skip
        return Molecule(name=name, position=position, element=element, **(default | columns))  # type: ignore[arg-type]
