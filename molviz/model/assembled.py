"""Copies of the atoms of one molecule, moved by operators: where and what they are is told only when it is asked."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Strings, Values
from molviz.model.bonds import Bonds, joined
from molviz.model.molecule import Molecule, column_names
from molviz.model.spheres import Spheres
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
    start: Ints  # (copies + 1,) where in the rows each copy begins and ends
    operator: Floats  # (copies, 3, 4)
    name: Strings  # (names,) of the original's chains
    number: Ints  # (atoms of the original,) of the chain's name
    suffix: Strings  # (copies,) of the names of chains

    def filtered(self, keep: Bools) -> "_Columns":
        start = np.append(0, np.cumsum(keep))[self.start]
        return self._replace(row=self.row[keep], start=start)

    def take(self, name: str, rows: Ints) -> Any:
        """Return a column of the given atoms, in that order."""
        if name not in ("position", "chain"):
            return getattr(self.original, name)[self.row[rows]]
        copy = np.searchsorted(self.start, rows, side="right") - 1
        return self.chain(rows, copy) if name == "chain" else self.position(rows, copy)

    def column(self, name: str) -> Any:
        """Return a whole column."""
        if name not in ("position", "chain"):
            return getattr(self.original, name)[self.row]
        if name == "position":
            return np.concatenate([np.empty((0, 3)), *(part for _, part in self.places())])
        return self.chain(np.arange(len(self.row)), np.repeat(np.arange(len(self.suffix)), np.diff(self.start)))

    def chain(self, rows: Ints, copy: Ints) -> Strings:
        names = np.char.add(self.name, self.suffix[:, None]) if len(self.name) else self.name[None]
        return np.asarray(names[copy, self.number[self.row[rows]]])

    def position(self, rows: Ints, copy: Ints) -> Floats:
        order, position = np.argsort(copy, kind="stable"), np.empty((len(rows), 3))
        for some in np.split(order, np.flatnonzero(np.diff(copy[order])) + 1):
            if len(some):
                position[some] = self.moved(self.row[rows[some]], int(copy[some[0]]))
        return position

    def places(self) -> Iterator[tuple[int, Floats]]:
        for copy, (first, last) in enumerate(zip(self.start.tolist(), self.start[1:].tolist(), strict=False)):
            if first < last:
                yield first, self.moved(self.row[first:last], copy)

    def moved(self, rows: Ints, copy: int) -> Floats:
        """Where a copy has the given atoms of the original."""
        operator = self.operator[copy]
        original = self.original.position.take(rows, axis=0)
        with np.errstate(over="ignore", invalid="ignore"):  # who draws or measures refuses what is not finite
            return np.asarray(transformed(original, operator[:, :3]) + operator[:, 3])


class Assembled(Molecule):
    """A molecule made of copies, which has no columns until one is asked for, and none after.

    Most atoms of a large assembly are never seen, and nobody asks where they are and what they are called. Whoever
    takes some of the atoms, or replaces a column, gets a molecule like any other.
    """

    _columns: _Columns

    def __new__(cls, *args: Any, **columns: Any) -> Molecule:  # type: ignore[misc]
        """Return a molecule like any other: given columns are no copies."""
        return Molecule(*args, **columns)

    @staticmethod
    def of_copies(original: Molecule, copies: Sequence[Copy]) -> "Assembled":
        """Return the copies, one behind the other."""
        sizes = [len(copy.rows) for copy in copies]
        name, number = np.unique(original.chain, return_inverse=True)
        columns = _Columns(
            original, np.concatenate([copy.rows for copy in copies]), np.cumsum([0, *sizes]),
            np.array([copy.operator for copy in copies]), name, number, np.array([copy.suffix for copy in copies]),
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
        columns = {name: self._columns.take(name, rows) for name in column_names()}
        return Molecule(self.name, **columns, stated_bonds=self.stated_bonds.take(rows, len(self)))

    def places(self) -> Iterator[tuple[int, Floats]]:
        """Yield where the atoms of each copy that has any are: the row of the first, and (m, 3) ångström."""
        return self._columns.places()

    def filtered(self, keep: Bools) -> Molecule:
        """Return the atoms to keep (n,) as copies still."""
        if keep.all():
            return self
        bonds = self.stated_bonds.take(np.flatnonzero(keep), len(self))
        return _assembled(self.name, self._columns.filtered(keep), bonds)

    @property
    def cuts(self) -> Ints:
        """Where copies begin and end: rows (copies + 1,)."""
        return self._columns.start

    def position_of(self, rows: Ints) -> Floats:
        """Return where the given atoms are (m, 3)."""
        return np.asarray(self._columns.take("position", rows))

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


class BallsOfCopies(NamedTuple):
    """A ball about each atom, of copies of which no centre is kept."""

    molecule: Assembled
    radius: Floats  # (n,) ångström

    @property
    def cuts(self) -> Ints:
        """Where copies begin and end: rows (copies + 1,)."""
        return self.molecule.cuts

    def take(self, rows: Ints) -> Spheres:
        """Return the given balls, in that order."""
        return Spheres(self.molecule.position_of(rows), self.radius[rows])

    def whole(self) -> Spheres:
        """Return all of them."""
        return Spheres(self.molecule.position, self.radius)

    def parts(self) -> Iterator[Spheres]:
        """Yield the balls of each copy that has any."""
        for first, position in self.molecule.places():
            yield Spheres(position, self.radius[first : first + len(position)])
