"""Balls: one a line, ``x y z r``; ``#`` begins a comment."""

from pathlib import PurePath

import numpy as np

from molviz.errors import InputError
from molviz.model.elements import UNKNOWN
from molviz.model.molecule import Molecule
from molviz.readers.atoms import coinciding_note, coinciding_rows
from molviz.readers.numbers import numbers, octets_of
from molviz.readers.reading import Reading


def read_xyzr(data: bytes, source: str) -> Reading:
    """Return the balls of a file as one molecule of unknown elements with radii of their own."""
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
    for row in np.flatnonzero(values[:, 3] <= 0)[:1].tolist():
        raise InputError(f"the radius is {values[row, 3]:g}; expected more than 0", source, rows[row][0])
    again = coinciding_rows(values[:, :3])
    warnings = (coinciding_note(len(again), source, rows[again[0]][0]),) if len(again) else ()
    element = np.full(len(values), UNKNOWN)
    name = PurePath(source.removesuffix(".gz")).stem
    molecule = Molecule.of(name, values[:, :3], element, radius=values[:, 3])
    return Reading(source, "xyzr", (molecule,), warnings=warnings, operator_chain=(molecule.chain,))
