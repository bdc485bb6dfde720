"""Pictures look alike whatever draws them, and no format holds a raster."""

import re
import zlib
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import molviz
from molviz.picture.style import STYLES
from tests.render import (
    needs_chromium,
    needs_ghostscript,
    needs_poppler,
    seen_by_cairo,
    seen_by_chromium,
    seen_by_ghostscript,
    seen_by_poppler,
    seen_by_resvg,
)

pytestmark = pytest.mark.filterwarnings("ignore:.*without element")
SAMPLES = Path(__file__).parent.parent / "samples"
PIXELS = 3  # to the point: about 900 across
WIDTH = 288  # points, of the drawing
MOST = 0.01  # of full scale, the mean difference
STYLED = [("1hpv.pdb.gz", style) for style in ("goodsell", "flat", "line", "shaded")]
STYLED += [("c60.xyz", style) for style in ("cel", "hatch", "print")]
# Ghostscript (in PDF) and poppler's own rasteriser paint every part of a pixel that a shape touches: lines of a pixel
# in width get wider by a third. What they make of pictures with fewer such lines is as near as the others.
FEWER_LINES = [("1hpv.pdb.gz", "goodsell"), ("1hpv.pdb.gz", "shaded"), ("c60.xyz", "cel")]


@cache
def drawn(name: str, style: str) -> molviz.Drawing:
    return molviz.draw(SAMPLES / name, style=style, width=WIDTH, background="white", no_water=True)


def page_pixels(drawing: molviz.Drawing) -> tuple[int, int]:
    width, height = re.search(r'viewBox="0 0 (\d+) (\d+)"', drawing.svg()).groups()
    return PIXELS * int(width), PIXELS * int(height)


@cache
def by_resvg(name: str, style: str) -> np.ndarray:
    drawing = drawn(name, style)
    return seen_by_resvg(drawing.to("svg"), *page_pixels(drawing)).astype(float)


def on_page(image: np.ndarray, eps: bytes, shape: tuple[int, ...]) -> np.ndarray:
    """The image of an EPS on its whole page: what is outside of the bounding box is white."""
    x0, _, _, y1 = (int(x) for x in re.search(rb"%%BoundingBox: (\d+) (\d+) (\d+) (\d+)", eps).groups())
    whole, top, left = np.full(shape, 255.0), shape[0] - PIXELS * y1, PIXELS * x0
    whole[top : top + image.shape[0], left : left + image.shape[1]] = image
    return whole


def difference(image: np.ndarray, name: str, style: str) -> float:
    usual = by_resvg(name, style)
    assert image.shape == usual.shape and 0.1 < (usual < 250).any(axis=2).mean() < 0.9
    return float(np.abs(image - usual).mean()) / 255


@needs_chromium
@pytest.mark.parametrize(("name", "style"), STYLED)
def test_svg_in_a_browser(name: str, style: str) -> None:
    drawing = drawn(name, style)
    image = seen_by_chromium(drawing.to("svg"), *page_pixels(drawing)).astype(float)
    assert difference(image, name, style) < MOST


@needs_ghostscript
@pytest.mark.parametrize(("name", "style"), FEWER_LINES)
def test_pdf_by_ghostscript(name: str, style: str) -> None:
    image = seen_by_ghostscript(drawn(name, style).to("pdf"), 72 * PIXELS).astype(float)
    assert difference(image, name, style) < MOST


@needs_poppler
@pytest.mark.parametrize(("name", "style"), STYLED)
def test_pdf_by_poppler_with_cairo(name: str, style: str) -> None:
    image = seen_by_cairo(drawn(name, style).to("pdf"), 72 * PIXELS).astype(float)
    assert difference(image, name, style) < MOST


@needs_poppler
@pytest.mark.parametrize(("name", "style"), FEWER_LINES)
def test_pdf_by_poppler(name: str, style: str) -> None:
    image = seen_by_poppler(drawn(name, style).to("pdf"), 72 * PIXELS).astype(float)
    assert difference(image, name, style) < MOST


@needs_ghostscript
@pytest.mark.parametrize(("name", "style"), STYLED)
def test_eps_by_ghostscript(name: str, style: str) -> None:
    eps = drawn(name, style).to("eps")
    image = on_page(seen_by_ghostscript(eps, 72 * PIXELS).astype(float), eps, by_resvg(name, style).shape)
    assert difference(image, name, style) < MOST


def streams(pdf: bytes) -> bytes:
    """A PDF with its compressed streams unpacked."""

    def unpacked(found: re.Match[bytes]) -> bytes:
        try:
            return zlib.decompressobj().decompress(found[1])
        except zlib.error:
            return found[1]

    return re.sub(rb"stream\r?\n(.*?)endstream", unpacked, pdf, flags=re.DOTALL)


@pytest.mark.parametrize("style", STYLES)
def test_nothing_is_a_raster(style: str) -> None:
    drawing = drawn("caffeine.xyz", style)
    assert not re.search(r"<(image|filter|foreignObject|mask|pattern)\b|data:", drawing.svg())
    pdf = streams(drawing.to("pdf"))
    assert b" re" in pdf and not re.search(rb"/Subtype\s*/Image|\bBI\s.*\bID\s", pdf)
    for suffix in ("ps", "eps"):
        assert not re.search(rb"\b(image|imagemask|colorimage)\b", drawing.to(suffix))


def test_shaded_balls_share_their_gradients() -> None:
    """One for each colour and radius, not for each ball."""
    drawing = drawn("1hpv.pdb.gz", "shaded")
    assert drawing.visible > 500 and drawing.svg().count("<radialGradient") < 30


@pytest.mark.parametrize("style", ["shaded", "goodsell", "flat"])
def test_drawings_in_one_web_page_keep_their_own_colours(style: str) -> None:
    """Gradients, clips and classes of one are not found by the other; the command that drew it changes nothing."""
    found = []
    for name in ("caffeine.xyz", "1hpv.pdb.gz"):
        svg = drawn(name, style).svg()
        referred = set(re.findall(r'(?:url\(|href=")#([^")]+)', svg))
        rules = set(re.findall(r"\.([a-z]\w*)\{", svg))
        assert referred <= set(re.findall(r' id="([^"]+)"', svg)) and (referred or rules)
        found.append(referred | rules)
    assert not found[0] & found[1]
