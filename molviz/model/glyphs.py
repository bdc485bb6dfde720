"""A dot-matrix font of capitals and digits, five dots wide and seven high, read from its table."""

from functools import cache
from importlib import resources

import numpy as np

from molviz.arrays import Ints
from molviz.errors import InputError

HEIGHT = 7
ADVANCE = 6  # columns from letter to letter


def dots(text: str) -> tuple[Ints, Ints]:
    """Return column and row (row 0 at the bottom) of every dot of ``text``, letter by letter.

    Raises ``InputError`` for a character that the font does not have, or a text without a dot.
    """
    places = [
        (ADVANCE * position + column, HEIGHT - 1 - line)
        for position, character in enumerate(text.upper())
        for line, pattern in enumerate(_glyph(character))
        for column, dot in enumerate(pattern)
        if dot == "#"
    ]
    if not places:
        raise InputError("the text has no letter, expected at least one")
    column, row = np.array(places, dtype=np.int64).T
    return column, row


def _glyph(character: str) -> list[str]:
    if character not in _font():
        raise InputError(f"no letter {character!r} in the dot-matrix font, expected A to Z, 0 to 9 or a blank")
    return _font()[character]


@cache
def _font() -> dict[str, list[str]]:
    """The table: a line with the character, then its seven rows of ``#`` and ``.``."""
    lines = resources.files("molviz.model").joinpath("glyphs.txt").read_text(encoding="utf-8").splitlines()
    font = {lines[at]: lines[at + 1 : at + 1 + HEIGHT] for at in range(0, len(lines), HEIGHT + 1)}
    return font | {" ": ["....."] * HEIGHT}
