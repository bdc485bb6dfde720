"""Franklin's generator by hand, and the shapes of scenes."""

import math

import numpy as np
import pytest

from molviz.errors import InputError
from molviz.model.glyphs import dots
from molviz.model.scenes import LAYERS, PERIOD, random_scene, text_scene


def test_the_cubic_generator_in_whole_numbers() -> None:
    scene = random_scene(300, radius=0.1)
    for k in (1, 2, 300):
        x = (5281 + 13513 * k + 22343 * k**2 + 16823 * k**3) % 32003 / 32003
        assert scene.center[k - 1, 0] == pytest.approx(0.1 + 0.8 * x, abs=1e-15)


@pytest.mark.parametrize("options", [{}, {"seed": 4}, {"depth": 3}, {"radius": 0.02}, {"shrink": True}])
def test_discs_lie_within_the_unit_square(options: dict) -> None:
    scene = random_scene(1000, **options)
    low, high = scene.center[:, :2] - scene.radius[:, None], scene.center[:, :2] + scene.radius[:, None]
    assert low.min() >= -1e-15 and high.max() <= 1 + 1e-15


@pytest.mark.parametrize("shrink", [False, True])
def test_depth_is_the_average_number_of_discs_over_a_point(shrink: bool) -> None:
    scene = random_scene(5000, depth=7, shrink=shrink)
    assert math.pi * np.sum(scene.radius**2) == pytest.approx(7)


def test_perspective_of_his_table_3() -> None:
    """N = 1000 and R1 = 0.135 give D = 10.25."""
    scene = random_scene(1000, radius=0.135, shrink=True)
    assert math.pi * np.sum(scene.radius**2) == pytest.approx(10.25, abs=0.05)
    assert np.all(np.diff(scene.radius[np.argsort(scene.center[:, 2], kind="stable")]) < 0)


def test_larger_scenes_do_not_repeat() -> None:
    scene = random_scene(PERIOD + 1000)
    assert len(np.unique(scene.center, axis=0)) == PERIOD + 1000


@pytest.mark.parametrize("options", [{"depth": 1, "radius": 0.1}, {"radius": 0.6}])
def test_scenes_that_cannot_be(options: dict) -> None:
    with pytest.raises(InputError):
        random_scene(10, **options)


def test_a_letter() -> None:
    column, row = dots("L")
    assert sorted(zip(column.tolist(), row.tolist(), strict=True)) == sorted(
        [(0, k) for k in range(7)] + [(k, 0) for k in range(1, 5)]
    )


@pytest.mark.parametrize("text", ["é", "A\n", "", "  "])
def test_text_without_letters(text: str) -> None:
    with pytest.raises(InputError):
        text_scene(text)


def test_spheres_of_a_layer_touch() -> None:
    scene = text_scene("CSE")
    front = scene.center[scene.center[:, 2] == 0, :2]
    gap = np.hypot(*(front[:, None] - front).transpose(2, 0, 1))
    assert len(scene.radius) == LAYERS * len(front)
    assert np.min(gap[gap > 0]) == 2 * scene.radius[0]  # exactly
