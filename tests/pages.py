"""Everything that the tests of pages, projections and culling take from the program, under names of their own."""

from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from molviz.curves import PlaneArcs
from molviz.model.entities import entities_of
from molviz.model.spheres import Spheres
from molviz.picture.compose import picture_of_map, picture_of_pieces
from molviz.picture.options import DrawOptions, Subject
from molviz.picture.palette import load_palette
from molviz.picture.picture import FillLayer, Picture, StrokeLayer
from molviz.picture.style import load_style
from molviz.pipeline.draw import color_values
from molviz.pipeline.inputs import InputOptions, Loaded, load
from molviz.pipeline.views import ViewOptions, view_of
from molviz.visibility.culling import possibly_visible
from molviz.visibility.curves import Curves
from molviz.visibility.eye import eye_coordinates, occluders_of, projection_of
from molviz.visibility.map import VisibilityMap
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.projection import Projection
from molviz.visibility.scene import Scene, extent
from molviz.visibility.view import View
from tests.pdb_lines import atom

FILE_AXES = ViewOptions("file")
STRAIGHT = View(np.eye(3), np.zeros(3))


def balls(*rows: tuple[float, float, float, float]) -> Loaded:
    """Balls x y z r, read as from a file."""
    text = "".join(" ".join(map(repr, row)) + "\n" for row in rows)
    return load("balls.xyzr", InputOptions(), text.encode())[0]


def residues(*rows: tuple[str, str, str, str, float, float]) -> Loaded:
    """Atoms (chain, residue name, residue number, element, x, B factor) side by side, read as from a PDB file."""
    lines = [
        atom(name=f" {element:<3}", residue=name, number=f"{number:>4} ", chain=chain, element=f"{element:>2}",
             xyz=f"{x:8.3f}{0:8.3f}{0:8.3f}", bfactor=f"{bfactor:6.2f}")
        for chain, name, number, element, x, bfactor in rows
    ]  # fmt: skip
    return load("residues.pdb", InputOptions(), "\n".join(lines).encode() + b"\n")[0]


def page(loaded: Loaded, method: str = "visible", eye: ViewOptions = FILE_AXES, **look: Any) -> Picture:
    """The picture that a model becomes; ``look`` are the fields of ``DrawOptions``."""
    look = {"style": load_style(look.pop("style", "flat")), "color_by": "element"} | look
    options = DrawOptions(load_palette("tide"), **look)
    options = options.settled(entities_of(loaded.molecule), method == "painter")
    view = view_of(loaded.spheres, eye)
    low, high = extent(loaded.spheres, view)
    values = color_values(loaded, options.color_by)

    def subject(row: np.ndarray) -> Subject:
        return Subject(loaded.molecule, entities_of(loaded.molecule), row, low, high, values)

    if method == "painter":
        pieces, row = Scene(loaded.spheres, only=view).pieces(view)
        return picture_of_pieces(pieces, subject(row), options)
    view_map, row = Scene(loaded.spheres, only=view).map(view)
    return picture_of_map(view_map, view, subject(row), options)


def named(picture: Picture) -> dict[str, Any]:
    """The layers by their names, which all differ."""
    table = {layer.name: layer for layer in picture.layers}
    assert len(table) == len(picture.layers)
    return table


@dataclass(frozen=True)
class Shape:
    """One shape of a layer: its loops, each a table of arcs."""

    loops: list[PlaneArcs]

    def sweeps(self) -> list[list[float]]:
        """The sweeps of the arcs of each loop in half turns."""
        return [(loop.sweep / np.pi).tolist() for loop in self.loops]

    def area(self) -> float:
        """½ ∮ x dy − y dx by small steps, in square points."""
        return sum(_area(loop) for loop in self.loops)


def _area(loop: PlaneArcs) -> float:
    """The polygon of 2,000 chords an arc, each longer by the segment that it cuts off."""
    t = loop.start[:, None] + loop.sweep[:, None] * np.linspace(0, 1, 2001)
    x, y = ((loop.c[:, [k]] + loop.u[:, [k]] * np.cos(t) + loop.v[:, [k]] * np.sin(t)).ravel() for k in (0, 1))
    return float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)) / 2)


def shapes(layer: FillLayer | StrokeLayer) -> list[Shape]:
    """The shapes of a layer in painting order."""
    paths = layer.paths
    loops = [
        paths.arcs.take(np.arange(begin, end))
        for begin, end in zip(paths.loop_start[:-1].tolist(), paths.loop_start[1:].tolist(), strict=True)
    ]
    ends = zip(paths.shape_start[:-1].tolist(), paths.shape_start[1:].tolist(), strict=True)
    return [Shape(loops[begin:end]) for begin, end in ends]


def projection(distance: float | None) -> Projection:
    """The parallel projection for None, else the central one from that distance."""
    return projection_of(View(np.eye(3), np.zeros(3), distance))


def occluders(spheres: Spheres, distance: float | None) -> SphereOccluders:
    """Spheres in eye coordinates as what hides."""
    return occluders_of(spheres, View(np.eye(3), np.zeros(3), distance))


def horizons(spheres: Spheres, distance: float | None) -> Curves:
    """The contour generators of spheres in eye coordinates."""
    return occluders(spheres, distance).horizons()


def margins(
    spheres: Spheres, distance: float | None, own: np.ndarray, other: np.ndarray, angle: np.ndarray
) -> np.ndarray:
    """At an angle of horizon ``own``: positive where sphere ``other`` hides it."""
    eye = occluders(spheres, distance)
    return eye.horizon_margin(eye.horizons(), own, other).at(angle)


def shadow_signs(
    spheres: Spheres, distance: float | None, circles: Curves, sphere: np.ndarray, angle: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """At an angle of circle k and for sphere ``sphere[k]``: positive beyond its plane, negative inside its cone."""
    eye, row = occluders(spheres, distance), np.arange(len(sphere))
    plane = eye.plane_margin(circles, row, sphere).at(angle)
    form, cos, sin = eye.cone(circles, row, sphere), np.cos(angle), np.sin(angle)
    square = form.aa * cos**2 + 2 * form.ab * cos * sin + form.bb * sin**2
    return plane, square + 2 * form.a * cos + 2 * form.b * sin + form.c


def kept(spheres: Spheres, distance: float | None, cuts: tuple[int, ...] = ()) -> np.ndarray:
    """Which spheres (view coordinates) culling keeps, given to it in parts that are cut before some rows."""
    view = View(np.eye(3), np.zeros(3), distance)
    seen, ends = occluders_of(eye_coordinates(spheres, view), view), [0, *cuts, len(spheres.radius)]
    parts = [partial(seen.take, np.arange(first, last)) for first, last in pairwise(ends)]
    rows = possibly_visible(parts, projection_of(view))
    return np.isin(np.arange(len(spheres.radius)), rows)


def tees(found: VisibilityMap) -> int:
    """The number of T-junctions of a map: vertices at which three arcs end, two of them on one circle."""
    vertex = np.append(found.curve_arcs.origin, found.curve_arcs.target)
    circle = np.tile(found.curve_arcs.curve, 2)
    degree = np.bincount(vertex)
    kinds = np.array([len(set(circle[vertex == k].tolist())) for k in range(len(degree))])
    return int(np.sum((degree == 3) & (kinds == 2)))
