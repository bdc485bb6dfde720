"""What is seen of a molecule, as arrays: the visibility map for Python users."""

from dataclasses import dataclass

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.model.spheres import Spheres
from molviz.pipeline.scene import map_in_view
from molviz.vectors import cross
from molviz.visibility.checks import check_map
from molviz.visibility.half_edges import loop_areas
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.projection import images_of, projection_of
from molviz.visibility.view import View


@dataclass(frozen=True, repr=False)
class Visible:
    """The visibility map of n atoms; arcs are rows of ``map``, atoms rows of the molecule.

    ``left`` and ``right`` name the atoms on either side of each arc, −1 the background.
    """

    map: VisibilityMap
    view: View
    area: Floats  # (n,) Å² of the page on which each atom is seen
    fraction: Floats  # (n,) of the atom's own disc (its ellipse in a central view)
    left: Ints  # (arcs,)
    right: Ints  # (arcs,)
    depth_jump: Floats  # (arcs,) Å from the nearer to the farther surface; 0 at a crease, inf at a silhouette

    def __repr__(self) -> str:
        seen = np.count_nonzero(self.area)
        return f"<Visible: {seen} of {len(self.area)} atoms, {len(self.left)} arcs>"

    @property
    def silhouette(self) -> Bools:
        """Which arcs (arcs,) lie between an atom and the background."""
        return np.asarray((self.left == BACKGROUND) | (self.right == BACKGROUND))

    def check(self) -> None:
        """Raise InternalError if Euler's formula, the areas or the faces seen beside arcs do not hold."""
        check_map(self.map, self.view)


def visible_of(spheres: Spheres, view: View) -> Visible:
    """Return what is seen of n spheres; raises InputError for an eye that is not in front of all of them."""
    found, atom = map_in_view(spheres, view)
    area, disc = np.zeros(len(spheres.radius)), np.full(len(spheres.radius), np.inf)
    inside = found.loops.face != BACKGROUND
    np.add.at(area, atom[found.loops.face[inside]], loop_areas(found.arcs, found.loops)[inside])
    disc[atom] = _disc_areas(found, view)
    named = np.append(atom, BACKGROUND)
    return Visible(found, view, area, area / disc, named[found.left], named[found.right], _depth_jump(found, view))


def _disc_areas(found: VisibilityMap, view: View) -> Floats:
    """Area of the image of each sphere: π times the product of its half-axes, ``|u × v|``."""
    image = images_of(found.horizons(), projection_of(view))
    return np.asarray(np.pi * np.abs(cross(image.u, image.v)))


def _depth_jump(found: VisibilityMap, view: View) -> Floats:
    """How much farther than the horizon the surface behind it lies, at the middle of each arc."""
    projection = projection_of(view)
    points = found.circles.at(found.circle, found.start + found.sweep / 2)
    behind = projection.surface(found.spheres, np.maximum(found.right, 0), projection.page_points(points))
    own = points[:, 2] if view.distance is None else -np.linalg.norm(points, axis=1)
    jump = np.where(found.right == BACKGROUND, np.inf, own - behind)
    return np.where(found.is_crease(), 0.0, jump)
