"""Questions to anything made of spheres, for Python users: an index made once, for any number of points and balls."""

import os
from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from molviz.arrays import Bools, Floats
from molviz.errors import InputError
from molviz.geometry.clashes import Clashes, clashes
from molviz.geometry.cubes import BallIndex
from molviz.geometry.grid import Neighbours
from molviz.geometry.shells import Shells
from molviz.geometry.whereabouts import Surroundings, Whereabouts
from molviz.model.molecule import doubles
from molviz.pipeline.door import load_one, tell
from molviz.pipeline.inputs import LONGEST, refuse_unresolved
from molviz.pipeline.placements import placements_from


class Index:
    """The balls of anything that ``molviz.draw`` takes, ready to be asked about points and other balls.

    ``molecule`` and ``spheres`` are what the options left of ``x``, row by row; answers name balls by their row. The
    options are those of ``molviz.draw``. Raises InputError for what cannot be used, and warns of what is odd.

    Behind it is the decomposition of Halperin & Overmars (1994), section 2.4: space is cut into cubes of side 2 r_max,
    each with the balls that meet it, and the order of these along a vertical tells in which simple cell of its cube a
    point lies. In a hard sphere model a cube meets a bounded number of balls, so that all cells together are O(n)
    (Theorem 2.4), and the index takes O(n) space and O(n log n) time; a point, or a ball of bounded radius, takes
    O(log n) (Theorem 3.1). Cubes are made when a query first needs them.
    """

    def __init__(
        self,
        x: Any,
        *,
        model: int | str = 1,
        assembly: str | None = None,
        select: str | None = None,
        no_water: bool = False,
        no_hydrogens: bool = False,
        chain: str | Sequence[str] | None = None,
        radii: str | os.PathLike[str] = "bondi",
        scale_radii: float = 1.0,
        probe: float = 0.0,
    ) -> None:
        loaded = load_one(x, locals())
        tell(loaded.warnings, stacklevel=3)
        self.molecule, self.spheres = loaded.molecule, loaded.spheres
        self._loaded, self._index = loaded, BallIndex(loaded.spheres)

    def __repr__(self) -> str:
        return f"<Index of {self.molecule.name!r}: {len(self.molecule)} balls>"

    def containing(self, points: Any) -> Neighbours:
        """Return which balls contain each point (m, 3): rows ``item[start[q] : start[q + 1]]`` for point q.

        Points on a sphere are outside. Raises InputError for what are no points.
        """
        place = _places("points", points)
        return self._index.balls_met(place, np.zeros(len(place)))

    def meeting(self, centers: Any, radii: Any) -> Neighbours:
        """Return which balls each ball of a center (m, 3) and a radius (m,), or of one radius for all, overlaps.

        Rows are as in ``containing``. Balls that only touch do not count. Raises InputError for what are no balls.
        """
        place = _places("centers", centers)
        one = isinstance(radii, int | float | np.number)
        radius = _numbers("radii", np.full(len(place), radii) if one else radii)
        if len(radius) != len(place):
            raise InputError(f"radii: {len(radius)} for {len(place)} centers; expected as many, or one for all")
        wrong = np.flatnonzero(~((radius >= 0) & (radius <= LONGEST)))
        if len(wrong):
            raise InputError(f"radii: row {wrong[0]} is {radius[wrong[0]]}; expected a number from 0 to {LONGEST:g}")
        return self._index.balls_met(place, radius)

    def inside(self, points: Any) -> Bools:
        """Return whether each point (m, 3) lies in any ball; those on the boundary do not."""
        return np.asarray(np.diff(self.containing(points).start) > 0)

    @property
    def shells(self) -> Shells:
        """The boundary of the union in its connected parts: first those around components, then the walls of cavities.

        ``outer`` (s,) tells which are which; ``area``, ``volume`` (negative for cavities), ``genus`` and
        ``parent``, the row of the shell around it or −1, are those of each.
        """
        return self._surroundings.shells

    def where(self, points: Any) -> Whereabouts:
        """Return in which component or cavity each point (m, 3) lies: rows of ``shells``, both −1 outside of all.

        They are the rows of ``molviz.surface(x, probe).components``, too, where its probe is that of this index.
        ``component`` is that of a ball which contains the point. From other points the way leads straight up, cube by
        cube, to the first face of the boundary, whose shell tells the ``cavity``. The boundary is made at the first
        call. Where balls are in special position (four spheres through a point, say) it is that of a few balls
        displaced by 2e-8 of their radius, and so are these answers. Raises InputError where the smallest ball is lost
        in the rounding of the scene.
        """
        return self._surroundings.at(_places("points", points))

    @cached_property
    def _surroundings(self) -> Surroundings:
        refuse_unresolved(self._loaded.balls, self._loaded.source)
        return Surroundings(self.spheres)

    def clashes(self, other: Any, placements: Any = None, tolerance: float = 0.0) -> Clashes:
        """Return which balls of ``other`` overlap which of these, for each of m placements of ``other``.

        ``other`` is an Index, which says what its options were, or anything that makes one; ``placements`` are
        matrices (m, 4, 4), or a tuple of rotations (m, 3, 3) and translations (m, 3) in ångström, a point x coming to
        lie at R x + t; None leaves ``other`` where it is. A pair counts that overlaps by more than ``tolerance``
        ångström; a negative one finds gaps too. Raises InputError for what is no rigid motion.
        """
        moved = other if isinstance(other, Index) else Index(other)
        if not isinstance(tolerance, int | float | np.number) or not abs(tolerance) <= LONGEST:
            raise InputError(f"tolerance: {tolerance!r}; expected a finite number of ångström")
        try:
            placed = placements_from(placements)
        except InputError as wrong:
            raise InputError(f"placements: {wrong}") from None
        return clashes(self._index, moved.spheres, placed, float(tolerance))


def _places(name: str, values: Any) -> Floats:
    """Points (m, 3), finite and not so far away that their squares are no numbers."""
    place = _numbers(name, values, (3,))
    wrong = np.flatnonzero(~(np.abs(place) <= LONGEST).all(axis=1))
    if len(wrong):
        raise InputError(f"{name}: row {wrong[0]} is not finite, or farther away than {LONGEST:g} Å")
    return place


def _numbers(name: str, values: Any, row: tuple[int, ...] = ()) -> Floats:
    """Numbers (m, *row); those in single precision as they are: they are places to ask for, not a file's decimals."""
    single = isinstance(values, np.ndarray) and values.dtype.kind == "f"
    return doubles(name, values.astype(np.float64) if single else values, row)
