"""Bonds as a table, and those that residues have by the names of their atoms; no distance is looked at here.

The bonds of a molecule, from its file or from distances, are found by ``molviz.geometry.bonds``.
"""

import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from molviz import toml
from molviz.arrays import Bools, Floats, Ints, Strings

SOURCES = ("file", "distance", "none")  # of the bonds that are drawn
AROMATIC = 1.5  # the order of a bond that the file calls aromatic
_ORDER_OF_SIGN = {"-": 1.0, "=": 2.0}  # of residue_bonds.toml
Template = tuple[tuple[str, str, float], ...]  # the two names and the order of every bond of a residue


class Bonds(NamedTuple):
    """m bonds between the atoms of one molecule, each once, ordered by first, then second atom.

    ``complete`` says that the file states all bonds there are, as SDF does: none is looked for beside them.
    """

    atoms: Ints  # (m, 2) row numbers, first < second
    order: Floats  # (m,) 1, 2, 3, 1.5 for aromatic; 1 where nothing states an order
    complete: bool = False

    @staticmethod
    def of(pairs: Ints, order: Floats | None = None, complete: bool = False) -> "Bonds":
        """Return bonds between the given pairs of rows (m, 2), each pair once and no atom with itself.

        Of a pair that comes several times, the order at its first place is kept.
        """
        order = np.ones(len(pairs)) if order is None else order
        low, high = np.minimum(*pairs.T), np.maximum(*pairs.T)
        proper = np.flatnonzero(low != high)
        _, place = np.unique(low[proper] * (int(high.max(initial=0)) + 1) + high[proper], return_index=True)
        rows = proper[place]
        return Bonds(np.column_stack([low[rows], high[rows]]), order[rows], complete)

    def take(self, rows: Ints, count: int) -> "Bonds":
        """Return the bonds among the given rows of ``count`` atoms, by their numbers in that order."""
        number = np.full(count, -1)
        number[rows] = np.arange(len(rows))
        atoms = number[self.atoms]
        kept = (atoms >= 0).all(axis=1)
        return Bonds.of(atoms[kept], self.order[kept], self.complete)

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


def joined_lists(parts: list[Bonds]) -> Bonds:
    """Return the bonds that several lists have of the same molecule; the order is that of the first list."""
    pairs = np.concatenate([part.atoms for part in parts])
    return Bonds.of(pairs, np.concatenate([part.order for part in parts]))


# ---- residues


class ResidueBonds(NamedTuple):
    """The bonds that templates give the residues of n atoms, and which atoms the templates name."""

    bonds: Bonds
    named: Bools  # (n,)


def run_of_atom(*columns: Ints | Strings) -> Ints:
    """Return for n atoms the number of the residue (n,): a run of rows that agree in all columns (n,)."""
    changes = np.zeros(max(len(columns[0]) - 1, 0), dtype=bool)
    for column in columns:
        changes |= column[1:] != column[:-1]
    return np.concatenate([[0], np.cumsum(changes)])[: len(columns[0])]


def bonds_in_residues(
    run: Ints, residue_name: Strings, atom_name: Strings, templates: Mapping[str, Template]
) -> ResidueBonds:
    """Return the bonds inside residues (runs of rows, (n,)) by the template of their name, a bond where both atoms are.

    Of atoms of one name in one residue, the first counts.
    """
    named = np.zeros(len(run), dtype=bool)
    names, which = np.unique(residue_name, return_inverse=True)
    groups = np.split(np.argsort(which, kind="stable"), np.cumsum(np.bincount(which, minlength=len(names)))[:-1])
    parts = [NO_BONDS]
    for number, name in enumerate(names.tolist()):
        rows = groups[number]
        template = templates.get(name.upper(), ())
        atoms = np.array(sorted({atom for bond in template for atom in bond[:2]}), dtype=str)
        if not len(atoms):
            continue
        column = np.minimum(np.searchsorted(atoms, atom_name[rows]), len(atoms) - 1)
        known = atoms[column] == atom_name[rows]
        rows, column = rows[known], column[known]
        named[rows] = True
        parts += _instances(rows, run[rows], column, atoms, template)
    return ResidueBonds(joined_lists(parts), named)


def _instances(rows: Ints, run: Ints, column: Ints, atoms: Strings, template: Template) -> list[Bonds]:
    """Return every bond of a template in all residues of its name; ``column`` says which of ``atoms`` a row is."""
    residues, residue = np.unique(run, return_inverse=True)
    place = np.full((len(residues), len(atoms)), -1)
    place[residue[::-1], column[::-1]] = rows[::-1]
    number = {atom: k for k, atom in enumerate(atoms.tolist())}
    parts = []
    for first, second, order in template:
        pair = place[:, [number[first], number[second]]]
        pair = pair[(pair >= 0).all(axis=1)]
        parts.append(Bonds(pair, np.full(len(pair), order)))
    return parts


@cache
def standard_residues() -> Mapping[str, Template]:
    """Return the heavy atoms' bonds and orders of amino acids, nucleotides and heme (``residue_bonds.toml``)."""
    content = toml.loads(Path(__file__).with_name("residue_bonds.toml").read_text(encoding="utf-8"))
    return {
        name: _bonded_along(f"{content['parts'][kind]} {paths}")
        for kind in content["parts"]
        for names, paths in content[kind].items()
        for name in names.split()
    }


def _bonded_along(paths: str) -> Template:
    """Return the bonds along paths of atoms such as ``CA-CB-CG=OD1``."""
    steps = [re.split("([-=])", path) for path in paths.split()]
    return tuple(
        (first, second, _ORDER_OF_SIGN[sign])
        for words in steps
        for first, sign, second in zip(words[::2], words[1::2], words[2::2], strict=False)
    )
