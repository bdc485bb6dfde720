"""Faces become regions: one for each atom, or one for all faces of one colour and chain, whose inner edges are gone."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import Paths, PlaneArcs
from molviz.geometry.planar_map import Loops, loop_areas, loops, merged_faces
from molviz.geometry.rows import lists_taken, offsets
from molviz.picture.chains import Chains, merged_arcs
from molviz.picture.hatching import hatched
from molviz.visibility.map import BACKGROUND, VisibilityMap

CHORDS = 9  # level ones across a region, to find where it is wide


def face_areas(view_map: VisibilityMap) -> Floats:
    """Return the area on the page (s,), Å², on which each sphere is seen."""
    seen = view_map.loops.face != BACKGROUND
    area = loop_areas(view_map.arcs, view_map.loops)[seen]
    return np.asarray(np.bincount(view_map.loops.face[seen], area, len(view_map.spheres.radius)), dtype=float)


def point_on(view_map: VisibilityMap, sphere: int) -> Floats:
    """Return a point (2,) of the page, ångström, at which a sphere with a face is seen, not close to where it ends.

    It is the middle of the longest of some level chords, or, where rounding leaves none, a point of the border.
    """
    chains = closed_chains(view_map.loops, np.flatnonzero(view_map.loops.face == sphere))
    paths = shapes_of(view_map.arcs, view_map.curve_arcs.curve, chains)
    arcs = paths.arcs
    height = np.concatenate([arcs.at(arcs.start + share * arcs.sweep)[:, 1] for share in (0.0, 0.25, 0.5, 0.75)])
    chords = hatched(paths, float(np.ptp(height)) / CHORDS, 0.0).arcs
    if not len(chords.c):
        return np.asarray(arcs.at(arcs.middle())[0])
    return np.asarray(chords.c[np.argmax(np.abs(chords.u[:, 0]))])


def shape_of(paths: Paths, shape: int) -> Paths:
    """Return one of the shapes as paths of their own."""
    first, last = paths.shape_start[shape], paths.shape_start[shape + 1]
    loop_start = paths.loop_start[first : last + 1]
    arcs = paths.arcs.take(np.arange(loop_start[0], loop_start[-1]))
    return Paths(arcs, loop_start - loop_start[0], np.array([0, last - first]))


def stacked(tables: list[Paths]) -> Paths:
    """Return the shapes of several tables as one table."""
    nothing = PlaneArcs(np.empty((0, 2)), np.empty((0, 2)), np.empty((0, 2)), np.empty(0), np.empty(0))
    arcs = PlaneArcs(*map(np.concatenate, zip(nothing, *(one.arcs for one in tables), strict=True)))
    return Paths(arcs, _joined([one.loop_start for one in tables]), _joined([one.shape_start for one in tables]))


def _joined(starts: list[Ints]) -> Ints:
    """CSR offsets of tables that follow each other."""
    counts = [np.diff(start) for start in starts]
    return np.concatenate([[0], np.cumsum(np.concatenate([np.empty(0, dtype=np.int64), *counts]))])


class Regions(NamedTuple):
    """Shapes, and the label that each has."""

    paths: Paths
    label: Ints  # (shapes,) ascending


def closed_chains(boundary: Loops, rows: Ints) -> Chains:
    """Return the given loops as closed chains."""
    place, start = lists_taken(boundary.start, rows)
    return Chains(boundary.half_edge[place], start, np.ones(len(rows), dtype=bool))


def shapes_of(arcs: PlaneArcs, curve: Ints, chains: Chains, shape: Ints | None = None) -> Paths:
    """Return chains as paths; all of one shape unless ``shape`` says of which (ascending from 0)."""
    rows, start = merged_arcs(arcs, curve, chains)
    shape = np.zeros(len(start) - 1, dtype=np.int64) if shape is None else shape
    return Paths(rows, start, offsets(shape, int(shape.max()) + 1 if len(shape) else 0))


def merged_regions(view_map: VisibilityMap, arcs: PlaneArcs, label: Ints) -> Regions:
    """Return the regions of equal labels, exact unions of faces; ``label`` (s,) of each sphere, from 0.

    ``arcs`` are the map's on the page.
    """
    labels = np.append(label, BACKGROUND)  # BACKGROUND is −1, the last
    boundary = loops(merged_faces(view_map.edges, labels[view_map.edges.face]))
    rows = np.flatnonzero(boundary.face != BACKGROUND)
    known, shape = np.unique(boundary.face[rows], return_inverse=True)
    return Regions(shapes_of(arcs, view_map.curve_arcs.curve, closed_chains(boundary, rows), shape), known)
