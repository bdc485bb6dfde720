"""MOL and SDF: connection tables, one a record, with the bonds and their orders.

BIOVIA, "CTfile Formats": versions V2000 (fixed columns) and V3000 (words); ``$$$$`` ends a record of an SDF.
"""

import re
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from molviz.errors import InputError
from molviz.model.bonds import AROMATIC, NO_BONDS, Bonds
from molviz.model.elements import UNKNOWN, symbol_of
from molviz.model.molecule import Molecule
from molviz.readers.atoms import coinciding_note, coinciding_rows
from molviz.readers.numbers import numbers
from molviz.readers.reading import Reading
from molviz.readers.source import note

_WHOLE = re.compile(r"[0-9]{1,18}")
_HEADER = 4  # lines: title, program, comment, counts
_END = b"$$$$"
_ORDERS = {"1": 1.0, "2": 2.0, "3": 3.0, "4": AROMATIC, "9": 1.0}  # 9: coordination
_QUERIES = ("5", "6", "7", "8")  # single or double, and the like: no one order
_HYDROGEN_BOND = "10"
DEUTERIUM = "2"  # the isotope of hydrogen that molviz keeps apart


class Atom(NamedTuple):
    """One atom, in texts."""

    line: int  # counted from one
    name: str  # by which bonds call it
    symbol: str
    position: list[bytes]  # x, y, z
    mass: str = ""


class Bond(NamedTuple):
    """One bond, in texts."""

    line: int
    type: str
    first: str
    second: str


class Table(NamedTuple):
    """The connection table of one record."""

    atoms: list[Atom]
    bonds: list[Bond]


def read_sdf(data: bytes, source: str) -> Reading:
    """Return one model for each record of a MOL or SDF file, with its bonds; a record may be V2000 or V3000.

    Raises InputError where counts, columns, atom numbers or types of bonds are not clear.
    """
    records = _records(data.split(b"\n"))
    told: dict[str, str] = {}
    molecules = tuple(_molecule(record, line, source, told) for line, record in records)
    chains = tuple(molecule.chain for molecule in molecules)
    return Reading(source, "sdf", molecules, warnings=tuple(told.values()), operator_chain=chains)


def _records(lines: list[bytes]) -> list[tuple[int, list[bytes]]]:
    """Return number of the first line and lines of every record; blank lines behind the last are none."""
    ends = [row for row, line in enumerate(lines) if line.startswith(_END)]
    starts = [0, *(end + 1 for end in ends)]
    records = [(start + 1, lines[start:end]) for start, end in zip(starts, [*ends, len(lines)], strict=True)]
    return [record for record in records if record[0] == 1 or any(line.strip() for line in record[1])]


def _molecule(lines: list[bytes], start: int, source: str, told: dict[str, str]) -> Molecule:
    """Return the molecule of a record whose first line has the number ``start``."""
    table = _table(lines, start, source)
    if not table.atoms:
        raise InputError("no atoms in the record; expected one at least", source, start)

    def error(index: int, text: str) -> InputError:
        what = repr(text.strip()) if text.strip() else "blank"
        message = f"{'xyz'[index % 3]} coordinate is {what}; expected a finite number"
        return InputError(message, source, table.atoms[index // 3].line)

    position = numbers(np.array([cell for atom in table.atoms for cell in atom.position]), error).reshape(-1, 3)
    again = coinciding_rows(position)
    if len(again):
        told.setdefault("coincide", coinciding_note(len(again), source, table.atoms[again[0]].line))
    if lines[1][20:22].upper() == b"2D":
        told.setdefault("flat", note("the coordinates are of a flat drawing (2D), not in ångström", source, start + 1))
    element = np.array([_element(atom) for atom in table.atoms])
    for row in np.flatnonzero(element == UNKNOWN)[:1].tolist():
        message = f"the symbol {table.atoms[row].symbol!r} is no element; its atoms are of unknown element"
        told.setdefault("unknown", note(message, source, table.atoms[row].line))
    name = lines[0].decode("latin-1").strip() or PurePath(source.removesuffix(".gz")).stem
    return Molecule.of(name, position, element, stated_bonds=_bonds(table, source, told))


def _element(atom: Atom) -> str:
    symbol = symbol_of(atom.symbol) or UNKNOWN
    return "D" if symbol == "H" and atom.mass == DEUTERIUM else symbol


def _bonds(table: Table, source: str, told: dict[str, str]) -> Bonds:
    """Return the bonds by rows; those of a record are all there are, if it has any."""
    row = {atom.name: number for number, atom in enumerate(table.atoms)}
    pairs, orders = [], []
    for bond in table.bonds:
        if bond.first not in row or bond.second not in row or bond.first == bond.second:
            message = f"a bond of atoms {bond.first} and {bond.second}; expected two numbers of the {len(row)} atoms"
            raise InputError(message, source, bond.line)
        if bond.type not in (*_ORDERS, *_QUERIES, _HYDROGEN_BOND):
            raise InputError(f"a bond of type {bond.type!r}; expected 1 to 10", source, bond.line)
        if bond.type in _QUERIES:
            message = f"a bond of type {bond.type} has no one order; taken as single"
            told.setdefault("query", note(message, source, bond.line))
        if bond.type != _HYDROGEN_BOND:
            pairs.append((row[bond.first], row[bond.second]))
            orders.append(_ORDERS.get(bond.type, 1.0))
    if not pairs:
        return NO_BONDS
    return Bonds.of(np.array(pairs), np.array(orders), complete=True)


# ---- V2000


def _table(lines: list[bytes], start: int, source: str) -> Table:
    """Return the connection table of a record, by the version that its fourth line states (none: V2000)."""
    if len(lines) < _HEADER:
        message = f"the record ends after {len(lines)} lines; expected a title, two more lines and the counts"
        raise InputError(message, source, start + len(lines) - 1)
    counts, line = lines[_HEADER - 1], start + _HEADER - 1
    version = counts[33:39].strip().upper()
    if version == b"V3000":
        return _version_3000(lines, start, source)
    if version not in (b"V2000", b"") or not _whole(counts[:3]) or not _whole(counts[3:6]):
        shown = counts.decode("latin-1").strip()[:40]
        message = f"{shown!r}; expected the numbers of atoms and bonds in columns 1-6, and V2000 or V3000"
        raise InputError(message, source, line)
    return _version_2000(lines, int(counts[:3]), int(counts[3:6]), start, source)


def _whole(text: bytes) -> bool:
    return text.strip().isdigit()


def _version_2000(lines: list[bytes], atoms: int, bonds: int, start: int, source: str) -> Table:
    end = _HEADER + atoms + bonds
    last = next((row for row, line in enumerate(lines) if line.rstrip() == b"M  END"), len(lines))
    if last < end or last == len(lines):
        message = f"the counts say {atoms} atoms and {bonds} bonds; expected so many lines and M  END behind them"
        raise InputError(message, source, start + min(last, end, len(lines) - 1))
    mass = _isotopes(lines[end:last])
    rows = lines[_HEADER : _HEADER + atoms]
    for row, line in enumerate(rows):
        if len(line) < 32 or b"\t" in line:
            message = "the row is too short or has tabs; expected x y z in columns 1-30, a symbol in 32-34"
            raise InputError(message, source, start + _HEADER + row)
    table = [
        Atom(
            start + _HEADER + row, str(row + 1), line[31:34].decode("latin-1").strip(),
            [line[0:10], line[10:20], line[20:30]], mass.get(str(row + 1), ""),
        )
        for row, line in enumerate(rows)
    ]  # fmt: skip
    return Table(table, [_bond_2000(lines[row], start + row, source) for row in range(_HEADER + atoms, end)])


def _bond_2000(line: bytes, number: int, source: str) -> Bond:
    cells = [line[0:3], line[3:6], line[6:9]]
    if not all(map(_whole, cells)):
        shown = line.decode("latin-1").strip()[:40]
        raise InputError(f"{shown!r}; expected two atoms and the type of a bond in columns 1-9", source, number)
    first, second, type = (str(int(cell)) for cell in cells)
    return Bond(number, type, first, second)


def _isotopes(properties: list[bytes]) -> dict[str, str]:
    """Return the mass of atoms by number: ``M  ISO``, a count, then pairs of atom and mass."""
    words = [word for line in properties if line.startswith(b"M  ISO") for word in line.decode("latin-1").split()[3:]]
    return dict(zip(words[::2], words[1::2], strict=False))


# ---- V3000


def _version_3000(lines: list[bytes], start: int, source: str) -> Table:
    rows = _rows_3000(lines, start)
    counts = next(((line, words[1:]) for line, words in rows if words[:1] == ["COUNTS"]), None)
    if counts is None or len(counts[1]) < 2 or not all(_WHOLE.fullmatch(word) for word in counts[1][:2]):
        raise InputError("no M  V30 COUNTS with two numbers; expected those of atoms and bonds", source, start + 3)
    atoms = [_atom_3000(line, words, source) for line, words in _block(rows, "ATOM", source)]
    bonds = [_bond_3000(line, words, source) for line, words in _block(rows, "BOND", source)]
    for what, said, there in zip(("atoms", "bonds"), counts[1], (len(atoms), len(bonds)), strict=False):
        if int(said) != there:
            raise InputError(f"the counts say {said} {what}, but {there} are listed", source, counts[0])
    if len({atom.name for atom in atoms}) < len(atoms):
        raise InputError("an atom number comes twice; expected a different one for each atom", source, counts[0])
    return Table(atoms, bonds)


def _rows_3000(lines: list[bytes], start: int) -> list[tuple[int, list[str]]]:
    """Return line number and words of the rows of a record; a row that ends with ``-`` goes on in the next."""
    rows: list[tuple[int, list[str]]] = []
    before, begun = "", 0
    for number, line in enumerate(lines, start=start):
        if not line.startswith(b"M  V30 "):
            continue
        text = before + line[7:].decode("latin-1").rstrip()
        begun = begun if before else number
        before = text[:-1] if text.endswith("-") else ""
        if not before:
            rows.append((begun, text.split()))
    return rows


def _block(rows: list[tuple[int, list[str]]], name: str, source: str) -> list[tuple[int, list[str]]]:
    """Return the rows between BEGIN and END of a block; no rows where a record has no such block."""
    words = [row[1] for row in rows]
    if ["BEGIN", name] not in words:
        return []
    begin = words.index(["BEGIN", name])
    if ["END", name] not in words[begin:]:
        raise InputError(f"the block {name} that begins here has no end", source, rows[begin][0])
    return rows[begin + 1 : words.index(["END", name], begin)]


def _atom_3000(line: int, words: list[str], source: str) -> Atom:
    if len(words) < 6 or not words[0].isdigit():
        raise InputError(f"{len(words)} words; expected number, symbol, x y z and mapping of an atom", source, line)
    mass = next((word[5:] for word in words[6:] if word.upper().startswith("MASS=")), "")
    return Atom(line, words[0], words[1], [word.encode("latin-1") for word in words[2:5]], mass)


def _bond_3000(line: int, words: list[str], source: str) -> Bond:
    if len(words) < 4:
        raise InputError(f"{len(words)} words; expected number, type and two atoms of a bond", source, line)
    return Bond(line, *words[1:4])
