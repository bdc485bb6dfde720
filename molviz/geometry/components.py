"""Connected components of a graph."""

import numpy as np

from molviz.arrays import Ints


def component_labels(one: Ints, other: Ints, count: int) -> Ints:
    """Return for each of ``count`` vertices the number, from 0, of its component; edges run from ``one`` to ``other``.

    Every component of what is found so far hooks itself to a lower one beside it, and paths are shortened to their
    ends: few rounds even for long chains, and only edges between components are looked at again.
    """
    label = np.arange(count)
    while len(one):
        low, high = np.minimum(label[one], label[other]), np.maximum(label[one], label[other])
        apart = low < high
        one, other = one[apart], other[apart]
        np.minimum.at(label, high[apart], low[apart])
        while not np.array_equal(label[label], label):
            label = label[label]
    return np.unique(label, return_inverse=True)[1]


def components(one: Ints, other: Ints, count: int) -> int:
    """Return the number of connected components of ``count`` vertices with edges from ``one`` (m,) to ``other``."""
    return int(component_labels(one, other, count).max(initial=-1)) + 1
