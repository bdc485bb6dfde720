"""Ragged tables: ranges become rows, rows become lists."""

from collections.abc import Iterator

import numpy as np

from molviz.arrays import Floats, Ints


def expand(begin: Ints, end: Ints) -> tuple[Ints, Ints]:
    """Return all (q, k) with begin[q] ≤ k < end[q], ordered by q then k."""
    length = np.maximum(end - begin, 0)
    owner = np.repeat(np.arange(len(length)), length)
    first_row = np.cumsum(length) - length
    return owner, np.arange(len(owner)) + (begin - first_row)[owner]


def lists_taken(start: Ints, lists: Ints) -> tuple[Ints, Ints]:
    """Return the rows of the given lists of a CSR table, in that order, and their new offsets."""
    owner, row = expand(start[lists], start[lists + 1])
    return row, offsets(owner, len(lists))


def blocks(size: Ints, limit: int) -> Iterator[slice]:
    """Cut items of the given sizes into consecutive slices of at most ``limit`` in total (or one item)."""
    total = np.cumsum(size)
    begin = 0
    while begin < len(size):
        done = total[begin - 1] if begin else 0
        end = max(int(np.searchsorted(total, done + limit, side="right")), begin + 1)
        yield slice(begin, end)
        begin = end


def offsets(owner: Ints, count: int) -> Ints:
    """Return the CSR offsets (count + 1,) of rows sorted by owner."""
    return np.concatenate([[0], np.cumsum(np.bincount(owner, minlength=count))])


def ordered(owner: Ints, value: Floats) -> Ints:
    """Return ``np.lexsort((value, owner))`` for m rows, faster: one sort by one key, owner and value to ten digits.

    The key never falls where owner and value rise, so only rows of equal keys are left to sort, by value and place.
    """
    if len(value) == 0:
        return np.empty(0, dtype=np.int64)
    low, high = float(value.min()), float(value.max())
    key = owner + (value - low) / (high - low + 1.0) * 0.999
    order = np.argsort(key)
    key = key[order]
    again = np.append(False, key[1:] == key[:-1])
    tied = np.flatnonzero(again | np.append(again[1:], False))
    rows = order[tied]
    order[tied] = rows[np.lexsort((rows, value[rows], key[tied]))]
    return order
