"""XYZ and extended XYZ: one or many frames of a count, a comment, and that many atoms."""

import re
from collections.abc import Iterator
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Strings
from molviz.errors import InputError
from molviz.model.elements import UNKNOWN, symbol_of, symbol_of_label
from molviz.model.molecule import Molecule
from molviz.readers.atoms import coinciding_note, coinciding_rows
from molviz.readers.numbers import LONGEST, SHOWN, is_number, numbers, octets_of, overlong
from molviz.readers.reading import BeyondCountError, Reading, sound_frames
from molviz.readers.source import note

_PROPERTIES = re.compile(rb"(?:^|\s)properties=(?:\"([^\"]*)\"|(\S+))", re.IGNORECASE)
_COUNT = re.compile(rb"\s*[+-]?\d{1,18}\s*")
_REPEAT = re.compile(rb"[1-9]\d{0,8}")
_REPEATED = {b"species": b"1", b"z": b"1", b"pos": b"3"}  # how many columns these have
_TYPES = {b"S", b"R", b"I", b"L"}


class Columns(NamedTuple):
    """Where a row holds symbol and coordinates, and how many words it has at least."""

    symbol: int
    x: int
    width: int


class Frame(NamedTuple):
    """The rows of one frame, split into words."""

    line: int  # of the first atom, counted from one
    comment: bytes
    rows: list[list[bytes]]


PLAIN = Columns(symbol=0, x=1, width=4)


def read_xyz(data: bytes, source: str) -> Reading:
    """Return the frames of an XYZ file, those before the first broken one with a warning.

    Raises InputError where count and rows of the first do not match, or a row is not clear.
    """
    told: dict[str, str] = {}
    lines, extended = data.split(b"\n"), False

    def one(frame: Frame) -> Molecule:
        nonlocal extended
        molecule = _molecule(frame, source, told)
        extended = extended or bool(_PROPERTIES.search(frame.comment))
        return molecule

    molecules, warnings = sound_frames(map(one, _frames(lines, source)))
    if not molecules:
        raise InputError("no atoms; expected a count, a comment and that many atoms", source)
    return Reading(
        source, "extxyz" if extended else "xyz", molecules, warnings=(*told.values(), *warnings),
        operator_chain=tuple(molecule.chain for molecule in molecules),
    )  # fmt: skip


def _frames(lines: list[bytes], source: str) -> Iterator[Frame]:
    at = 0
    while at < len(lines):
        if not lines[at].strip():
            at += 1
            continue
        if at and _is_atom(lines[at].split()):
            raise BeyondCountError(f"{_shown(lines[at])}; expected the number of atoms of a frame", source, at + 1)
        count = _count(lines[at], source, at + 1)
        yield Frame(at + 3, lines[at + 1] if at + 1 < len(lines) else b"", _rows(lines, at, count, source))
        at += 2 + count


def _count(text: bytes, source: str, line: int) -> int:
    if not _COUNT.fullmatch(text):
        raise InputError(f"{_shown(text)}; expected the number of atoms of a frame", source, line)
    count = int(text)
    if count < 1:
        raise InputError(f"the count is {count}; expected at least one atom", source, line)
    return count


def _shown(text: bytes) -> str:
    return repr(text.decode("latin-1").strip()[:SHOWN])


def _rows(lines: list[bytes], at: int, count: int, source: str) -> list[list[bytes]]:
    rows = [line.split() for line in lines[at + 2 : at + 2 + count]]
    filled = next((k for k, row in enumerate(rows) if not row), len(rows))
    if filled < count:
        message = f"the count says {count} atoms, but only {filled} follow its comment; expected all of them"
        if at + 1 < len(lines) and _is_atom(lines[at + 1].split()):
            message += f" (line {at + 2}, where the comment stands, looks like an atom)"
        raise InputError(message, source, at + 1)
    return rows


def _is_atom(row: list[bytes]) -> bool:
    return len(row) >= PLAIN.width and all(is_number(word) for word in row[1:4])


# ---- one frame


def _molecule(frame: Frame, source: str, told: dict[str, str]) -> Molecule:
    """Return the molecule of a frame; what is odd is told once of a kind."""
    columns = _columns(frame, source, told)
    short = next((k for k, row in enumerate(frame.rows) if len(row) < columns.width), None)
    if short is not None:
        width = len(frame.rows[short])
        raise InputError(f"{width} words; expected a symbol and x y z", source, frame.line + short)
    position = _positions(frame, columns, source)
    label = [row[columns.symbol].decode("latin-1") for row in frame.rows]
    wrong = overlong(label)
    if wrong is not None:
        message = f"a label of {len(label[wrong])} letters, {label[wrong][:SHOWN]!r}…; expected at most {LONGEST}"
        raise InputError(message, source, frame.line + wrong)
    element = _elements(label, frame.line, source, told)
    again = coinciding_rows(position)
    if len(again):
        told.setdefault("coincide", coinciding_note(len(again), source, frame.line + int(again[0])))
    name = PurePath(source.removesuffix(".gz")).stem
    return Molecule.of(name, position, element, atom_name=np.array(label))


def _positions(frame: Frame, columns: Columns, source: str) -> Floats:
    words = [word for row in frame.rows for word in row[columns.x : columns.x + 3]]

    def error(index: int, text: str) -> InputError:
        message = f"{'xyz'[index % 3]} coordinate is {text!r}; expected a finite number"
        return InputError(message, source, frame.line + index // 3)

    return numbers(octets_of(words, error), error).reshape(-1, 3)


def _elements(labels: list[str], line: int, source: str, told: dict[str, str]) -> Strings:
    symbols = {label: symbol_of_label(label) for label in set(labels)}
    unknown = {label for label in symbols if symbols[label] == UNKNOWN}
    decorated = {label for label in symbols if not symbol_of(label) and not label.isdigit()} - unknown
    _tell("whose element is unknown", unknown, labels, line, source, told)
    _tell("whose element is taken from the leading letters", decorated, labels, line, source, told)
    return np.array([symbols[label] for label in labels])


def _tell(what: str, odd: set[str], labels: list[str], line: int, source: str, told: dict[str, str]) -> None:
    """Add a warning about the atoms with the odd labels, unless one of that kind is there already."""
    rows = [row for row, label in enumerate(labels) if label in odd] if odd else []
    if rows:
        message = f"{len(rows)} atoms {what}, the first is {labels[rows[0]]!r}"
        told.setdefault(what, note(message, source, line + rows[0]))


# ---- the columns of extended XYZ


def _columns(frame: Frame, source: str, told: dict[str, str]) -> Columns:
    """Return the columns that ``Properties=`` states, or the plain ones where that is missing or wrong."""
    match = _PROPERTIES.search(frame.comment)
    if not match:
        return PLAIN
    columns = _stated(match[1] or match[2])
    if columns is not None and _fits(columns, frame.rows):
        return columns
    told.setdefault(
        "properties", note("Properties= does not fit the rows; read as symbol x y z", source, frame.line - 1)
    )
    return PLAIN


def _stated(properties: bytes) -> Columns | None:
    """Return the columns of ``name:type:repeat`` triples; ``species`` or ``Z`` and ``pos`` are needed."""
    words = properties.split(b":")
    start, place = 0, dict[bytes, int]()
    for name, kind, repeat in zip(words[::3], words[1::3], words[2::3], strict=False):
        if kind not in _TYPES or not _REPEAT.fullmatch(repeat) or _REPEATED.get(name.lower(), repeat) != repeat:
            return None
        place[name.lower()] = start
        start += int(repeat)
    symbol = place.get(b"species", place.get(b"z"))
    if len(words) % 3 or symbol is None or b"pos" not in place:
        return None
    return Columns(symbol, place[b"pos"], start)


def _fits(columns: Columns, rows: list[list[bytes]]) -> bool:
    first = rows[0]
    return len(first) >= columns.width and all(is_number(word) for word in first[columns.x : columns.x + 3])
