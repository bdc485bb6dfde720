"""The visibility map as plain data, for ``draw -o x.json``."""

from typing import Any

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.curves import PlaneArcs
from molviz.geometry.planar_map import UNUSED, loop_areas, loops, merged_faces, taken_arcs
from molviz.rounding import ANGLE_DIGITS, DIRECTION_DIGITS, LENGTH_DIGITS, rounded
from molviz.vectors import transformed
from molviz.visibility.curves import KINDS, LINE
from molviz.visibility.eye import eye_of
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.occluders.stick import StickOccluders
from molviz.visibility.view import View


def map_as_data(view_map: VisibilityMap, atom: Ints, view: View, unit: float = 1.0) -> dict[str, Any]:
    """Return the map in view coordinates: the molecule's own, turned by ``view`` (its origin where the file's is).

    ``atom`` (s,) is each sphere's row in the input. Spheres are those the map was computed for: displaced by less than
    1e-4 of their radius from the input, and without those that are certainly hidden. Sticks, whole ones, are numbered
    after the spheres; with them the version is 2. Map and view are in lengths of ``unit`` ångström, the result is in
    ångström, with the digits of ``molviz.rounding``.
    """
    origin = transformed(view.center, view.rotation)
    shift = origin + eye_of(view)
    whole, spheres = _whole_sticks(view_map), _spheres(view_map, atom, shift, unit)
    sticks = _sticks(view_map.sticks, unit)
    return {
        "format": "molviz-visibility-map",
        "version": 2 if sticks else 1,
        "units": "angstrom",
        "view": rounded(view.rotation, DIRECTION_DIGITS).tolist(),
        "spheres": spheres,
        **({"sticks": sticks} if sticks else {}),
        "arcs": _arcs(whole, origin[:2], unit),
        "faces": _faces(whole, unit),
    }


def _whole_sticks(view_map: VisibilityMap) -> VisibilityMap:
    """The map with one face for each stick instead of two halves; the borders between these are gone."""
    if not len(view_map.sticks.length):
        return view_map
    count = len(view_map.spheres.radius)
    solid = np.append(np.arange(count), count + np.arange(len(view_map.sticks.ends.sphere)) // 2)
    edges = merged_faces(view_map.edges, np.append(solid, BACKGROUND)[view_map.edges.face])
    kept = np.flatnonzero(edges.face[::2] != UNUSED)
    edges = taken_arcs(edges, kept)
    curves = view_map.curves._replace(first=solid[view_map.curves.first], second=solid[view_map.curves.second])
    return view_map._replace(
        curves=curves, curve_arcs=view_map.curve_arcs.take(kept), arcs=view_map.arcs.take(kept), edges=edges,
        loops=loops(edges),
    )  # fmt: skip


def _sticks(sticks: StickOccluders, unit: float) -> list[dict[str, Any]]:
    pairs, columns = sticks.ends.sphere.reshape(-1, 2).tolist(), (sticks.radius, sticks.ends.offset[::2])
    rows = zip(pairs, *(rounded(column, LENGTH_DIGITS, unit).tolist() for column in columns), strict=True)
    return [{"spheres": pair, "radius": radius, "offset": offset} for pair, radius, offset in rows]


def _spheres(view_map: VisibilityMap, atom: Ints, shift: Floats, unit: float) -> list[dict[str, Any]]:
    center, radius = view_map.spheres.center + shift, view_map.spheres.radius
    columns = (rounded(column, LENGTH_DIGITS, unit).tolist() for column in (center, radius))
    rows = zip(*columns, atom.tolist(), strict=True)
    return [{"center": center, "radius": radius, "atom": number} for center, radius, number in rows]


def _arcs(view_map: VisibilityMap, origin: Floats, unit: float) -> list[dict[str, Any]]:
    curve = view_map.curve_arcs.curve
    second = np.where(view_map.curves.is_contour()[curve], -1, view_map.curves.second[curve])
    arcs = _with_straight_lines(view_map)
    c, u, v = (rounded(column, LENGTH_DIGITS, unit) for column in (arcs.c + origin, arcs.u, arcs.v))
    columns = {
        "kind": np.array(KINDS)[view_map.curves.kind[curve]],
        "spheres": np.column_stack([view_map.curves.first[curve], second]),
        "c": c,
        "u": u,
        "v": v,
        "start": rounded(arcs.start, ANGLE_DIGITS),
        "sweep": rounded(arcs.sweep, ANGLE_DIGITS),
        "left": view_map.left,
        "right": view_map.right,
        "from": view_map.curve_arcs.origin,
        "to": view_map.curve_arcs.target,
    }
    return [dict(zip(columns, row, strict=True)) for row in zip(*(c.tolist() for c in columns.values()), strict=True)]


def _with_straight_lines(view_map: VisibilityMap) -> PlaneArcs:
    """The arcs; a piece of a line is c + t u for t from 0 to 1."""
    arcs = view_map.arcs
    line = view_map.curves.kind[view_map.curve_arcs.curve] == LINE
    start, end = arcs.starts(), arcs.ends()
    columns = ((start, arcs.c), (end - start, arcs.u), (0.0 * start, arcs.v))
    c, u, v = (np.where(line[:, None], straight, bent) for straight, bent in columns)
    return PlaneArcs(c, u, v, np.where(line, 0.0, arcs.start), np.where(line, 1.0, arcs.sweep))


def _faces(view_map: VisibilityMap, unit: float) -> list[dict[str, Any]]:
    areas = loop_areas(view_map.arcs, view_map.loops)
    start, edges = view_map.loops.start.tolist(), view_map.loops.half_edge.tolist()
    faces: dict[int, dict[str, Any]] = {}
    for row, sphere in enumerate(view_map.loops.face.tolist()):
        if sphere == BACKGROUND:
            continue
        face = faces.setdefault(sphere, {"sphere": sphere, "area": 0.0, "loops": []})
        face["area"] += float(areas[row])
        face["loops"].append(edges[start[row] : start[row + 1]])
    for face in faces.values():
        face["area"] = float(rounded(np.array(face["area"]), LENGTH_DIGITS, unit**2))
    return list(faces.values())
