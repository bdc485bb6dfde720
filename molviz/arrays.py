"""Names for the array types that all tables are made of."""

from typing import TYPE_CHECKING, TypeAlias

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
