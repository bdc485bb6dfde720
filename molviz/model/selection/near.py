"""Which atoms lie near others."""

import numpy as np

from molviz.arrays import Bools, Floats, Ints

FARTHEST = 1e100  # ångström: everything is nearer, and the square is a number
NEAREST = 1e-3  # ångström, the least edge of a cube


def within(position: Floats, target: Ints, distance: float) -> Bools:
    """Return which points (n,) are at most ``distance`` from one of the targets, rows of points.

    Points and targets are cast into cubes of that edge; only targets in the 27 cubes around a point's can be so near.
    """
    near = np.zeros(len(position), dtype=bool)
    if not len(target) or distance < 0:
        return near
    distance = min(distance, FARTHEST)
    cell = np.column_stack([_slabs(column, max(distance, NEAREST)) for column in position.T])
    stride = np.cumprod([1, *(cell.max(axis=0) + 2)[:2]])
    order = target[np.argsort(cell[target] @ stride)]
    key = cell[order] @ stride
    for step in np.ndindex(3, 3, 3):
        wanted = (cell + np.array(step) - 1) @ stride
        first, last = np.searchsorted(key, wanted, "left"), np.searchsorted(key, wanted, "right")
        for offset in range(int((last - first).max())):
            rows = np.flatnonzero((first + offset < last) & ~near)
            gap = position[rows] - position[order[first[rows] + offset]]
            near[rows] = (gap**2).sum(axis=1) <= distance**2
    return near


def _slabs(column: Floats, side: float) -> Ints:
    """Return the slab of width ``side`` of every number (n,), from 1; rows of empty slabs are numbered as one."""
    slabs, which = np.unique(np.floor(column / side), return_inverse=True)
    return np.cumsum(np.append(1, np.minimum(np.diff(slabs), 2))).astype(np.int64)[which]
