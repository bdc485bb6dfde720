"""Bonds as a table, and those that residues have by the names of their atoms; no distance is looked at here.

The bonds of a molecule, from its file or from distances, are found by ``molviz.geometry.bonds``.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints, Strings

AROMATIC = 1.5  # the order of a bond that the file calls aromatic
Template = tuple[tuple[str, str, float], ...]  # the two names and the order of every bond of a residue


class Bonds(NamedTuple):
    """m bonds between the atoms of one molecule, each once, ordered by first, then second atom.

    ``complete`` says that the file states all bonds there are, as SDF does: none is looked for beside them.
    """

    atoms: Ints  # (m, 2) row numbers, first < second
    order: Floats  # (m,) 1, 2, 3, 1.5 for aromatic; 1 where nothing states an order
    complete: bool = False

    @staticmethod
    def of(first: Ints, second: Ints, order: Floats | None = None, complete: bool = False) -> "Bonds":
        """Return bonds between the given rows (m,), (m,), each pair once and no atom with itself.

        Of a pair that comes several times, the order at its first place is kept.
        """
        order = np.ones(len(first)) if order is None else order
        pair = np.sort(np.column_stack([first, second]).astype(np.int64).reshape(-1, 2), axis=1)
        proper = pair[:, 0] != pair[:, 1]
        atoms, place = np.unique(pair[proper], axis=0, return_index=True)
        return Bonds(atoms, order[proper][place], complete)

    def take(self, rows: Ints, count: int) -> "Bonds":
        """Return the bonds among the given rows of ``count`` atoms, by their numbers in that order."""
        number = np.full(count, -1)
        number[rows] = np.arange(len(rows))
        atoms = number[self.atoms]
        kept = (atoms >= 0).all(axis=1)
        return Bonds.of(atoms[kept, 0], atoms[kept, 1], self.order[kept], self.complete)

    def span(self, first: int, last: int) -> "Bonds":
        """Return the bonds among the rows from ``first`` to before ``last``, numbered from 0."""
        begin, end = np.searchsorted(self.atoms[:, 0], [first, last])
        atoms, order = self.atoms[begin:end] - first, self.order[begin:end]
        inside = atoms[:, 1] < last - first
        return Bonds(atoms[inside], order[inside], self.complete)


NO_BONDS = Bonds(np.empty((0, 2), dtype=np.int64), np.empty(0))


def joined(parts: list[Bonds], counts: list[int]) -> Bonds:
    """Return the bonds of molecules of so many atoms each, put behind one another."""
    start = np.cumsum([0, *counts[:-1]])
    atoms = np.concatenate([part.atoms + begin for part, begin in zip(parts, start.tolist(), strict=True)])
    return Bonds(atoms, np.concatenate([part.order for part in parts]), all(part.complete for part in parts))


def run_of_atom(*columns: Ints | Strings) -> Ints:
    """Return for n atoms the number of the residue (n,): a run of rows that agree in all columns."""
    changes = np.zeros(max(len(columns[0]) - 1, 0), dtype=bool)
    for column in columns:
        changes |= column[1:] != column[:-1]
    return np.concatenate([[0], np.cumsum(changes)])[: len(columns[0])]
