"""Pictures look alike whatever draws them, and no format holds a raster."""

import re
import zlib
from functools import cache
from pathlib import Path

import pytest

import molviz
from molviz.picture.style import STYLES
from tests.alike import MOST, difference
from tests.render import needs_chromium, needs_ghostscript, needs_poppler

pytestmark = pytest.mark.filterwarnings("ignore:.*without element")
SAMPLES = Path(__file__).parent.parent / "samples"
WIDTH = 288  # points, of the drawing
STYLED = [("1hpv.pdb.gz", style) for style in ("goodsell", "flat", "line", "shaded")]
STYLED += [("c60.xyz", style) for style in ("cel", "hatch", "print")]
# Ghostscript (in PDF) and poppler's own rasteriser paint every part of a pixel that a shape touches: lines of a pixel
# in width get wider by a third. What they make of pictures with fewer such lines is as near as the others.
FEWER_LINES = [("1hpv.pdb.gz", "goodsell"), ("1hpv.pdb.gz", "shaded"), ("c60.xyz", "cel")]


@cache
def drawn(name: str, style: str) -> molviz.Drawing:
    return molviz.draw(SAMPLES / name, style=style, width=WIDTH, background="white", no_water=True)


@needs_chromium
@pytest.mark.parametrize(("name", "style"), STYLED)
def test_svg_in_a_browser(name: str, style: str) -> None:
    assert difference(drawn(name, style), "SVG by Chromium") < MOST


@needs_ghostscript
@pytest.mark.parametrize(("name", "style"), FEWER_LINES)
def test_pdf_by_ghostscript(name: str, style: str) -> None:
    assert difference(drawn(name, style), "PDF by ghostscript") < MOST


@needs_poppler
@pytest.mark.parametrize(("name", "style"), STYLED)
def test_pdf_by_poppler_with_cairo(name: str, style: str) -> None:
    assert difference(drawn(name, style), "PDF by poppler with cairo") < MOST


@needs_poppler
@pytest.mark.parametrize(("name", "style"), FEWER_LINES)
def test_pdf_by_poppler(name: str, style: str) -> None:
    assert difference(drawn(name, style), "PDF by poppler") < MOST


@needs_ghostscript
@pytest.mark.parametrize(("name", "style"), STYLED)
def test_eps_by_ghostscript(name: str, style: str) -> None:
    assert difference(drawn(name, style), "EPS by ghostscript") < MOST


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
