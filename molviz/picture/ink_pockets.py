"""Pockets: what the ink around a small part of the picture leaves of it; narrow ones are filled with ink."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import Paths
from molviz.geometry.components import component_labels
from molviz.geometry.planar_map import loop_areas, oriented
from molviz.geometry.rows import blocks, expand, lists_taken, offsets
from molviz.picture.ink import Widths, at_places
from molviz.picture.ink_ends import INSIDE, OUTSIDE
from molviz.vectors import dot
from molviz.visibility.horizon_runs import HorizonRuns
from molviz.visibility.map import VisibilityMap

LONGEST = 12.0  # ångström of ink around a pocket
STEP = 0.1  # ångström between samples of the border of a pocket
TOUCH = 0.01  # ångström by which a disc that touches ink may lie in it
ACROSS = 0.5  # ångström times the detail in which a border is nearly straight
FEW = 4  # one sample in so many is asked first
PAIRS = 1 << 16  # of samples at a time


class Pockets(NamedTuple):
    """Shapes to be filled, and of each the run that most of its border belongs to."""

    paths: Paths
    run: Ints
    dark: Bools


def inked_arcs(runs: HorizonRuns, widths: Widths) -> Floats:
    """Return the width (5, k) of the ink along each arc of the map, from end to end; 0 where a line ended before."""
    known = np.flatnonzero(runs.run_of_arc >= 0)
    run, (first, last) = runs.run_of_arc[known], runs.place_of_arc[:, known]
    begin, end = runs.vertices.place[widths.ends[:, run]]
    width = np.zeros((5, len(runs.run_of_arc)))
    for row, share in zip(width, np.linspace(0.0, 1.0, 5), strict=True):
        place = first + share * (last - first)
        row[known] = np.where((place >= begin) & (place <= end), at_places(widths.width, runs, run, place), 0.0)
    return width


def pockets(view_map: VisibilityMap, runs: HorizonRuns, widths: Widths, neck: float) -> Pockets:
    """Return the parts of the picture that ink closes in and in which it leaves no room for a disc ``neck`` Å wide.

    Faces between which there is no ink are one part.
    """
    width, boundary = inked_arcs(runs, widths)[2], view_map.loops
    loop, count = np.repeat(np.arange(len(boundary.face)), np.diff(boundary.start)), len(boundary.face)
    arc = boundary.half_edge >> 1
    part = _parts(arc, loop, width)
    length = view_map.arcs.lengths()[arc] * (width[arc] > 0)
    border = np.bincount(part[loop], length, count)
    area = np.bincount(part, loop_areas(view_map.arcs, boundary), count)
    deep = length * (width[arc] * np.where(boundary.half_edge & 1, OUTSIDE, -INSIDE) + neck)
    narrow = (area > 0) & (area < np.bincount(part[loop], deep, count)) & (border < LONGEST)
    rows = np.flatnonzero(narrow[part[loop]] & (length > 0))
    rows = rows[np.argsort(part[loop[rows]], kind="stable")]
    narrow[_with_room(view_map, runs, widths, boundary.half_edge[rows], part[loop[rows]], neck)] = False
    return _filled(view_map, runs, widths, part, narrow, length, loop)


def _with_room(
    view_map: VisibilityMap, runs: HorizonRuns, widths: Widths, half_edge: Ints, part: Ints, neck: float
) -> Ints:
    """The parts, of half-edges sorted by them, in which there is room for a disc.

    A disc that is moved until it touches ink does so at some sample of the border, and keeps off the ink of all others;
    at cusps of the border it would lie across the other side. Where both sides of a line are in the part, the disc has
    to do with the side on which it is.
    """
    arc, back = half_edge >> 1, (half_edge & 1).astype(bool)
    count = np.ceil(view_map.arcs.lengths()[arc] / STEP).astype(np.int64) + 1
    row, number = expand(np.zeros_like(count), count)
    share, arcs = number / (count - 1)[row], view_map.arcs.take(arc[row])
    first, last = runs.place_of_arc[:, arc[row]]
    width = at_places(widths.width, runs, runs.run_of_arc[arc[row]], first + share * (last - first))
    point, tangent = arcs.at_with_tangent(arcs.start + share * arcs.sweep)
    tangent *= np.where(back[row], -1.0, 1.0)[:, None]
    inwards = np.column_stack([-tangent[:, 1], tangent[:, 0]]) / np.hypot(*tangent.T)[:, None]
    reach = width * np.where(back[row], OUTSIDE, -INSIDE) + neck / 2
    center = point + reach[:, None] * inwards
    straight = ACROSS * runs.detail[runs.run_of_arc[arc[row]]]
    key = part * (int(half_edge.max(initial=0)) + 2)
    both_sides = np.isin(key + (half_edge ^ 1), key + half_edge)[row]
    begin, end = (np.searchsorted(part[row], part[row], side=side) for side in ("left", "right"))
    room = np.zeros(int(part.max(initial=-1)) + 1, dtype=bool)
    for few in (True, False):  # most parts have room nearly everywhere
        asked = np.flatnonzero(((number % FEW == 0) == few) & ~room[part[row]])
        for block in blocks((end - begin)[asked], PAIRS):
            one, other = expand(begin[asked[block]], end[asked[block]])
            away = center[asked[block]][one] - point[other]
            gap = np.hypot(*away.T)
            beyond = dot(away, inwards[other]) < 0
            gap = np.where(beyond & (gap < straight[other]), -1.0, gap - reach[other])
            gap[beyond & both_sides[other]] = np.inf
            free = np.minimum.reduceat(gap, np.flatnonzero(np.diff(one, prepend=-1))) > -TOUCH
            room[part[row[asked[block][free]]]] = True
    return np.flatnonzero(room)


def _parts(arc: Ints, loop: Ints, width: Floats) -> Ints:
    """The part (loops,) to which each loop of faces belongs: those across arcs without ink are of one part."""
    order = np.argsort(arc, kind="stable")
    pair = np.flatnonzero((arc[order][1:] == arc[order][:-1]) & (width[arc[order][1:]] == 0))
    count = int(loop.max(initial=-1)) + 1
    return component_labels(loop[order[pair]], loop[order[pair + 1]], count)


def _filled(
    view_map: VisibilityMap, runs: HorizonRuns, widths: Widths, part: Ints, narrow: Bools, length: Floats, loop: Ints
) -> Pockets:
    """The loops of narrow parts as shapes, one of each part, in the ink of the longest arc around it."""
    boundary = view_map.loops
    rows = np.flatnonzero(narrow[part])
    rows = rows[np.argsort(part[rows], kind="stable")]
    known, shape = np.unique(part[rows], return_inverse=True)
    half_edge, start = lists_taken(boundary.start, rows)
    paths = Paths(oriented(view_map.arcs, boundary.half_edge[half_edge]), start, offsets(shape, len(known)))
    longest = np.zeros(len(boundary.face), dtype=np.int64)
    order = np.argsort(length, kind="stable")
    longest[part[loop[order]]] = boundary.half_edge[order] >> 1  # the last one written is the longest
    arc = longest[known]
    run, place = runs.run_of_arc[arc], runs.place_of_arc[:, arc].mean(axis=0)
    return Pockets(paths, run, at_places(widths.dark, runs, run, place) > 0.5)
