"""From a molecule to a drawing: what is seen is computed once, and becomes a picture in any format when asked for."""

import json
import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import PurePath

import numpy as np

from molviz.arrays import Floats, Ints, distinct
from molviz.errors import InputError
from molviz.geometry.measure import measure_spheres
from molviz.geometry.solids import BallsAndSticks
from molviz.model.entities import Entities, entities_of
from molviz.model.molecule import Molecule
from molviz.model.selection import NO_ATOMS, check_selection, select
from molviz.picture.compose import alike_with, picture_of_map, picture_of_pieces, placed_and_colored
from molviz.picture.options import Alike, DrawOptions, Labelled, Painted, Subject
from molviz.picture.page import Placement
from molviz.picture.palette import load_palette
from molviz.picture.picture import Color, Picture
from molviz.picture.style import load_style
from molviz.pipeline.inputs import WATER_RADIUS, Loaded, refuse_unresolved
from molviz.pipeline.outputs import pieces_of, refuse_inputs, save
from molviz.pipeline.solids import SolidOptions, shown, solid_options_from, solids_for
from molviz.pipeline.units import in_unit, solids_in_unit, unit_of, view_in_unit
from molviz.pipeline.values import (
    Options,
    chosen,
    given,
    page_from,
    parse_all_painted,
    parse_background,
    parse_labels,
    parse_not_negative,
    parse_scale_bar,
    parse_text,
)
from molviz.pipeline.views import ViewOptions, view_of
from molviz.visibility.checks import check_map
from molviz.visibility.eye import refuse_eye_among
from molviz.visibility.lines import slivers
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.map_json import map_as_data
from molviz.visibility.overlay import seen_spheres
from molviz.visibility.painter import Pieces
from molviz.visibility.scene import Scene, extent
from molviz.visibility.tiles import Each
from molviz.visibility.view import View
from molviz.write import WRITERS

AUTO = "auto"
JSON = ".json"
NOT_PAINTED = (JSON, ".hpgl")  # the map is another thing, and a pen cannot cover what it drew


@dataclass(frozen=True)
class DrawRequest:
    """A picture as it was asked for, before the molecule is known: selections are words still."""

    options: DrawOptions
    colors: tuple[tuple[str, Color], ...] = ()  # selection, colour
    labels: tuple[str, ...] = ()  # SELECTION[=TEXT]
    solids: SolidOptions = SolidOptions()
    description: str = ""  # the command that draws it
    each: Each = map  # what does the tiles of large maps


@dataclass(frozen=True, repr=False, eq=False)
class Drawing:
    """One molecule as it is seen, ready for any format; a notebook shows it as SVG.

    ``atoms_read`` counts the atoms of the model, ``atoms_drawn`` those that the options left, ``visible`` those of
    which something is seen, ``arcs`` the pieces of all lines.
    """

    atoms_read: int
    atoms_drawn: int
    visible: int
    arcs: int
    _loaded: Loaded
    _options: DrawOptions  # settled
    _view: View  # in lengths of the options' unit, as what is seen
    _seen: VisibilityMap | Pieces
    _solids: BallsAndSticks
    subject: Subject  # the molecule, and what there is to tell of it

    @property
    def source(self) -> str:
        """The name of the file that is drawn, or what stands for one."""
        return self._loaded.source

    @property
    def notes(self) -> tuple[str, ...]:
        """What is odd about the picture: sticks that are not as asked for, colours that stand for more than one chain,
        options that change nothing."""
        told = (*self._shared_colors(), *self._without_effect())
        return self._solids.notes + tuple(f"{self._loaded.source}: {note}" for note in told)

    def _shared_colors(self) -> Iterator[str]:
        if self._options.color_by != "chain":
            return
        chains = len(distinct(self._loaded.molecule.chain))
        if self._options.palette.repeats(chains):
            yield f"{chains} chains share {len(self._options.palette.chain)} colours; expected a palette of more"

    def _without_effect(self) -> Iterator[str]:
        """Colours and labels of nothing that is drawn, and labels of what is hidden."""
        for painted in self.subject.painted:
            if not painted.atoms.any():
                yield f"color {painted.name!r} means no atom that is drawn"
        seen = self._seen.spheres() if isinstance(self._seen, Pieces) else seen_spheres(self._seen.by_sphere())
        for labelled in self.subject.labelled:
            if not labelled.atoms.any():
                yield f"label {labelled.name!r} means no atom that is drawn"
            elif not labelled.atoms[self.subject.atom[seen]].any():
                yield f"label {labelled.name!r} means atoms that are hidden"

    def __repr__(self) -> str:
        return (
            f"<Drawing of {self._loaded.molecule.name!r}: {self.atoms_read} atoms read, {self.atoms_drawn} drawn, "
            f"{self.visible} visible, {self.arcs} arcs>"
        )

    def _repr_svg_(self) -> str:
        return self.svg()

    def svg(self) -> str:
        """Return the drawing as the text of an SVG file."""
        return self.to("svg").decode("utf-8")

    def to(self, format: str, plotter: str = "", paper: str = "") -> bytes:
        """Return the drawing as the content of a file: ``"svg"``, ``"pdf"``, ``"eps"``, ``"json"`` (the map) …

        ``plotter`` and ``paper`` matter to ``"hpgl"`` alone. Raises InputError for a format that nobody knows, and
        for one that painting over (``method="painter"``) does not give.
        """
        return b"".join(self.pieces(format, plotter, paper))

    def pieces(self, format: str, plotter: str = "", paper: str = "") -> Iterable[bytes]:
        """Return the same in pieces that are made one by one, for drawings that are large; raises as ``to`` does."""
        suffix = f".{str(format).removeprefix('.')}".lower()
        if suffix not in suffixes():
            raise InputError(f"format: {format!r}; expected one of {' '.join(suffixes())}")
        if isinstance(self._seen, Pieces) and suffix in NOT_PAINTED:
            raise InputError(f"painting over gives no {suffix}; expected method visible", self._loaded.source)
        if suffix == JSON:
            return [self._map_as_json()]
        return pieces_of(self.picture(suffix), suffix, plotter, paper)

    def save(self, path: str | os.PathLike[str], plotter: str = "", paper: str = "") -> None:
        """Write the drawing in the format that the suffix of the path names; the file appears whole or not at all.

        Raises InputError for an unknown suffix, and where the file cannot be written.
        """
        suffix = PurePath(path).suffix
        if suffix.lower() not in suffixes():
            raise InputError(f"path: no format {suffix!r}; expected one of {' '.join(suffixes())}")
        refuse_inputs(os.fspath(path), [self.source])
        save(os.fspath(path), self.pieces(suffix, plotter, paper))

    def picture(self, suffix: str) -> Picture:
        """Return the drawing as layers on a page, as the format of a suffix can show them."""
        return self._pen_picture if suffix == ".hpgl" else self._picture

    @property
    def view(self) -> View:
        """Where the eye is."""
        return self._view

    def placed_and_colored(self) -> tuple[Placement, Ints]:
        """Return where the drawing lies on its page, and what each atom (n, 3) is filled with before fog."""
        return placed_and_colored(self._seen, self._view, self.subject, self._options)

    def alike(self) -> Alike:
        """Return what the pictures of a set would share if all were like this one."""
        return alike_with(self._seen, self._view, self.subject, self._options)

    @cached_property
    def _picture(self) -> Picture:
        return self._composed(self._options)

    @cached_property
    def _pen_picture(self) -> Picture:
        """What a pen can draw: even lines where the style has filled ones."""
        style = self._options.chosen_style()
        if style.lines.outline.width or style.hatch.nearest:
            return self._picture
        return self._composed(replace(self._options, style=load_style("line")))

    def _composed(self, options: DrawOptions) -> Picture:
        if isinstance(self._seen, Pieces):
            return picture_of_pieces(self._seen, self.subject, options)
        return picture_of_map(self._seen, self._view, self.subject, options)

    def _map_as_json(self) -> bytes:
        assert isinstance(self._seen, VisibilityMap)  # painter's pieces were refused
        data = map_as_data(self._seen, self._loaded.molecule.row[self.subject.atom], self._view, self._options.unit)
        return json.dumps(data, separators=(",", ":")).encode() + b"\n"


def draw_request_from(options: Options) -> DrawRequest:
    """Return the look of a picture; raises InputError for a style or palette that is none as well."""
    style, scheme = str(options["style"]), chosen(options, "color_by")
    look = DrawOptions(
        palette=load_palette(str(options["palette"])),
        style=None if style == AUTO else load_style(style),
        color_by=None if scheme == AUTO else scheme,
        fill=chosen(options, "fill") if options["fill"] is not None else None,
        parts=chosen(options, "parts") if options["parts"] is not None else None,
        outline=given(options, "outline", parse_not_negative),
        crease=given(options, "crease", parse_not_negative),
        background=given(options, "background", parse_background),
        page=page_from(options),
        legend=bool(options["legend"]),
        title=given(options, "title", parse_text) or "",
        scale_bar=given(options, "scale_bar", parse_scale_bar),
    )
    colors, labels = given(options, "color", parse_all_painted) or (), given(options, "label", parse_labels) or ()
    for selection, _ in colors:
        check_selection(selection)
    for label in labels:
        labelled_of(NO_ATOMS, label)
    return DrawRequest(look, colors, labels, solid_options_from(options))


def labelled_of(molecule: Molecule, text: str, model: int = 1) -> Labelled:
    """Return the atoms that ``SELECTION[=TEXT]`` means, split at the first = that leaves a valid selection."""
    for place in [*(k for k, letter in enumerate(text) if letter == "="), len(text)]:
        try:
            return Labelled(select(molecule, text[:place], model), text[place + 1 :], text[:place])
        except InputError:
            if place == len(text):
                raise
    raise AssertionError


def drawing_of(
    loaded: Loaded, request: DrawRequest, view_options: ViewOptions, method: str = "visible", check: bool = False
) -> Drawing:
    """Return one model drawn; ``method`` is ``visible`` or ``painter``.

    ``check`` verifies the visibility map and raises InternalError where an invariant does not hold. Raises InputError
    where the eye is not in front of all atoms.
    """
    view = view_of(shown(loaded, request.solids)[0].balls, view_options)
    return drawings_of(loaded, request, [view], method, check)[0]


def drawings_of(
    loaded: Loaded,
    request: DrawRequest,
    views: Sequence[View],
    method: str = "visible",
    check: bool = False,
    unit: float | None = None,
) -> list[Drawing]:
    """Return one model drawn from each view; what no view changes is computed once. As ``drawing_of`` otherwise.

    ``unit`` in ångström is that of the set which the drawings belong to, None for the model's own.
    """
    loaded, representation = shown(loaded, request.solids)
    solids = solids_for(loaded, representation, request.solids)
    refuse_unresolved(solids.balls, loaded.source)
    for view in views:
        refuse_eye_among(solids.balls, view)
    unit = unit_of(loaded) if unit is None else unit
    scaled, views = in_unit(loaded, unit), [view_in_unit(view, unit) for view in views]
    solids = solids_in_unit(solids, unit)
    scene = Scene(solids.balls, views[0] if len(views) == 1 else None, solids.sticks, request.each)
    entities = entities_of(scaled.molecule)
    options = request.options.settled(entities, method == "painter").in_unit(unit)
    subject = replace(subject_of(loaded, entities, request, options), molecule=scaled.molecule)
    return [_seen_from(view, scene, solids, loaded, subject, options, method, check) for view in views]


def subject_of(loaded: Loaded, entities: Entities, request: DrawRequest, options: DrawOptions) -> Subject:
    """Return what there is to tell of a model, before anything is known of views; ``options`` are settled."""
    molecule, nowhere = loaded.molecule, np.zeros(2)
    values = color_values(loaded, str(options.color_by), options.unit)
    painted = tuple(
        Painted(select(molecule, selection, loaded.model), color, selection) for selection, color in request.colors
    )
    labelled = tuple(labelled_of(molecule, label, loaded.model) for label in request.labels)
    none = np.empty(0, dtype=np.int64)
    return Subject(molecule, entities, none, nowhere, nowhere, values, painted, labelled, request.description)


def _seen_from(
    view: View,
    scene: Scene,
    solids: BallsAndSticks,
    loaded: Loaded,
    subject: Subject,
    options: DrawOptions,
    method: str,
    check: bool,
) -> Drawing:
    """The drawing of what is seen from one view."""
    seen: VisibilityMap | Pieces
    if method == "painter":
        seen, atom = scene.pieces(view)
        visible, arcs = len(seen.spheres()), len(seen.curve_arcs.curve)
    else:
        seen, atom = scene.map(view)
        if check:
            check_map(seen, view)
        faces = np.append(seen.owner(), BACKGROUND)[seen.loops.face[~slivers(seen)]]
        visible, arcs = int(np.sum(distinct(faces) != BACKGROUND)), len(seen.left)
    low, high = extent(solids.balls, view)
    subject = replace(subject, atom=atom, low=low, high=high)
    return Drawing(loaded.read, len(loaded.molecule), visible, arcs, loaded, options, view, seen, solids, subject)


def color_values(loaded: Loaded, scheme: str, unit: float = 1.0) -> Floats:
    """Return what a continuous colour scheme shows of each atom (n,), NaN for other schemes.

    Exposure is the exact solvent-accessible area of the atom in Å² among the atoms drawn: the table's radii, whatever
    those of the drawing, and a water of radius 1.4 Å (1.4 times the ``unit`` of a scene).
    """
    if scheme == "exposure":
        return measure_spheres(loaded.bare.enlarged(1.0, WATER_RADIUS * unit)).area
    return loaded.molecule.bfactor if scheme == "bfactor" else np.full(len(loaded.molecule), np.nan)


def suffixes() -> tuple[str, ...]:
    """Return the suffixes of all formats that a drawing has."""
    return (*WRITERS, JSON)
