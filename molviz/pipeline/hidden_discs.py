"""Hidden lines of opaque discs from scene to file: Franklin's SPHERES (1980) and the statistics of his Fig. 8."""

import json
import math
import time
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from molviz.discs.arcs import Work
from molviz.discs.bands import Each as Each
from molviz.discs.bands import visible_perimeters
from molviz.discs.grid import (
    UNIT_SQUARE,
    Grid,
    Square,
    bounding_square,
    by_depth,
    cell_lists,
    depth_complexity,
    franklin_count,
)  # fmt: skip
from molviz.discs.regions import DiscRegions, displaced, visible_regions
from molviz.errors import InputError, OptionError
from molviz.geometry.circles import CircleArcs
from molviz.geometry.general_position import Degenerate, first_general
from molviz.model.scenes import random_scene, text_scene
from molviz.model.spheres import Spheres
from molviz.picture.disc_picture import DiscLook, disc_picture
from molviz.picture.picture import Picture
from molviz.pipeline.inputs import Loaded
from molviz.pipeline.outputs import pieces_of
from molviz.pipeline.views import ViewOptions, view_of
from molviz.rounding import ANGLE_DIGITS, rounded, significant

Statistics: TypeAlias = dict[str, int | float | dict[str, int]]

LABELS = {  # his words, where he has them
    "n": "Circles", "radius": "Max radius", "depth": "Depth complexity", "grid": "Grid resolution",
    "cell_entries": "Circle entries on cell lists", "cells_blocked": "Cells with blocking circles",
    "pairs_tested": "Pairs of circles tested for intersection", "pairs_intersecting": "Unique pairs that intersected",
    "visible_whole": "Completely visible", "visible_in_arcs": "Partially visible with K arcs", "hidden":
    "Completely hidden", "arcs": "Total visible arcs", "length_circumferences":
    "Total length of all visible arcs (circles)", "seconds": "Time (seconds)",
}  # fmt: skip
MOST_LETTERS = 100  # of a text: each is a few hundred spheres


@dataclass(frozen=True)
class HiddenDiscs:
    """A scene without its hidden lines."""

    spheres: Spheres
    grid: Grid
    arcs: CircleArcs
    work: Work
    seconds: float

    def visible(self) -> int:
        """Return the number of spheres with some of their perimeter visible."""
        return len(np.unique(self.arcs.circle))

    def statistics(self) -> Statistics:
        """Return the statistics by name, in the order of his Fig. 8."""
        count = len(self.spheres.radius)
        whole = int(np.count_nonzero(self.arcs.before < 0))
        pieces = np.bincount(np.bincount(self.arcs.circle[self.arcs.before >= 0], minlength=count))
        return {
            "n": count,
            "radius": float(self.spheres.radius.max()),
            "depth": significant(depth_complexity(self.spheres.radius, self.grid.square)),
            "grid": self.grid.across,
            "cell_entries": self.work.cell_entries,
            "cells_blocked": self.work.cells_blocked,
            "pairs_tested": self.work.pairs_tested,
            "pairs_intersecting": self.work.pairs_intersecting,
            "visible_whole": whole,
            "visible_in_arcs": {str(k): int(pieces[k]) for k in range(1, len(pieces))},
            "hidden": int(pieces[0]) - whole,
            "arcs": len(self.arcs.circle),
            "length_circumferences": significant(float(self.arcs.sweep.sum()) / (2.0 * math.pi)),
            "seconds": self.seconds,
        }


def random_discs(
    count: int, *, depth: float | None, radius: float | None, seed: int | None, shrink: bool, across: int | None,
    each: Each = map,
) -> HiddenDiscs:  # fmt: skip
    """Return Franklin's random scene without its hidden lines, its grid over the unit square."""
    scene = random_scene(count, depth=depth, radius=radius, seed=seed, shrink=shrink)
    return hide_discs(scene, UNIT_SQUARE, across, each)


def lettered_discs(text: str, *, shrink: bool, across: int | None) -> HiddenDiscs:
    """Return a word spelt in layers of spheres without its hidden lines; raises OptionError for a long text."""
    if len(text) > MOST_LETTERS:
        raise OptionError(f"text: {len(text)} letters; expected at most {MOST_LETTERS}")
    return hide_discs(text_scene(text, shrink=shrink), across=across)


def molecule_discs(
    loaded: Loaded, view_options: ViewOptions, across: int | None, each: Each = map
) -> HiddenDiscs:
    """Return a molecule's atoms as opaque discs, ordered by their centres alone, without their hidden lines.

    Raises InputError for a central view, whose outlines are no circles.
    """
    if view_options.distance is not None:
        raise InputError("discs are drawn in parallel projection; expected no --perspective", loaded.source)
    seen = view_of(loaded.spheres, view_options).of(loaded.spheres)
    return hide_discs(by_depth(seen), across=across, each=each)


def hide_discs(
    spheres: Spheres, square: Square | None = None, across: int | None = None, each: Each = map
) -> HiddenDiscs:
    """Remove the hidden lines of n ≥ 1 discs; z of the spheres is depth, larger is farther.

    ``square`` is what the grid covers, by default the bounding square; ``across`` its cells along one side, by
    default those of Franklin's formula; ``each`` does the bands of a large scene. Raises ``InputError`` where there is
    nothing to draw.
    """
    if not len(spheres.radius):
        raise InputError("no spheres, expected at least one")
    begin = time.perf_counter()
    square = square or bounding_square(spheres)
    grid = Grid(square, across or franklin_count(spheres.radius, square))
    arcs, work = visible_perimeters(spheres, grid, each)
    return HiddenDiscs(spheres, grid, arcs, work, time.perf_counter() - begin)


def regions_of(scene: HiddenDiscs) -> DiscRegions:
    """Return the visible regions; those of a displaced copy if the scene is not in general position.

    Raises InputError if displacing does not help.
    """
    return first_general(lambda attempt: _regions(scene, attempt))


def _regions(scene: HiddenDiscs, attempt: int) -> DiscRegions:
    if attempt:
        scene = hide_discs(displaced(scene.spheres, seed=attempt - 1), across=scene.grid.across)
    if scene.work.pairs_touching:
        raise Degenerate
    return visible_regions(scene.spheres, scene.grid, cell_lists(scene.spheres, scene.grid), scene.arcs)


def picture_of(scene: HiddenDiscs, look: DiscLook, fill: bool = False) -> Picture:
    """Return the scene's visible arcs on a page, over its visible regions if ``fill`` is wanted."""
    return disc_picture(scene.spheres, scene.arcs, regions_of(scene) if fill else None, look)


def drawn(
    scene: HiddenDiscs, suffix: str, look: DiscLook, fill: bool, plotter: str = "", paper: str = ""
) -> Iterable[bytes]:
    """Return the pieces of the scene as a file of the format that a suffix names."""
    if suffix == ".json":
        return [to_json(scene)]
    return pieces_of(picture_of(scene, look, fill), suffix, plotter, paper)


def to_json(scene: HiddenDiscs) -> bytes:
    """Return circles, arcs and statistics as JSON; its seconds are null, so that a scene has one file.

    Lists of finite numbers print in Python as in JSON, several times faster than the encoder writes them.
    """
    circles = np.column_stack([scene.spheres.center, scene.spheres.radius]).tolist()
    angles = (rounded(column, ANGLE_DIGITS) for column in (scene.arcs.start, scene.arcs.sweep))
    columns = (column.tolist() for column in (scene.arcs.circle, *angles))
    arcs = [list(row) for row in zip(*columns, strict=True)]
    statistics = scene.statistics() | {"seconds": None}
    return f'{{"circles": {circles}, "arcs": {arcs}, "statistics": {json.dumps(statistics)}}}\n'.encode("ascii")


def statistics_table(statistics: Statistics) -> str:
    """Return the statistics as a table like his Fig. 8."""
    width = max(len(label) for label in LABELS.values()) + 2
    return "\n".join(f"{LABELS[name]:>{width}} = {_cell(value)}" for name, value in statistics.items())


def _cell(value: int | float | dict[str, int]) -> str:
    if isinstance(value, dict):
        return "  ".join(f"{k}: {count}" for k, count in value.items()) or "none"
    return str(value) if isinstance(value, int) else f"{value:.6g}"
