"""The PDB format: every column of the file at once, as a table of bytes.

wwPDB, "Protein Data Bank Contents Guide: Atomic Coordinate Entry Format Description", version 3.3.
"""

import itertools
import re
from collections.abc import Iterator, Mapping
from pathlib import PurePath
from typing import Any, NamedTuple

import numpy as np

from molviz.arrays import Bools, Fields, Floats, Ints, Octets, Strings
from molviz.errors import InputError
from molviz.model.bonds import NO_BONDS, Bonds, joined_lists
from molviz.model.elements import UNKNOWN, symbol_of, symbol_of_atom_name
from molviz.readers.atoms import AtomTable, models_of
from molviz.readers.connections import Connection, connected
from molviz.readers.numbers import number_of, numbers, plain_fields
from molviz.readers.reading import AssemblyPart, Reading, left_out
from molviz.readers.source import note

WIDTH = 80
_COORDINATES = {"x": (31, 38), "y": (39, 46), "z": (47, 54)}
_PARTNERS = (12, 17, 22, 27)  # first columns of the serial numbers that CONECT joins to that in column 7
_TRIPLE = 3
_HYBRID_36 = re.compile(r"([A-Z][0-9A-Z]{3}|[a-z][0-9a-z]{3})(?![0-9])(.?)$")


class Lines(NamedTuple):
    """The lines of a text, cut and padded with blanks to 80 columns."""

    octet: Octets  # (n, 80)
    length: Ints  # (n,) as in the file
    number: Ints  # (n,) counted from one

    def take(self, rows: Ints | Bools) -> "Lines":
        """Return the given lines."""
        return Lines(self.octet[rows], self.length[rows], self.number[rows])

    def field(self, first: int, last: int) -> Fields:
        """Return the columns ``first`` to ``last``, counted from one as the format does, as texts (n,)."""
        return np.ascontiguousarray(self.octet[:, first - 1 : last]).view(f"S{last - first + 1}").ravel()

    def texts(self) -> Iterator[tuple[int, str]]:
        """Yield number and text of every line, blanks at its end removed."""
        for number, text in zip(self.number.tolist(), self.field(1, WIDTH).tolist(), strict=True):
            yield number, text.decode("latin-1").rstrip()


def read_pdb(data: bytes, source: str) -> Reading:
    """Return the models of a PDB file; raises InputError at the first atom that is not clear."""
    lines = _lines(data)
    record = np.char.upper(lines.field(1, 6))
    is_atom = np.char.startswith(record, b"ATOM") | np.char.startswith(record, b"HETATM")
    if not is_atom.any():
        raise InputError("no ATOM or HETATM records; expected a PDB file with atoms", source)
    model, warnings = _models(record, lines, is_atom, source)
    atoms, table, more = _sound_table(lines.take(is_atom), model, source)
    bonds, still_more = _connections(lines.take(record == b"CONECT"), _serials(atoms, 7), table.model, source)
    links = connected(table, list(_links(lines, record)))
    models = models_of(table._replace(bonds=joined_lists([bonds, links])), _title(record, lines, source), source)
    assemblies = _assemblies(lines.take(np.char.startswith(lines.field(1, 10), b"REMARK 350")), source)
    told = (*warnings, *more, *models.warnings, *still_more)
    return Reading(source, "pdb", models.molecules, assemblies, told, models.operator_chain)


def _lines(data: bytes) -> Lines:
    padded = np.frombuffer(data + b"\n" + b" " * WIDTH, np.uint8)
    stop = np.flatnonzero(padded == ord("\n"))
    start = np.concatenate([[0], stop[:-1] + 1])
    filled = np.flatnonzero(stop > start)  # empty lines are a byte in the file, and WIDTH here
    start, stop = start[filled], stop[filled]
    octet = np.lib.stride_tricks.sliding_window_view(padded, WIDTH)[start]
    length = stop - start
    short = np.flatnonzero(length < WIDTH)
    octet[short] = np.where(np.arange(WIDTH) < length[short, None], octet[short], ord(" "))
    return Lines(octet, length, filled + 1)


def _check_columns(atoms: Lines, source: str) -> None:
    """Refuse atom records that end inside the coordinates or have tabs, which leave no fixed columns."""
    tabs = atoms.octet == ord("\t")
    tabs = tabs.any(axis=1) if tabs.any() else np.zeros(len(tabs), dtype=bool)
    for bad in np.flatnonzero(tabs | (atoms.length < _COORDINATES["z"][1]))[:1].tolist():
        line = int(atoms.number[bad])
        if tabs[bad]:
            raise InputError("tabs in an atom record; expected blanks and fixed columns", source, line)
        raise InputError(
            f"the record ends at column {atoms.length[bad]}; expected coordinates in columns 31-54", source, line
        )


# ---- models


def _models(record: Fields, lines: Lines, is_atom: Bools, source: str) -> tuple[Ints, list[str]]:
    """Return the model (n,) of every atom, and warnings.

    MODEL, ENDMDL and END each part what is before from what is behind, so that a missing number or a missing ENDMDL
    costs no atom. Models without atoms are passed over.
    """
    word = np.char.rstrip(record)
    opens, closes = word == b"MODEL", word == b"ENDMDL"
    parts = np.cumsum(opens | closes | (word == b"END"))
    opening, closing = np.flatnonzero(opens), np.flatnonzero(closes)
    warnings = _model_number_notes(lines.take(opening), source)
    stray = closing[np.searchsorted(opening, closing) == np.searchsorted(opening, np.append(-1, closing[:-1]))]
    if len(stray):
        warnings.append(note("ENDMDL without a MODEL above it", source, int(lines.number[stray[0]])))
    unclosed = opening[1:][np.diff(np.searchsorted(closing, opening)) == 0]
    if len(unclosed):
        warnings.append(note("MODEL before the ENDMDL of the model above", source, int(lines.number[unclosed[0]])))
    return np.unique(parts[is_atom], return_inverse=True)[1], warnings


def _model_number_notes(openings: Lines, source: str) -> list[str]:
    seen: set[str] = set()
    for line, text in openings.texts():
        number = text[5:].strip()
        if not number.isdigit():
            return [note("MODEL without a number; models are counted in their order", source, line)]
        if number in seen:
            return [note(f"MODEL {number} again; models are counted in their order", source, line)]
        seen.add(number)
    return []


# ---- atoms


def _sound_table(atoms: Lines, model: Ints, source: str) -> tuple[Lines, AtomTable, list[str]]:
    """Return lines and table of the atoms in models before the first broken one, and warnings.

    Raises InputError where the first model is broken.
    """
    try:
        _check_columns(atoms, source)
        return atoms, *_table(atoms, model, source)
    except InputError as wrong:
        broken = int(model[np.searchsorted(atoms.number, wrong.line or 0)])
        if broken == 0:
            raise
        rows = np.flatnonzero(model < broken)
        sound, table, warnings = _sound_table(atoms.take(rows), model[rows], source)
        return sound, table, [left_out(wrong, broken, "model"), *warnings]


def _table(atoms: Lines, model: Ints, source: str) -> tuple[AtomTable, list[str]]:
    element, warnings = _elements(atoms, source)
    occupancy, more = _optional(atoms, "occupancy", 55, 60, 1.0, source)
    bfactor, still_more = _optional(atoms, "B-factor", 61, 66, np.nan, source)
    chain = _names(atoms, 22, 22)
    table = AtomTable(
        position=_positions(atoms, source), element=element, atom_name=_names(atoms, 13, 16),
        residue_name=_names(atoms, 18, 21), residue=_residues(_names(atoms, 23, 27)), chain=chain,
        operator_chain=chain, bfactor=bfactor, radius=np.full(len(model), np.nan),
        occupancy=occupancy, alternate=_names(atoms, 17, 17), model=model,
        line_of=lambda row: int(atoms.number[row]), segment=_names(atoms, 73, 76),
        hetero=np.char.startswith(np.char.upper(atoms.field(1, 6)), b"HETATM"),
    )  # fmt: skip
    return table, [*warnings, *more, *still_more]


def _positions(atoms: Lines, source: str) -> Floats:
    def error_in(axis: str, first: int, last: int) -> Any:
        def error(row: int, text: str) -> InputError:
            what = f"{axis} coordinate (columns {first}-{last}) is {repr(text.strip()) if text.strip() else 'blank'}"
            return InputError(f"{what}; expected a finite number", source, int(atoms.number[row]))

        return error

    columns = [
        numbers(atoms.field(first, last), error_in(axis, first, last)) for axis, (first, last) in _COORDINATES.items()
    ]
    return np.column_stack(columns)


def _optional(atoms: Lines, what: str, first: int, last: int, default: float, source: str) -> tuple[Floats, list[str]]:
    """Return a column that may be blank, and a warning where it is neither blank nor a number."""
    plain = plain_fields(atoms.field(first, last))
    if plain is not None:
        return plain, []
    texts, which = np.unique(atoms.field(first, last), return_inverse=True)
    values = np.array([number_of(text) for text in texts.tolist()], dtype=float)
    readable = ~np.isnan(values)
    values[~readable] = default
    wrong = ~readable & (np.char.strip(texts) != b"")
    rows = np.flatnonzero(wrong[which])
    if not len(rows):
        return values[which], []
    text = texts[which[rows[0]]].decode("latin-1").strip()
    message = f"{what} {text!r} (columns {first}-{last}) is no number; taken as {default:g}, {len(rows)} in all"
    return values[which], [note(message, source, int(atoms.number[rows[0]]))]


def _names(atoms: Lines, first: int, last: int) -> Strings:
    """Return a column of short names without the blanks around them; at most eight columns wide."""
    codes, which = _distinct(atoms, (first, last))
    return np.array([_text(code).strip() for code in codes])[which]


def _distinct(atoms: Lines, *fields: tuple[int, int]) -> tuple[list[bytes], Ints]:
    """Return the different texts of some columns, at most eight in all, and which of them each row has."""
    octets = np.zeros((len(atoms.number), 8), np.uint8)
    columns = np.concatenate([np.arange(first - 1, last) for first, last in fields])
    octets[:, : len(columns)] = atoms.octet[:, columns]
    codes, which = np.unique(octets.view(np.uint64).ravel(), return_inverse=True)
    return [code.tobytes()[: len(columns)] for code in codes], which


def _text(octets: bytes) -> str:
    return octets.decode("latin-1")


def _residues(texts: Strings) -> Strings:
    """Return residue numbers with insertion code; numbers above 9999 run into column 27 or are hybrid-36."""
    names, which = np.unique(texts, return_inverse=True)
    return np.array([_residue(name) for name in names.tolist()])[which]


def _residue(text: str) -> str:
    """Return number and code without blanks between, hybrid-36 (Grosse-Kunstleve 2007: A000 is 10000) decoded."""
    text = text.replace(" ", "")
    match = _HYBRID_36.match(text)
    if not match:
        return text
    digits, code = match.groups()
    offset = 10**4 - 10 * 36**3 if digits[0].isupper() else 10**4 + 16 * 36**3
    return f"{int(digits, 36) + offset}{code}"


def _elements(atoms: Lines, source: str) -> tuple[Strings, list[str]]:
    """Return symbols from columns 77-78 where they hold one, else from atom and residue name, and warnings.

    Before 1996 these columns held part of an entry name and a serial number: digits there are no element.
    """
    codes, which = _distinct(atoms, (77, 78))
    written = np.array([symbol_of(_text(code)) for code in codes])[which]
    names, which = _distinct(atoms, (13, 16), (18, 21))
    guessed = np.array([symbol_of_atom_name(_text(name[:4]), _text(name[4:])) for name in names])[which]
    missing = written == ""
    element = np.where(missing, guessed, written)
    known, unknown = np.flatnonzero(missing & (guessed != UNKNOWN)), np.flatnonzero(element == UNKNOWN)
    warnings = []
    if len(known):
        warnings.append(_guess_note("without element; taken from their names", known, atoms, source))
    if len(unknown):
        warnings.append(_guess_note("whose element is unknown", unknown, atoms, source))
    return element, warnings


def _guess_note(what: str, rows: Ints, atoms: Lines, source: str) -> str:
    name = _text(atoms.octet[rows[0], 12:16].tobytes()).strip()
    return note(f"{len(rows)} atoms {what}, the first is {name!r}", source, int(atoms.number[rows[0]]))


# ---- what stands beside the atoms


def _title(record: Fields, lines: Lines, source: str) -> str:
    title = " ".join(text[10:80].strip() for _, text in lines.take(record == b"TITLE ").texts())
    entry = "".join(text[62:66].strip() for _, text in lines.take(record == b"HEADER").texts())
    return title or entry or PurePath(source.removesuffix(".gz")).stem


def _serials(lines: Lines, first: int) -> Fields:
    """Return the serial numbers (n,) in the five columns from the given one, as texts without blanks."""
    return np.char.strip(lines.field(first, first + 4))


def _connections(records: Lines, serial: Fields, model: Ints, source: str) -> tuple[Bonds, list[str]]:
    """Return the bonds of CONECT between the rows of all models, and a warning where serial numbers run together.

    An atom that stands k times in one record has a bond of order k, as programs write it. Serial numbers that no atom
    or several atoms of a model have make no bond.
    """
    clear = np.ones(len(records.number), dtype=bool)
    warnings = []
    for row, (line, text) in enumerate(records.texts()):
        serials = text[6:31].rstrip()
        if len(serials) % 5 and re.search(r"\S{6,}", serials):
            clear[row] = False
            warnings.append(note("CONECT with serial numbers run together is ignored", source, line))
    return _bonds(records.take(clear), serial, model), warnings[:1]


def _bonds(records: Lines, serial: Fields, model: Ints) -> Bonds:
    if not len(records.number):
        return NO_BONDS
    first, partner = _serials(records, 7), np.column_stack([_serials(records, start) for start in _PARTNERS])
    order = np.minimum((partner[:, :, None] == partner[:, None, :]).sum(axis=2), _TRIPLE).ravel()
    texts, code = np.unique(np.concatenate([serial, first, partner.ravel()]), return_inverse=True)
    code, one, other = np.split(code, np.cumsum([len(serial), len(first)]))
    one = np.repeat(one, len(_PARTNERS))
    pairs = []
    for begin, end in itertools.pairwise([*np.searchsorted(model, np.arange(model[-1] + 1)).tolist(), len(model)]):
        row_of = np.full(len(texts), -1)
        row_of[code[begin:end]] = np.arange(begin, end)
        row_of[(np.bincount(code[begin:end], minlength=len(texts)) > 1) | (texts == b"")] = -1
        pairs.append(np.column_stack([row_of[one], row_of[other]]))
    atoms, order = np.concatenate(pairs), np.tile(order, len(pairs)).astype(float)
    rows = np.flatnonzero((atoms >= 0).all(axis=1))
    rows = rows[np.argsort(-order[rows], kind="stable")]  # of two records, the one that says more
    return Bonds.of(atoms[rows], order[rows])


def _links(lines: Lines, record: Fields) -> Iterator[Connection]:
    """Yield the connections of LINK and SSBOND, less those to an atom of another cell (columns 60-65 and 67-72)."""
    for _, short in lines.take((record == b"LINK  ") | (record == b"SSBOND")).texts():
        text = short.ljust(WIDTH)
        operators = [text[first : first + 6].strip() for first in (59, 66)]
        if operators[0] != operators[1]:
            continue
        is_link = text[:4].upper() == "LINK"
        names = [text[12:16].strip(), text[42:46].strip()] if is_link else ["SG", "SG"]
        chains = (21, 51) if is_link else (15, 29)  # behind each its residue's number and insertion code
        one, other = [
            (text[k].strip(), _residue(text[k + 1 : k + 7]), name) for k, name in zip(chains, names, strict=True)
        ]
        yield one, other, 1.0


def _assemblies(remarks: Lines, source: str) -> Mapping[str, tuple[AssemblyPart, ...]]:
    """Return the assemblies of REMARK 350: for each biomolecule, chains and BIOMT operators that apply to them.

    Raises InputError where a BIOMT row is no row of numbers, or the rows are not three to an operator.
    """
    assemblies: dict[str, list[tuple[set[str], list[list[float]]]]] = {}
    parts: list[tuple[set[str], list[list[float]]]] = []
    for line, text in remarks.texts():
        head, _, tail = text[10:].partition(":")
        if head.strip() == "BIOMOLECULE":
            parts = assemblies.setdefault(tail.strip(), [])
        elif head.strip().startswith("APPLY THE FOLLOWING"):
            parts.append((_chains(tail), []))
        elif head.strip() == "AND CHAINS" and parts:
            parts[-1][0].update(_chains(tail))
        elif "BIOMT" in head and parts:
            parts[-1][1].append(_operator_row(head.split(), source, line))
    return {
        name: tuple(AssemblyPart(frozenset(chains), _operators(rows, source)) for chains, rows in parts)
        for name, parts in assemblies.items()
        if parts
    }


def _chains(text: str) -> set[str]:
    return {"" if name == "NULL" else name for name in text.replace(",", " ").split()}


def _operator_row(words: list[str], source: str, line: int) -> list[float]:
    values = [number_of(word.encode()) for word in words[2:]]
    row = [value for value in values if value is not None]
    if len(words) != 6 or len(row) != 4:
        raise InputError("BIOMT without four numbers; expected a row of R and t", source, line)
    return row


def _operators(rows: list[list[float]], source: str) -> Floats:
    if len(rows) % 3:
        raise InputError(f"{len(rows)} BIOMT rows; expected three to an operator", source)
    return np.array(rows, dtype=float).reshape(-1, 3, 4)
