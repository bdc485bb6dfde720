"""PQR: the atoms of a PDB file with charge and radius behind the coordinates, in columns or between blanks.

T. J. Dolinsky, J. E. Nielsen, J. A. McCammon, N. A. Baker (2004) PDB2PQR: an automated pipeline for the setup of
Poisson-Boltzmann electrostatics calculations. Nucleic Acids Res. 32, W665-W667.
"""

import re
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.errors import InputError
from molviz.model.elements import UNKNOWN, symbol_of_atom_name, symbol_of_free_name
from molviz.readers.atoms import AtomTable, models_of
from molviz.readers.numbers import is_number, numbers
from molviz.readers.reading import Reading
from molviz.readers.source import note

_VALUES = ("x", "y", "z", "charge", "radius")
_WITHOUT_CHAIN, _WITH_CHAIN = 10, 11  # words of a row
_COLUMNS = ((30, 38), (38, 46), (46, 54))  # of x, y and z where they stand as in PDB
_RECORD = re.compile(rb"(ATOM|HETATM)[ \t\d]")
_RESIDUE_NUMBER = re.compile(rb"-?\d+[A-Za-z]?")


class Row(NamedTuple):
    """One atom, in texts."""

    line: int  # counted from one
    hetero: bool  # HETATM
    atom_name: bytes  # four columns with their blanks where these are known to hold it, else bare
    residue_name: bytes
    chain: bytes
    residue: bytes
    values: list[bytes]  # x, y, z, charge, radius


def read_pqr(data: bytes, source: str) -> Reading:
    """Return the models of a PQR file, its radii in ``Molecule.radius``; a radius of 0 becomes NaN, with a warning.

    Raises InputError at the first atom that is not clear. Charges are checked, and not kept.
    """
    lines = data.split(b"\n")
    atoms = [(number, line) for number, line in enumerate(lines, start=1) if _RECORD.match(line)]
    if not atoms:
        raise InputError("no ATOM or HETATM records; expected a PQR file with atoms", source)
    by_words = {len(line.split()) for _, line in atoms}
    rows = [_row(line, number, source, len(by_words) == 1) for number, line in atoms]
    values = _values(rows, source)
    radius, warnings = _radii(rows, values[:, 4], source)
    table = _table(rows, values[:, :3], radius, _models(lines, [row.line for row in rows]))
    models = models_of(table, PurePath(source.removesuffix(".gz")).stem, source)
    told = (*warnings, *_unknown(table, source), *models.warnings)
    return Reading(source, "pqr", models.molecules, {}, told, models.operator_chain)


def _models(lines: list[bytes], atoms: list[int]) -> Ints:
    """Return the model (n,) of the atoms at the given lines: MODEL, ENDMDL and END part one from the next."""
    marks = (b"MODEL", b"ENDMDL", b"END")
    parts = [number for number, line in enumerate(lines, start=1) if line.split(b" ")[0] in marks]
    return np.unique(np.searchsorted(parts, atoms), return_inverse=True)[1]


# ---- one row


def _row(line: bytes, number: int, source: str, alike: bool) -> Row:
    """Return the atom of a line: between blanks, where that is clear, else in the columns of PDB.

    It is clear for 10 words, or 11 with a chain, if all rows have as many (``alike``) or the columns do not fit.
    """
    if b"\t" not in line and not alike and _fits(line):
        return _row_of_columns(line, number)
    words = line.split()
    apart = words[0] in (b"ATOM", b"HETATM") and len(words) in (_WITHOUT_CHAIN, _WITH_CHAIN)
    if apart and _RESIDUE_NUMBER.fullmatch(words[-6]):
        chain = words[4] if len(words) == _WITH_CHAIN else b""
        aligned = line[12:16].strip() == words[2]
        name, hetero = line[12:16] if aligned else words[2], words[0] == b"HETATM"
        return Row(number, hetero, name, words[3], chain, words[-6], words[-5:])
    if b"\t" not in line and _fits(line):
        return _row_of_columns(line, number)
    expected = "serial, atom, residue, chain if any, residue number, x y z, charge and radius"
    raise InputError(f"{len(words)} words; expected {expected}", source, number)


def _fits(line: bytes) -> bool:
    """Tell whether columns 31-54 hold coordinates with decimal points, and two words follow."""
    cells = [line[first:last] for first, last in _COLUMNS]
    return all(b"." in cell and is_number(cell) for cell in cells) and len(line[54:].split()) == 2


def _row_of_columns(line: bytes, number: int) -> Row:
    values = [line[first:last].strip() for first, last in _COLUMNS] + line[54:].split()
    names = line[12:16], line[17:21].strip(), line[21:22].strip(), line[22:27].strip()
    return Row(number, line.startswith(b"HETATM"), *names, values)


# ---- columns


def _values(rows: list[Row], source: str) -> Floats:
    """Return x, y, z, charge and radius (n, 5)."""

    def error(index: int, text: str) -> InputError:
        message = f"{_VALUES[index % 5]} is {text!r}; expected a finite number"
        return InputError(message, source, rows[index // 5].line)

    return numbers(np.array([value for row in rows for value in row.values]), error).reshape(-1, 5)


def _radii(rows: list[Row], radius: Floats, source: str) -> tuple[Floats, list[str]]:
    """Return the radii, NaN for 0, which force fields give hydrogens within their neighbour, and a warning."""
    for row in np.flatnonzero(radius < 0)[:1].tolist():
        raise InputError(f"the radius is {radius[row]:g}; expected 0 or more", source, rows[row].line)
    none = np.flatnonzero(radius == 0)
    message = f"{len(none)} atoms of radius 0, the first here: they have no radius of their own"
    warnings = [note(message, source, rows[none[0]].line)] if len(none) else []
    return np.where(radius == 0, np.nan, radius), warnings


def _table(rows: list[Row], position: Floats, radius: Floats, model: Ints) -> AtomTable:
    n = len(rows)
    name, residue_name, chain, residue = (
        np.array([cell.decode("latin-1").strip() for cell in cells]) for cells in list(zip(*rows, strict=True))[2:6]
    )
    element = np.array([_element(row.atom_name.decode("latin-1"), row.residue_name.decode("latin-1")) for row in rows])
    return AtomTable(
        position=position, element=element, atom_name=name, residue_name=residue_name, residue=residue,
        chain=chain, operator_chain=chain, bfactor=np.full(n, np.nan), radius=radius,
        occupancy=np.ones(n), alternate=np.full(n, ""), model=model, line_of=lambda row: rows[row].line,
        segment=np.full(n, ""), hetero=np.array([row.hetero for row in rows]),
    )  # fmt: skip


def _element(name: str, residue_name: str) -> str:
    columns = name != name.strip() or len(name) == 4
    return symbol_of_atom_name(name, residue_name) if columns else symbol_of_free_name(name, residue_name)


def _unknown(table: AtomTable, source: str) -> list[str]:
    rows = np.flatnonzero(table.element == UNKNOWN)
    if not len(rows):
        return []
    message = f"{len(rows)} atoms whose element is unknown, the first is {str(table.atom_name[rows[0]])!r}"
    return [note(message, source, table.line_of(int(rows[0])))]
