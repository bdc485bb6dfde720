"""A short fixed part of `make soak`: every kind of scene, each way of drawing."""

import warnings

import numpy as np
import pytest

from molviz.model.spheres import Spheres
from tests import soak

STEP = 13  # of the numbers of scenes, so that kinds and ways meet differently; prime to both


@pytest.mark.parametrize("number", range(0, STEP * len(soak.KINDS) * 3, STEP))
def test_a_scene(number: int) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", category=UserWarning)
        soak.soak(3, number)


@pytest.mark.parametrize("distance", [None, 9.0])
def test_wrong_pixels_are_counted(distance: float | None) -> None:
    """A mask in which two balls have changed places, and one in which a far ball shines through."""
    balls = Spheres(np.array([[-2.0, 0, 0], [2, 0, 0], [0, 0, -3]]), np.array([1.5, 1.5, 1.0]))
    draw = soak.zbuffer if distance is None else lambda *args: soak.central_zbuffer(*args, distance)
    low, pixel = np.array([-5.0, -5.0]), 0.1
    right = draw(balls, low, pixel, (100, 100))
    assert soak.wrong_pixels(right, balls, low, pixel, distance) == 0
    swapped = np.array([1, 0, 2, -1])[right]
    assert soak.wrong_pixels(swapped, balls, low, pixel, distance) > 500
    assert soak.wrong_pixels(np.where(right == 0, 2, right), balls, low, pixel, distance) > 300


def test_scenes_are_the_same_every_time() -> None:
    for number in range(len(soak.KINDS)):
        one, other = soak.scene(7, number), soak.scene(7, number)
        assert one[0] == other[0] == soak.KINDS[number].__name__ and (one[1] == other[1]).all()
        assert (one[2] == other[2]).all() and len(one[1]) == len(one[2]) > 0
