"""Connected components of a graph."""

import numpy as np

from molviz.arrays import Ints


def components(one: Ints, other: Ints, count: int) -> int:
    """Return the number of connected components of ``count`` vertices with edges from ``one`` (m,) to ``other``."""
    return len(np.unique(component_labels(one, other, count)))


def component_labels(one: Ints, other: Ints, count: int) -> Ints:
    """Return for each of ``count`` vertices the least vertex of its component; edges run from ``one`` to ``other``.

    Each vertex takes the least label of its neighbours, and labels are shortened by following them, until nothing
    changes: few rounds even for long chains.
    """
    label = np.arange(count)
    while True:
        least = label.copy()
        np.minimum.at(least, one, label[other])
        np.minimum.at(least, other, label[one])
        np.minimum.at(least, label, least.copy())
        least = least[least]
        if np.array_equal(least, label):
            return label
        label = least
