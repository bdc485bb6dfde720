"""Colours mixed, lightened and turned as the eye sees them: OKLab, and CIE L* for what a grey print keeps.

B. Ottosson (2020) A perceptual color space for image processing, bottosson.github.io/posts/oklab; sRGB by
IEC 61966-2-1. A colour is sRGB from 0 to 255: a tuple, or one in each row of (..., 3). Answers are arrays of whole
numbers of the same shape, rounded to the nearest and cut to 0 to 255.
"""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from molviz.arrays import Floats, Ints
from molviz.picture.picture import Color
from molviz.vectors import transformed

Colors: TypeAlias = Color | Sequence[Color] | Ints

_CONES = np.array(  # rows L, M, S of linear sRGB
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
_OPPONENTS = np.array(  # rows lightness, green to red, blue to yellow of the cones' cube roots
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
_GREY = 1e-3  # chroma: far below one step of 8 bits
_HALVINGS = 10  # of an interval of 1: finer than 8 bits
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # Y of linear sRGB


def _inverse(matrix: Floats) -> Floats:
    """The inverse (3, 3): cross products of rows over the determinant, the same to the last bit on every machine."""
    columns = [np.cross(matrix[(k + 1) % 3], matrix[(k + 2) % 3]) for k in range(3)]
    inverse: Floats = np.column_stack(columns) / np.sum(matrix[0] * columns[0])
    return inverse


_FROM_CONES, _FROM_OPPONENTS = _inverse(_CONES), _inverse(_OPPONENTS)


def linear_light(color: Colors) -> Floats:
    """Return the linear sRGB (..., 3) of colours, 0 to 1."""
    share = np.asarray(color) / 255.0
    light: Floats = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return light


def color_of_light(light: Floats) -> Ints:
    """Return the colours of linear sRGB (..., 3), what lies outside of 0 to 1 cut off."""
    bounded = np.clip(light, 0.0, 1.0)
    share = np.where(bounded <= 0.0031308, 12.92 * bounded, 1.055 * bounded ** (1 / 2.4) - 0.055)
    return np.rint(255.0 * share).astype(np.int64)


def to_oklab(color: Colors) -> Floats:
    """Return OKLab (..., 3) of colours: lightness 0 to 1, green to red, blue to yellow."""
    lab: Floats = transformed(np.cbrt(transformed(linear_light(color), _CONES)), _OPPONENTS)
    return lab


def from_oklab(lab: Floats) -> Ints:
    """Return the colours (..., 3) of OKLab, the nearest of each channel where the screen has none such."""
    return color_of_light(transformed(transformed(lab, _FROM_OPPONENTS) ** 3, _FROM_CONES))


def mix(one: Colors, other: Colors, share: float | Floats) -> Ints:
    """Return the colours (..., 3) that lie a ``share`` (a number, or (...)) of the way from one to the other."""
    start, part = to_oklab(one), np.asarray(share, dtype=float)[..., None]
    return from_oklab(start + part * (to_oklab(other) - start))


def lightness(color: Colors) -> Floats:
    """Return CIE L* (...), 0 for black to 100 for white: how light a grey print of the colours is."""
    luminance = transformed(linear_light(color), _LUMINANCE[None])[..., 0]
    low = luminance <= (6 / 29) ** 3  # CIE 15: the cube root's straight start
    result: Floats = np.where(low, luminance * (29 / 3) ** 3, 116 * np.cbrt(luminance) - 16)
    return result


def lighter(color: Colors, by: float | Floats) -> Ints:
    """Return the colours (..., 3) with ``by`` (a number, or (...)) added to their L*, of the same hue.

    Darker: OKLab times s is light times s³, so s is the ratio of the cube roots of luminance: exact, and never outside
    of what a screen shows. Lighter: moved towards white, lightness before chroma, the share found by bisection.
    """
    lab, start = to_oklab(color), lightness(color)
    goal = np.clip(start + by, 0.0, 100.0)
    darkened = np.minimum(_root(goal) / np.maximum(_root(start), 1e-9), 1.0)[..., None] * lab
    low, high = np.zeros_like(goal), np.ones_like(goal)
    for _ in range(_HALVINGS):
        share = (low + high) / 2
        short = lightness(from_oklab(_whitened(darkened, share))) < goal
        low, high = np.where(short, share, low), np.where(short, high, share)
    return from_oklab(np.where((goal > start)[..., None], _whitened(lab, high), darkened))


def _root(light: Floats) -> Floats:
    """Return the cube root of the luminance that has that L*."""
    root: Floats = np.where(light > 8, (light + 16) / 116, np.cbrt(light * (3 / 29) ** 3))
    return root


def _whitened(lab: Floats, share: Floats) -> Floats:
    left = np.stack([1.0 - share, 1.0 - share**2, 1.0 - share**2], axis=-1)  # chroma goes last, or sand would be chalk
    whitened: Floats = np.array([1.0, 0.0, 0.0]) + left * (lab - np.array([1.0, 0.0, 0.0]))
    return whitened


def shaded(color: Colors, shade: Colors, drop: float | Floats) -> Ints:
    """Return the colours (..., 3) mixed with ``shade`` so far that their L* is ``drop`` lower, to within 1.

    So a contact shade stays in its colour's own hue. Never beyond ``shade``; a colour darker than that stays as it is.
    """
    whole = lightness(color) - lightness(shade)  # L* is nearly linear along a mix
    share: Floats = np.where(whole > 0, np.clip(drop / np.where(whole > 0, whole, 1.0), 0.0, 1.0), 0.0)
    return mix(color, shade, share)


def turned(color: Colors, degrees: float | Floats) -> Ints:
    """Return the colours (..., 3) of turned hue (red to yellow to green), lightness and chroma as before."""
    lab, angle = to_oklab(color), np.radians(degrees)
    chroma, hue = np.hypot(lab[..., 1], lab[..., 2]), np.arctan2(lab[..., 2], lab[..., 1])
    columns = np.broadcast_arrays(lab[..., 0], chroma * np.cos(hue + angle), chroma * np.sin(hue + angle))
    return from_oklab(np.stack(columns, axis=-1))


def turn_between(one: Colors, other: Colors) -> Floats:
    """Return by how many degrees (...), −180 to 180, the hue of one turns to that of the other; 0 for greys."""
    (_, red, yellow), (_, to_red, to_yellow) = np.moveaxis(to_oklab(one), -1, 0), np.moveaxis(to_oklab(other), -1, 0)
    across, along = red * to_yellow - yellow * to_red, red * to_red + yellow * to_yellow
    grey = np.hypot(across, along) < _GREY**2
    degrees: Floats = np.where(grey, 0.0, np.degrees(np.arctan2(across, along)))
    return degrees


def colors_of(rows: Ints) -> list[Color]:
    """Return the rows (n, 3) as a list of colours."""
    return [(red, green, blue) for red, green, blue in rows.tolist()]
