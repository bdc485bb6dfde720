"""Copies of the atoms of one molecule, moved by operators: what most of them are called is known only when asked."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Strings, Values
from molviz.errors import InputError
from molviz.model.bonds import Bonds, joined
from molviz.model.molecule import Molecule, column_names
from molviz.vectors import transformed


class Copy(NamedTuple):
    """Atoms of the original and where they go, ``x → R x + t``."""

    rows: Ints  # (m,) of the original
    operator: Floats  # (3, 4), R in the first three columns, t in the last, ångström
    suffix: str  # of the names of its chains


class _Columns(NamedTuple):
    """What the columns of n atoms are made of."""

    original: Molecule
    row: Ints  # (n,) of the original
    copy: Ints  # (n,) number of the copy, ascending
    position: Floats  # (n, 3) ångström
    name: Strings  # (names,) of the original's chains
    number: Ints  # (atoms of the original,) of the chain's name
    suffix: Strings  # (copies,) of the names of chains

    def take(self, rows: Ints) -> "_Columns":
        return self._replace(row=self.row[rows], copy=self.copy[rows], position=self.position.take(rows, axis=0))

    def column(self, name: str) -> Any:
        if name == "position":
            return self.position
        if name != "chain":
            return getattr(self.original, name)[self.row]
        names = np.char.add(self.name, self.suffix[:, None]) if len(self.name) else self.name[None]
        return names[self.copy, self.number[self.row]]


class Assembled(Molecule):
    """A molecule made of copies, which has no columns but places until one is asked for, and none after.

    Most atoms of a large assembly are never seen, and nobody asks their names. Whoever takes some of the atoms, or
    replaces a column, gets a molecule like any other.
    """

    _columns: _Columns

    def __new__(cls, *args: Any, **columns: Any) -> Molecule:  # type: ignore[misc]
        """Return a molecule like any other: given columns are no copies."""
        return Molecule(*args, **columns)

    @staticmethod
    def of_copies(original: Molecule, copies: Sequence[Copy]) -> "Assembled":
        """Return the copies, one behind the other.

        Raises InputError where an operator moves an atom to where numbers end.
        """
        sizes = [len(copy.rows) for copy in copies]
        name, number = np.unique(original.chain, return_inverse=True)
        columns = _Columns(
            original, np.concatenate([copy.rows for copy in copies]), np.repeat(np.arange(len(copies)), sizes),
            np.concatenate([_moved(original, copy) for copy in copies]), name, number,
            np.array([copy.suffix for copy in copies]),
        )  # fmt: skip
        bonds = [original.stated_bonds.take(copy.rows, len(original)) for copy in copies]
        return _assembled(original.name, columns, joined(bonds, sizes))

    def __getattr__(self, name: str) -> Any:
        """Return a column, which is not kept."""
        if name in column_names():
            return self._columns.column(name)
        raise AttributeError(name)

    def __len__(self) -> int:
        return len(self._columns.row)

    def __reduce__(self) -> tuple[Any, ...]:
        return _assembled, (self.name, self._columns, self.stated_bonds)

    def take(self, rows: Ints) -> Molecule:
        """Return the molecule of the given atoms, in that order."""
        columns = self._columns.take(rows)
        bonds = self.stated_bonds.take(rows, len(self))
        return Molecule(self.name, **{name: columns.column(name) for name in column_names()}, stated_bonds=bonds)

    def filtered(self, keep: Bools) -> Molecule:
        """Return the atoms to keep (n,) as copies still."""
        rows = np.flatnonzero(keep)
        if len(rows) == len(keep):
            return self
        return _assembled(self.name, self._columns.take(rows), self.stated_bonds.take(rows, len(self)))

    def named(self, name: str) -> Molecule:
        """Return the copies under another name."""
        return _assembled(name, self._columns, self.stated_bonds)

    def by_atom(self, rule: Callable[[Molecule], Values]) -> Values:
        """Return what the rule says of the original, for each copy."""
        return rule(self._columns.original)[self._columns.row]


def _assembled(name: str, columns: _Columns, bonds: Bonds) -> Assembled:
    made = object.__new__(Assembled)
    vars(made).update(name=name, _columns=columns, stated_bonds=bonds)
    return made


def _moved(original: Molecule, copy: Copy) -> Floats:
    with np.errstate(over="ignore", invalid="ignore"):
        position = transformed(original.position[copy.rows], copy.operator[:, :3]) + copy.operator[:, 3]
    if not np.isfinite(position).all():
        raise InputError("an operator of the assembly moves atoms to where no number is")
    return position
