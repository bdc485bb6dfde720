"""A molecule: named atoms in space, as a file or an object of another library described them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Strings, Values
from molviz.errors import InputError
from molviz.model.bonds import NO_BONDS, Bonds

_NUMBERS = {"position": (3,), "bfactor": (), "radius": ()}  # columns of numbers, and the shape of a row
_TYPES = {"row": np.int64, "hetero": bool}  # of columns that are neither numbers with a fraction nor texts
_WIDEST = 8  # bytes of a number that float64 holds


@dataclass(frozen=True, repr=False)
class Molecule:
    """n atoms in columns; row k of every column is the same atom.

    ``residue`` holds number and insertion code as one text (``"56A"``), ``residue_name`` the name (``"CYS"``); both
    are empty where the format has no residues. ``element`` is the symbol as usually written (``"Fe"``), ``"X"``
    where unknown; D is kept apart from H. ``radius`` is the file's own, NaN where it has none; ``molviz.model.radii``
    says when it is used. ``water`` is not stored: see ``molviz.model.selection``. ``row`` is the atom's row in the
    model it was read from. ``segment`` and ``hetero`` (HETATM) are empty and False where the format has no such thing.
    ``stated_bonds`` are those that the file states; ``bonds`` and ``bond_orders`` all there are, by file, residues and
    distances.

    Lists are taken as arrays. Raises InputError, naming the column, for lengths that differ, positions that are not
    finite, radii that are not positive and bonds to rows that are not there.
    """

    name: str
    position: Floats  # (n, 3) ångström
    element: Strings  # (n,)
    atom_name: Strings  # (n,)
    residue_name: Strings  # (n,)
    residue: Strings  # (n,)
    chain: Strings  # (n,)
    bfactor: Floats  # (n,) Å², NaN where the format has none
    radius: Floats  # (n,) ångström or NaN
    row: Ints  # (n,)
    stated_bonds: Bonds = NO_BONDS
    segment: Strings = field(default_factory=lambda: np.empty(0, dtype=str))  # (n,), or none for empty texts
    hetero: Bools = field(default_factory=lambda: np.empty(0, dtype=bool))  # (n,), or none for False

    def __post_init__(self) -> None:
        for name, usual in (("segment", ""), ("hetero", False)):
            if not len(getattr(self, name)):
                object.__setattr__(self, name, np.full(len(self.position), usual))
        for name in column_names():
            object.__setattr__(self, name, _column(name, getattr(self, name)))
        for name in column_names():
            rows = len(getattr(self, name))
            if rows != len(self):
                raise InputError(f"{name}: {rows} rows; expected {len(self)}, one for each position")
        _refuse("position", np.isfinite(self.position).sum(axis=1) < 3, "is not finite")
        _refuse("radius", (self.radius <= 0) | np.isinf(self.radius), "is not a finite number above 0")
        first, second = self.stated_bonds.atoms.T
        _refuse("stated_bonds", (first < 0) | (second >= len(self)), "names an atom that is not there")

    def __len__(self) -> int:
        return len(self.position)

    def __repr__(self) -> str:
        return f"<Molecule {self.name!r}: {len(self)} atoms>"

    @property
    def bonds(self) -> Ints:
        """Row numbers (m, 2) of bonded atoms, first < second, each pair once; found when asked for, then kept."""
        return self._all_bonds.atoms

    @property
    def bond_orders(self) -> Floats:
        """Order (m,) of every bond: 1, 2, 3, 1.5 for aromatic ones of a file; 1 where only distances show the bond."""
        return self._all_bonds.order

    @cached_property
    def _all_bonds(self) -> Bonds:
        from molviz.geometry.bonds import bonds_of  # the law's exception: whoever asks for no bonds needs no geometry

        return bonds_of(self)

    def take(self, rows: Ints) -> "Molecule":
        """Return the molecule of the given atoms, in that order."""
        columns = {name: getattr(self, name)[rows] for name in column_names()}
        return Molecule(name=self.name, **columns, stated_bonds=self.stated_bonds.take(rows, len(self)))

    def places(self) -> Iterator[tuple[int, Floats]]:
        """Yield where the atoms are, in parts: the row of the first, and (m, 3) ångström."""
        yield 0, self.position

    def position_of(self, rows: Ints) -> Floats:
        """Return where the given atoms are (m, 3)."""
        return self.position[rows]

    def filtered(self, keep: Bools) -> "Molecule":
        """Return the molecule of the atoms to keep (n,)."""
        return self if keep.all() else self.take(np.flatnonzero(keep))

    def named(self, name: str) -> "Molecule":
        """Return the molecule under another name."""
        return replace(self, name=name)

    def by_atom(self, rule: Callable[["Molecule"], Values]) -> Values:
        """Return what a rule says of each atom (n,) that looks neither at places and chains nor at other atoms."""
        return rule(self)

    @staticmethod
    def of(name: str, position: Floats, element: Strings, **columns: object) -> "Molecule":
        """Return a molecule whose missing columns are empty texts, NaN and the natural row numbers."""
        position = doubles("position", position, _NUMBERS["position"])
        n = len(position)
        text, number = np.full(n, ""), np.full(n, np.nan)
        default: dict[str, object] = {
            "atom_name": element, "residue_name": text, "residue": text, "chain": text,
            "bfactor": number, "radius": number, "row": np.arange(n),
        }  # fmt: skip
        return Molecule(name=name, position=position, element=element, **(default | columns))  # type: ignore[arg-type]


def column_names() -> list[str]:
    """Return the names of the columns of a molecule."""
    return [field.name for field in fields(Molecule) if field.name not in ("name", "stated_bonds")]


def doubles(name: str, values: object, row: tuple[int, ...] = ()) -> Floats:
    """Return numbers (n, *row) in double precision; ``name`` is what InputError calls them where they are none.

    Those in single precision become the double nearest to their shortest decimal: 0.1 stays 0.1, as files have it.
    """
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "fiuO":
            raise TypeError
        short = array.dtype.kind == "f" and array.dtype.itemsize < _WIDEST
        numbers = (array.astype(str) if short else array).astype(np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name}: not a table of numbers") from None
    if row and numbers.size == 0:
        numbers = numbers.reshape(0, *row)
    if numbers.ndim != 1 + len(row) or numbers.shape[1:] != row:
        raise InputError(f"{name}: numbers of shape {numbers.shape}; expected (n{''.join(f', {k}' for k in row)})")
    return numbers


def _column(name: str, values: Any) -> Any:
    """Return a column as an array of its type."""
    if name in _NUMBERS:
        return doubles(name, values, _NUMBERS[name])
    array = np.asarray(values)
    if array.ndim != 1:
        raise InputError(f"{name}: shape {array.shape}; expected (n,)")
    return array.astype(_TYPES.get(name, str), copy=False)


def _refuse(name: str, wrong: Bools, what: str) -> None:
    rows = np.flatnonzero(wrong)
    if len(rows):
        raise InputError(f"{name}: row {rows[0]} {what}")
