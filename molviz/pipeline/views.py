"""Where the eye is: the user's options, or a view of their own, become a view of one model."""

import math
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from molviz.arrays import Floats
from molviz.errors import InputError
from molviz.model.spheres import Balls, Spheres
from molviz.visibility.view import View, file_axes, middle, principal_axes

Quaternion: TypeAlias = tuple[float, float, float, float]  # w, x, y, z; from the file's axes to the page's

ORTHOGONAL = 1e-6  # by which the rows of a rotation may miss being unit vectors at right angles


@dataclass(frozen=True)
class ViewOptions:
    """Where the user looks from."""

    orient: str = "principal"
    rotations: tuple[tuple[str, float], ...] = ()  # axis of the page, degrees
    distance: float | None = None  # ångström from the centre, None for a parallel view
    orientation: Quaternion | None = None  # instead of ``orient``


def view_of(balls: Balls, view_options: ViewOptions) -> View:
    """Return the view that the user's options mean for one model."""
    view = _beginning(balls, view_options)
    for axis, degrees in view_options.rotations:
        view = view.rotated(axis, degrees)
    return view


def _beginning(balls: Balls, view_options: ViewOptions) -> View:
    if view_options.orientation is not None:
        return View(rotation_of(view_options.orientation), middle(balls), view_options.distance)
    axes = principal_axes if view_options.orient == "principal" else file_axes
    return axes(balls, view_options.distance)


def rotation_of(quaternion: Quaternion) -> Floats:
    """Return the rotation (3, 3) of a quaternion, made as long as 1: ``v + 2 w (q × v) + 2 q × (q × v)``."""
    w, x, y, z = np.array(quaternion) / math.hypot(*quaternion)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + 2 * w * cross + 2 * cross @ cross)


def checked_view(view: object, spheres: Spheres) -> View:
    """Return the view given, or that of the principal axes for None.

    Raises InputError where it is no view, its numbers are not finite, or its rotation does more than turn.
    """
    if view is None:
        return principal_axes(spheres)
    if not isinstance(view, View):
        raise InputError(f"view: {type(view).__name__}; expected a molviz.View or None")
    rotation, center = np.asarray(view.rotation, dtype=float), np.asarray(view.center, dtype=float)
    if not _is_rotation(rotation):
        raise InputError("view: its rotation is none; expected right-handed unit vectors at right angles, shape (3, 3)")
    if center.shape != (3,) or not np.isfinite(center).all():
        raise InputError("view: its center is no point; expected three finite numbers")
    if view.distance is not None and not 0 < view.distance < np.inf:
        raise InputError(f"view: its distance is {view.distance}; expected a number above 0, or None")
    return View(rotation, center, view.distance)


def _is_rotation(matrix: "np.ndarray[tuple[int, ...], np.dtype[np.float64]]") -> bool:
    if matrix.shape != (3, 3) or not np.isfinite(matrix).all():
        return False
    return bool(np.allclose(matrix @ matrix.T, np.eye(3), rtol=0, atol=ORTHOGONAL) and np.linalg.det(matrix) > 0)
