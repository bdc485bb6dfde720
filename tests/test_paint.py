"""Gradients and opacities: closed forms, what is written, and the colours of rendered pixels."""

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.picture.picture import Gradient, RadialGradient, offsets_at
from molviz.write.paint import border_colors, mixed_color
from tests.render import (
    needs_chromium,
    needs_ghostscript,
    needs_poppler,
    seen_by_chromium,
    seen_by_ghostscript,
    seen_by_poppler,
    seen_by_resvg,
    write,
)
from tests.shaded_pictures import BALL, HEIGHT, PICTURES, SMALL, STICK, WIDTH, balls, page

SVG = "{http://www.w3.org/2000/svg}"
ZOOM = 3
SIZE = round(ZOOM * WIDTH), round(ZOOM * HEIGHT)
VIEWERS: dict[str, Callable[[object], np.ndarray]] = {
    "resvg": lambda picture: seen_by_resvg(write(picture, ".svg"), *SIZE),
    "chromium": lambda picture: seen_by_chromium(write(picture, ".svg"), *SIZE),
    "ghostscript ps": lambda picture: seen_by_ghostscript(write(picture, ".ps"), 72 * ZOOM),
    "ghostscript eps": lambda picture: seen_by_ghostscript(write(picture, ".eps"), 72 * ZOOM),
    "ghostscript pdf": lambda picture: seen_by_ghostscript(write(picture, ".pdf"), 72 * ZOOM),
    "poppler": lambda picture: seen_by_poppler(write(picture, ".pdf"), 72 * ZOOM),
}
NEEDS = {"chromium": needs_chromium, "poppler": needs_poppler}
EVERY_VIEWER = [
    pytest.param(name, marks=NEEDS.get(name, needs_ghostscript) if name != "resvg" else ()) for name in VIEWERS
]


def expected(gradient: Gradient, points: np.ndarray) -> np.ndarray:
    offset, table = zip(*gradient.stops, strict=True)
    at = offsets_at(gradient, points)
    return np.column_stack([np.interp(at, offset, channel) for channel in zip(*table, strict=True)])


@given(st.floats(0, 0.95), st.floats(0, 6.3), st.floats(0, 1), st.floats(0, 6.3))
def test_offsets_are_those_of_the_circle_through_a_point(reach: float, way: float, s: float, turn: float) -> None:
    focus = (7 * reach * np.cos(way), 7 * reach * np.sin(way))
    gradient = RadialGradient(7.0, focus, ((0.0, (0, 0, 0)), (1.0, (255, 255, 255))))
    point = (1 - s) * np.array(focus) + 7 * s * np.array([np.cos(turn), np.sin(turn)])
    assert abs(offsets_at(gradient, point[None])[0] - s) < 1e-6


@pytest.mark.parametrize("viewer", EVERY_VIEWER)
def test_pixels_have_the_colour_of_the_gradient(viewer: str) -> None:
    image = VIEWERS[viewer](page(balls())).astype(float)
    x, y = np.meshgrid((np.arange(SIZE[0]) + 0.5) / ZOOM, HEIGHT - (np.arange(SIZE[1]) + 0.5) / ZOOM)
    places = [(BALL, (70, 120), 40), (BALL, (160, 140), 40), (SMALL, (230, 60), 22), (STICK, (70, 32), 11)]
    for gradient, origin, radius in places:
        at = np.stack([x, y], axis=-1) - origin
        inside = np.hypot(*np.moveaxis(at, -1, 0)) < radius - 1
        inside &= (np.abs(at @ [-np.sin(0.4), np.cos(0.4)]) > 1) | (gradient is not SMALL)  # where two halves meet
        gap = np.abs(image[inside] - expected(gradient, at[inside]))
        assert gap.mean() < 2.5


def test_equal_gradients_are_written_once_in_every_format() -> None:
    root = ElementTree.fromstring(write(page(balls()), ".svg"))
    assert len(root.findall(f".//{SVG}radialGradient")) == 2 and len(root.findall(f".//{SVG}linearGradient")) == 1
    assert len(root.findall(f".//{SVG}path[@transform]")) == 6
    postscript = write(page(balls()), ".ps").decode()
    assert postscript.count("/ShadingType") == 3 and len(re.findall(r"^S\d \S+ \S+ g$", postscript, re.M)) == 6
    assert "%%LanguageLevel: 3" in postscript and max(map(len, postscript.splitlines())) <= 255
    assert write(page(balls()), ".pdf").count(b"/ShadingType") == 3


@pytest.mark.parametrize("name", PICTURES)
@pytest.mark.parametrize("background", [(255, 255, 255), (16, 20, 28)])
@pytest.mark.parametrize("viewer", EVERY_VIEWER[1:])
def test_all_viewers_show_the_same(viewer: str, name: str, background: tuple[int, int, int]) -> None:
    picture = page(*PICTURES[name], background=background)
    first, other = (VIEWERS[one](picture).astype(float) for one in ("resvg", viewer))
    assert first.shape == other.shape
    assert np.abs(first - other).mean() / 255 < 0.01


@pytest.mark.parametrize("name", PICTURES)
def test_nothing_is_a_raster(name: str) -> None:
    svg, pdf = (write(page(*PICTURES[name]), suffix) for suffix in (".svg", ".pdf"))
    assert not re.search(rb"<image|<filter|<mask|data:", svg)
    assert b"/Subtype /Image" not in pdf and not re.search(rb"/SMask|/ShadingType [14567]", pdf)
    assert not re.search(rb"\bimage(mask)?\b", write(page(*PICTURES[name]), ".ps"))


def test_borders_close_in_a_colour_of_their_own() -> None:
    colors = border_colors(balls())
    assert colors[0] == BALL.stops[-1][1]  # a whole ball: all of its border is the rim
    assert colors[3] == (20, 120, 90)
    assert SMALL.stops[0][1] > colors[4] > SMALL.stops[-1][1]  # half a ball: rim, and the middle of its diameter


def test_colours_mix_as_viewers_mix_them() -> None:
    assert mixed_color((255, 255, 255), (0, 100, 255), 0.25) == (191, 216, 255)


@pytest.mark.parametrize("suffix", [".svg", ".pdf"])
def test_a_translucent_layer_is_one_group(suffix: str) -> None:
    data = write(page(*PICTURES["translucent lines"]), suffix)
    if suffix == ".svg":
        assert data.count(b'opacity=".4"') == 1
    else:
        assert b"/ca .4/CA .4" in data and data.count(b"/S /Transparency") == 2  # the layer's and the page's


def test_a_plotter_ignores_shade_and_fills() -> None:
    assert write(page(*PICTURES["shade"], *PICTURES["gradients"]), ".hpgl") == b"IN;\nPU;SP0;\n"
