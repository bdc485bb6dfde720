"""What is seen of a molecule, as arrays: the visibility map for Python users."""

from dataclasses import dataclass

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.planar_map import loop_areas
from molviz.model.spheres import Spheres
from molviz.vectors import cross
from molviz.visibility.checks import check_map
from molviz.visibility.eye import projection_of
from molviz.visibility.lines import depth_jump, is_silhouette
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.projection import images_of
from molviz.visibility.scene import Scene
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
        return is_silhouette(self.map)

    def check(self) -> None:
        """Raise InternalError if Euler's formula, the areas or the faces seen beside arcs do not hold."""
        check_map(self.map, self.view)


def visible_of(spheres: Spheres, view: View) -> Visible:
    """Return what is seen of n spheres; raises InputError for an eye that is not in front of all of them."""
    view_map, atom = Scene(spheres, only=view).map(view)
    area, disc = np.zeros(len(spheres.radius)), np.full(len(spheres.radius), np.inf)
    inside = view_map.loops.face != BACKGROUND
    np.add.at(area, atom[view_map.loops.face[inside]], loop_areas(view_map.arcs, view_map.loops)[inside])
    disc[atom] = _disc_areas(view_map, view)
    named = np.append(atom, BACKGROUND)
    left, right = named[view_map.left], named[view_map.right]
    return Visible(view_map, view, area, area / disc, left, right, depth_jump(view_map, view))


def _disc_areas(view_map: VisibilityMap, view: View) -> Floats:
    """Area of the image of each sphere: π times the product of its half-axes, ``|u × v|``."""
    image = images_of(view_map.horizons(), projection_of(view))
    return np.asarray(np.pi * np.abs(cross(image.u, image.v)))
