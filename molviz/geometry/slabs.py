"""Many balls as slabs, each together with all that its own can meet: what is asked of neighbours, in bounded memory."""

from collections.abc import Iterator

import numpy as np

from molviz.arrays import Bools, Ints
from molviz.model.spheres import Spheres

SLAB_BALLS = 1 << 18  # of a slab's own
ROOM = 1.001  # of the distance at which two balls can meet, for rounding


def slabs(spheres: Spheres) -> Iterator[tuple[Ints, Bools]]:
    """Yield rows of n balls, ascending, and which of them are a slab's own (by row): no others meet these.

    Few balls are one slab.
    """
    count, side = len(spheres.radius), 2 * float(spheres.radius.max(initial=0.0))
    if count <= SLAB_BALLS:
        yield np.arange(count), np.ones(count, dtype=bool)
        return
    low, high = spheres.box()
    along = spheres.center[:, int(np.argmax(high - low))]
    order = np.argsort(along)
    place = along[order]
    for begin in range(0, count, SLAB_BALLS):
        end = min(begin + SLAB_BALLS, count)
        first = np.searchsorted(place, place[begin] - ROOM * side)
        rows = order[first : np.searchsorted(place, place[end - 1] + ROOM * side, side="right")]
        own: Bools = np.zeros(len(rows), dtype=bool)
        own[begin - first : end - first] = True
        ascending = np.argsort(rows)
        yield rows[ascending], own[ascending]
