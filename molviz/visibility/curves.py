"""The curves that are seen: each knows its kind and the two solids that it lies between.

A *horizon* is the curve on which a ball turns away from the eye, and a *line* one of the two of a stick: the field's
*contour generators*, whose images are the occluding contours. Two solids meet in a *crease*; in a *seam*, which is no
line of a drawing, where a stick goes over into its joint or into another stick. A *border* halves a stick.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.circles import Circles

CREASE, HORIZON, LINE, SEAM, BORDER = range(5)
KINDS = ("crease", "horizon", "line", "seam", "border")  # their names
CONTOURS = (HORIZON, LINE)


class Curves(NamedTuple):
    """m curves ``p(θ) = center + a cos θ + b sin θ`` in eye coordinates.

    ``a × b`` of a crease points from the centre of ``first`` towards that of ``second``. A horizon has its own solid on
    both sides, ``first`` = ``second``, the half that faces the eye and the half that does not, and a × b points
    towards the eye. A line has b = 0 and runs between the two halves of its stick.
    """

    kind: Ints  # (m,)
    first: Ints  # (m,)
    second: Ints  # (m,)
    center: Floats  # (m, 3)
    a: Floats  # (m, 3)
    b: Floats  # (m, 3)

    def is_crease(self) -> Bools:
        """Return which curves (m,) are creases."""
        return np.asarray(self.kind == CREASE)

    def is_contour(self) -> Bools:
        """Return which curves (m,) are contour generators: horizons and lines."""
        return np.isin(self.kind, CONTOURS)

    def of_kind(self, kind: int) -> "Curves":
        """Return the curves of one kind, in their order."""
        return self.take(np.flatnonzero(self.kind == kind))

    def at(self, curve: Ints, angle: Floats) -> Floats:
        """Return the points (k, 3) at the given angles of the given curves."""
        center, a, b = (column.take(curve, axis=0) for column in self[3:])
        return np.asarray(center + a * np.cos(angle)[:, None] + b * np.sin(angle)[:, None])

    def circles(self) -> Circles:
        """Return the same curves without their kinds."""
        return Circles(self.first, self.second, self.center, self.a, self.b)

    def take(self, rows: Ints) -> "Curves":
        """Return the given curves, in that order."""
        rest = (column.take(rows, axis=0) for column in self[3:])
        return Curves(self.kind[rows], self.first[rows], self.second[rows], *rest)

    def followed_by(self, others: "Curves") -> "Curves":
        """Return the curves of two tables as one."""
        return Curves(*(np.concatenate(columns) for columns in zip(self, others, strict=True)))


def creases_of(circles: Circles) -> Curves:
    """Return circles in which spheres meet as curves."""
    return Curves(np.full(len(circles.first), CREASE), *circles)


def horizons_of(circles: Circles) -> Curves:
    """Return circles, one for each sphere in turn, as the spheres' horizons."""
    return Curves(np.full(len(circles.first), HORIZON), *circles)
