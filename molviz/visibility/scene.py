"""One scene, any number of views: spheres in general position, their union boundary, and the map or the pieces."""

from collections.abc import Callable, Sequence
from functools import cache, partial
from itertools import pairwise
from typing import NamedTuple, TypeVar

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.errors import InputError, InternalError
from molviz.geometry.boundary import Boundary, union_boundary
from molviz.geometry.general_position import (
    ATTEMPTS,
    NONE,
    Degenerate,
    displaced,
    first_general,
    first_of_each,
    shrinkage,
)
from molviz.model.spheres import Balls, Spheres
from molviz.model.sticks import NO_STICKS, Sticks
from molviz.visibility.culling import outlines, possibly_visible
from molviz.visibility.eye import (
    eye_coordinates,
    occluders_of,
    projection_of,
    refuse_eye_among,
    sticks_in_view,
)
from molviz.visibility.map import VisibilityMap, map_in_view
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.painter import Pieces, painter_pieces
from molviz.visibility.solids import Solids
from molviz.visibility.tiles import Each
from molviz.visibility.view import View

T = TypeVar("T")
# Of the offset of parallel sticks, less at each attempt: some 5e-4 Å, by which the ends of their rims may miss those of
# horizons and lines, and what passes just there is in special position however little the spheres are displaced.
NARROWER = 5e-3
WIDER_STEPS = 3.0  # times as much less at each further time that a stick is concerned: each costs a map
MOST_TIMES = 3  # before all spheres are displaced anew


class Prepared(NamedTuple):
    """A displaced copy of a scene's spheres, their rows in the scene, and the sticks between them."""

    boundary: Boundary
    row: Ints  # (s,)
    sticks: Sticks
    stick: Ints  # (k,) rows of the scene's sticks


class Scene:
    """Balls and sticks to look at. What no view changes, displacement and union boundary, is computed once and kept.

    Sticks may meet the two balls that they join, and others as wide as their common ball, but nothing else: sticks of
    one ball not outside it, and no others at all.

    Where only one view is wanted, naming it spares the work for spheres that it hides; no other may be asked for then.
    ``each`` does the tiles of large maps of balls in turn, as ``map`` does, or has others do them.
    """

    def __init__(
        self, balls: Balls, only: View | None = None, sticks: Sticks = NO_STICKS, each: Each = map
    ) -> None:
        self.balls, self.only, self.sticks, self.each = balls, only, sticks, each
        self._prepared: dict[int, Prepared] = {}

    def __repr__(self) -> str:
        return f"<Scene: {len(self.balls.radius)} spheres>"

    def map(self, view: View) -> tuple[VisibilityMap, Ints]:
        """Return the visibility map and the row of each of its spheres.

        Raises InputError if an eye lies inside the molecule or too far away.
        """
        return self._in_general_position(view, partial(_map, each=self.each))

    def pieces(self, view: View) -> tuple[Pieces, Ints]:
        """Return the painter's pieces, in an order that is a rule for sticks, and the row of each sphere; raises as
        ``map`` does."""
        return self._in_general_position(view, _pieces)

    def _in_general_position(self, view: View, query: Callable[[Prepared, View], T]) -> T:
        """The query's answer, displacing again as long as the spheres prove degenerate."""
        refuse_eye_among(self.balls, view)
        try:
            return self._first_general(lambda prepared: query(prepared, view))
        except InternalError:
            if projection_of(view).keeps_circles:
                raise
            raise InputError("too far an eye: numbers run out of digits; expected a nearer one, or none") from None

    def _first_general(self, query: Callable[[Prepared], T]) -> T:
        """The first answer without ``Degenerate``; sticks that are concerned are changed before all spheres are."""
        times, attempt = np.zeros(len(self.sticks.radius), dtype=np.int64), 0
        while attempt < ATTEMPTS:
            prepared = self._attempt(attempt, times)
            try:
                return query(prepared)
            except Degenerate as special:
                rows = prepared.stick[special.rows]
                rows = rows[np.any(self.sticks.offset[rows] != 0.0, axis=1)]
                times[rows] += 1
                if not len(rows) or times[rows].max() > MOST_TIMES:
                    attempt += 1
        raise InternalError(f"the spheres stay in special position after {ATTEMPTS} perturbations")

    def _attempt(self, attempt: int, times: Ints) -> Prepared:
        if attempt not in self._prepared:
            self._prepared[attempt] = _prepare(self.balls, self.sticks, attempt, self.only)
        prepared = self._prepared[attempt]
        less = NARROWER * (WIDER_STEPS ** times[prepared.stick] - 1.0)
        offset = prepared.sticks.offset * (1.0 - less)[:, None]
        return prepared._replace(sticks=prepared.sticks._replace(offset=offset))


def _prepare(balls: Balls, sticks: Sticks, attempt: int, only: View | None) -> Prepared:
    row = first_of_each(balls)
    radius, offset = sticks.radius * shrinkage(attempt), sticks.offset * (1.0 - attempt * NARROWER)
    stick = sticks.rows_among(row, len(balls.radius))
    sticks = sticks._replace(radius=radius, offset=offset).among(row, len(balls.radius))

    def spheres_at(rows: Ints) -> Spheres:
        return displaced(balls.take(row[rows]), row[rows], attempt)

    parts = [np.arange(first, last) for first, last in pairwise(np.searchsorted(row, balls.cuts).tolist())]
    if only is None:
        return Prepared(union_boundary(spheres_at(np.arange(len(row)))), row, sticks, stick)
    keep = _wanted(spheres_at, parts, sticks, only)
    return Prepared(union_boundary(spheres_at(keep)), row[keep], sticks.among(keep, len(row)), stick)


def _wanted(spheres_at: Callable[[Ints], Spheres], parts: Sequence[Ints], sticks: Sticks, view: View) -> Ints:
    """The spheres that may be seen, and all with sticks, ascending; ``parts`` are rows of those that lie together."""
    wanted = np.zeros(sum(map(len, parts)), dtype=bool)
    wanted[sticks.first] = wanted[sticks.second] = True
    if not wanted.all():
        wanted[_possibly_visible(spheres_at, parts, view)] = True
    return np.flatnonzero(wanted)


def _wanted_of_all(spheres: Spheres, sticks: Sticks, view: View) -> Ints:
    """The same of spheres that are kept."""
    return _wanted(spheres.take, [np.arange(len(spheres.radius))], sticks, view)


def _possibly_visible(spheres_at: Callable[[Ints], Spheres], parts: Sequence[Ints], view: View) -> Ints:
    def part(rows: Ints) -> SphereOccluders:
        return occluders_of(eye_coordinates(spheres_at(rows), view), view)

    kept = cache if len(parts) == 1 else lambda made: made  # each is made twice, and one is no larger than all
    return possibly_visible([kept(partial(part, rows)) for rows in parts], projection_of(view))


def _map(
    prepared: Prepared, view: View, label: Ints | None = None, each: Each = map
) -> tuple[VisibilityMap, Ints]:
    spheres, sticks = prepared.boundary.spheres, prepared.sticks
    wanted = _wanted_of_all(spheres, sticks, view)
    seen = eye_coordinates(spheres.take(wanted), view)
    solids = Solids(
        occluders_of(seen, view), sticks_in_view(seen, sticks.among(wanted, len(spheres.radius)), view)
    )
    labels = None if label is None else label[prepared.row]
    view_map = map_in_view(prepared.boundary, solids, wanted, view, projection_of(view), labels, each)
    return view_map, prepared.row[wanted]


def _pieces(prepared: Prepared, view: View) -> tuple[Pieces, Ints]:
    spheres, sticks = prepared.boundary.spheres, prepared.sticks
    seen = eye_coordinates(spheres, view)
    solids = Solids(occluders_of(seen, view), sticks_in_view(seen, sticks, view))
    wanted = _wanted_of_all(spheres, sticks, view)
    return painter_pieces(prepared.boundary, solids, wanted, view, projection_of(view)), prepared.row


def labelled_map(spheres: Spheres, label: Ints, view: View) -> VisibilityMap:
    """Return the map whose faces are what is seen of the spheres of each label (n,), from 0.

    The spheres are taken as they are, and displaced only if they prove not to be in general position.
    """

    def prepared(attempt: int) -> Prepared:
        if attempt:
            return _prepare(spheres, NO_STICKS, attempt - 1, view)
        keep = _wanted_of_all(spheres, NO_STICKS, view)
        return Prepared(union_boundary(spheres.take(keep)), keep, NO_STICKS, NONE)

    return first_general(lambda attempt: _map(prepared(attempt), view, label)[0])


def extent(balls: Balls, view: View) -> tuple[Floats, Floats]:
    """Return the corners (2,), (2,) of the bounding box of all balls' images on the page, in ångström.

    Raises InputError if an eye is not in front of all of them.
    """
    refuse_eye_among(balls, view)
    low, high = zip(*(_extent(part, view) for part in balls.parts()), strict=True)
    return np.min(low, axis=0), np.max(high, axis=0)


def _extent(spheres: Spheres, view: View) -> tuple[Floats, Floats]:
    center, half = outlines(occluders_of(eye_coordinates(spheres, view), view), projection_of(view))
    return (center - half).min(axis=0), (center + half).max(axis=0)
