"""From a molecule to the bytes of a drawing: every stage in order."""

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats
from molviz.errors import InputError
from molviz.geometry.measure import measure_spheres
from molviz.model.spheres import Spheres
from molviz.picture.compose import DrawOptions, Subject, picture_of_map, picture_of_pieces
from molviz.picture.picture import Picture
from molviz.pipeline.inputs import Loaded
from molviz.pipeline.outputs import encoded
from molviz.visibility.checks import check_map
from molviz.visibility.lines import slivers
from molviz.visibility.map import BACKGROUND
from molviz.visibility.map_json import map_as_data
from molviz.visibility.scene import Scene, extent
from molviz.visibility.view import View, file_axes, principal_axes
from molviz.write import WRITERS

JSON = ".json"
NOT_PAINTED = (JSON, ".hpgl")  # the map is another thing, and a pen cannot cover what it drew
WATER_RADIUS = 1.4  # ångström, Lee & Richards 1971
Report = Callable[[str], None]  # told the name of each stage as it begins


@dataclass(frozen=True)
class ViewOptions:
    """Where the user looks from."""

    orient: str = "principal"
    rotations: tuple[tuple[str, float], ...] = ()  # axis of the page, degrees
    distance: float | None = None  # ångström from the centre, None for a parallel view


@dataclass(frozen=True)
class OutputFormat:
    """The format of a drawing by its suffix; plotter and paper for HPGL, the usual ones where empty."""

    suffix: str
    plotter: str = ""
    paper: str = ""


class Drawing(NamedTuple):
    """The bytes of a drawing and what its summary line tells."""

    data: bytes
    atoms: int
    visible: int
    arcs: int


def draw(
    loaded: Loaded,
    output: OutputFormat,
    options: DrawOptions,
    view_options: ViewOptions,
    method: str,
    check: bool,
    report: Report,
) -> Drawing:
    """Return one model drawn; ``method`` is ``visible`` or ``painter``.

    ``check`` verifies the visibility map and raises InputError where an invariant does not hold.
    """
    view = view_of(loaded, view_options)
    low, high = extent(loaded.spheres, view)
    values = color_values(loaded, options.color_by)
    subject = Subject(loaded.molecule, np.arange(len(loaded.molecule)), low, high, values)
    if method == "painter":
        if output.suffix in NOT_PAINTED:
            raise InputError(f"painting over gives no {output.suffix}; expected --method visible", loaded.source)
        return _painted(loaded, output, options, view, subject, report)
    return _mapped(loaded, output, options, view, subject, check, report)


def _mapped(
    loaded: Loaded,
    output: OutputFormat,
    options: DrawOptions,
    view: View,
    subject: Subject,
    check: bool,
    report: Report,
) -> Drawing:
    report("visibility map")
    view_map, atom = Scene(loaded.spheres, only=view).map(view)
    if check:
        check_map(view_map, view)
    visible = int(np.sum(np.unique(view_map.loops.face[~slivers(view_map)]) != BACKGROUND))
    if output.suffix == JSON:
        plain = map_as_data(view_map, loaded.molecule.row[atom], view)
        data = json.dumps(plain, separators=(",", ":")).encode() + b"\n"
    else:
        report("picture")
        data = _written(picture_of_map(view_map, replace(subject, atom=atom), options), output, report)
    return Drawing(data, loaded.read, visible, len(view_map.curve_arcs.curve))


def _painted(
    loaded: Loaded, output: OutputFormat, options: DrawOptions, view: View, subject: Subject, report: Report
) -> Drawing:
    report("painter's pieces")
    pieces, atom = Scene(loaded.spheres, only=view).pieces(view)
    report("picture")
    picture = picture_of_pieces(pieces, replace(subject, atom=atom), options)
    return Drawing(_written(picture, output, report), loaded.read, len(pieces.order), len(pieces.curve_arcs.curve))


def _written(picture: Picture, output: OutputFormat, report: Report) -> bytes:
    report("writing")
    return encoded(picture, output.suffix, output.plotter, output.paper)


def color_values(loaded: Loaded, scheme: str) -> Floats:
    """Return what a continuous colour scheme shows of each atom (n,), NaN for other schemes.

    Exposure is the exact solvent-accessible area of the atom in Å² (water, radius 1.4 Å, among the atoms subject).
    """
    if scheme == "exposure":
        return measure_spheres(Spheres(loaded.spheres.center, loaded.spheres.radius + WATER_RADIUS)).area
    return loaded.molecule.bfactor if scheme == "bfactor" else np.full(len(loaded.molecule), np.nan)


def view_of(loaded: Loaded, view_options: ViewOptions) -> View:
    """Return the view that the user's options mean for one model."""
    axes = principal_axes if view_options.orient == "principal" else file_axes
    view = axes(loaded.spheres, view_options.distance)
    for axis, degrees in view_options.rotations:
        view = view.rotated(axis, degrees)
    return view


def suffixes() -> tuple[str, ...]:
    """Return the suffixes of all formats that ``draw`` writes."""
    return (*WRITERS, JSON)
