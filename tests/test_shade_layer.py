"""Steps of shade: every pixel has the colour that the definition gives it, with and without translucency."""

import re

import numpy as np
import pytest

from molviz.write.postscript_shade import LINES, procedures, sets_of_steps
from tests.render import needs_ghostscript, render_ps, seen_by_resvg, write
from tests.shaded_pictures import HEIGHT, SHADES, STEPS, TONE_COLORS, WIDTH, page, regions, shade
from tests.write_pictures import inside_ellipse

ZOOM = 2


def inside(shape: list[list[tuple]], points: np.ndarray) -> np.ndarray:
    return np.logical_or.reduce([inside_ellipse(points, *loop[0][:3]) for loop in shape])


def covered(layer: object, shape: int, points: np.ndarray) -> np.ndarray:
    """Which points (h, w) one of the discs of a step covers."""
    paths = layer.steps
    rows = range(paths.shape_start[shape], paths.shape_start[shape + 1])
    return inside([[(paths.arcs.c[k], paths.arcs.u[k], paths.arcs.v[k])] for k in rows], points)


def expected() -> np.ndarray:
    """Return the colours (h, w, 3) by compositing step after step, as the layer says."""
    x = (np.arange(WIDTH * ZOOM) + 0.5) / ZOOM
    y = HEIGHT - (np.arange(HEIGHT * ZOOM) + 0.5) / ZOOM
    points = np.stack(np.meshgrid(x, y), axis=-1)
    disc = inside_ellipse(points, (150, 100), (90, 0), (0, 90))
    left = (points - (150, 100)) @ [-np.sin(0.3), np.cos(0.3)] > 0
    hole = inside_ellipse(points, (100, 120), (30, 0), (0, 30))
    tones = [disc & left & ~hole, hole, disc & ~left, inside_ellipse(points, (270, 40), (25, 0), (0, 25))]
    layer, color = shade(), np.full((*points.shape[:2], 3), 255.0)
    for tone, value, clip in zip(tones, TONE_COLORS, layer.tone_clip, strict=True):
        color[tone] = value
        for step, opacity in enumerate(STEPS):
            where = tone & covered(layer, step, points)
            color[where] += opacity * (np.array(SHADES[clip]) - color[where])
    return color


def near_edges(image: np.ndarray) -> np.ndarray:
    padded = np.pad(image, ((1, 1), (1, 1), (0, 0)), mode="edge")
    rows, columns = image.shape[:2]
    around = [padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)]
    return np.any([(part != image).any(axis=2) for part in around], axis=0)


@pytest.mark.parametrize(
    "suffix", [".svg", *(pytest.param(suffix, marks=needs_ghostscript) for suffix in (".ps", ".eps", ".pdf"))]
)
def test_pixels_are_composited_step_after_step(suffix: str) -> None:
    data = write(page(regions(), shade()), suffix)
    size = round(WIDTH * ZOOM), round(HEIGHT * ZOOM)
    image = seen_by_resvg(data, *size) if suffix == ".svg" else render_ps(data, 72 * ZOOM)
    want = expected()
    far = ~near_edges(want)
    assert far.mean() > 0.8
    assert np.abs(image - want)[far].max() <= 3  # levels: viewers round after every step


def test_the_last_set_that_paints_a_point_is_that_of_all_its_steps() -> None:
    opacity = (0.1, 0.2, 0.3, 0.4)
    text = "\n".join(sets_of_steps(opacity, 0, 1.0))
    painted, now = [], []
    for line in text.split("\n"):
        clip = re.fullmatch(r"gsave P(\d) I (\S+) V", line)
        if clip:
            now.append(int(clip[1]))
            painted.append((frozenset(now), float(clip[2])))
        else:
            now.pop()
    assert len(painted) == 2 ** len(opacity) - 1
    for steps, share in painted:
        assert [mine for mine, _ in painted if mine <= steps][-1] == steps
        assert share == pytest.approx(1 - np.prod([1 - opacity[k] for k in steps]), abs=1e-4)


def test_long_paths_are_several_procedures() -> None:
    words = list(procedures("\n".join(f"{k} 0 m\n{k} 1 l h" for k in range(LINES))))
    assert words.count("{") == words.count("}") == 2 and len(words) == 2 * LINES + 4


def test_steps_are_written_once() -> None:
    svg = write(page(regions(), shade()), ".svg").decode()
    assert svg.count("<use") == svg.count("<clipPath") == len(SHADES)
    assert svg.count(' opacity="') == len(STEPS)
    postscript = write(page(regions(), shade()), ".ps").decode()
    assert len(re.findall(r"^/P\d\[$", postscript, re.M)) == len(STEPS) and "%%LanguageLevel: 2" in postscript
    assert max(map(len, postscript.splitlines())) <= 255
    assert write(page(regions(), shade()), ".pdf").count(b"/Subtype /Form") == 1
