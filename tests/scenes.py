"""Scenes for tests of visibility, and their maps and pieces."""

import numpy as np

from molviz.geometry.boundary import union_boundary
from molviz.geometry.general_position import displaced, first_of_each
from molviz.model.spheres import Spheres
from molviz.model.sticks import NO_STICKS, Sticks
from molviz.visibility.eye import eye_coordinates, occluders_of, projection_of, sticks_in_view
from molviz.visibility.map import VisibilityMap, map_in_view
from molviz.visibility.painter import Pieces, painter_pieces
from molviz.visibility.solids import Solids
from molviz.visibility.view import View


def map_of(spheres: Spheres, view: View, sticks: Sticks = NO_STICKS) -> VisibilityMap:
    """The map of all spheres and sticks, which are taken to be in general position."""
    seen = eye_coordinates(spheres, view)
    solids = Solids(occluders_of(seen, view), sticks_in_view(seen, sticks, view))
    return map_in_view(union_boundary(spheres), solids, np.arange(len(spheres.radius)), view, projection_of(view))


def pieces_of(spheres: Spheres, view: View, sticks: Sticks = NO_STICKS) -> Pieces:
    seen = eye_coordinates(spheres, view)
    solids = Solids(occluders_of(seen, view), sticks_in_view(seen, sticks, view))
    return painter_pieces(union_boundary(spheres), solids, np.arange(len(spheres.radius)), view, projection_of(view))


def general_position(spheres: Spheres, attempt: int = 0) -> tuple[Spheres, np.ndarray]:
    """A displaced copy without exact duplicates, and the rows of the spheres in it."""
    rows = first_of_each(spheres)
    return displaced(spheres.take(rows), rows, attempt), rows


def shaken(center: object, radius: object) -> Spheres:
    """Spheres in special position, displaced as for a drawing."""
    return general_position(Spheres(np.array(center, dtype=float), np.array(radius, dtype=float)))[0]
