"""Where the eye is: the rotation from a molecule's axes to the page's, and the distance of the eye."""

from dataclasses import dataclass

import numpy as np

from molviz.arrays import Floats
from molviz.model.spheres import Spheres

EQUAL_MOMENTS = 1e-4  # of the largest: moments closer than that leave the axes to rounding
SKEW = 1e-6  # of the absolute third moment: less than that is a symmetric molecule


@dataclass(frozen=True, repr=False)
class View:
    """Rows of ``rotation`` are the page's x, y, z in the molecule's axes; the eye looks down −z.

    ``center`` is the point that lies in the middle of the view; ``distance`` that of the eye from it for a central
    projection, in ångström, or None for a parallel one.
    """

    rotation: Floats  # (3, 3)
    center: Floats  # (3,) ångström
    distance: float | None = None

    def __repr__(self) -> str:
        eye = "parallel" if self.distance is None else f"eye {self.distance:g} Å away"
        return f"<View: {eye}, towards the eye {np.array2string(self.rotation[2], precision=3)}>"

    def rotated(self, axis: str, degrees: float) -> "View":
        """Return the view after a right-handed turn of the molecule about the page's x, y or z."""
        angle = np.radians(degrees)
        turn = np.eye(3)
        one, other = ((1, 2), (2, 0), (0, 1))["xyz".index(axis)]
        turn[one, one] = turn[other, other] = np.cos(angle)
        turn[other, one] = np.sin(angle)
        turn[one, other] = -np.sin(angle)
        return View(turn @ self.rotation, self.center, self.distance)

    def of(self, spheres: Spheres) -> Spheres:
        """Return the spheres in view coordinates, ``center`` at the origin."""
        return Spheres((spheres.center - self.center) @ self.rotation.T, spheres.radius)


def middle(spheres: Spheres) -> Floats:
    """Return the middle of the bounding box of the balls (3,)."""
    low, high = spheres.box()
    return np.asarray((low + high) / 2)


def file_axes(spheres: Spheres, distance: float | None = None) -> View:
    """Return the view along the file's own −z, x to the right."""
    return View(np.eye(3), middle(spheres), distance)


def principal_axes(spheres: Spheres, distance: float | None = None) -> View:
    """Return the view with the longest principal axis of the centres across the page and the shortest towards the eye.

    Signs, which the axes leave open, are chosen by the third moments, so that the same molecule looks the same however
    it was turned; a right-handed frame in any case. Where moments are equal, as of a cube, the file's axes decide.
    """
    offset = spheres.center - spheres.center.mean(axis=0)
    rotation = _principal_frame(offset.T @ offset)
    for axis in range(2):
        along = offset @ rotation[axis]
        skew = np.sum(along**3)
        if skew < -SKEW * np.sum(np.abs(along) ** 3):
            rotation[axis] *= -1
    rotation[2] = np.cross(rotation[0], rotation[1])
    return View(rotation, middle(spheres), distance)


def _principal_frame(moments: Floats) -> Floats:
    """Eigenvectors (3, 3) in rows, longest first; among equal moments those nearest the file's axes, in their order."""
    values, vectors = np.linalg.eigh(moments)
    values, vectors = values[::-1], vectors.T[::-1]
    frame: list[Floats] = []
    for row in range(3):
        equal = vectors[np.abs(values - values[row]) <= EQUAL_MOMENTS * values[0]]
        projected = np.vstack([equal.T @ equal @ axis for axis in np.eye(3)]) if len(equal) > 1 else equal
        for taken in frame:
            projected = projected - np.outer(projected @ taken, taken)
        best = projected[np.argmax(np.round(np.linalg.norm(projected, axis=1), 6))]
        frame.append(best / np.linalg.norm(best))
    return np.array(frame)
