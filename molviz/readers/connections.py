"""Connections that a file lists by the names of two atoms, as bonds between the rows of its table of atoms."""

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np

from molviz.model.bonds import NO_BONDS, Bonds
from molviz.readers.atoms import AtomTable

Key = tuple[str, str, str]  # chain, residue, atom name
Connection = tuple[Key, Key, float]  # two atoms and the order of their bond


def connected(table: AtomTable, connections: Sequence[Connection]) -> Bonds:
    """Return the bonds of connections in every model, alternate locations only with their own kind.

    Connections of atoms that are not there make none.
    """
    if not connections:
        return NO_BONDS
    rows = _rows_of(table, {key for first, second, _ in connections for key in (first, second)})
    model, alternate = table.model.tolist(), table.alternate.tolist()
    pairs, orders = [], []
    for first, second, order in connections:
        partners = defaultdict(list)
        for row in rows[second]:
            partners[model[row]].append(row)
        for row in rows[first]:
            met = [other for other in partners[model[row]] if len({alternate[row], alternate[other]} - {""}) < 2]
            pairs += [(row, other) for other in met]
            orders += [order] * len(met)
    return Bonds.of(np.array(pairs, dtype=np.int64).reshape(-1, 2), np.array(orders, dtype=float))


def _rows_of(table: AtomTable, keys: set[Key]) -> Mapping[Key, list[int]]:
    """Return the rows of the atoms that the keys name, alternate locations and models included."""
    rows: dict[Key, list[int]] = defaultdict(list)
    for row in np.flatnonzero(np.isin(table.residue, [residue for _, residue, _ in keys])).tolist():
        key = str(table.chain[row]), str(table.residue[row]), str(table.atom_name[row])
        if key in keys:
            rows[key].append(row)
    return rows
