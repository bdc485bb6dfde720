"""RDKit: ``Mol``, one model per conformer."""

from typing import Any

import numpy as np

from molviz.adapters.plain import SOURCE, plain_models
from molviz.errors import InputError
from molviz.model.bonds import AROMATIC, NO_BONDS, Bonds
from molviz.model.elements import UNKNOWN, symbol_of
from molviz.model.molecule import Molecule
from molviz.readers.atoms import Models

_ORDERS = {"DOUBLE": 2.0, "TRIPLE": 3.0, "AROMATIC": AROMATIC}  # all others that are bonds: 1
_HYDROGEN_BOND = "HYDROGEN"
DEUTERIUM = 2  # the isotope of hydrogen that molviz keeps apart


def models_of_mol(mol: Any) -> Models:
    """Return one molecule per conformer, with the bonds; raises InputError where there is no conformer."""
    if not mol.GetNumConformers():
        raise InputError("the RDKit Mol has no conformer; expected coordinates, for example of EmbedMolecule", SOURCE)
    name = mol.GetProp("_Name") if mol.HasProp("_Name") else ""
    atoms = list(mol.GetAtoms())
    element = np.array([_symbol(atom) for atom in atoms], dtype=str)
    columns = _residues([atom.GetPDBResidueInfo() for atom in atoms]) | {"stated_bonds": _bonds(mol)}
    return plain_models(*(Molecule.of(name, one.GetPositions(), element, **columns) for one in mol.GetConformers()))


def _bonds(mol: Any) -> Bonds:
    """Return the bonds, all there are if there is any: a molecule made of an XYZ file has none."""
    bonds = [bond for bond in mol.GetBonds() if bond.GetBondType().name != _HYDROGEN_BOND]
    if not bonds:
        return NO_BONDS
    pairs = np.array([(bond.GetBeginAtomIdx(), bond.GetEndAtomIdx()) for bond in bonds])
    order = np.array([_ORDERS.get(bond.GetBondType().name, 1.0) for bond in bonds])
    return Bonds.of(pairs, order, complete=True)


def _symbol(atom: Any) -> str:
    if atom.GetAtomicNum() == 1 and atom.GetIsotope() == DEUTERIUM:
        return "D"
    return symbol_of(atom.GetSymbol()) or UNKNOWN


def _residues(infos: list[Any]) -> dict[str, Any]:
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
