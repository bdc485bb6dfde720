"""Where a circle lies inside a cylinder or a cone: up to four angles, found as those of two straight lines.

A quadratic function on the unit circle does not change when a multiple of cos² + sin² − 1 is added. One such multiple
makes it a product of two linear functions, each of which changes sign where a line meets the circle: an instance of
the one primitive ``a cos θ + b sin θ > c``. So roots come in pairs, one pair per line, and a line that only touches
gives both or none: a tangent never opens an interval on one side.
"""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.intervals import above
from molviz.visibility.forms import Quadratic

POLISH_STEPS = 3  # Newton steps for the roots themselves, quadratic from the lines' 1e-8 or better
SMALL_FACTOR = 1e-3  # below this ratio of p and q, dividing by the smaller loses what the product e f still knows
SMALL_TERM = 1e-6  # of a line: what is left beside it would be known to ten digits
NOTHING = 1e-40  # of the function's size: far below rounding, and its square is still a number
NEARLY_LINEAR = 1e-10  # second harmonic relative to the first below which one line is taken, and polished


class Harmonics(NamedTuple):
    """``h0 + h1 cos (θ − ψ) + g1 sin (θ − ψ) + h2 cos 2 (θ − ψ)`` with h2 ≥ 0."""

    h0: Floats
    h1: Floats
    g1: Floats
    h2: Floats
    psi: Floats

    def take(self, rows: Ints) -> "Harmonics":
        """Return the given rows, in that order."""
        return Harmonics(*(column[rows] for column in self))

    def at(self, angle: Floats) -> Floats:
        """Return the values at one angle each (m,), or at several (m, k)."""
        h0, h1, g1, h2, psi = (column.reshape(-1, *[1] * (angle.ndim - 1)) for column in self)
        t = angle - psi
        cosine = np.cos(t)
        return np.asarray(h0 + h1 * cosine + g1 * np.sin(t) + h2 * (2 * cosine**2 - 1))

    def slope(self, angle: Floats) -> Floats:
        """Return the derivatives at one angle each (m,)."""
        t = angle - self.psi
        sine, cosine = np.sin(t), np.cos(t)
        return np.asarray(self.g1 * cosine - self.h1 * sine - 4 * self.h2 * sine * cosine)


def harmonics(form: Quadratic) -> Harmonics:
    """Return a quadratic function with its second harmonic turned to a pure cosine, scaled to size one."""
    even, odd = (form.aa - form.bb) / 2, form.ab
    psi = np.arctan2(odd, even) / 2
    cosine, sine = np.cos(psi), np.sin(psi)
    columns = np.stack([
        form.c + (form.aa + form.bb) / 2,
        2 * (form.a * cosine + form.b * sine),
        2 * (form.b * cosine - form.a * sine),
        np.hypot(even, odd),
    ])  # fmt: skip
    columns /= np.maximum(np.abs(columns).max(axis=0), np.finfo(float).tiny)
    columns[np.abs(columns) < NOTHING] = 0.0
    return Harmonics(columns[0], columns[1], columns[2], columns[3], psi)


def roots(form: Harmonics) -> tuple[Floats, Bools]:
    """Return the angles (m, 4) where the functions vanish, two per line, and which of them exist and are exact."""
    p, q, e, f = _two_lines(form)
    middle, half = np.stack([above(p, q, -e), above(p, -q, -f)], axis=2)
    exists = np.tile((half > 0) & (half < np.pi), 2)
    angle = np.concatenate([middle - half, middle + half], axis=1) + form.psi[:, None]
    row, column = np.nonzero(exists)
    reach = half[row, column % 2] / 2
    angle[row, column] = _polished(form.take(row), angle[row, column], reach)
    return angle, exists


def _two_lines(form: Harmonics) -> tuple[Floats, Floats, Floats, Floats]:
    """The factors ``(p cos t + q sin t + e)(p cos t − q sin t + f)`` of the function on the circle.

    ``p² = 2 h2 + λ`` and ``q² = −λ`` for a root λ in [−2 h2, 0] of the cubic; comparing coefficients gives
    ``p (e + f) = h1``, ``q (f − e) = g1`` and ``e f = h0 − h2 − λ``. Without a second harmonic the function is one line
    itself, and the other passes the circle by.
    """
    shift = _cubic_root(form)
    p, q = np.sqrt(np.maximum(2 * form.h2 + shift, 0.0)), np.sqrt(np.maximum(-shift, 0.0))
    product = form.h0 - form.h2 - shift
    total, difference = _quotient(form.h1, p, q), _quotient(form.g1, q, p)
    by_total = np.copysign(np.sqrt(np.maximum(total**2 - 4 * product, 0.0)), form.g1)
    by_difference = np.copysign(np.sqrt(np.maximum(difference**2 + 4 * product, 0.0)), form.h1)
    difference = np.where(q < SMALL_FACTOR * p, by_total, difference)
    total = np.where(p < SMALL_FACTOR * q, by_difference, total)
    linear = form.h2 <= NEARLY_LINEAR * np.hypot(form.h1, form.g1)
    e, f = _terms(total, difference, product)
    e, f = np.where(linear, form.h0, e), np.where(linear, np.inf, f)
    return np.where(linear, form.h1, p), np.where(linear, form.g1, q), e, f


def _terms(total: Floats, difference: Floats, product: Floats) -> tuple[Floats, Floats]:
    """e and f from ``e + f``, ``f − e`` and ``e f``: by the sums, or by the product where these cancel.

    The product is a difference of numbers as large as 1: beside a term near nought it is rounding, the sums are not.
    """
    e, f = (total - difference) / 2, (total + difference) / 2
    return _unless_lost(e, f, product), _unless_lost(f, e, product)


def _unless_lost(term: Floats, other: Floats, product: Floats) -> Floats:
    lost = (np.abs(term) < SMALL_FACTOR * np.abs(other)) & (np.abs(other) > SMALL_TERM)
    return np.divide(product, other, out=term.copy(), where=lost)


def _quotient(part: Floats, factor: Floats, other: Floats) -> Floats:
    """``part / factor`` where the factor is not small beside the other one, else 0."""
    usable = factor >= SMALL_FACTOR * other
    return np.divide(part, factor, out=np.zeros_like(part), where=usable & (factor > 0))


def _cubic_root(form: Harmonics) -> Floats:
    """The root in [−2 h2, 0], farthest from its ends, of the cubic that makes the function degenerate.

    ``λ³ + (2 h2 − k) λ² − (2 h2 k − g1²/4 − h1²/4) λ + h2 g1²/2 = 0`` with ``k = h0 − h2``. It is ≤ 0 at −2 h2 and
    ≥ 0 at 0, so an odd number of roots lies between, where both factors are real.
    """
    k, square = form.h0 - form.h2, (form.h1**2 + form.g1**2) / 4
    candidates = _real_roots(2 * form.h2 - k, square - 2 * form.h2 * k, form.h2 * form.g1**2 / 2)
    inside = np.minimum(-candidates, 2 * form.h2 + candidates)
    best = np.argmax(inside, axis=0)
    return np.asarray(np.clip(candidates[best, np.arange(len(best))], -2 * form.h2, 0.0))


def _real_roots(b: Floats, c: Floats, d: Floats) -> Floats:
    """The real roots (3, m) of ``x³ + b x² + c x + d``; the one real root three times where two are complex.

    Viète's cosines where all are real, else Cardano's formula with the sign that does not cancel. With ``x = y − b/3``:
    ``y³ + p y + q``.
    """
    p, q = c - b**2 / 3, 2 * (b / 3) ** 3 - b * c / 3 + d
    discriminant = (q / 2) ** 2 + (p / 3) ** 3
    size = np.sqrt(np.maximum(-p / 3, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        angle = np.arccos(np.clip(np.nan_to_num(-q / (2 * size**3)), -1.0, 1.0)) / 3
        u = -np.copysign(np.cbrt(np.abs(q) / 2 + np.sqrt(np.maximum(discriminant, 0.0))), q)
        single = u - np.nan_to_num(p / (3 * u))
    cosines = 2 * size * np.cos(angle + np.array([[0.0], [2.0], [-2.0]]) * np.pi / 3)
    return np.asarray(np.where(discriminant <= 0, cosines, single) - b / 3)


def _polished(form: Harmonics, angle: Floats, reach: Floats) -> Floats:
    """Newton's method on the function itself, while it helps, and never half-way to the line's other root."""
    start, value = angle, form.at(angle)
    for _ in range(POLISH_STEPS):
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.nan_to_num(value / form.slope(angle), nan=0.0, posinf=0.0, neginf=0.0)
        trial = np.clip(angle - step, start - reach, start + reach)
        reached = form.at(trial)
        better = np.abs(reached) < np.abs(value)
        angle, value = np.where(better, trial, angle), np.where(better, reached, value)
    return angle
