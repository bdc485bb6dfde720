"""biotite: ``AtomArray``."""

from typing import Any

import numpy as np

from molviz.adapters.plain import plain_models
from molviz.model.bonds import AROMATIC, NO_BONDS, Bonds
from molviz.model.elements import UNKNOWN, symbol_of
from molviz.model.molecule import Molecule
from molviz.readers.atoms import Models

_ORDERS = {2: 2.0, 3: 3.0, 4: 4.0, 6: 2.0, 7: 3.0, 9: AROMATIC}  # by the number of BondType; all others: 1


def models_of_array(array: Any) -> Models:
    """Return the atoms as one molecule; alternate locations were left out when the array was made."""
    element = np.array([symbol_of(text) or UNKNOWN for text in array.element.tolist()], dtype=str)
    columns = {"bfactor": array.b_factor} if "b_factor" in array.get_annotation_categories() else {}
    return plain_models(
        Molecule.of(
            "", array.coord, element, atom_name=array.atom_name, residue_name=array.res_name,
            residue=_residues(array), chain=array.chain_id, hetero=array.hetero, stated_bonds=_bonds(array), **columns,
        ),
    )  # fmt: skip


def _bonds(array: Any) -> Bonds:
    if array.bonds is None or not array.bonds.get_bond_count():
        return NO_BONDS
    first, second, kind = array.bonds.as_array().astype(np.int64).T
    order = np.array([_ORDERS.get(one, 1.0) for one in kind.tolist()])
    return Bonds.of(np.column_stack([first, second]), order)


def _residues(array: Any) -> Any:
    """Number and insertion code; an array made of nothing numbers everything 0, which is no number."""
    if not np.any(array.res_id) and not np.any(array.res_name != ""):
        return np.full(len(array), "")
    return np.char.add(array.res_id.astype(str), array.ins_code)
