"""RDKit: ``Mol``, one model per conformer."""

from typing import Any

import numpy as np

from molviz.adapters.plain import SOURCE, plain_models
from molviz.errors import InputError
from molviz.model.elements import UNKNOWN, symbol_of
from molviz.model.molecule import Molecule
from molviz.readers.atoms import Models

DEUTERIUM = 2  # the isotope of hydrogen that molviz keeps apart


def models_of_mol(mol: Any) -> Models:
    """Return one molecule per conformer, bonds left aside; raises InputError where there is no conformer."""
    if not mol.GetNumConformers():
        raise InputError("the RDKit Mol has no conformer; expected coordinates, for example of EmbedMolecule", SOURCE)
    name = mol.GetProp("_Name") if mol.HasProp("_Name") else ""
    atoms = list(mol.GetAtoms())
    element = np.array([_symbol(atom) for atom in atoms], dtype=str)
    columns = _residues([atom.GetPDBResidueInfo() for atom in atoms])
    return plain_models(*(Molecule.of(name, one.GetPositions(), element, **columns) for one in mol.GetConformers()))


def _symbol(atom: Any) -> str:
    if atom.GetAtomicNum() == 1 and atom.GetIsotope() == DEUTERIUM:
        return "D"
    return symbol_of(atom.GetSymbol()) or UNKNOWN


def _residues(infos: list[Any]) -> dict[str, list[Any]]:
    """The columns that an RDKit molecule has if it was read from a PDB file or built from a sequence."""
    if not all(infos):
        return {}
    return {
        "atom_name": [info.GetName().strip() for info in infos],
        "residue_name": [info.GetResidueName().strip() for info in infos],
        "residue": [f"{info.GetResidueNumber()}{info.GetInsertionCode().strip()}" for info in infos],
        "chain": [info.GetChainId().strip() for info in infos],
        "hetero": [info.GetIsHeteroAtom() for info in infos],
        "bfactor": [info.GetTempFactor() for info in infos],
    }
