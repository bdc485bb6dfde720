"""Names for the array types that all tables are made of, and sets of values."""

from collections.abc import Container
from typing import TYPE_CHECKING, TypeAlias, TypeVar

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats: TypeAlias = NDArray[np.float64]
    Ints: TypeAlias = NDArray[np.int64]
    Bools: TypeAlias = NDArray[np.bool_]
    Strings: TypeAlias = NDArray[np.str_]
    Singles: TypeAlias = NDArray[np.float32]
    Masks: TypeAlias = NDArray[np.uint64]
    Octets: TypeAlias = NDArray[np.uint8]
    Words: TypeAlias = NDArray[np.uint32]
    ShortInts: TypeAlias = NDArray[np.int32]
    Fields: TypeAlias = NDArray[np.bytes_]
    Texts: TypeAlias = NDArray[np.object_]
else:  # importing numpy.typing takes longer than drawing a small molecule
    Floats = Ints = Bools = Strings = Singles = Masks = Octets = Words = ShortInts = Fields = Texts = np.ndarray

Values = TypeVar("Values", "Floats", "Ints", "Bools", "Strings")


def distinct(values: Values) -> Values:
    """Return the distinct values of an array (n,), ascending.

    ``np.unique`` alone loads numpy's masked arrays first, which takes longer than small drawings do.
    """
    ordered: Values = np.sort(values)
    known: Values = ordered[np.append(True, ordered[1:] != ordered[:-1])[: len(ordered)]]
    return known


def among(values: "Strings", words: Container[str]) -> "Bools":
    """Return which of the strings (n,) are one of the words. ``np.isin`` would sort all of them."""
    return np.fromiter((value in words for value in values.tolist()), dtype=np.bool_, count=len(values))
