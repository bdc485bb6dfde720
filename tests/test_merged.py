"""Merged regions against a z-buffer: what lies inside a region of a chain or an element has that colour."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from molviz.model.spheres import Spheres
from molviz.picture.options import DrawOptions
from molviz.picture.page import Page
from molviz.picture.palette import load_palette
from molviz.picture.style import load_style
from molviz.pipeline.draw import Drawing, DrawRequest, drawing_of
from molviz.pipeline.inputs import InputOptions, Loaded, load
from molviz.pipeline.views import ViewOptions, view_of
from tests.render import needs_ghostscript, render_ps, render_svg
from tests.zbuffer import central_zbuffer, image_boxes, interior, zbuffer

SAMPLES = Path(__file__).parent.parent / "samples"
TURN = (("x", 40.0), ("y", 65.0), ("z", 10.0))
VIEWS = {"file": ViewOptions("file"), "turned": ViewOptions("file", TURN), "central": ViewOptions("file", TURN, 120.0)}
MOST_SLIVERS = 0.1  # of the pixels inside regions by the z-buffer: so few may lie beside exact boundaries
SIZE = 400.0  # points along the longer side, and pixels
STYLE = 'base = "flat"\nparts = "merged"\n[ink]\nsilhouette = 0.0\n[fog]\nstrength = 0.0\n[shade]\nsteps = []\n'


def bounds(spheres: Spheres, distance: float | None) -> tuple[np.ndarray, np.ndarray]:
    reach, flat = spheres.radius[:, None], spheres.center[:, :2]
    lows, highs = (flat - reach, flat + reach) if distance is None else image_boxes(spheres, distance)
    return lows.min(axis=0), highs.max(axis=0)


def seen_rows(seen: Spheres, low: np.ndarray, pixel: float, shape: tuple[int, int], eye: ViewOptions) -> np.ndarray:
    if eye.distance is None:
        return zbuffer(seen, low, pixel, shape)
    return central_zbuffer(seen, low, pixel, shape, eye.distance)


def beside_boundaries(
    drawing: Drawing, names: np.ndarray, low: np.ndarray, pixel: float, shape: tuple[int, int]
) -> np.ndarray:
    """Pixels near exact boundaries, which may run between two pixel centres: a sliver that a z-buffer does not see."""
    seen, of = drawing._seen, np.append(names[drawing.subject.atom], -1)
    arcs = seen.arcs.take(np.flatnonzero(of[seen.left] != of[seen.right]))
    count = np.ceil(np.abs(arcs.sweep) * arcs.major() / pixel * 3).astype(int) + 2
    owner = np.repeat(np.arange(len(count)), count)
    place = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    points = arcs.take(owner).at(arcs.start[owner] + arcs.sweep[owner] * place / (count[owner] - 1))
    column, line = np.floor((points - low) / pixel).astype(int).T
    near = np.zeros((shape[0] + 2, shape[1] + 2), dtype=bool)
    for dx, dy in np.ndindex(3, 3):
        near[np.clip(shape[0] - 1 - line + dy, 0, shape[0] + 1), np.clip(column + dx, 0, shape[1] + 1)] = True
    return near[1:-1, 1:-1]


def wrong_pixels(image: np.ndarray, names: np.ndarray, inside: np.ndarray) -> int:
    """How many pixels farther than one from a boundary have not the colour of their name; names share no colour."""
    rgb, empty = image[..., :3].astype(int), image[..., 3] == 0 if image.shape[2] == 4 else np.zeros(names.shape, bool)
    code = np.where(empty, -1, rgb[..., 0] << 16 | rgb[..., 1] << 8 | rgb[..., 2])
    wrong, usual = 0, []
    for name in np.unique(names[inside]).tolist():
        found, count = np.unique(code[inside & (names == name)], return_counts=True)
        wrong += int(count.sum() - count.max())
        usual.append(int(found[count.argmax()]))
    assert len(set(usual)) == len(usual)
    return wrong


def pixels_asked_and_wrong(
    loaded: Loaded, eye: ViewOptions, suffix: str, style: str, scheme: str, least: int = 5_000
) -> tuple[int, int]:
    """The picture without ink, fog and shade beside a z-buffer whose rows are named by chain or element."""
    seen = view_of(loaded.spheres, eye).of(loaded.spheres)
    low, high = bounds(seen, eye.distance)
    scale = SIZE / float((high - low).max())
    look = DrawOptions(
        load_palette("tide"), load_style(style), scheme, parts="merged", outline=0.0, crease=0.0, page=Page(scale=scale)
    )
    drawing = drawing_of(loaded, DrawRequest(look), eye)
    data = drawing.to(suffix)
    if suffix == ".svg":
        width, height = (float(x) for x in re.findall(rb'viewBox="0 0 (\S+) ([^"]+)"', data)[0])
        image, corner = render_svg(data, int(width)), (low + high) / 2 - np.array([width, height]) / 2 / scale
    else:
        image = render_ps(data, 72)
        corner = (low + high) / 2 - np.array(image.shape[1::-1]) / 2 / scale
    rows = seen_rows(seen, corner, 1 / scale, image.shape[:2], eye)
    column = loaded.molecule.chain if scheme == "chain" else loaded.molecule.element
    number = np.unique(column, return_inverse=True)[1]
    names = np.append(number, -1)[rows]
    inside = interior(names)
    parts = np.unique(np.char.add(column, loaded.molecule.chain), return_inverse=True)[1]  # regions never span chains
    near = beside_boundaries(drawing, parts, corner, 1 / scale, names.shape)
    assert inside.sum() > least and np.sum(inside & near) < MOST_SLIVERS * inside.sum()
    inside &= ~near
    return int(inside.sum()), wrong_pixels(image, names, inside)


@pytest.fixture(scope="module")
def style(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A style file without ink, fog and shade."""
    path = tmp_path_factory.mktemp("styles") / "bare.toml"
    path.write_text(STYLE, encoding="utf-8")
    return str(path)


@pytest.fixture(scope="module")
def model() -> Callable[[str], Loaded]:
    """Models by name, read once."""
    known: dict[str, Loaded] = {}

    def one(name: str) -> Loaded:
        if name not in known:
            known[name] = load(str(SAMPLES / name), InputOptions(water=None))[0]
        return known[name]

    return one


@pytest.mark.parametrize("eye", VIEWS)
@pytest.mark.parametrize(
    ("name", "scheme"),
    [("1hpv.pdb.gz", "chain"), ("1a1f.pdb", "chain"), ("1hpv.pdb.gz", "element"), ("caffeine.xyz", "element")],
)
def test_regions_are_the_unions_of_what_is_seen(
    name: str, scheme: str, eye: str, style: str, model: Callable[[str], Loaded]
) -> None:
    assert pixels_asked_and_wrong(model(name), VIEWS[eye], ".svg", style, scheme)[1] == 0


@needs_ghostscript
@pytest.mark.parametrize("suffix", [".ps", ".pdf"])
@pytest.mark.parametrize("eye", VIEWS)
def test_other_formats_have_the_same_regions(suffix: str, eye: str, style: str, model: Callable[[str], Loaded]) -> None:
    assert pixels_asked_and_wrong(model("1a1f.pdb"), VIEWS[eye], suffix, style, "chain")[1] == 0


@needs_ghostscript
@pytest.mark.parametrize("suffix", [".svg", ".eps", ".pdf"])
def test_no_style_touches_a_mask(suffix: str, model: Callable[[str], Loaded]) -> None:
    """Ink, fog, shade, light, gradients and merged regions are all off where colours are names."""
    masks = set()
    for name in ("flat", "goodsell", "cel", "shaded", "print", "hatch", "line"):
        look = DrawOptions(load_palette("clay"), load_style(name), "index", parts="merged", outline=0.0, crease=0.0)
        masks.add(drawing_of(model("caffeine.xyz"), DrawRequest(look), VIEWS["turned"]).to(suffix))
    assert len(masks) == 1
