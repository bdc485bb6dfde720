"""What a view means for the algorithms: coordinates, projection, occluders. Only here is it asked its distance."""

import numpy as np

from molviz.arrays import Floats
from molviz.errors import InputError
from molviz.model.spheres import Balls, Spheres
from molviz.model.sticks import Sticks
from molviz.visibility.occluders.sphere import CentralSpheres, ParallelSpheres, SphereOccluders
from molviz.visibility.occluders.stick import StickOccluders, stick_occluders
from molviz.visibility.projection import Central, Parallel, Projection
from molviz.visibility.view import View


def projection_of(view: View) -> Projection:
    """Return the projection that a view asks for."""
    return Parallel() if view.distance is None else Central(view.distance)


def eye_of(view: View) -> Floats:
    """Return the origin of eye coordinates (3,) in view coordinates: the eye itself, or the middle of the view."""
    return np.array([0.0, 0.0, view.distance or 0.0])


def from_the_eye(view: View) -> View:
    """Return the view whose eye coordinates are those of space: what is given in eye coordinates is seen as it is."""
    return View(np.eye(3), -eye_of(view), view.distance)


def eye_coordinates(spheres: Spheres, view: View) -> Spheres:
    """Return spheres of the molecule's space in eye coordinates."""
    turned = view.of(spheres)
    return turned if view.distance is None else Spheres(turned.center - eye_of(view), turned.radius)


def occluders_of(spheres: Spheres, view: View) -> SphereOccluders:
    """Return spheres in eye coordinates as what hides."""
    return ParallelSpheres(spheres) if view.distance is None else CentralSpheres(spheres, view.distance)


def sticks_in_view(spheres: Spheres, sticks: Sticks, view: View) -> StickOccluders:
    """Return sticks as what hides; the spheres (n, 3) they join are in eye coordinates, the offsets in space."""
    turned = sticks._replace(offset=sticks.offset @ view.rotation.T)
    return stick_occluders(spheres, turned, view.distance is not None)


def refuse_eye_among(balls: Balls, view: View) -> None:
    """Raise InputError if the eye of a central view is not in front of all spheres of the molecule's space."""
    if view.distance is None:
        return
    seen = (eye_coordinates(part, view) for part in balls.parts())
    nearest = max(float(np.max(part.center[:, 2] + part.radius)) for part in seen)
    if nearest >= 0:
        needed = view.distance + nearest
        raise InputError(f"perspective: the eye is not in front of all atoms; expected more than {needed:.2f} Å")
