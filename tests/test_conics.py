"""Roots of a quadratic function on the circle, against dense sampling."""

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from molviz.geometry.intervals import TURN
from molviz.visibility.conics import harmonics, roots
from molviz.visibility.forms import Quadratic

number = st.floats(-3, 3, allow_subnormal=False)


def sign_changes(form: Quadratic) -> np.ndarray:
    theta = np.linspace(0, TURN, 4001)
    c, s = np.cos(theta), np.sin(theta)
    value = form.aa * c * c + 2 * form.ab * c * s + form.bb * s * s + 2 * form.a * c + 2 * form.b * s + form.c
    clear = np.minimum(np.abs(value[:-1]), np.abs(value[1:])) > 1e-9
    return theta[np.flatnonzero((value[:-1] * value[1:] < 0) & clear)]


@given(st.tuples(*[number] * 6))
@example((0.0, 1.0, 0.0, 0.0, 1e-09, 1.0))  # two roots 5e-5 apart, from which Newton's step flew far
@example((0.0, 2.0, 0.0, 0.0, 2e-55, 1.0))  # both terms nought to rounding
@example((0.5, -1.6145356490770436e-12, 0.5, 0.5, 0.5, 0.0))  # the second harmonic is lost in the cubic
@example((1.0, 1e-11, 1.0, 0.0, 1.0, 0.0))  # the cubic's root at the end of its bracket
@example((0.0, 0.5, 0.0, 1e-67, 0.0, 1e-09))  # a first harmonic whose square is no number
@example((0.0, 1.0, 0.001953125, 3.2114338103709774e-189, 0.0, 0.0))
@example((0.001953125, 1.0, 0.0, 0.0, 1.175494351e-38, 0.0))  # both terms nought, their product is rounding
@settings(max_examples=400)
def test_every_sign_change_is_a_root(columns: tuple[float, ...]) -> None:
    form = Quadratic(*(np.array([column]) for column in columns))
    angle, exists = roots(harmonics(form))
    found = angle[exists]
    for change in sign_changes(form):
        assert len(found)
        gap = np.abs(np.mod(found - change + np.pi, TURN) - np.pi)
        assert gap.min() < 2 * TURN / 4000


@given(st.lists(st.floats(0, 6.2), min_size=4, max_size=4, unique=True))
def test_four_given_roots_are_found(angles: list[float]) -> None:
    """The product of the chords through points 1, 2 and 3, 4."""
    chords = []
    for one, other in (angles[:2], angles[2:]):
        middle, half = (one + other) / 2, (one - other) / 2
        chords.append((np.cos(middle), np.sin(middle), -np.cos(half)))
    (p, q, r), (s, t, w) = chords
    form = Quadratic(*(np.array([x]) for x in (
        p * s, (p * t + q * s) / 2, q * t, (p * w + r * s) / 2, (q * w + r * t) / 2, r * w
    )))  # fmt: skip
    gaps = np.diff(np.sort([*angles, min(angles) + TURN]))
    if gaps.min() < 1e-3:
        return
    angle, exists = roots(harmonics(form))
    assert exists.all()
    distance = np.abs(np.mod(angle[0][:, None] - np.array(angles) + np.pi, TURN) - np.pi)
    assert distance.min(axis=0).max() < 1e-9 / gaps.min()
