"""Balls: one a line, ``x y z r``; ``#`` begins a comment."""

import warnings
from collections.abc import Callable
from pathlib import PurePath
from typing import TypeAlias

import numpy as np

from molviz.arrays import Floats
from molviz.errors import InputError
from molviz.model.elements import UNKNOWN
from molviz.model.molecule import Molecule
from molviz.readers.atoms import coinciding_note, coinciding_rows
from molviz.readers.numbers import LONGEST, numbers, octets_of
from molviz.readers.reading import Reading

PLAIN = b"0123456789+-.eE \t\n"  # letters of most files
Table: TypeAlias = tuple[Floats, Callable[[int], int]]  # numbers (n, 4); row → line of the file


def read_xyzr(data: bytes, source: str) -> Reading:
    """Return the balls of a file as one molecule of unknown elements with radii of their own."""
    values, line_of = _table(data) or _checked_table(data, source)
    for row in np.flatnonzero(values[:, 3] <= 0)[:1].tolist():
        raise InputError(f"the radius is {values[row, 3]:g}; expected more than 0", source, line_of(row))
    again = coinciding_rows(values[:, :3])
    told = (coinciding_note(len(again), source, line_of(int(again[0]))),) if len(again) else ()
    element = np.full(len(values), UNKNOWN)
    name = PurePath(source.removesuffix(".gz")).stem
    molecule = Molecule.of(name, values[:, :3], element, radius=values[:, 3])
    return Reading(source, "xyzr", (molecule,), warnings=told, operator_chain=(molecule.chain,))


def _table(data: bytes) -> Table | None:
    """Return the numbers (n, 4) at once where every line has four and nothing else; None for all other texts.

    Between the last word of a row and the first of the next there is then one end of a line, and nowhere else.
    """
    if data.translate(None, delete=PLAIN):
        return None
    octets = np.frombuffer(data.strip() + b"\n", np.uint8)
    blank = octets <= ord(" ")
    first = np.flatnonzero(blank[:-1] & ~blank[1:]) + 1  # letters of words after the first
    end = np.flatnonzero(octets == ord("\n"))
    whole = len(first) + 1 == 4 * len(end) and np.diff(end, prepend=0).max() <= LONGEST
    if not whole or not ((end[:-1] > first[2:-1:4]).all() and (end[:-1] < first[3::4]).all()):
        return None
    values = _converted(data)
    if values is None or len(values) != 4 * len(end):
        return None
    before = data[: len(data) - len(data.lstrip())].count(b"\n")
    return values.reshape(-1, 4), lambda row: row + 1 + before


def _converted(data: bytes) -> Floats | None:
    """The finite numbers of a text, None where there is something else."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # which it gives at what is no number
        try:
            values = np.fromstring(data, sep=" ")
        except (DeprecationWarning, ValueError):
            return None
    return values if np.isfinite(values).all() else None


def _checked_table(data: bytes, source: str) -> Table:
    """Return the numbers (n, 4) of any text, word by word; raises InputError at the first line that is not clear."""
    split = [(number, line.partition(b"#")[0].split()) for number, line in enumerate(data.split(b"\n"), start=1)]
    rows = [(number, words) for number, words in split if words]
    if not rows:
        raise InputError("no balls; expected lines of x y z r", source)
    for number, words in rows:
        if len(words) != 4:
            raise InputError(f"{len(words)} words; expected x y z r", source, number)

    def error(index: int, text: str) -> InputError:
        return InputError(f"{'xyzr'[index % 4]} is {text!r}; expected a finite number", source, rows[index // 4][0])

    values = numbers(octets_of([word for _, words in rows for word in words], error), error).reshape(-1, 4)
    return values, lambda row: rows[row][0]
