"""Many numbers at once as text, by tables: words of four bytes in columns, zero where a word has fewer letters.

A row of words is one piece of text, such as a command with its numbers; all rows without their zeros are the text.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Words, distinct
from molviz.curves import Paths
from molviz.threads import in_threads

BLOCK = 8192  # arcs formatted at a time: what is in between stays in the cache
STREAMED = 32 * BLOCK  # arcs whose text is kept at a time
GROUP = 10_000  # of four digits, which are one word
BYTES = 4  # of a word
MINUS, SPACE = 1, 2  # what stands before a number, as rows of a table


class Formatted(NamedTuple):
    """The text of all loops of some paths, and where (loops,) each ends in it."""

    text: str
    stop: Ints

    def pieces(self, start: Ints) -> list[str]:
        """Return the text of each run of loops ``start[k] : start[k + 1]``."""
        at = np.concatenate([[0], self.stop])[start].tolist()
        return [self.text[first:stop] for first, stop in zip(at, at[1:], strict=False)]


def texts_of_shapes(paths: Paths, write: Callable[[Paths], Formatted]) -> Iterator[str]:
    """Yield what ``write`` makes of each shape: some blocks at a time, so that the text of all is never kept."""
    for first, stop in _cuts(paths.loop_start[paths.shape_start], STREAMED):
        some = _shapes(paths, first, stop)
        yield from formatted(some, write).pieces(some.shape_start)


def formatted(paths: Paths, write: Callable[[Paths], Formatted]) -> Formatted:
    """Return what ``write`` makes of the paths, which are given to it in blocks of whole loops, each one shape."""
    parts = in_threads(lambda cut: write(_loops(paths, *cut)), _cuts(paths.loop_start, BLOCK))
    before = np.cumsum([0, *(len(part.text) for part in parts)])
    stops = [part.stop + shift for part, shift in zip(parts, before, strict=False)]
    return Formatted("".join(part.text for part in parts), np.concatenate([np.empty(0, dtype=np.int64), *stops]))


def _cuts(start: Ints, size: int) -> Iterator[tuple[int, int]]:
    """Cut items that begin and end at ``start`` (k + 1,) into runs that are about so long."""
    count, total = len(start) - 1, int(start[-1])
    at = np.searchsorted(start, np.arange(0, total + size, size)).clip(0, count)
    cuts = distinct(np.concatenate([[0], at, [count]])).tolist()
    return zip(cuts, cuts[1:], strict=False)


def _loops(paths: Paths, first: int, stop: int) -> Paths:
    """Some loops of the paths, each a shape of its own."""
    start = paths.loop_start[first : stop + 1]
    arcs = type(paths.arcs)(*(column[start[0] : start[-1]] for column in paths.arcs))
    return Paths(arcs, start - start[0], np.arange(len(start)))


def _shapes(paths: Paths, first: int, stop: int) -> Paths:
    """Some shapes of the paths."""
    start = paths.shape_start[first : stop + 1]
    return _loops(paths, start[0], start[-1])._replace(shape_start=start - start[0])


@cache
def word(text: str) -> Words:
    """Return up to four letters as a word (1,)."""
    return np.frombuffer(text.encode("ascii").ljust(BYTES, b"\0"), np.uint32)


@cache
def words(*texts: str) -> Words:
    """Return a table of words."""
    return np.concatenate([word(text) for text in texts])


def steps_of(values: Floats, places: int) -> Ints:
    """Return values as whole numbers of the last of so many decimal places."""
    return np.rint(values * 10.0**places).astype(np.int64)


def number_words(steps: Ints, places: int, spaced: Bools) -> Words:
    """Return numbers of any shape as words (shape, w), as ``text.number`` writes them, after a blank where ``spaced``.

    The words of a number are its sign, groups of four digits, and its decimals; ``places`` is at most three.
    """
    size, unit = np.abs(steps), 10**places
    whole = size // unit
    part = size - whole * unit
    groups = _groups(int(whole.max(initial=0)))
    table = np.empty((*steps.shape, 2 + groups), dtype=np.uint32)
    table[..., 0] = words("", "-", " ", " -")[MINUS * (steps < 0) + SPACE * spaced]
    for group in range(groups):
        table[..., groups - group] = _group_words(whole, group, groups)
    table[..., -1] = np.where(size == 0, word("0"), _decimals(places)[part])
    return table


def spaced_numbers(values: Floats, places: int) -> Words:
    """Return rows of numbers (n, m) as words (n, w), separated by blanks."""
    spaced = np.ones(values.shape, dtype=bool)
    spaced[:, 0] = False
    return beside_each_other(number_words(steps_of(values, places), places, spaced))


def beside_each_other(table: Words) -> Words:
    """Return the words of numbers (n, m, w) as rows (n, m w)."""
    return table.reshape(len(table), table.shape[1] * table.shape[2])


def in_loops(start: Ints, moves: Words, commands: Words) -> Formatted:
    """Return the text of loops: of each its move (loops, w), then its commands ``start[k] : start[k + 1]`` (k, v)."""
    loop = np.arange(len(start) - 1)
    table = np.zeros((len(loop) + len(commands), max(moves.shape[1], commands.shape[1])), dtype=np.uint32)
    table[start[:-1] + loop, : moves.shape[1]] = moves
    rows = np.arange(len(commands)) + np.repeat(loop, np.diff(start)) + 1
    table[rows, : commands.shape[1]] = commands
    text, stop = packed(table)
    return Formatted(text, stop[start[1:] + loop])


def spaced_rows(kinds: Sequence[tuple[Bools, Floats, Words]], places: int) -> Words:
    """Return commands of several kinds, each row of one of them, as words (k, w).

    A kind is its rows (k,), their numbers (rows, m), and the letters behind them, a word for all or for each.
    """
    parts = [
        (rows, np.column_stack([spaced_numbers(values, places), np.broadcast_to(after, len(values))]))
        for rows, values, after in kinds
    ]
    table = np.zeros((len(kinds[0][0]), max(part.shape[1] for _, part in parts)), dtype=np.uint32)
    for rows, part in parts:
        table[rows, : part.shape[1]] = part
    return table


def packed(table: Words) -> tuple[str, Ints]:
    """Return the text of rows of words (n, w), and where (n,) each row ends in it."""
    octets = np.ascontiguousarray(table).view(np.uint8)
    kept = octets != 0
    return octets[kept].tobytes().decode("ascii"), np.cumsum(kept.sum(axis=1, dtype=np.int64))


def _groups(largest: int) -> int:
    """How many groups of digits a number has, at least one."""
    return 1 if largest < GROUP else 1 + _groups(largest // GROUP)


def _group_words(whole: Ints, group: int, groups: int) -> Words:
    """A group of digits of whole numbers, without leading zeros where nothing stands before it."""
    if groups == 1:
        return _digits(False)[whole]
    above = whole // GROUP**group
    digits = above % GROUP
    return np.asarray(np.where(above < GROUP, _digits(False)[digits], _digits(True)[digits]))


@cache
def _digits(full: bool) -> Words:
    """All groups of four digits, as words; without leading zeros unless ``full``."""
    digits = np.arange(GROUP)[:, None] // [1000, 100, 10, 1] % 10
    shown = full | (np.cumsum(digits, axis=1) > 0)
    return np.where(shown, digits + ord("0"), 0).astype(np.uint8).view(np.uint32).ravel()


@cache
def _decimals(places: int) -> Words:
    """All decimals of so many places behind their point, as words, without zeros at the end."""
    digits = np.arange(10**places)[:, None] // 10 ** np.arange(places)[::-1] % 10
    shown = np.cumsum(digits[:, ::-1], axis=1)[:, ::-1] > 0
    table = np.zeros((10**places, BYTES), dtype=np.uint8)
    table[:, 0] = np.where(shown[:, 0], ord("."), 0)
    table[:, 1 : 1 + places] = np.where(shown, digits + ord("0"), 0)
    return table.view(np.uint32).ravel()
