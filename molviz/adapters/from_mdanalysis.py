"""MDAnalysis: ``AtomGroup`` and ``Universe``, at the frame that the trajectory stands at."""

from pathlib import PurePath
from typing import Any

import numpy as np

from molviz.adapters.plain import SOURCE, plain_models
from molviz.arrays import Strings
from molviz.errors import InputError
from molviz.model.bonds import AROMATIC, NO_BONDS, Bonds
from molviz.model.elements import UNKNOWN, symbol_of, symbol_of_label
from molviz.model.molecule import Molecule
from molviz.readers.atoms import Models

COLUMNS = {"names": "atom_name", "resnames": "residue_name"}
_ORDERS = {"2": 2.0, "2.0": 2.0, "3": 3.0, "3.0": 3.0, "1.5": AROMATIC, "ar": AROMATIC}  # numbers, or words of MOL2


def models_of_universe(universe: Any) -> Models:
    """Return all atoms of the universe."""
    return models_of_group(universe.atoms)


def models_of_group(group: Any) -> Models:
    """Return the atoms of the group as one molecule; raises InputError where the universe has no coordinates."""
    try:
        position = group.positions
    except AttributeError:  # NoDataError, and a universe without a trajectory
        raise InputError("the universe has no coordinates; expected a trajectory or coordinate file", SOURCE) from None
    columns = {ours: _column(group, theirs) for theirs, ours in COLUMNS.items() if hasattr(group, theirs)}
    if hasattr(group, "tempfactors"):
        columns["bfactor"] = group.tempfactors.astype(np.float32)  # as read; MDAnalysis shows them in double precision
    return plain_models(
        Molecule.of(
            PurePath(str(group.universe.filename or "")).stem, position, _elements(group),
            residue=_residues(group), chain=_chains(group), segment=_named(group, "segids"),
            hetero=_column(group, "record_types") == "HETATM", stated_bonds=_bonds(group), **columns,
        ),
    )  # fmt: skip


def _column(group: Any, name: str) -> Any:
    column = getattr(group, name, None)
    return np.full(len(group), "") if column is None else np.asarray(column)


def _bonds(group: Any) -> Bonds:
    """The bonds of the topology among the atoms of the group, where it has any; of order 1 where it has no orders."""
    if not len(getattr(group, "bonds", ())):
        return NO_BONDS
    bonds = group.bonds
    row = np.full(len(group.universe.atoms), -1)
    row[group.indices] = np.arange(len(group))
    pairs, order = row[bonds.indices], np.array([_ORDERS.get(str(bond.order), 1.0) for bond in bonds])
    inside = (pairs >= 0).all(axis=1)
    return Bonds.of(pairs[inside], order[inside])


def _elements(group: Any) -> Strings:
    """The element where the topology has it, else what MDAnalysis guessed as type, else the letters of the name."""
    columns = [_column(group, name).astype(str).tolist() for name in ("elements", "types", "names")]
    return np.array(
        [symbol_of(element) or symbol_of(kind) or symbol_of_label(name) or UNKNOWN
         for element, kind, name in zip(*columns, strict=True)], dtype=str
    )  # fmt: skip


def _residues(group: Any) -> Strings:
    if not hasattr(group, "resnames"):
        return np.full(len(group), "")  # a format without residues: MDAnalysis makes one for all atoms
    return np.char.add(group.resids.astype(str), _column(group, "icodes").astype(str))


def _chains(group: Any) -> Strings:
    """The chain, else the segment."""
    return _named(group, "chainIDs" if hasattr(group, "chainIDs") else "segids")


def _named(group: Any, name: str) -> Strings:
    """A column of names; SYSTEM is what MDAnalysis calls a segment without one."""
    names = _column(group, name).astype(str)
    return np.where(names == "SYSTEM", "", names)
