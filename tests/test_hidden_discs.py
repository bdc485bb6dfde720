"""``hidden-lines`` from scene to file."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from molviz.cli import main
from molviz.errors import InputError
from molviz.picture.disc_picture import FAR, NEAR, WIDTH, DiscLook
from molviz.picture.page import Page
from molviz.pipeline.hidden_discs import LABELS, hide_discs, picture_of, random_discs, statistics_table
from tests.disc_scenes import scene_of
from tests.render import needs_ghostscript, render_ps, render_svg

NAMES = [
    "n", "radius", "depth", "grid", "cell_entries", "cells_blocked", "pairs_tested", "pairs_intersecting",
    "visible_whole", "visible_in_arcs", "hidden", "arcs", "length_circumferences", "seconds",
]  # fmt: skip


def run(*arguments: str) -> Result:
    return CliRunner().invoke(main, ["hidden-lines", *arguments])


def test_statistics_add_up() -> None:
    answer = json.loads(run("--random", "3000", "--json").stdout)
    pieces = {int(k): count for k, count in answer["visible_in_arcs"].items()}
    assert list(answer) == NAMES == list(LABELS)
    assert answer["visible_whole"] + sum(pieces.values()) + answer["hidden"] == answer["n"] == 3000
    assert answer["visible_whole"] + sum(k * count for k, count in pieces.items()) == answer["arcs"]
    assert answer["depth"] == pytest.approx(math.pi * 3000 * answer["radius"] ** 2) == pytest.approx(10)


def test_statistics_of_three_discs() -> None:
    """One whole, one with a sixth of its perimeter behind the first's edge on either side hidden, one hidden."""
    scene = hide_discs(scene_of([(0, 0, 0, 1), (1, 0, 1, 1), (0.2, 0, 2, 0.5)]))
    told = scene.statistics()
    assert (told["n"], told["radius"], told["arcs"], scene.visible()) == (3, 1.0, 2, 2)
    assert (told["visible_whole"], told["visible_in_arcs"], told["hidden"]) == (1, {"1": 1}, 1)
    assert told["length_circumferences"] == pytest.approx(1 + 2 / 3)
    assert told["pairs_intersecting"] <= told["pairs_tested"] and 0 <= told["seconds"] < 10
    lines = statistics_table(told).splitlines()
    assert len({line.index(" = ") for line in lines}) == 1 and min(len(x) - len(x.lstrip()) for x in lines) == 2
    for row in ("Total length of all visible arcs (circles) = 1.66667", "Partially visible with K arcs = 1: 1",
                "Completely visible = 1", "Completely hidden = 1", "Max radius = 1"):  # fmt: skip
        assert row in [line.strip() for line in lines]


def test_nothing_is_no_scene() -> None:
    with pytest.raises(InputError, match="no spheres"):
        hide_discs(scene_of([]))


def test_discs_of_a_molecule_are_drawn_in_parallel_projection_only(tmp_path: Path) -> None:
    words = [str(Path(__file__).parent.parent / "samples" / "caffeine.xyz"), "--as", "discs"]
    words += ["-o", str(tmp_path / "x.json")]
    refused = run(*words, "--perspective", "50")
    assert refused.exit_code == 1 and "expected no --perspective" in refused.stderr
    done = run(*words)
    assert done.exit_code == 0, done.output
    answer = json.loads((tmp_path / "x.json").read_text())
    seen = len({arc[0] for arc in answer["arcs"]})
    assert len(answer["circles"]) == 24 and f"24 spheres, {seen} with visible lines" in done.stderr


def test_a_picture_of_discs_is_a_box_around_them_from_light_to_dark() -> None:
    """4 wide and 3 high; the front disc light, the rear one dark, the line half outside."""
    scene = hide_discs(scene_of([(1, 1, 0, 1), (3, 2, 1, 1), (3.2, 2.2, 2, 0.5)]))
    picture = picture_of(scene, DiscLook(outline=2.0, background=(1, 2, 3)), fill=True)
    fills, lines = picture.layers
    assert [layer.name for layer in picture.layers] == ["visible regions", "visible arcs"]
    assert [mark.id for mark in fills.mark] == ["f0", "f1"] and [mark.id for mark in lines.mark] == ["s0", "s1"]
    assert list(fills.paint) == [NEAR, tuple(round((a + b) / 2) for a, b in zip(NEAR, FAR, strict=True))]
    x0, y0, x1, y1 = picture.box
    assert (x1 - x0, y1 - y0) == pytest.approx((WIDTH + 2, 0.75 * WIDTH + 2))
    assert (x0 + x1, y0 + y1) == pytest.approx((picture.width, picture.height))
    assert (lines.width, lines.color, picture.background) == (2.0, (0, 0, 0), (1, 2, 3))
    assert (picture.title, picture.description) == ("", "")
    assert lines.paths.shape_start.tolist() == [0, 1, 2] and lines.paths.loop_start.tolist() == [0, 1, 2]
    assert np.allclose(np.diff(lines.paths.arcs.c, axis=0), [[WIDTH / 2, WIDTH / 4]])
    assert [layer.name for layer in picture_of(scene, DiscLook(outline=0.0)).layers] == []


def test_without_an_output_the_table_is_printed() -> None:
    result = run("--random", "200", "--radius", "0.05", "--grid", "30")
    assert result.exit_code == 0
    assert [line.split(" = ")[0].strip() for line in result.stdout.splitlines()] == list(LABELS.values())
    assert "Grid resolution = 30" in result.stdout


def test_json_is_the_whole_answer(tmp_path: Path) -> None:
    assert run("--random", "300", "--seed", "2", "-o", str(tmp_path / "x.json")).exit_code == 0
    answer = json.loads((tmp_path / "x.json").read_text())
    circles = np.array(answer["circles"])
    assert np.array_equal(circles[:, :3], random_discs(
        300, depth=None, radius=None, seed=2, shrink=False, across=None).spheres.center)  # fmt: skip
    arcs = hide_discs(scene_of(circles.tolist())).arcs
    assert np.allclose(np.array(answer["arcs"]), np.column_stack([arcs.circle, arcs.start, arcs.sweep]), atol=1e-9)
    assert answer["statistics"]["arcs"] == len(answer["arcs"])


@pytest.mark.parametrize("suffix", [".svg", ".ps", ".eps", ".pdf", ".hpgl", ".json"])
def test_the_same_input_gives_the_same_bytes(tmp_path: Path, suffix: str) -> None:
    names = [tmp_path / f"{k}{suffix}" for k in "ab"]
    for name in names:
        result = run("--text", "CSE", "--fill", "-o", str(name))
        assert result.exit_code == 0 and "1840 spheres" in result.stderr
    assert names[0].read_bytes() == names[1].read_bytes()


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ([], 2, "--random"),
        (["--random", "5", "--text", "A"], 2, "--random"),
        (["--random", "0"], 2, "0 is not in the range"),
        (["--random", "5", "--radius", "0.7"], 1, "expected at most 0.5"),
        (["--random", "50", "--radius", "0.1", "--depth", "2"], 1, "expected one of them"),
        (["--text", "*", "-o", "x.svg"], 1, "expected A to Z"),
        (["--text", "A", "-o", "x.tiff"], 2, "expected one of .svg"),
        (["--text", "A", "-o", "/dev/null/x.svg"], 1, "/dev/null/x.svg"),
        (["--text", "A", "-o", "x.hpgl", "--plotter", "none"], 1, "expected one of hp7440a"),
    ],
)
def test_what_cannot_be_done_is_said(arguments: list[str], code: int, words: str) -> None:
    result = run(*arguments)
    assert result.exit_code == code and words in result.stderr
    assert code == 2 or result.stderr.startswith("molviz: ")


def test_regions_are_painted_in_front_of_what_they_hide() -> None:
    """Fills without lines, as pixels, against the foremost disc at each pixel's centre."""
    from tests.render import write

    scene = random_discs(60, depth=3, radius=None, seed=1, shrink=False, across=None)
    look = DiscLook(Page(width=300, margin=0), outline=0)
    picture = picture_of(scene, look, fill=True)
    pixels = render_svg(write(picture, ".svg"), 300)
    order = np.argsort(scene.spheres.center[:, 2])
    low = (scene.spheres.center[:, :2] - scene.spheres.radius[:, None]).min(axis=0)
    high = (scene.spheres.center[:, :2] + scene.spheres.radius[:, None]).max(axis=0)
    unit = (high[0] - low[0]) / 300
    height = len(pixels)
    x, y = np.meshgrid(low[0] + (np.arange(300) + 0.5) * unit, high[1] - (np.arange(height) + 0.5) * unit)
    layer = picture.layers[0]
    shades = {int(mark.id[1:]): color for mark, color in zip(layer.mark, layer.paint, strict=True)}
    wanted = np.zeros((height, 300, 4))
    for disc in order[::-1]:
        cx, cy, _ = scene.spheres.center[disc]
        inside = np.hypot(x - cx, y - cy) < scene.spheres.radius[disc]
        wanted[inside] = (*shades.get(int(disc), (0, 0, 0)), 255)
    assert np.mean(np.any(pixels != wanted, axis=2)) < 0.03  # along the edges, which are spread by 0.125 points


@needs_ghostscript
def test_postscript_draws_the_visible_arcs() -> None:
    from tests.render import write

    scene = hide_discs(scene_of([(0.0, 0.0, 0.0, 1.0), (1.0, 0.0, 1.0, 1.0)]))
    picture = picture_of(scene, DiscLook(Page(width=300, margin=10), outline=2))
    dark = render_ps(write(picture, ".ps"), 72).sum(axis=2) < 384
    arcs = picture.layers[0].paths.arcs
    row = np.repeat(np.arange(2), 400)
    points = arcs.take(row).at(arcs.start[row] + arcs.sweep[row] * np.tile(np.linspace(0, 1, 400), 2))
    down, across = np.nonzero(dark)
    pixels = np.column_stack([across + 0.5, len(dark) - down - 0.5])
    gap = np.hypot(*(pixels[:, None] - points).transpose(2, 0, 1))
    assert gap.min(axis=1).max() < 2.5 and gap.min(axis=0).max() < 1.0
