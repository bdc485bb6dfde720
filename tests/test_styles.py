"""Styles keep what they promise."""

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import molviz
from molviz.errors import InputError
from molviz.picture.chains import linked
from molviz.picture.compose import MapComposer
from molviz.picture.ink import SPUR, at_places, line_widths
from molviz.picture.ink_pockets import inked_arcs
from molviz.picture.oklab import lightness
from molviz.picture.style import STYLES, load_style
from molviz.visibility.horizon_runs import horizon_runs
from molviz.visibility.map import BACKGROUND

CAFFEINE = Path(__file__).parent.parent / "samples" / "caffeine.xyz"
ATOMS = 24
SHORT = 0.3  # ångström: shorter horizons may change within a sample


@pytest.mark.parametrize("name", ["print", "hatch"])
def test_print_has_greys_that_stay_apart_and_nothing_else(name: str) -> None:
    """Whatever the element or residue: what a style does not state it has from its base."""
    colors = load_style(name).colors
    greys = {colors.unknown, *colors.ramp, *colors.element.values(), *colors.residue.values()}
    assert all(red == green == blue for red, green, blue in greys)
    levels = sorted(float(lightness(color)) for color in {*colors.element.values(), *colors.residue.values()})
    assert min(light - dark for dark, light in pairwise(levels)) >= 8


def test_print_has_no_hue() -> None:
    """Not in its ink either, whatever the palette."""
    colors = re.findall(r"#([0-9a-f]{6})\b", molviz.draw(CAFFEINE, style="print", palette="clay").svg())
    assert colors and all(color[:2] == color[2:4] == color[4:] for color in colors)


@pytest.mark.parametrize("name", ["goodsell", "cel", "print"])
def test_silhouettes_have_no_gaps(name: str) -> None:
    """Wherever a horizon is seen before the background, a line is drawn, at nearly its full width.

    Caffeine is flat: where its atoms touch, a horizon's last arc is too short to be seen and has the neighbour, not
    the background, behind it.
    """
    scene = molviz.Scene(CAFFEINE)
    view_map, _ = scene.map(scene.view)
    runs = horizon_runs(view_map, scene.view)
    ink, scale = load_style(name).ink, 30.0
    widths = line_widths(runs, np.zeros(ATOMS, dtype=np.int64), np.zeros(ATOMS), ink, scale).width
    outer = np.array([(runs.behind[a + 1 : b - 1] == BACKGROUND).all() for a, b in pairwise(runs.start)])
    outer &= runs.length() > SHORT
    assert outer.sum() > 12
    assert widths[outer[runs.owner()]].min() > 0.9 * ink.silhouette.at(scale)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("goodsel", "goodsel: no such style or file; did you mean 'goodsell'?"),
        ("zzz", f"zzz: no such style or file; expected one of {', '.join(STYLES)} or a TOML file"),
    ],
)
def test_no_style_is_told_once(name: str, told: str) -> None:
    with pytest.raises(InputError) as raised:
        load_style(name)
    assert str(raised.value) == told


def test_a_line_changes_its_ink_for_no_short_stretch() -> None:
    """In 1A1F, a protein on DNA, lines run before both; no stretch is under an ångström between longer ones."""
    scene = molviz.Scene(CAFFEINE.parent / "1a1f.pdb", no_water=True)
    view_map, row = scene.map(scene.view)
    runs = horizon_runs(view_map, scene.view)
    group = np.unique(scene.molecule.chain, return_inverse=True)[1].ravel()[row]
    dark = line_widths(runs, group, np.zeros(len(group)), load_style("goodsell").ink, 5.0).dark
    stretches = 0
    for begin, end in pairwise(runs.start.tolist()):
        changes = np.flatnonzero(np.diff((dark[begin:end] > 0.5).astype(int))) + 1
        parts = np.diff([0, *changes.tolist(), end - begin])
        stretches += len(parts) > 1
        lone = [k for k in range(1, len(parts) - 1) if parts[k] < min(parts[k - 1], parts[k + 1])]
        assert all(parts[k] * runs.spacing >= 0.99 for k in lone)
    assert stretches > 10


@pytest.mark.parametrize(("paper", "light"), [("#101820", True), ("#fff8e8", False)])
def test_texts_are_seen_on_any_page(paper: str, light: bool) -> None:
    svg = molviz.draw(CAFFEINE, title="caffeine", scale_bar=True, background=paper).svg()
    assert ('fill="#f0f0f0"' in svg) == light


def test_a_palette_has_its_own_ink_around_what_it_colours() -> None:
    from molviz.picture.palette import load_palette

    protein = CAFFEINE.parent / "1a8o.pdb"
    ink = "#{:02x}{:02x}{:02x}".format(*load_palette("clay").ink)
    assert molviz.draw(protein, palette="clay", crease=0, style="goodsell", background="white", title="x").svg()
    drawn = molviz.draw(protein, palette="clay", style="goodsell")
    layers = {layer.name: layer for layer in drawn.picture(".svg").layers}
    darkest = min(layers["ink"].paint, key=sum)
    assert np.abs(np.array(darkest) - load_palette("clay").ink).max() < 30, ink


@pytest.mark.parametrize("style", ["cel", "print"])
def test_where_all_creases_are_drawn_every_inner_edge_is(style: str) -> None:
    """An inner horizon whose ink fades goes on as an even line: on its way every edge meets another line."""
    drawing = molviz.draw(CAFFEINE, style=style)
    view_map = drawing._seen
    composer = MapComposer(view_map, drawing._view, drawing.subject, drawing._options)
    ink = inked_arcs(*composer.inking[:2]).min(axis=0)
    even = composer.wanted_creases
    assert np.all(even | (ink >= composer.widths[1] / composer.scale))
    assert 0 < (even & ~view_map.is_crease()).sum() < (~view_map.is_crease()).sum()


def test_short_creases_that_meet_no_line_are_crumbs() -> None:
    """Each crease by itself: it is one unless it is long or ends in a vertex in which there is ink."""
    drawing = molviz.draw(CAFFEINE, style="goodsell")
    composer = MapComposer(drawing._seen, drawing._view, drawing.subject, drawing._options)
    runs, widths, _ = composer.inking
    arcs, on_curves = np.flatnonzero(drawing._seen.is_crease()), drawing._seen.curve_arcs
    crumbs = np.array([
        composer.crumbs(linked(on_curves.origin, on_curves.target, on_curves.curve, arcs[k : k + 1]))[0]
        for k in range(len(arcs))
    ])  # fmt: skip
    inked = {
        int(vertex) for vertex, run, place in zip(*runs.vertices[:3], strict=True)
        if at_places(widths.width, runs, np.array([run]), np.array([place]))[0] > 0
    }  # fmt: skip
    lone = [not {int(on_curves.origin[arc]), int(on_curves.target[arc])} & inked for arc in arcs]
    assert np.array_equal(crumbs, (drawing._seen.arcs.lengths()[arcs] < SPUR) & lone)
    assert 0 < crumbs.sum() < len(arcs)
