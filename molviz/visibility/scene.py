"""One drawing's geometry: spheres in general position, what may be seen of them, and the map or the pieces."""

from collections.abc import Callable
from typing import NamedTuple, TypeVar

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.errors import InputError
from molviz.geometry.boundary import Boundary, union_boundary
from molviz.geometry.general_position import first_general, general_position
from molviz.model.spheres import Spheres
from molviz.visibility.culling import outlines, possibly_visible
from molviz.visibility.map import VisibilityMap, visibility_map
from molviz.visibility.painter import Pieces, painter_pieces
from molviz.visibility.projection import eye_coordinates, projection_of
from molviz.visibility.view import View

T = TypeVar("T")


class Scene(NamedTuple):
    """Spheres prepared for any number of views: their union boundary, and their rows in the caller's table."""

    boundary: Boundary
    row: Ints  # (s,)


def prepared(spheres: Spheres, attempt: int = 0, view: View | None = None) -> Scene:
    """Return the spheres in general position with their union boundary: the work that no view changes.

    Where only one view is wanted, naming it here spares the work for spheres that it hides.
    """
    moved, row = general_position(spheres, attempt)
    if view is not None:
        keep = np.flatnonzero(possibly_visible(eye_coordinates(moved, view), projection_of(view)))
        moved, row = moved.take(keep), row[keep]
    return Scene(union_boundary(moved), row)


def map_of_scene(scene: Scene, view: View) -> tuple[VisibilityMap, Ints]:
    """Return the visibility map and the row of each of its spheres; raises ``Degenerate``."""
    seen, wanted = _seen(scene, view)
    found = visibility_map(scene.boundary, seen, wanted, view, projection_of(view))
    return found, scene.row[wanted]


def pieces_of_scene(scene: Scene, view: View) -> tuple[Pieces, Ints]:
    """Return the painter's pieces and the row of each sphere; raises ``Degenerate``."""
    seen, wanted = _seen(scene, view)
    return painter_pieces(scene.boundary, seen, wanted, view, projection_of(view)), scene.row


def _seen(scene: Scene, view: View) -> tuple[Spheres, Ints]:
    seen = eye_coordinates(scene.boundary.spheres, view)
    return seen, np.flatnonzero(possibly_visible(seen, projection_of(view)))


def in_one_view(spheres: Spheres, view: View, query: Callable[[Scene, View], T]) -> T:
    """Return the query's answer for one view, perturbing again as long as the spheres prove degenerate.

    Raises InputError if an eye lies inside the molecule, or (never seen) if no perturbation helps.
    """
    _refuse_eye_among(spheres, view)
    return first_general(lambda attempt: query(prepared(spheres, attempt, view), view))


def _refuse_eye_among(spheres: Spheres, view: View) -> None:
    if view.distance is None:
        return
    seen = eye_coordinates(spheres, view)
    nearest = float(np.max(seen.center[:, 2] + seen.radius))
    if nearest >= 0:
        needed = view.distance + nearest
        raise InputError(f"the eye is not in front of all atoms; expected a distance above {needed:.2f} Å")


def extent(spheres: Spheres, view: View) -> tuple[Floats, Floats]:
    """Return the corners (2,), (2,) of the bounding box of all spheres' images on the page, in ångström.

    Raises InputError if an eye is not in front of all of them.
    """
    _refuse_eye_among(spheres, view)
    center, half = outlines(eye_coordinates(spheres, view), projection_of(view))
    return (center - half).min(axis=0), (center + half).max(axis=0)
