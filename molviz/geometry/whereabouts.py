"""In which component, in which cavity, or outside of all a point lies (Halperin & Overmars 1994, sections 2.4 and 3).

A point in a ball is in the component of that ball. From any other, the face of the boundary that is met first straight
up tells by its shell: the wall of a cavity is met from within it, and an outer shell from where its component lies.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.geometry.boundary_graph import boundary_graph
from molviz.geometry.climb import FacesAbove
from molviz.geometry.cubes import BLOCK_ROWS
from molviz.geometry.shells import Shells, ball_components, shells_of
from molviz.model.spheres import Spheres

OUTSIDE = -1


class Whereabouts(NamedTuple):
    """Where m points lie, as rows of ``Shells``; both are −1 outside of all."""

    component: Ints  # (m,) of whose balls one contains the point, else −1
    cavity: Ints  # (m,) in which the point lies, outside of all balls, else −1


class Surroundings:
    """n balls, their shells, and what tells where points are."""

    def __init__(self, spheres: Spheres) -> None:
        graph = boundary_graph(spheres)
        self.shells: Shells = shells_of(graph)
        self._above = FacesAbove(graph)
        of_ball, of_face = ball_components(graph), self.shells.of_face
        outer = np.empty(len(of_ball), dtype=np.int64)  # of a component's number: its outer shell
        outer[of_ball[graph.faces.sphere]] = self.shells.component[of_face]
        self._component = outer[of_ball[self._above.rows]]

    def at(self, point: Floats) -> Whereabouts:
        """Return where points (m, 3) are, in blocks that keep memory flat."""
        parts = [self._at(point[begin : begin + BLOCK_ROWS]) for begin in range(0, max(len(point), 1), BLOCK_ROWS)]
        return Whereabouts(*(np.concatenate(column) for column in zip(*parts, strict=True)))

    def _at(self, point: Floats) -> Whereabouts:
        met = self._above.index.balls_met(point, np.zeros(len(point)))
        inside = np.diff(met.start) > 0
        component, cavity = np.full(len(point), OUTSIDE), np.full(len(point), OUTSIDE)
        component[inside] = self._component[met.item[met.start[:-1][inside]]]
        cavity[~inside] = self._around(self._above(point[~inside]))
        return Whereabouts(component, cavity)

    def _around(self, face: Ints) -> Ints:
        """The cavity on the outer side of each face, or −1."""
        shell = self.shells.of_face[face]
        cavity = np.where(self.shells.outer[shell], self.shells.parent[shell], shell)
        return np.where(face >= 0, cavity, OUTSIDE)
