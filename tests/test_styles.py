"""Styles keep what they promise."""

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import molviz
from molviz.errors import InputError
from molviz.picture.ink import line_widths
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
    """Wherever a horizon is seen before the background, a line is drawn, at its full width.

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
    assert widths[outer[runs.owner()]].min() == pytest.approx(ink.silhouette.at(scale))


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
