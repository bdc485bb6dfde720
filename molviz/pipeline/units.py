"""The unit that a scene is drawn in: styles state widths and distances for atoms, and other balls may have any size."""

import math
from dataclasses import replace

import numpy as np

from molviz.geometry.solids import BallsAndSticks
from molviz.model.spheres import Spheres
from molviz.pipeline.inputs import Loaded
from molviz.visibility.view import View

ATOM = 1.7  # ångström, the radius of carbon: balls from a third to three times as large are drawn in ångström


def unit_of(loaded: Loaded) -> float:
    """Return the power of ten, in ångström, in which a scene is drawn: 1 for all whose radii come from a table.

    Balls with radii of their own have no natural size. Their middle radius is an atom's in that unit, so that a scene
    times a power of ten is drawn like the scene.
    """
    own = loaded.molecule.radius
    if np.isnan(own).any():
        return 1.0
    return float(10.0 ** math.floor(math.log10(float(np.median(own)) / ATOM) + 0.5))


def in_unit(loaded: Loaded, unit: float) -> Loaded:
    """Return a model with all lengths divided by ``unit``."""
    if unit == 1.0:
        return loaded
    molecule = loaded.molecule
    scaled = replace(molecule, position=molecule.position / unit, radius=molecule.radius / unit)
    return replace(loaded, molecule=scaled, radius=loaded.radius / unit, bare_radius=loaded.bare_radius / unit)


def _divided(spheres: Spheres, unit: float) -> Spheres:
    return Spheres(spheres.center / unit, spheres.radius / unit)


def solids_in_unit(solids: BallsAndSticks, unit: float) -> BallsAndSticks:
    """Return balls and sticks with all lengths divided by ``unit``."""
    if unit == 1.0:
        return solids
    sticks = solids.sticks._replace(radius=solids.sticks.radius / unit, offset=solids.sticks.offset / unit)
    return solids._replace(balls=_divided(solids.balls.whole(), unit), sticks=sticks)


def view_in_unit(view: View, unit: float) -> View:
    """Return a view with all lengths divided by ``unit``."""
    return View(view.rotation, view.center / unit, None if view.distance is None else view.distance / unit)
