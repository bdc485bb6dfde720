"""Where the eye is: the rotation from a molecule's axes to the page's, and the distance of the eye."""

import math
from dataclasses import dataclass

import numpy as np

from molviz.arrays import Floats
from molviz.model.spheres import Balls, Spheres, box_of
from molviz.vectors import length, transformed

EQUAL_MOMENTS = 1e-4  # of the largest: moments closer than that leave the axes to rounding
SWEEPS = 30  # of Jacobi's method; five suffice for doubles
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
        angle = math.radians(degrees)
        turn = np.eye(3)
        one, other = ((1, 2), (2, 0), (0, 1))["xyz".index(axis)]
        turn[one, one] = turn[other, other] = math.cos(angle)
        turn[other, one] = math.sin(angle)
        turn[one, other] = -math.sin(angle)
        return View(transformed(self.rotation.T, turn).T, self.center, self.distance)

    def of(self, spheres: Spheres) -> Spheres:
        """Return the spheres in view coordinates, ``center`` at the origin."""
        return Spheres(transformed(spheres.center - self.center, self.rotation), spheres.radius)


def middle(balls: Balls) -> Floats:
    """Return the middle of the bounding box of the balls (3,)."""
    low, high = box_of(balls)
    return np.asarray((low + high) / 2)


def file_axes(balls: Balls, distance: float | None = None) -> View:
    """Return the view along the file's own −z, x to the right."""
    return View(np.eye(3), middle(balls), distance)


def principal_axes(balls: Balls, distance: float | None = None) -> View:
    """Return the view with the longest principal axis of the centres across the page and the shortest towards the eye.

    Signs, which the axes leave open, are chosen by the third moments, so that the same molecule looks the same however
    it was turned; a right-handed frame in any case. Where moments are equal, as of a cube, the file's axes decide.
    """
    mean = np.sum([np.sum(part.center, axis=0) for part in balls.parts()], axis=0) / len(balls.radius)
    moments = [_moments(part.center - mean) for part in balls.parts()]
    rotation = _principal_frame(np.sum(moments, axis=0))
    skews = [_skews(part.center - mean, rotation[:2]) for part in balls.parts()]
    skew, size = np.sum(skews, axis=0)
    rotation[:2][skew < -SKEW * size] *= -1
    rotation[2] = np.cross(rotation[0], rotation[1])
    return View(rotation, middle(balls), distance)


def _moments(offset: Floats) -> Floats:
    """The second moments (3, 3) of offsets (m, 3) from the mean."""
    return np.array([[np.sum(one * other) for other in offset.T] for one in offset.T])


def _skews(offset: Floats, axes: Floats) -> Floats:
    """The third moments (2, k) along each of the axes (k, 3): with signs, and of sizes."""
    along = transformed(offset, axes)
    return np.array([[np.sum(column**3), np.sum(np.abs(column) ** 3)] for column in np.ascontiguousarray(along.T)]).T


def _principal_frame(moments: Floats) -> Floats:
    """Eigenvectors (3, 3) in rows, longest first; among equal moments those nearest the file's axes, in their order."""
    values, vectors = _eigenvectors(moments)
    frame: list[Floats] = []
    for row in range(3):
        equal = vectors[np.abs(values - values[row]) <= EQUAL_MOMENTS * values[0]]
        projected = transformed(equal.T, equal.T) if len(equal) > 1 else equal
        for taken in frame:
            projected = projected - transformed(projected, taken[None]) * taken
        size = length(projected)
        best = int(np.argmax(np.round(size, 6)))
        frame.append(projected[best] / size[best])
    return np.array(frame)


def _eigenvectors(matrix: Floats) -> tuple[Floats, Floats]:
    """Eigenvalues (3,), the largest first, and eigenvectors (3, 3) in rows of a symmetric matrix.

    Jacobi's method: turns that clear one pair off the diagonal at a time. LAPACK's last digits differ between machines.
    """
    rest, vectors = matrix / max(float(np.abs(matrix).max()), math.ulp(0.0)), np.eye(3)
    for step in range(3 * SWEEPS):
        p, q = ((0, 1), (0, 2), (1, 2))[step % 3]
        if rest[p, q] == 0:
            continue
        theta = float(rest[q, q] - rest[p, p]) / (2 * float(rest[p, q]))
        t = math.copysign(1.0, theta) / (abs(theta) + math.hypot(theta, 1.0))
        cosine = 1 / math.sqrt(1 + t * t)
        turn = np.eye(3)
        turn[p, p] = turn[q, q] = cosine
        turn[p, q], turn[q, p] = -t * cosine, t * cosine
        rest = transformed(transformed(rest, turn).T, turn)
        rest[p, q] = rest[q, p] = 0.0
        vectors = transformed(vectors.T, turn).T
    values = np.diag(rest)
    order = np.argsort(-values, kind="stable")
    return values[order], vectors[order]
