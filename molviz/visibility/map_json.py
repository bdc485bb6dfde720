"""The visibility map as plain data, for ``draw -o x.json``."""

from typing import Any

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.geometry.planar_map import loop_areas
from molviz.rounding import ANGLE_DIGITS, DIRECTION_DIGITS, LENGTH_DIGITS, rounded
from molviz.vectors import transformed
from molviz.visibility.curves import KINDS
from molviz.visibility.eye import eye_of
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.view import View


def map_as_data(view_map: VisibilityMap, atom: Ints, view: View, unit: float = 1.0) -> dict[str, Any]:
    """Return the map in view coordinates: the molecule's own, turned by ``view`` (its origin where the file's is).

    ``atom`` (s,) is each sphere's row in the input. Spheres are those the map was computed for: displaced by less than
    1e-4 of their radius from the input, and without those that are certainly hidden. Map and view are in lengths of
    ``unit`` ångström, the result is in ångström, with the digits of ``molviz.rounding``.
    """
    origin = transformed(view.center, view.rotation)
    shift = origin + eye_of(view)
    return {
        "format": "molviz-visibility-map",
        "version": 1,
        "units": "angstrom",
        "view": rounded(view.rotation, DIRECTION_DIGITS).tolist(),
        "spheres": _spheres(view_map, atom, shift, unit),
        "arcs": _arcs(view_map, origin[:2], unit),
        "faces": _faces(view_map, unit),
    }


def _spheres(view_map: VisibilityMap, atom: Ints, shift: Floats, unit: float) -> list[dict[str, Any]]:
    center, radius = view_map.spheres.center + shift, view_map.spheres.radius
    columns = (rounded(column, LENGTH_DIGITS, unit).tolist() for column in (center, radius))
    rows = zip(*columns, atom.tolist(), strict=True)
    return [{"center": center, "radius": radius, "atom": number} for center, radius, number in rows]


def _arcs(view_map: VisibilityMap, origin: Floats, unit: float) -> list[dict[str, Any]]:
    curve = view_map.curve_arcs.curve
    second = np.where(view_map.is_crease(), view_map.curves.second[curve], -1)
    arcs = view_map.arcs
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
