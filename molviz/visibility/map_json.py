"""The visibility map as plain data, for ``draw -o x.json``."""

from typing import Any

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.visibility.half_edges import loop_areas
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.view import View


def map_as_data(found: VisibilityMap, atom: Ints, view: View) -> dict[str, Any]:
    """Return the map in view coordinates: the molecule's own, turned by ``view`` (its origin where the file's is).

    ``atom`` (s,) is each sphere's row in the input. Spheres are those the map was computed for: displaced by less than
    1e-4 of their radius from the input, and without those that are certainly hidden.
    """
    origin = view.rotation @ view.center
    shift = origin + [0.0, 0.0, view.distance or 0.0]
    return {
        "format": "molviz-visibility-map",
        "version": 1,
        "units": "angstrom",
        "view": view.rotation.tolist(),
        "spheres": _spheres(found, atom, shift),
        "arcs": _arcs(found, origin[:2]),
        "faces": _faces(found),
    }


def _spheres(found: VisibilityMap, atom: Ints, shift: Floats) -> list[dict[str, Any]]:
    rows = zip((found.spheres.center + shift).tolist(), found.spheres.radius.tolist(), atom.tolist(), strict=True)
    return [{"center": center, "radius": radius, "atom": number} for center, radius, number in rows]


def _arcs(found: VisibilityMap, origin: Floats) -> list[dict[str, Any]]:
    pairs = np.column_stack([found.circles.first[found.circle], found.circles.second[found.circle]])
    arcs = found.arcs
    columns = {
        "kind": np.where(found.is_crease(), "crease", "horizon"),
        "spheres": pairs,
        "c": arcs.c + origin,
        "u": arcs.u,
        "v": arcs.v,
        "start": arcs.start,
        "sweep": arcs.sweep,
        "left": found.left,
        "right": found.right,
        "from": found.origin,
        "to": found.target,
    }
    return [dict(zip(columns, row, strict=True)) for row in zip(*(c.tolist() for c in columns.values()), strict=True)]


def _faces(found: VisibilityMap) -> list[dict[str, Any]]:
    areas = loop_areas(found.arcs, found.loops)
    start, edges = found.loops.start.tolist(), found.loops.half_edge.tolist()
    faces: dict[int, dict[str, Any]] = {}
    for row, sphere in enumerate(found.loops.face.tolist()):
        if sphere == BACKGROUND:
            continue
        face = faces.setdefault(sphere, {"sphere": sphere, "area": 0.0, "loops": []})
        face["area"] += float(areas[row])
        face["loops"].append(edges[start[row] : start[row + 1]])
    return list(faces.values())
