"""GRO, the coordinate format of GROMACS: one or many frames of a title, a count, that many atoms, and the box.

GROMACS reference manual, "File formats", gro: residue number, residue name, atom name and atom number in five columns
each, then x, y, z in nanometres, each as wide as the distance between two decimal points; velocities may follow.
"""

import re
from collections.abc import Iterator
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Strings
from molviz.errors import InputError
from molviz.model.elements import UNKNOWN, symbol_of_free_name
from molviz.model.molecule import Molecule
from molviz.readers.atoms import coinciding_note, coinciding_rows
from molviz.readers.numbers import numbers, octets_of
from molviz.readers.reading import Reading, sound_frames
from molviz.readers.source import note

NANOMETRE = 10.0  # ångström
_COUNT = re.compile(rb"\d{1,18}")
_NAMES = 20  # columns before the coordinates
_BOX_WORDS = (3, 9)  # a rectangular box, or three vectors


class Frame(NamedTuple):
    """The lines of one frame."""

    title: str
    line: int  # of the first atom, counted from one
    rows: list[bytes]


def read_gro(data: bytes, source: str) -> Reading:
    """Return the frames of a GRO file in ångström, those before the first broken one with a warning.

    Raises InputError where count, columns or box of the first are not clear.
    """
    told: dict[str, str] = {}
    frames = _frames(data.rstrip().split(b"\n"), source)
    molecules, warnings = sound_frames(_molecule(frame, source, told) for frame in frames)
    chains = tuple(molecule.chain for molecule in molecules)
    return Reading(source, "gro", molecules, warnings=(*told.values(), *warnings), operator_chain=chains)


def _frames(lines: list[bytes], source: str) -> Iterator[Frame]:
    at = 0
    while at < len(lines):
        frame = _frame(lines, at, source)
        yield frame
        at += len(frame.rows) + 3


def _frame(lines: list[bytes], at: int, source: str) -> Frame:
    """Return the frame whose title stands at the given index."""
    text = lines[at + 1].strip() if at + 1 < len(lines) else b""
    if not _COUNT.fullmatch(text) or int(text) < 1:
        shown = text.decode("latin-1")[:40]
        raise InputError(f"{shown!r} below the title; expected the number of atoms of a frame", source, at + 2)
    count = int(text)
    rows = lines[at + 2 : at + 2 + count]
    if len(rows) < count or at + 2 + count >= len(lines):
        follow = len(lines) - at - 2
        message = f"the count says {count} atoms, but {follow} lines follow; expected all atoms and the box"
        raise InputError(message, source, at + 2)
    _check_box(lines[at + 2 + count], source, at + 3 + count)
    return Frame(lines[at].decode("latin-1").strip(), at + 3, rows)


def _check_box(line: bytes, source: str, number: int) -> None:
    words = line.split()
    if len(words) not in _BOX_WORDS:
        message = f"{len(words)} words where the box stands by the count; expected 3 or 9 lengths in nm"
        raise InputError(message, source, number)

    def error(_: int, text: str) -> InputError:
        return InputError(f"{text!r} where the box stands by the count; expected lengths in nm", source, number)

    numbers(octets_of(words, error), error)


def _molecule(frame: Frame, source: str, told: dict[str, str]) -> Molecule:
    """Return the molecule of a frame; what is odd is told once of a kind."""
    fields = [[row[k : k + 5].decode("latin-1").strip() for row in frame.rows] for k in (0, 5, 10)]
    position = _positions(frame, source)
    residue, residue_name, atom_name = map(np.array, fields)
    element = _elements(atom_name, residue_name)
    unknown = np.flatnonzero(element == UNKNOWN)
    if len(unknown):
        message = f"{len(unknown)} atoms whose element is unknown, the first is {str(atom_name[unknown[0]])!r}"
        told.setdefault("unknown", note(message, source, frame.line + int(unknown[0])))
    again = coinciding_rows(position)
    if len(again):
        told.setdefault("coincide", coinciding_note(len(again), source, frame.line + int(again[0])))
    name = frame.title or PurePath(source.removesuffix(".gz")).stem
    return Molecule.of(name, position, element, atom_name=atom_name, residue_name=residue_name, residue=residue)


def _positions(frame: Frame, source: str) -> Floats:
    """Return the coordinates (n, 3) in ångström, from columns as wide as the first row has them."""
    width = _width(frame.rows[0], source, frame.line)
    end = _NAMES + 3 * width
    for row, text in enumerate(frame.rows):
        if len(text) < end or b"\t" in text:
            what = "tabs in the row" if b"\t" in text else f"the row ends at column {len(text)}"
            raise InputError(f"{what}; expected coordinates in columns {_NAMES + 1}-{end}", source, frame.line + row)

    def error(index: int, text: str) -> InputError:
        message = f"{'xyz'[index % 3]} coordinate is {text.strip()!r}; expected a finite number"
        return InputError(message, source, frame.line + index // 3)

    cells = [text[k : k + width] for text in frame.rows for k in range(_NAMES, end, width)]
    with np.errstate(over="ignore"):
        position = numbers(np.array(cells), error) * NANOMETRE
    for index in np.flatnonzero(np.isinf(position))[:1].tolist():
        raise error(index, cells[index].decode("latin-1"))
    return position.reshape(-1, 3)


def _width(row: bytes, source: str, line: int) -> int:
    first = row.find(b".", _NAMES)
    second = row.find(b".", first + 1)
    if first < 0 or second < 0:
        raise InputError("no coordinates with decimal points behind column 20; expected x y z in nm", source, line)
    return second - first


def _elements(atom_name: Strings, residue_name: Strings) -> Strings:
    keys = list(zip(atom_name.tolist(), residue_name.tolist(), strict=True))
    element_of = {key: symbol_of_free_name(*key) for key in set(keys)}
    return np.array([element_of[key] for key in keys])
