"""Why arcs end where they do: the kinds of vertices, and the reasons for which intervals of curves are hidden."""

import numpy as np

from molviz.arrays import Ints

TRIPLE, ENTRY, TEE, WHOLE, EDGE, ELBOW, HALF = range(7)
BALL, OWN, FRONT, CUT = range(4)  # inside a ball or a stick, behind the curve's own solid or one in front, or cut off


def named(kind: Ints, side: Ints | int, *numbers: Ints | int) -> Ints:
    """Return names (k, 4): kind × 2 + side, and three numbers."""
    columns = [kind * 2 + side, *numbers]
    return np.stack([np.broadcast_to(column, kind.shape) for column in columns], axis=1).astype(np.int64)
