"""Columns of text to columns of finite numbers, without forgiveness."""

import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from molviz.arrays import Fields, Floats
from molviz.errors import InputError

LONGEST = 500  # letters of a name or number; a column is as wide as its longest, and one has to fit many times
SHOWN = 40  # letters of a longer one that a message repeats
_NUMBER = re.compile(rb" *[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)? *")
_LEGAL = np.isin(np.arange(256), np.frombuffer(b"0123456789+-.eE \0", np.uint8))
_FORTRAN = np.where(np.isin(np.arange(256), (ord("d"), ord("D"))), ord("E"), np.arange(256)).astype(np.uint8)


def numbers(texts: Fields, error: Callable[[int, str], InputError]) -> Floats:
    """Return the texts (n,) as finite numbers; decimal, with an exponent after e, E or Fortran's d, D.

    ``error(row, text)`` makes the exception for the first text that is no such number: blank, ``abc``, ``15,268``,
    ``********``, ``nan``, ``inf`` and ``1_0`` are none.
    """
    octets = _FORTRAN[texts.view(np.uint8).reshape(len(texts), -1)]
    if _LEGAL[octets].all():
        values = _converted(octets.view(texts.dtype).ravel())
        if values is not None:
            return values
    row = next(row for row, text in enumerate(texts) if not is_number(text))
    raise error(row, texts[row].decode("latin-1"))


def plain_numbers(words: Sequence[str]) -> Floats | None:
    """Return words (n,) as finite numbers where all are plain decimal ones, as in most files; None where one is not."""
    if not words or max(map(len, words)) > LONGEST:
        return None
    try:
        return plain_fields(np.array(words, dtype=np.bytes_))
    except UnicodeEncodeError:
        return None


def plain_fields(texts: Fields) -> Floats | None:
    """Return texts (n,) as finite numbers where all are plain decimal ones; None where one is not."""
    return _converted(texts) if _LEGAL[texts.view(np.uint8)].all() else None


def octets_of(words: list[bytes], error: Callable[[int, str], InputError]) -> Fields:
    """Return words (n,) as a column, as wide as the longest; raises ``error(row, text)`` for one that is too long."""
    row = overlong(words)
    if row is not None:
        raise error(row, f"{words[row][:SHOWN].decode('latin-1')}…")
    return np.array(words)


def overlong(words: Sequence[str] | Sequence[bytes]) -> int | None:
    """Return the row of the first word that is longer than ``LONGEST``, None where there is none."""
    return next((row for row, word in enumerate(words) if len(word) > LONGEST), None)


def number_of(text: bytes) -> float | None:
    """Return the finite decimal number that the text is, None where it is none."""
    if not _NUMBER.fullmatch(text):
        return None
    number = float(re.sub(rb"[dD]", b"e", text))
    return number if abs(number) < np.inf else None


def is_number(text: bytes) -> bool:
    """Tell whether the text is a finite decimal number."""
    return number_of(text) is not None


def _converted(texts: "np.ndarray[Any, np.dtype[np.bytes_]]") -> Floats | None:
    try:
        with np.errstate(over="ignore"):  # 1e324 is infinite
            values = texts.astype(np.float64)
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None
