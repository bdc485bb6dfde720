"""What the readers of PDB, mmCIF and PQR share: one table of all atoms becomes models without alternate locations."""

from collections import defaultdict
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Strings
from molviz.model.bonds import NO_BONDS, Bonds
from molviz.model.molecule import Molecule
from molviz.readers.source import note

WEIGHTS = (1.0, np.sqrt(2.0), np.sqrt(3.0), np.sqrt(5.0))  # no sum of different decimals is equal but by rounding
HASH = 1_000_003  # a prime: no two names of few letters have the same sum of powers
FAR = 0x1E3779B97F4A7C15  # odd, with bits in every byte: runs are as far from each other as from names


class AtomTable(NamedTuple):
    """n atoms of all models, in the order of the file."""

    position: Floats  # (n, 3) ångström
    element: Strings  # (n,)
    atom_name: Strings  # (n,)
    residue_name: Strings  # (n,)
    residue: Strings  # (n,) number and insertion code
    chain: Strings  # (n,)
    operator_chain: Strings  # (n,) the chain as the file's symmetry operators call it
    bfactor: Floats  # (n,) Å² or NaN
    radius: Floats  # (n,) ångström or NaN
    occupancy: Floats  # (n,)
    alternate: Strings  # (n,) "" where the atom has one location
    model: Ints  # (n,) increasing with the order of models
    line_of: Callable[[int], int | None]  # row → line of the file
    segment: Strings  # (n,) "" where the format has none
    hetero: Bools  # (n,) stated as HETATM
    bonds: Bonds = NO_BONDS  # between rows, as the file states them

    def take(self, rows: Ints) -> "AtomTable":
        """Return the given rows."""
        line_of = self.line_of
        columns = {name: getattr(self, name)[rows] for name in self._fields if name not in ("bonds", "line_of")}
        bonds = self.bonds.take(rows, len(self.model))
        return self._replace(**columns, bonds=bonds, line_of=lambda row: line_of(int(rows[row])))


class Models(NamedTuple):
    """The models of a table."""

    molecules: tuple[Molecule, ...]
    operator_chain: tuple[Strings, ...]
    warnings: list[str]


def models_of(table: AtomTable, name: str, source: str) -> Models:
    """Return the models of a table, alternate locations dropped, with warnings about what is odd in it."""
    table = _in_order_of_models(table)
    kept = _best_locations(table)
    warnings = [_alternates_note(len(kept) - int(kept.sum()), source)] if not kept.all() else []
    table = table.take(np.flatnonzero(kept))
    start = np.flatnonzero(np.diff(table.model, prepend=table.model[0] - 1))
    stop = np.append(start[1:], len(table.model))
    warnings += _oddities(table, source)
    spans = list(zip(start.tolist(), stop.tolist(), strict=True))
    return Models(
        tuple(_molecule(table, first, last, name) for first, last in spans),
        tuple(table.operator_chain[first:last] for first, last in spans),
        warnings,
    )


def _in_order_of_models(table: AtomTable) -> AtomTable:
    if (np.diff(table.model) >= 0).all():
        return table
    return table.take(np.argsort(table.model, kind="stable"))


def _molecule(table: AtomTable, first: int, last: int, name: str) -> Molecule:
    part = slice(first, last)
    return Molecule.of(
        name, table.position[part], table.element[part], atom_name=table.atom_name[part],
        residue_name=table.residue_name[part], residue=table.residue[part], chain=table.chain[part],
        bfactor=table.bfactor[part], radius=table.radius[part], stated_bonds=table.bonds.span(first, last),
        segment=table.segment[part], hetero=table.hetero[part],
    )  # fmt: skip


# ---- alternate locations


def _best_locations(table: AtomTable) -> Bools:
    """Return which rows stay (n,): of alternate locations the highest occupancy, the first on a tie.

    Where the locations of one residue have different residue names (a point mutation), the name of the highest
    occupancy stays and the located atoms of the others go, so that no side chain is mixed of two. An atom has
    alternate locations when its rows carry different location letters; rows of one letter repeated all stay.
    """
    kept = np.ones(len(table.model), dtype=bool)
    if not (table.alternate != "").any():
        return kept
    place = list(zip(table.model.tolist(), table.chain.tolist(), table.residue.tolist(), strict=True))
    touched = {place[row] for row in np.flatnonzero(table.alternate != "").tolist()}
    residues: dict[tuple[int, str, str], list[int]] = defaultdict(list)
    for row, key in enumerate(place):
        if key in touched:
            residues[key].append(row)
    for rows in residues.values():
        chosen = _one_residue_name(table, rows)
        kept[rows] = False
        kept[_one_location_each(table, chosen)] = True
    return kept


def _one_residue_name(table: AtomTable, rows: list[int]) -> list[int]:
    """Return the rows without location letter and, of those with one, the rows of the residue name that stays."""
    names, letters = table.residue_name, table.alternate
    lettered = [row for row in rows if letters[row] != ""]
    best = names[max(lettered, key=lambda row: table.occupancy[row])]
    return [row for row in rows if letters[row] == "" or names[row] == best]


def _one_location_each(table: AtomTable, rows: list[int]) -> list[int]:
    atoms: dict[tuple[str, str], list[int]] = defaultdict(list)
    for row in rows:
        atoms[(table.residue_name[row], table.atom_name[row])].append(row)
    kept: list[int] = []
    for same in atoms.values():
        several = len({table.alternate[row] for row in same}) > 1
        kept += [max(same, key=lambda row: table.occupancy[row])] if several else same
    return kept


def _alternates_note(dropped: int, source: str) -> str:
    return note(f"{dropped} atoms at alternate locations left out (kept: highest occupancy, first on a tie)", source)


# ---- what is odd but clear


def _oddities(table: AtomTable, source: str) -> list[str]:
    return [*_coinciding(table, source), *_repeated_names(table, source), *_unequal_models(table, source)]


def coinciding_rows(position: Floats) -> Ints:
    """Return the rows (k,) whose atom stands exactly where an earlier row's atom stands; position (n, 3)."""
    with np.errstate(over="ignore", invalid="ignore"):  # what is no number is compared
        rows = _repeated(sum(column * weight for column, weight in zip(position.T, WEIGHTS, strict=False)))
    place = position[rows]  # of few
    order = np.lexsort((rows, *place.T))
    same = (place[order][1:] == place[order][:-1]).all(axis=1)
    return np.sort(rows[order[1:][same]])


def _repeated(key: Floats | Ints) -> Ints:
    """The rows (k,), ascending, whose key (n,) is that of another row, or no number: equal things have equal keys."""
    order = np.argsort(key)
    again = ~(key[order][1:] > key[order][:-1])
    return np.sort(order[(np.append(again, False) | np.insert(again, 0, False))[: len(order)]])


def coinciding_note(count: int, source: str, line: int | None) -> str:
    """Return the warning about atoms at the very place of others, the first of them at the line."""
    return note(f"{count} atoms at exactly the place of an earlier atom, the first here", source, line)


def _coinciding(table: AtomTable, source: str) -> list[str]:
    rows = coinciding_rows(np.column_stack([table.position, table.model]))
    return [coinciding_note(len(rows), source, table.line_of(int(rows[0])))] if len(rows) else []


def _repeated_names(table: AtomTable, source: str) -> list[str]:
    """Return a warning where two atoms of one residue have the same name (residues being runs of rows)."""
    changes = np.zeros(len(table.model) - 1, dtype=bool)
    for column in (table.model, table.chain, table.residue, table.residue_name):
        changes |= column[1:] != column[:-1]
    run = np.concatenate([[0], np.cumsum(changes)])
    seen: dict[tuple[int, str], int] = {}
    rows = _repeated(_hash(table.atom_name) + FAR * run).tolist()
    keys = zip(run[rows].tolist(), table.atom_name[rows].tolist(), strict=True)
    again = [row for row, key in zip(rows, keys, strict=True) if seen.setdefault(key, row) != row]
    if not again:
        return []
    where = f"{table.residue_name[again[0]]} {table.chain[again[0]]} {table.residue[again[0]]}"
    first = f"the first {table.atom_name[again[0]]} of {where}"
    message = f"{len(again)} atoms named as another atom of their residue, {first}; all are kept"
    return [note(message, source, table.line_of(again[0]))]


def _hash(texts: Strings) -> Ints:
    """A number (n,) for each text, equal where the texts are, and nearly always different where they are not."""
    code = np.zeros(len(texts), dtype=np.int64)
    for letter in np.ascontiguousarray(texts).view(np.uint32).reshape(len(texts), -1).T:
        code = code * HASH + letter
    return code


def _unequal_models(table: AtomTable, source: str) -> list[str]:
    _, sizes = np.unique(table.model, return_counts=True)
    if (sizes == sizes[0]).all():
        return []
    return [note(f"the models differ in atoms: from {sizes.min()} to {sizes.max()}", source)]
