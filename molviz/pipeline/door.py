"""The front door for Python: what is drawn, measured and seen of anything made of spheres.

The signatures here state the defaults, and the command line takes its own from them. What does the work is imported
when it is called for: naming a function costs nothing.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence

TYPE_CHECKING = False  # as typing's: importing that costs more than all else here
if TYPE_CHECKING:
    import os
    from typing import Any

    from molviz.geometry.measure import Measure
    from molviz.pipeline.draw import Drawing
    from molviz.pipeline.inputs import Loaded
    from molviz.pipeline.sets import DrawingSet
    from molviz.pipeline.surface import Surface
    from molviz.pipeline.visible import Visible
    from molviz.visibility.view import View


def draw(
    x: Any,
    *,
    method: str = "visible",
    check: bool = False,
    rep: str | Sequence[str | tuple[str, str]] = (),
    bonds: str = "file",
    ball_scale: float = 0.25,
    stick_radius: float | None = None,
    style: str | os.PathLike[str] = "auto",
    color_by: str = "auto",
    color: str | Sequence[str | tuple[str, Any]] = (),
    palette: str | os.PathLike[str] = "tide",
    parts: str | None = None,
    surface: str | None = None,
    cavities: bool = False,
    label: str | Sequence[str] = (),
    scale_bar: float | str | bool | None = None,
    title: str | None = None,
    legend: bool = False,
    fill: str | None = None,
    outline: float | None = None,
    crease: float | None = None,
    background: str | Sequence[int] | None = "none",
    orient: str = "principal",
    view: str | Sequence[float] | None = None,
    rotate: str | Sequence[str | tuple[str, float]] = (),
    perspective: float | None = None,
    turntable: int | None = None,
    stereo: str | None = None,
    view_from: str | os.PathLike[str] | None = None,
    width: float | str | None = None,
    scale: float | None = None,
    margin: float | str | None = None,
    page: str = "fit",
    model: int | str = 1,
    assembly: str | None = None,
    select: str | None = None,
    water: bool = False,
    no_water: bool = False,
    no_hydrogens: bool = False,
    chain: str | Sequence[str] | None = None,
    radii: str | os.PathLike[str] = "bondi",
    scale_radii: float = 1.0,
    probe: float = 0.0,
) -> Drawing | DrawingSet:
    """Return an exact vector picture of ``x``, which a notebook shows and ``save("x.pdf")`` writes.

    ``x`` is a path, a Molecule, a pair (centers (n, 3), radii (n,)) in ångström, ASE Atoms, a gemmi Structure or
    Model, a biotite AtomArray, an MDAnalysis AtomGroup or Universe, or an RDKit Mol with a conformer.

    The options are those of ``molviz draw`` on the command line:

    * what is seen: ``method`` "visible" (the exact map) or "painter" (pieces that cover each other, with sticks in
      an order that is a rule), ``check``;
    * the atoms: ``rep`` "spacefill" (unless told otherwise), "ball-and-stick", "sticks" or "hide", for a part
      "resn HEM=sticks", several, of which the last that applies wins; ``bonds`` from the "file" and, where it has none,
      from distances, by "distance" alone, or "none"; ``ball_scale`` (of the radius, in ball-and-stick) and
      ``stick_radius`` (ångström; usually 0.15 in ball-and-stick, 0.2 in sticks);
    * the look: ``style`` (a name of ``molviz styles`` or a TOML file), ``color_by`` "auto", "element", "chain",
      "entity", "residue", "index", "bfactor" or "exposure", ``color`` ("resn HEM=crimson", several), ``palette``,
      ``parts`` "atoms" or "merged", ``fill`` "flat" or "none", ``outline`` and ``crease`` (widths in points, 0 for
      none), ``background`` ("white", "#ffe", (255, 255, 238) or "none");
    * beside it: ``label`` ("resn HEM", "chain A and name CA={resn} {resi}", several), ``scale_bar`` (ångström, or
      True), ``title``, ``legend``;
    * which balls: ``surface`` "vdw" or "accessible" (enlarged by ``probe``, 1.4 Å if none is given), ``cavities`` (only
      those that line a cavity, found with the same probe; with none for "vdw");
    * the view: ``orient`` "principal" or "file", or any orientation as ``view``, the quaternion w, x, y, z that turns
      the file's axes into the page's ("0.5,0.5,0.5,0.5", or four numbers); ``rotate`` ("x,30", or [("x", 30),
      ("y", 10)] in degrees), ``perspective`` (the eye's distance in ångström), ``stereo`` "wall" or "cross" (two
      beside each other), ``view_from`` (a file that ``molviz view`` saved: its options hold wherever the call leaves
      the usual one);
    * a set of pictures, a ``DrawingSet``: ``turntable`` (so many views around the page's y axis), or ``model`` "2-4"
      or "all";
    * the page: ``width`` ("8cm", or points), ``scale`` (points per ångström), ``margin``, ``page`` "fit", "a4" or
      "letter";
    * the part that is drawn: ``model`` (from 1), ``assembly``, ``select`` ("chain A and not water"), ``water`` (left
      out unless True, if there is anything else), ``no_water``, ``no_hydrogens``, ``chain`` ("A,B" or ["A", "B"]);
    * its radii: ``radii`` (table or file), ``scale_radii``, ``probe`` (ångström).

    Raises InputError, a ValueError, naming what is wrong, and warns of what is odd.
    """
    options = dict(locals())
    from molviz.pipeline.draw import draw_request_from
    from molviz.pipeline.sets import drawn, set_options_from
    from molviz.pipeline.state import USUAL, with_state
    from molviz.pipeline.values import chosen, view_options_from

    options = with_state(options, [name for name in USUAL if options[name] is not USUAL[name]])
    look, view_options, together = draw_request_from(options), view_options_from(options), set_options_from(options)
    loaded = load_models(x, options)
    tell((warning for one in loaded for warning in one.warnings), stacklevel=3)
    drawing = drawn(loaded, look, view_options, together, chosen(options, "method"), options["check"])
    tell(drawing.notes, stacklevel=3)
    return drawing


def measure(
    x: Any,
    probe: float = 0.0,
    radii: str | os.PathLike[str] = "bondi",
    *,
    model: int | str = 1,
    assembly: str | None = None,
    select: str | None = None,
    no_water: bool = False,
    no_hydrogens: bool = False,
    chain: str | Sequence[str] | None = None,
    scale_radii: float = 1.0,
) -> Measure:
    """Return exact areas (n,) in Å² and the volume in Å³ of the union of the balls of ``x``, ``probe`` Å larger.

    Derivatives by the atoms' positions come with it. ``x`` and the options are as for ``molviz.draw``; rows are the
    atoms that they leave. Raises InputError naming what is wrong, and warns of what is odd.
    """
    options = dict(locals())
    from molviz.geometry.measure import measure_spheres

    loaded = load_one(x, options)
    tell(loaded.warnings, stacklevel=3)
    return measure_spheres(loaded.spheres)


def surface(
    x: Any,
    probe: float = 1.4,
    radii: str | os.PathLike[str] = "bondi",
    *,
    outer_only: bool = False,
    check: bool = False,
    model: int | str = 1,
    assembly: str | None = None,
    select: str | None = None,
    no_water: bool = False,
    no_hydrogens: bool = False,
    chain: str | Sequence[str] | None = None,
    scale_radii: float = 1.0,
) -> Surface:
    """Return the boundary of the balls of ``x``, ``probe`` Å larger, as a graph, and the smooth surface of the probe.

    Components, cavities and their lining, and exact areas and volumes by kind and atom come with it. ``outer_only``
    leaves out voids; ``check`` verifies both identities of the surface and raises InternalError where one does not
    hold. ``x`` and the options are as for ``molviz.draw``; rows are the atoms that they leave. Raises InputError naming
    what is wrong, and warns of what is odd.
    """
    options = dict(locals())
    from molviz.pipeline.surface import surface_of
    from molviz.pipeline.values import given, parse_not_negative

    radius = given(options, "probe", parse_not_negative)
    loaded = load_one(x, options | {"probe": 0.0})
    tell(loaded.warnings, stacklevel=3)
    return surface_of(loaded, radius, outer_only, check)


def visible(
    x: Any,
    view: View | None = None,
    *,
    model: int | str = 1,
    assembly: str | None = None,
    select: str | None = None,
    no_water: bool = False,
    no_hydrogens: bool = False,
    chain: str | Sequence[str] | None = None,
    radii: str | os.PathLike[str] = "bondi",
    scale_radii: float = 1.0,
    probe: float = 0.0,
) -> Visible:
    """Return what is seen of ``x`` as arrays, by default along its shortest principal axis.

    ``x`` and the options are as for ``molviz.draw``; rows are the atoms that they leave. Raises InputError naming what
    is wrong, or if an eye is not in front of all atoms, and warns of what is odd.
    """
    options = dict(locals())
    from molviz.pipeline.views import checked_view
    from molviz.pipeline.visible import visible_of

    loaded = load_one(x, options)
    tell(loaded.warnings, stacklevel=3)
    return visible_of(loaded.spheres, checked_view(view, loaded.spheres))


def load_one(x: object, options: Mapping[str, Any]) -> Loaded:
    """Return the one model of ``x`` that the options mean; raises InputError for what is wrong."""
    from molviz.errors import InputError
    from molviz.pipeline.inputs import means_several

    if means_several(str(options["model"])):
        raise InputError(f"model: {options['model']!r}; expected a number from 1")
    return load_models(x, options)[0]


def load_models(x: object, options: Mapping[str, Any]) -> list[Loaded]:
    """Return all models of ``x`` that the options mean; raises InputError for what is wrong."""
    from molviz.pipeline.inputs import loaded_from
    from molviz.pipeline.subject import reading_of
    from molviz.pipeline.values import input_options_from

    return loaded_from(reading_of(x), input_options_from(options))


def tell(notes: Iterable[str], stacklevel: int) -> None:
    """Warn of what is odd, once of a kind; the warning names the line ``stacklevel`` calls further out."""
    for note in dict.fromkeys(notes):
        warnings.warn(note, stacklevel=stacklevel)
