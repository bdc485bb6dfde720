"""Work on blocks, shared by as many threads as the process may use; numpy lets them run side by side.

Results come in the order of the blocks, so that they are the same for any number of threads.
"""

import os
from collections.abc import Callable, Iterable
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")
S = TypeVar("S")

_chosen: list[int] = []  # by the user; empty: all there are


def use(number: int) -> None:
    """Let work be shared by that many threads from now on."""
    _chosen[:] = [number]


def count() -> int:
    """Return how many threads share work: by default one for each processor that the process may run on."""
    if _chosen:
        return _chosen[0]
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def in_threads(work: Callable[[T], R], blocks: Iterable[T]) -> list[R]:
    """Return the result of every block; blocks are taken from an iterable that is cheap to run through."""
    several = list(blocks)
    if len(several) < 2 or count() < 2:
        return [work(block) for block in several]
    from concurrent.futures import ThreadPoolExecutor  # takes longer to import than small scenes to draw

    with ThreadPoolExecutor(min(count(), len(several))) as pool:
        return list(pool.map(work, several))


def both(one: Callable[[], R], other: Callable[[], S], worth: bool) -> tuple[R, S]:
    """Return the results of two pieces of work, done side by side where that is ``worth`` a thread."""
    if not worth or count() < 2:
        return one(), other()
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(1) as pool:
        later = pool.submit(other)
        return one(), later.result()
