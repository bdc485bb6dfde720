"""Every format of one tiny picture: the same bytes as before, the same pixels as each other and as the mathematics."""

import gzip
import re
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

import numpy as np
import pytest

from molviz.picture.picture import Picture, StrokeLayer
from molviz.write import WRITERS
from tests.render import needs_ghostscript, render_ps, render_svg, write
from tests.write_pictures import COLORS, expected_colors, fills, picture, whole_picture

GOLDEN = Path(__file__).parent / "golden"
SVG = "{http://www.w3.org/2000/svg}"
ZOOM = 4


def flat(image: np.ndarray) -> np.ndarray:
    """Return an RGBA image on white as RGB."""
    return np.where(image[..., 3:] > 0, image[..., :3], 255).astype(np.uint8)


def pixels(page: Picture, suffix: str) -> np.ndarray:
    data = write(page, suffix)
    return flat(render_svg(data, ZOOM * 170)) if suffix == ".svg" else render_ps(data, 72 * ZOOM)


def centres(box: tuple[float, float, float, float]) -> np.ndarray:
    """Return the page points (h, w, 2) under the centres of the pixels."""
    x = np.arange(box[0] + 0.5 / ZOOM, box[2], 1 / ZOOM)
    y = np.arange(box[3] - 0.5 / ZOOM, box[1], -1 / ZOOM)
    return np.stack(np.meshgrid(x, y), axis=-1)


@pytest.mark.parametrize("suffix", [".svg", ".ps", ".eps", ".pdf"])
def test_the_bytes_are_the_golden_ones(suffix: str) -> None:
    assert plain(write(whole_picture(), suffix)) == plain((GOLDEN / f"tiny{suffix}").read_bytes())


def plain(data: bytes) -> bytes:
    """A PDF's page inflated, as how it is packed differs from one zlib to the next; other formats as they are."""
    page = re.search(rb"stream\n(.*?)\nendstream", data, re.DOTALL) if data.startswith(b"%PDF") else None
    return zlib.decompress(page[1]) if page else data


def test_svgz_is_the_svg_without_a_date() -> None:
    data = write(whole_picture(), ".svgz")
    assert gzip.decompress(data) == write(whole_picture(), ".svg") and data[4:8] == bytes(4)


@pytest.mark.parametrize(
    "suffix", [".svg", *(pytest.param(suffix, marks=needs_ghostscript) for suffix in (".ps", ".eps", ".pdf"))]
)
def test_pixels_have_the_colour_of_the_shape_under_their_centre(suffix: str) -> None:
    page = picture(fills())
    image = pixels(page, suffix)
    want = expected_colors(centres(page.box if suffix == ".eps" else (0, 0, 170, 100)))
    assert image.shape == want.shape
    padded = np.pad(want, ((1, 1), (1, 1), (0, 0)), mode="edge")
    rows, columns = want.shape[:2]
    around = [padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)]
    near_edge = np.any([(part != want).any(axis=2) for part in around], axis=0)
    assert not ((image != want).any(axis=2) & ~near_edge).any()
    assert set(map(tuple, image.reshape(-1, 3).tolist())) == {*COLORS, (255, 255, 255)}


@needs_ghostscript
@pytest.mark.parametrize("suffix", [".ps", ".pdf"])
@pytest.mark.parametrize("spread", [0.0, 2.0])
def test_formats_paint_the_same(suffix: str, spread: float) -> None:
    page = picture(fills(spread), StrokeLayer("lines", fills().paths, 1.0, (0, 90, 200)))
    differ = (pixels(page, ".svg") != pixels(page, suffix)).any(axis=2)
    eroded = differ[1:-1, 1:-1] & differ[:-2, 1:-1] & differ[2:, 1:-1] & differ[1:-1, :-2] & differ[1:-1, 2:]
    assert not eroded.any()
    assert differ.mean() < 0.02


def test_without_background_the_page_is_transparent_and_with_one_it_is_not() -> None:
    assert (render_svg(write(picture(fills()), ".svg"), 170)[0, 0] == 0).all()
    page = Picture(170, 100, (0, 0, 170, 100), [], background=(1, 2, 3))
    assert (render_svg(write(page, ".svg"), 170) == [1, 2, 3, 255]).all()


@needs_ghostscript
@pytest.mark.parametrize("suffix", [".ps", ".eps", ".pdf"])
def test_a_background_covers_the_page(suffix: str) -> None:
    page = Picture(170, 100, (50, 50, 60, 60), [], background=(1, 2, 3))
    image = render_ps(write(page, suffix), 72)
    assert image.shape == (100, 170, 3) and (image == [1, 2, 3]).all()


def test_names_from_files_are_escaped_unique_and_kept() -> None:
    root = ElementTree.fromstring(write(whole_picture(), ".svg"))
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert len(ids) == len(set(ids)) == 8
    shapes = root.findall(f".//{SVG}path[{SVG}title]")
    assert [shape.findtext(f"{SVG}title") for shape in shapes] == [f"CYS 32 {k}<&>\"' ]]>\ufffd é" for k in range(4)]
    assert {shape.get("class") for shape in shapes} == {"atom C"}
    assert root.find(f"{SVG}g/{SVG}g[@class='chain']/{SVG}g[@class='residue']") is not None


@pytest.mark.parametrize("suffix", [".ps", ".eps"])
def test_postscript_is_clean_ascii_in_short_lines_with_its_comments(suffix: str) -> None:
    lines = write(whole_picture(), suffix).decode("ascii").splitlines()
    assert max(map(len, lines)) <= 255
    assert lines[0].startswith("%!PS-Adobe-3.0") and lines[0].endswith("EPSF-3.0") == (suffix == ".eps")
    assert "%%BoundingBox: 19 9 152 81" in lines and "%%HiResBoundingBox: 19.500 9.500 152.000 80.500" in lines
    assert lines[-1] == "%%EOF" and not any("setpagedevice" in line for line in lines if suffix == ".eps")


@pytest.mark.parametrize("suffix", sorted(WRITERS))
def test_an_empty_picture_can_be_written_twice_alike(suffix: str) -> None:
    page = Picture(10, 10, (0, 0, 0, 0), [])
    assert write(page, suffix) == write(page, suffix) != b""
