"""Pictures against a z-buffer of the same spheres: no pixel inside a region may differ."""

import re
from pathlib import Path

import numpy as np
import pytest

from molviz.model.spheres import Spheres
from molviz.picture.options import DrawOptions
from molviz.picture.page import Page
from molviz.picture.palette import load_palette
from molviz.pipeline.draw import DrawRequest, drawing_of
from molviz.pipeline.inputs import InputOptions, Loaded, load
from molviz.pipeline.views import ViewOptions, view_of
from tests.render import needs_ghostscript, render_ps, render_svg
from tests.zbuffer import central_zbuffer, image_boxes, interior, mask_labels, zbuffer

SAMPLES = Path(__file__).parent.parent / "samples"
TURNS = [(), (("x", 40.0), ("y", 65.0), ("z", 10.0))]
NEARBY = [("caffeine.xyz", 9.0), ("c60.xyz", 6.5), ("pile.xyzr", 40.0)]  # Å from the middle: just in front of all
SIZE = 500.0  # points along the longer side; two pixels a point


def mask(loaded: Loaded, eye: ViewOptions, suffix: str, method: str) -> tuple[bytes, Spheres, float]:
    """A picking mask, the spheres as seen, and points per ångström."""
    seen = view_of(loaded.spheres, eye).of(loaded.spheres)
    low, high = bounds(seen, eye.distance)
    scale = SIZE / float((high - low).max())
    return drawing_of(loaded, DrawRequest(mask_options(scale)), eye, method).to(suffix), seen, scale


def mask_options(scale: float) -> DrawOptions:
    return DrawOptions(load_palette("tide"), color_by="index", outline=0.0, crease=0.0, page=Page(scale=scale))


def bounds(spheres: Spheres, distance: float | None = None) -> tuple[np.ndarray, np.ndarray]:
    reach = spheres.radius[:, None]
    flat = spheres.center[:, :2]
    lows, highs = (flat - reach, flat + reach) if distance is None else image_boxes(spheres, distance)
    return lows.min(axis=0), highs.max(axis=0)


def wrong_pixels(label: np.ndarray, seen: Spheres, low: np.ndarray, pixel: float, distance: float | None = None) -> int:
    if distance is None:
        truth = zbuffer(seen, low, pixel, label.shape)
    else:
        truth = central_zbuffer(seen, low, pixel, label.shape, distance)
    inside = interior(truth)
    assert inside.sum() > 10_000
    return int(np.sum(inside & (label != truth)))


@pytest.mark.parametrize("method", ["visible", "painter"])
@pytest.mark.parametrize("turn", TURNS, ids=["file", "turned"])
@pytest.mark.parametrize("name", ["caffeine.xyz", "c60.xyz", "1a8o.pdb", "nacl.extxyz", "pile.xyzr"])
def test_svg_mask_equals_zbuffer(name: str, turn: tuple[tuple[str, float], ...], method: str) -> None:
    loaded = load(str(SAMPLES / name), InputOptions())[0]
    svg, seen, scale = mask(loaded, ViewOptions("file", turn), ".svg", method)
    page = np.array([float(x) for x in re.findall(rb'viewBox="0 0 (\S+) ([^"]+)"', svg)[0]])
    low, high = bounds(seen)
    label = mask_labels(render_svg(svg, int(2 * page[0])))
    assert wrong_pixels(label, seen, (low + high) / 2 - page / 2 / scale, 0.5 / scale) == 0


@needs_ghostscript
@pytest.mark.parametrize("method", ["visible", "painter"])
@pytest.mark.parametrize("turn", TURNS, ids=["file", "turned"])
@pytest.mark.parametrize("name", ["caffeine.xyz", "c60.xyz", "1a8o.pdb"])
def test_eps_mask_equals_zbuffer(name: str, turn: tuple[tuple[str, float], ...], method: str) -> None:
    """The tight bounding box begins where the spheres do."""
    loaded = load(str(SAMPLES / name), InputOptions())[0]
    eps, seen, scale = mask(loaded, ViewOptions("file", turn), ".eps", method)
    label = mask_labels(render_ps(eps, 144))
    assert wrong_pixels(label, seen, bounds(seen)[0], 0.5 / scale) == 0


@pytest.mark.parametrize("method", ["visible", "painter"])
@pytest.mark.parametrize(("name", "distance"), NEARBY)
def test_svg_mask_from_nearby_equals_casting_rays(name: str, distance: float, method: str) -> None:
    loaded = load(str(SAMPLES / name), InputOptions())[0]
    svg, seen, scale = mask(loaded, ViewOptions("file", TURNS[1], distance), ".svg", method)
    page = np.array([float(x) for x in re.findall(rb'viewBox="0 0 (\S+) ([^"]+)"', svg)[0]])
    low, high = bounds(seen, distance)
    label = mask_labels(render_svg(svg, int(page[0])))
    assert wrong_pixels(label, seen, (low + high) / 2 - page / 2 / scale, 1 / scale, distance) == 0


@needs_ghostscript
@pytest.mark.parametrize("method", ["visible", "painter"])
@pytest.mark.parametrize(("name", "distance"), NEARBY)
def test_eps_mask_from_nearby_equals_casting_rays(name: str, distance: float, method: str) -> None:
    loaded = load(str(SAMPLES / name), InputOptions())[0]
    eps, seen, scale = mask(loaded, ViewOptions("file", TURNS[1], distance), ".eps", method)
    label = mask_labels(render_ps(eps, 72))
    assert wrong_pixels(label, seen, bounds(seen, distance)[0], 1 / scale, distance) == 0
