"""ASE: ``Atoms``, with what its reader of PDB files keeps of residues."""

from typing import Any

import numpy as np

from molviz.adapters.plain import plain_models
from molviz.model.elements import UNKNOWN, symbol_of
from molviz.model.molecule import Molecule
from molviz.readers.atoms import Models

COLUMNS = {"atomtypes": "atom_name", "residuenames": "residue_name", "residuenumbers": "residue", "bfactor": "bfactor"}


def models_of_atoms(atoms: Any) -> Models:
    """Return the atoms as one molecule, named by its formula; the cell is left aside."""
    element = np.array([symbol_of(text) or UNKNOWN for text in atoms.get_chemical_symbols()], dtype=str)
    columns = {ours: atoms.arrays[theirs] for theirs, ours in COLUMNS.items() if theirs in atoms.arrays}
    return plain_models(Molecule.of(atoms.get_chemical_formula(), atoms.get_positions(), element, **columns))
