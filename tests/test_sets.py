"""Sets of pictures: how many files and pages, framed and coloured alike, shown in turn, and as two eyes see them."""

import gzip
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from click.testing import CliRunner, Result

import molviz
from molviz.cli import main
from molviz.errors import InputError
from molviz.pipeline.sets import EYE_TURN, DrawingSet
from molviz.write import MANY

from .render import needs_chromium, needs_ghostscript, render_ps, render_svg, seen_by_chromium

SAMPLES = Path(__file__).parent.parent / "samples"
CAFFEINE, C60 = str(SAMPLES / "caffeine.xyz"), str(SAMPLES / "c60.xyz")
FIBRIL = str(SAMPLES / "2beg.cif.gz")
SVG = "{http://www.w3.org/2000/svg}"
BALLS = {"fill": "flat", "style": "flat"}


def run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words))


def drawn(x: Any, **options: Any) -> DrawingSet:
    result = molviz.draw(x, **options)
    assert isinstance(result, DrawingSet)
    return result


def files(drawings: DrawingSet, folder: Path, suffix: str = ".svg") -> list[bytes]:
    drawings.save(folder / f"it-{{n}}{suffix}")
    return [path.read_bytes() for path in sorted(folder.glob(f"it-*{suffix}"))]


def page_of(svg: bytes) -> str:
    return ElementTree.fromstring(svg).attrib["viewBox"]


def largest_arc(svg: bytes) -> float:
    """The largest half axis of any arc: of equal balls in a parallel view, the radius of each on the page."""
    return max(float(radius) for radius in re.findall(rb"[aA](\d+\.?\d*)[ ,-]", svg))


def pages_of_pdf(document: bytes) -> list[bytes]:
    return re.findall(rb"/Type /Page\b.*?/MediaBox (\[.*?\])", document, re.S)


@pytest.fixture
def walk(tmp_path: Path) -> str:
    """A trajectory in which one of two balls moves away."""
    path = tmp_path / "walk.xyz"
    path.write_text("".join(f"2\nframe\nC 0 0 0\nO {x} 0 0\n" for x in (1.2, 2.0, 6.0)), encoding="utf-8")
    return str(path)


# ---- files and pages

FEW = [(".eps", "--turntable 3"), (".hpgl", "--model all"), (".json", "--frame 1-1")]


def test_numbered_files_have_leading_zeros_and_one_page(tmp_path: Path) -> None:
    result = run("draw", CAFFEINE, "--turntable", "12", "-o", str(tmp_path / "{stem}-{n}.svg"))
    assert result.exit_code == 0 and "12 pictures" in result.output
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"caffeine-{k:02d}.svg" for k in range(1, 13)]
    contents = [path.read_bytes() for path in tmp_path.iterdir()]
    assert len(set(map(page_of, contents))) == 1 and len(set(contents)) == 12


@pytest.mark.parametrize("suffix", MANY)
def test_one_file_holds_all_and_is_the_same_from_python(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"x{suffix}"
    assert run("draw", CAFFEINE, "--turntable", "3", "-o", str(path)).exit_code == 0
    drawings = drawn(CAFFEINE, turntable=3)
    data = drawings.to(suffix)
    drawings.save(tmp_path / f"y{suffix.upper()}")
    assert data == (tmp_path / f"y{suffix.upper()}").read_bytes()
    if suffix not in (".svg", ".svgz"):  # these name the command in their metadata
        return
    content, other = (gzip.decompress(one) if suffix == ".svgz" else one for one in (data, path.read_bytes()))
    assert re.sub(rb"<metadata>.*?</metadata>", b"", other, flags=re.S) == content


def test_a_pdf_has_equal_pages_and_each_layer_once() -> None:
    drawings = drawn(CAFFEINE, turntable=4, title="T")
    document = drawings.to("pdf")
    assert len(set(pages_of_pdf(document))) == 1 and len(pages_of_pdf(document)) == 4
    names = re.findall(rb"/OCG /Name \((.*?)\)", document) or re.findall(rb"/Name \((.*?)\)", document)
    assert names and len(names) == len(set(names))
    assert document.count(b"/FontFile2") == 1


def test_postscript_pages_are_numbered_and_share_their_prolog() -> None:
    document = drawn(CAFFEINE, turntable=4).to("ps").decode()
    assert re.findall(r"^%%Page: (\d+) \1$", document, re.M) == ["1", "2", "3", "4"]
    assert "%%Pages: 4\n" in document and document.count("%%BeginProlog") == 1 and document.count("\nshowpage") == 4


@needs_ghostscript
def test_the_first_page_is_the_first_picture(tmp_path: Path) -> None:
    drawings = drawn(CAFFEINE, turntable=3, style="flat")
    alone = render_ps(files(drawings, tmp_path, ".ps")[0], 72)
    assert np.array_equal(render_ps(drawings.to("ps"), 72), alone)
    assert not np.array_equal(render_ps(files(drawings, tmp_path, ".ps")[1], 72), alone)


@pytest.mark.parametrize(("suffix", "words"), FEW)
def test_formats_of_one_picture_need_a_number_in_the_name(suffix: str, words: str, tmp_path: Path) -> None:
    refused = run("draw", CAFFEINE, *words.split(), "-o", str(tmp_path / f"x{suffix}"))
    assert refused.exit_code == 2 and "{n}" in refused.output and not list(tmp_path.iterdir())
    assert run("draw", CAFFEINE, *words.split(), "-o", str(tmp_path / f"{{n}}{suffix}")).exit_code == 0
    assert (tmp_path / f"1{suffix}").exists()


def test_what_no_set_can_be_is_refused(walk: str) -> None:
    for options, word in [
        ({"turntable": 0}, "turntable"), ({"turntable": 2.5}, "turntable"), ({"stereo": "red"}, "stereo"),
        ({"turntable": 3, "model": "all"}, "single model"), ({"model": "2-9"}, "2-9"), ({"model": "3-2"}, "3-2"),
    ]:  # fmt: skip
        with pytest.raises(InputError, match=word):
            molviz.draw(walk, **options)
    with pytest.raises(InputError, match="{n}"):
        drawn(walk, model="all").to("eps")
    with pytest.raises(InputError, match="two maps"):
        drawn(CAFFEINE, stereo="wall").to("json")
    with pytest.raises(InputError, match="from 1"):
        molviz.measure(walk, model="1-2")
    assert run("hidden-lines", "--random", "10", "--turntable", "3", "-o", "x.svg").exit_code == 2


def test_files_of_models_have_their_numbers(walk: str, tmp_path: Path) -> None:
    assert run("draw", walk, "--frame", "2-3", "-o", str(tmp_path / "f{n}.pdf")).exit_code == 0
    assert sorted(path.name for path in tmp_path.glob("*.pdf")) == ["f2.pdf", "f3.pdf"]
    assert drawn(walk, model="2-3").numbers == (2, 3) and len(drawn(walk, model="all")) == 3
    said = repr(drawn(walk, model="all"))
    assert re.fullmatch(r"<DrawingSet of '.*': 3 pictures, 2 atoms drawn, \d+ arcs>", said)


# ---- alike


@pytest.mark.parametrize("options", [{}, {"page": "a4"}, {"width": 300}, {"legend": True, "label": "element C"}])
def test_balls_have_one_size_in_all_views(options: dict[str, Any], tmp_path: Path) -> None:
    svgs = files(drawn(C60, turntable=5, rotate="x,20", **BALLS, **options), tmp_path)
    sizes = [largest_arc(svg) for svg in svgs]
    assert len(set(map(page_of, svgs))) == 1 and max(sizes) - min(sizes) <= 0.011


def test_a_ball_that_stays_has_its_place_in_all_frames(walk: str, tmp_path: Path) -> None:
    svgs = files(drawn(walk, model="all", orient="file", fill="flat", style="flat", outline=0), tmp_path)
    assert len(set(map(page_of, svgs))) == 1
    images = [render_svg(svg, 400) for svg in svgs]
    carbon = images[0][images[0][:, :, 3] > 0][0]
    left = [int(np.flatnonzero((image[:, :, 3] > 0).any(axis=0))[0]) for image in images]
    assert carbon[3] and len(set(left)) == 1
    widths = [int((image[:, :, 3] > 0).any(axis=0).sum()) for image in images]
    assert widths == sorted(widths) and widths[0] < widths[2]


def test_a_value_has_one_colour_in_all_frames() -> None:
    options = {"select": "chain A", "color_by": "exposure"}
    drawings = drawn(FIBRIL, model="1-3", **options)
    bounds = {drawing.subject.bounds for views in drawings._views for drawing in views}
    single = [molviz.draw(FIBRIL, model=k, **options) for k in (1, 2, 3)]
    own = [one.subject.bounds for one in single if not isinstance(one, DrawingSet)]
    assert bounds == {(min(low for low, _ in own), max(high for _, high in own))} and len(set(own)) > 1


def test_chains_keep_their_tints_and_depths_their_fog() -> None:
    drawings = drawn(str(SAMPLES / "1tii.pdb.gz"), turntable=3, water=True)
    shared = [drawing.subject.alike for views in drawings._views for drawing in views]
    assert shared[0] == shared[1] == shared[2]
    own = [drawing.alike() for views in drawings._views for drawing in views]
    assert all(one.tint == shared[0].tint for one in own) and any((shared[0].tint or {}).values())
    assert shared[0].depth and shared[0].depth[0] == (
        min(one.depth[0][0] for one in own if one.depth), max(one.depth[0][1] for one in own if one.depth)
    )  # fmt: skip


def test_a_whole_turn_ends_where_it_began() -> None:
    views = [drawing._view.rotation for views in drawn(CAFFEINE, turntable=4)._views for drawing in views]
    assert np.allclose(views[0] @ views[1].T, views[1] @ views[2].T)
    assert np.allclose(views[0] @ views[3].T @ (views[0] @ views[1].T), np.eye(3))
    assert all(np.allclose(one[1], views[0][1]) for one in views), "the page's y axis stays"


# ---- one animated SVG


def test_an_animated_svg_has_unique_ids_and_a_frame_for_each_picture() -> None:
    drawings = drawn(CAFFEINE, turntable=6, parts="atoms")
    root = ElementTree.fromstring(drawings.svg())
    ids = [element.attrib["id"] for element in root.iter() if "id" in element.attrib]
    assert len(ids) == len(set(ids)) and drawings._repr_svg_() == drawings.svg()
    referred = set(re.findall(r"(?:url\(|href=\")#([^\")]+)", drawings.svg()))
    assert referred <= set(ids)
    frames = [group for group in root.iter(f"{SVG}g") if group.attrib.get("class", "").endswith("-frame")]
    delays = [int(re.findall(r"animation-delay:(-\d+)ms", frame.attrib["style"])[0]) for frame in frames]
    assert delays == [-3000 + 500 * k for k in range(6)]
    assert [frame.attrib.get("visibility") for frame in frames] == [None, *["hidden"] * 5]
    assert len(root.findall(f"{SVG}title")) == 1


def test_what_may_not_move_shows_the_first_picture(tmp_path: Path) -> None:
    drawings = drawn(CAFFEINE, turntable=3, style="flat")
    svg = drawings.to("svg")
    rules = "".join(element.text or "" for element in ElementTree.fromstring(svg).iter(f"{SVG}style"))
    moving = rules[rules.index("@media") :]
    assert moving.startswith("@media (prefers-reduced-motion:no-preference){") and rules.count("animation:") == 1
    assert np.array_equal(render_svg(svg, 300), render_svg(files(drawings, tmp_path)[0], 300))


@needs_chromium
@pytest.mark.parametrize("row", [0, 2])
def test_a_browser_shows_each_picture_at_its_time(row: int, tmp_path: Path) -> None:
    drawings = drawn(CAFFEINE, turntable=3, style="flat", background="white")
    svg = drawings.svg()
    later = re.sub(r"animation-delay:(-?\d+)", lambda one: f"animation-delay:{int(one[1]) - 1000 * row - 500}", svg)
    still = later.replace("step-end infinite}", "step-end infinite paused}")
    assert still != later != svg
    alone = files(drawings, tmp_path)[row]
    size = (400, round(400 * float(page_of(alone).split()[3]) / float(page_of(alone).split()[2])))
    seen, expected = (seen_by_chromium(one, *size).astype(int) for one in (still.encode(), alone))
    assert np.abs(seen - expected).mean() < 0.5
    other = seen_by_chromium(files(drawings, tmp_path)[(row + 1) % 3], *size).astype(int)
    assert np.abs(seen - other).mean() > 2


# ---- stereo


def centers_of(svg: bytes) -> dict[str, list[float]]:
    """The middle in pixels of the one region of each colour, in the left and in the right half of the page."""
    image = render_svg(svg, 1200)
    half = image.shape[1] // 2
    colors = {"C": (0xB4, 0xB8, 0xBA), "O": (0xE5, 0x6B, 0x5D)}
    halves = (image[:, :half], image[:, half:])
    return {name: [middle_of(part, color) for part in halves] for name, color in colors.items()}


def middle_of(image: np.ndarray, color: tuple[int, int, int]) -> float:
    distance = np.abs(image[:, :, :3].astype(int) - color).sum(axis=2) + 1000 * (image[:, :, 3] == 0)
    return float(np.flatnonzero((distance < 60).any(axis=0)).mean())


@pytest.fixture
def near_and_far(tmp_path: Path) -> str:
    """A carbon far away and, beside it, an oxygen 10 Å nearer to the eye."""
    path = tmp_path / "deep.xyz"
    path.write_text("2\ndeep\nC -3 0 -5\nO 3 0 5\n", encoding="utf-8")
    return str(path)


@pytest.mark.parametrize(("stereo", "sign"), [("wall", 1), ("cross", -1)])
def test_near_things_lie_farther_to_the_right_for_the_left_eye(stereo: str, sign: int, near_and_far: str) -> None:
    drawings = drawn(near_and_far, stereo=stereo, orient="file", width=100, **BALLS, outline=0, crease=0)
    assert len(drawings) == 1
    middles = centers_of(drawings.to("svg"))
    disparity = (middles["O"][0] - middles["O"][1]) - (middles["C"][0] - middles["C"][1])
    points = float(page_of(drawings.to("svg")).split()[2])
    subject = drawings._views[0][0].subject
    expected = 10 * 2 * np.sin(np.radians(EYE_TURN)) * (100 / float(subject.high[0] - subject.low[0])) * 1200 / points
    assert disparity == pytest.approx(sign * expected, abs=3) and expected > 10


def test_cross_exchanges_the_views_of_wall(near_and_far: str) -> None:
    wall, cross = (drawn(near_and_far, stereo=stereo)._views[0] for stereo in ("wall", "cross"))
    assert np.array_equal(wall[0]._view.rotation, cross[1]._view.rotation)
    assert np.array_equal(wall[1]._view.rotation, cross[0]._view.rotation)


@pytest.mark.parametrize("method", ["visible", "painter"])
@pytest.mark.parametrize("style", ["cel", "shaded", "goodsell"])
def test_both_halves_are_on_one_page_in_every_style(method: str, style: str) -> None:
    drawings = drawn(CAFFEINE, stereo="wall", turntable=2, style=style, method=method, legend=True, title="T")
    assert len(drawings) == 2 and len(pages_of_pdf(drawings.to("pdf"))) == 2
    root = ElementTree.fromstring(drawings.svg())
    ids = [element.attrib["id"] for element in root.iter() if "id" in element.attrib]
    assert len(ids) == len(set(ids)) and [text.text for text in root.iter(f"{SVG}text")].count("T") == 4


def test_a_pair_shares_the_width_of_a_sheet() -> None:
    sheet = drawn(CAFFEINE, stereo="wall", page="a4").svg()
    assert page_of(sheet.encode()) == page_of(str(molviz.draw(CAFFEINE, page="a4").svg()).encode())
