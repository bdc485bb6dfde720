"""Pictures by several renderers beside each other: the mean difference from the SVG by resvg, in percent of full scale.

    python -m tests.alike FILE... [--style goodsell] [--pixels 900]

Chromium draws the SVG, ghostscript the EPS and the PDF, poppler the PDF with cairo and by itself. More than 1 % is told
by the exit code, but for ghostscript's and poppler's own PDF, which make thin lines wider.
"""

import argparse
import re
import sys
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

import molviz
from tests.render import seen_by_cairo, seen_by_chromium, seen_by_ghostscript, seen_by_poppler, seen_by_resvg

PIXELS = 3  # to the point: about 900 across
MOST = 0.01  # of full scale, the mean difference


def page_pixels(drawing: molviz.Drawing, pixels: int = PIXELS) -> tuple[int, int]:
    """The size of the picture at so many pixels to the point."""
    found = re.search(r'viewBox="0 0 (\d+) (\d+)"', drawing.svg())
    assert found
    return pixels * int(found[1]), pixels * int(found[2])


def on_page(image: np.ndarray, eps: bytes, shape: tuple[int, ...], pixels: int = PIXELS) -> np.ndarray:
    """The image of an EPS on its whole page: what is outside of the bounding box is white."""
    found = re.search(rb"%%BoundingBox: (\d+) (\d+) (\d+) (\d+)", eps)
    assert found
    whole, top, left = np.full(shape, 255.0), shape[0] - pixels * int(found[4]), pixels * int(found[1])
    whole[top : top + image.shape[0], left : left + image.shape[1]] = image
    return whole


@cache
def by_resvg(drawing: molviz.Drawing) -> np.ndarray:
    """The picture to which all others are compared."""
    return seen_by_resvg(drawing.to("svg"), *page_pixels(drawing)).astype(float)


def _eps_by_ghostscript(drawing: molviz.Drawing) -> np.ndarray:
    eps = drawing.to("eps")
    return on_page(seen_by_ghostscript(eps, 72 * PIXELS).astype(float), eps, by_resvg(drawing).shape)


RENDERERS: dict[str, Callable[[molviz.Drawing], np.ndarray]] = {
    "SVG by Chromium": lambda drawing: seen_by_chromium(drawing.to("svg"), *page_pixels(drawing)),
    "EPS by ghostscript": _eps_by_ghostscript,
    "PDF by poppler with cairo": lambda drawing: seen_by_cairo(drawing.to("pdf"), 72 * PIXELS),
    "PDF by poppler": lambda drawing: seen_by_poppler(drawing.to("pdf"), 72 * PIXELS),
    "PDF by ghostscript": lambda drawing: seen_by_ghostscript(drawing.to("pdf"), 72 * PIXELS),
}
WIDER_LINES = ("PDF by poppler", "PDF by ghostscript")


def difference(drawing: molviz.Drawing, renderer: str) -> float:
    """The mean difference of a renderer's picture from the usual one, of full scale."""
    image, usual = RENDERERS[renderer](drawing).astype(float), by_resvg(drawing)
    assert image.shape == usual.shape and 0.03 < (usual < 250).any(axis=2).mean() < 0.9
    return float(np.abs(image - usual).mean()) / 255


def main() -> None:
    parser = argparse.ArgumentParser(description="Draw files and compare what several renderers make of them.")
    parser.add_argument("file", nargs="+")
    parser.add_argument("--style", action="append", help="instead of the one that suits the file; many times")
    parser.add_argument("--pixels", type=int, default=900)
    asked = parser.parse_args()
    warnings.simplefilter("ignore")
    worst = 0.0
    for file in asked.file:
        for style in asked.style or [""]:
            options = {"style": style} if style else {}
            drawing = molviz.draw(file, width=asked.pixels / PIXELS, background="white", **options)
            found = {name: difference(drawing, name) for name in RENDERERS}
            worst = max([worst, *(value for name, value in found.items() if name not in WIDER_LINES)])
            print(Path(file).name, style, *(f"| {name} {value:.2%}" for name, value in found.items()), flush=True)
            by_resvg.cache_clear()
    sys.exit(worst > MOST)


if __name__ == "__main__":
    main()
