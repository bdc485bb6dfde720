"""Colour mixing keeps what the eye keeps."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.picture.colors import css_colors, parse_color
from molviz.picture.oklab import colors_of, from_oklab, lighter, lightness, mix, shaded, to_oklab, turn_between, turned
from molviz.picture.picture import Color

BYTE = st.integers(0, 255)
COLORS = st.tuples(BYTE, BYTE, BYTE)
SHARES = st.floats(0, 1)
SOME = np.random.default_rng(7).integers(0, 256, (20000, 3))
GREYS = np.repeat(np.arange(256)[:, None], 3, axis=1)


def test_there_and_back_is_the_same_colour() -> None:
    corners = np.array(list(itertools.product((0, 1, 127, 128, 254, 255), repeat=3)))
    for colors in (SOME, corners, GREYS):
        assert np.array_equal(from_oklab(to_oklab(colors)), colors)


def test_values_that_others_found() -> None:
    """CSS Color Module Level 4 gives red and green in OKLab; D65 white is (1, 0, 0)."""
    assert np.allclose(to_oklab((255, 255, 255)), (1, 0, 0), atol=1e-6)
    assert np.allclose(to_oklab((255, 0, 0)), (0.62796, 0.22486, 0.12585), atol=1e-5)
    assert np.allclose(to_oklab((0, 128, 0)), (0.51975, -0.14030, 0.10768), atol=1e-5)
    assert np.allclose(lightness([(255, 255, 255), (0, 0, 0), (119, 119, 119)]), (100, 0, 50.03), atol=0.01)


@given(COLORS, COLORS, SHARES)
def test_mixing(one: Color, other: Color, share: float) -> None:
    assert tuple(mix(one, one, share)) == one
    assert tuple(mix(one, other, 0.0)) == one and tuple(mix(one, other, 1.0)) == other
    assert np.abs(mix(one, other, share) - mix(other, one, 1 - share)).max() <= 1
    rows = mix([one, other], other, np.array([share, share]))
    assert colors_of(rows) == [tuple(mix(one, other, share)), other]


@given(SHARES, st.integers(0, 255), st.integers(0, 255), st.floats(-100, 100), st.floats(-360, 360))
def test_greys_stay_grey(share: float, one: int, other: int, by: float, degrees: float) -> None:
    assert np.ptp(mix((one,) * 3, (other,) * 3, share)) == 0
    assert np.ptp(lighter((one,) * 3, by)) == 0
    assert tuple(turned((one,) * 3, degrees)) == (one,) * 3


def test_greys_mix_evenly() -> None:
    light = lightness(mix((0, 0, 0), (255, 255, 255), np.linspace(0, 1, 101)))
    assert (np.diff(light) >= 0).all()


@pytest.mark.parametrize("by", [-30.0, -22.0, -10.0, 8.0, 20.0])
def test_lightness_moves_as_far_as_asked(by: float) -> None:
    start = lightness(SOME)
    possible = (start + by > 3) & (start + by < 98)
    assert np.abs(lightness(lighter(SOME, by)) - start - by)[possible].max() < 1.0  # 8 bits of a channel are coarse


@given(COLORS)
def test_lightness_is_monotone_and_hue_stays(color: Color) -> None:
    steps = lighter([color] * 41, np.linspace(-100, 100, 41))
    assert (np.diff(lightness(steps)) > -1e-9).all()
    assert tuple(steps[20]) == color and tuple(steps[0]) == (0, 0, 0)
    assert np.abs(steps[40] - 255).max() <= 1
    before, after = to_oklab(color)[1:], to_oklab(lighter(color, -20.0))[1:]
    if np.hypot(*before) > 0.08 and lightness(color) > 50:
        assert before @ after / np.hypot(*before) / np.hypot(*after) > np.cos(np.radians(3))


def test_turning_keeps_lightness_and_comes_back() -> None:
    pastel = mix(SOME, (150, 150, 150), 0.85)
    assert np.abs(turned(turned(pastel, 25.0), -25.0) - pastel).max() <= 2
    assert np.abs(to_oklab(turned(pastel, 120.0))[:, 0] - to_oklab(pastel)[:, 0]).max() < 0.005
    before, after = to_oklab((200, 120, 120)), to_oklab(turned((200, 120, 120), 90.0))
    assert np.allclose(after, (before[0], -before[2], before[1]), atol=0.003)


def test_turns_are_measured() -> None:
    start = np.array([(200, 120, 120)] * 5)
    asked = np.array([-170.0, -20.0, 0.0, 20.0, 100.0])
    assert np.allclose(turn_between(start, turned(start, asked)), asked, atol=2.0)
    assert turn_between((90, 90, 90), (200, 30, 30)) == 0 == turn_between((200, 30, 30), (90, 90, 90))


@given(COLORS, COLORS, st.floats(0, 40))
def test_shaded_never_leaves_the_way_to_the_shade(color: Color, shade: Color, drop: float) -> None:
    whole = lightness(color) - lightness(shade)
    result = tuple(shaded(color, shade, drop))
    if whole <= 0 or drop == 0:
        assert result == color
    elif whole <= drop:
        assert result == shade


def test_names_of_css() -> None:
    assert len(css_colors()) == 148
    assert parse_color("RebeccaPurple") == parse_color("#663399") == parse_color("#639") == (102, 51, 153)
    assert parse_color("grey") == parse_color("gray") == (128, 128, 128)
    assert parse_color(" crimson ") == (220, 20, 60)


def test_names_are_those_of_another_authority() -> None:
    from PIL import ImageColor

    assert {name: parse_color(name) for name in css_colors()} == {
        name: ImageColor.getrgb(name) for name in ImageColor.colormap
    }


@pytest.mark.parametrize(
    ("text", "meant"),
    [("crimsom", "'crimson'"), ("Gray5", "'gray'"), ("ff8800", "'#ff8800'"), ("lightblu", "'lightblue'")],
)
def test_near_misses_are_answered(text: str, meant: str) -> None:
    with pytest.raises(ValueError, match=f"did you mean {meant}"):
        parse_color(text)


NO_COLORS = ["", "#", "#12", "#12345", "#1234567", "#ggg", "#-1-1-", "# 1 2 3", "qqqqqq", "#\uff11\uff12\uff13"]


@pytest.mark.parametrize("text", NO_COLORS)
def test_what_is_no_colour_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="is not a colour; expected"):
        parse_color(text)
