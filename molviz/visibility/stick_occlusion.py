"""What sticks in front hide of all curves, and spheres in front of the curves of sticks."""

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.geometry.grid import Neighbours
from molviz.geometry.intervals import TURN, above
from molviz.geometry.rows import blocks, expand
from molviz.threads import in_threads
from molviz.visibility.bounds import Bounds
from molviz.visibility.curves import LINE, Curves
from molviz.visibility.forms import Linear
from molviz.visibility.named_arcs import Hidden
from molviz.visibility.names import FRONT
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.occluders.stick import LINES, StickOccluders
from molviz.visibility.occlusion import BLOCK_ROWS, discs_of, occlusion
from molviz.visibility.projection import Projection
from molviz.visibility.solids import Solids
from molviz.visibility.stick_curves import StickCurves

CONDITIONS = 5
SILHOUETTE_PLANE = 2  # the condition of being behind it
MIDDLE_THIRD = 0.5 + 1e-6  # the largest cosine on it, and room for rounding
NO_CONTOUR = -1  # an end that no contour explains; arcs that end there are degenerate


def hidden_of_stick_curves(
    solids: Solids, of: StickCurves, near: Neighbours, bounds: Bounds, projection: Projection, first_curve: int
) -> tuple[list[Hidden], list[Hidden]]:
    """Return what spheres and what sticks hide of the curves of sticks, which are number ``first_curve`` onwards.

    ``near`` is what may be in front of some of each solid. In blocks, shared by threads.
    """
    spheres, sticks, count = solids.spheres, solids.sticks, solids.balls
    discs = discs_of(of.curves, projection)
    begin, end = near.start[count + of.stick], near.start[count + of.stick + 1]

    def hidden_in(block: slice) -> tuple[Hidden, Hidden]:
        row, entry = expand(begin[block], end[block])
        curve, solid = row + block.start, near.item[entry]
        met = bounds.meet_discs(solid, discs.center.take(curve, axis=0), discs.radius[curve])
        rows = np.flatnonzero(met | (of.curves.kind[curve] == LINE))
        curve, solid = curve[rows], solid[rows]
        ball = solid < count
        by_spheres = _hidden_by_spheres(spheres, sticks, of, curve[ball], solid[ball])
        by_sticks = _hidden_by_sticks(sticks, of, curve[~ball], solid[~ball] - count, count)
        return by_spheres, by_sticks

    found = in_threads(hidden_in, blocks(end - begin, 2 * BLOCK_ROWS))
    by_spheres, by_sticks = (
        [part._replace(curve=part.curve + first_curve) for part in parts] for parts in zip(*found, strict=True)
    )
    return by_spheres, by_sticks


def _hidden_by_spheres(
    spheres: SphereOccluders, sticks: StickOccluders, of: StickCurves, curve: Ints, sphere: Ints
) -> Hidden:
    """What the given spheres hide of the given curves.

    A joint lies inside the cylinders of its sticks, extended: it hides nothing of them. Rims lie on their own spheres.
    """
    own = _joint_of(sticks, of.stick[curve], sphere) | ((of.end[curve] >= 0) & (of.other[curve] < 0) & (
        sticks.ends.sphere[of.end[curve]] == sphere))  # fmt: skip
    margin = spheres.plane_margin(of.curves, curve, sphere)
    rows = np.flatnonzero(~own & _holds_somewhere(margin, of.curves.kind[curve] == LINE))
    found = occlusion(spheres, of.curves, curve[rows], sphere[rows])
    return found.take(_in_first_half(of.curves, found))


def _hidden_by_sticks(sticks: StickOccluders, of: StickCurves, curve: Ints, stick: Ints, count: int) -> Hidden:
    """What the given sticks hide of the given curves.

    Neither of an elbow's own does, nor do sticks of a joint hide its rims, which lie on the ball outside of them all.
    """
    rim = (of.end[curve] >= 0) & (of.other[curve] < 0)
    sphere = sticks.ends.sphere[np.where(rim, of.end[curve], 0)]
    rows = np.flatnonzero((of.other[curve] != stick) & ~(rim & _joint_of(sticks, stick, sphere)))
    return _behind(sticks, of.curves, curve[rows], stick[rows], count)


def hidden_by_sticks(sticks: StickOccluders, curves: Curves, near: Neighbours, count: int) -> list[Hidden]:
    """Return what sticks hide of creases and horizons, in blocks, shared by threads; no horizon its own sticks at a
    joint: what they hide lies inside them.

    ``near`` is what may be in front of some of each solid, after ``count`` spheres the sticks.
    """
    begin, end = near.start[curves.first], near.start[curves.first + 1]

    def hidden_in(block: slice) -> Hidden:
        row, entry = expand(begin[block], end[block])
        rows = np.flatnonzero(near.item[entry] >= count)
        curve, stick = row[rows] + block.start, near.item[entry[rows]] - count
        first = curves.first[curve]
        horizon = first == curves.second[curve]
        rows = np.flatnonzero(~(horizon & _joint_of(sticks, stick, first)))
        return _behind(sticks, curves, curve[rows], stick[rows], count)

    return in_threads(hidden_in, blocks(end - begin, BLOCK_ROWS))


def _behind(sticks: StickOccluders, curves: Curves, curve: Ints, stick: Ints, count: int) -> Hidden:
    """The intervals on which all five conditions hold, by their end points.

    An end of one condition counts where the other four hold; between consecutive ones a curve is hidden or not as a
    whole. Where a curve passes behind one of the two lines is a T-junction; elsewhere balls hide it on either side.
    """
    side = _joint_sides(sticks, curves, curve, stick, count)
    margins = sticks.all_behind(curves, curve, stick)
    rows = np.flatnonzero(_holds_somewhere(margins, (curves.kind[curve] == LINE) & (side == 0)).all(axis=0))
    margins = Linear(*(column[:, rows] for column in margins))
    angle, real = _ends(margins)
    hidden = np.flatnonzero(real.any(axis=0) | (margins.a + margins.c > 0).all(axis=0))
    curve, stick, side = (column[rows[hidden]] for column in (curve, stick, side))
    margins = Linear(*(column[:, hidden] for column in margins))
    angle = np.ascontiguousarray(np.where(real, angle, np.nan)[:, hidden].T)
    amount = np.sum(real[:, hidden], axis=0)
    order = np.argsort(angle, axis=1)
    start = np.take_along_axis(angle, order, axis=1)
    last = np.arange(2 * CONDITIONS) == amount[:, None] - 1
    sweep = np.where(last, start[:, :1] + TURN, np.roll(start, -1, axis=1)) - start
    start[amount == 0, 0], sweep[amount == 0, 0] = 0.0, TURN
    row, column = np.nonzero(np.arange(2 * CONDITIONS) < np.maximum(amount, 1)[:, None])
    behind = np.flatnonzero(_all_hold(margins, row, start[row, column] + sweep[row, column] / 2))
    row, column = row[behind], column[behind]
    after = np.where(column + 1 < np.maximum(amount, 1)[row], column + 1, 0)
    begins, ends = ((order // 2)[row, place] for place in (column, after))
    reason = np.full(len(row), FRONT)
    enters, leaves = (_contour(condition, stick[row], count) for condition in (begins, ends))
    found = Hidden(curve[row], start[row, column], sweep[row, column], reason, leaves, enters)
    found = _up_to_joints(found, side[row], begins == SILHOUETTE_PLANE, ends == SILHOUETTE_PLANE)
    return found.take(_in_first_half(curves, found))


def _holds_somewhere(margin: Linear, short: Bools) -> Bools:
    """Whether functions are positive anywhere on their curves or, of ``short`` ones, on the middle third of a line."""
    reach = np.where(short, MIDDLE_THIRD * np.abs(margin.a), np.hypot(margin.a, margin.b))
    return np.asarray(margin.c + reach > 0)


def _in_first_half(curves: Curves, hidden: Hidden) -> Ints:
    """The rows of intervals other than those between π and 2π of a line, where it runs back outside its third."""
    back = (hidden.start >= np.pi) & (hidden.start + hidden.sweep <= TURN)
    return np.flatnonzero(~(back & (curves.kind[hidden.curve] == LINE)))


def _joint_sides(sticks: StickOccluders, curves: Curves, curve: Ints, stick: Ints, count: int) -> Ints:
    """1 where a line begins in a joint that it shares with a stick, −1 where it ends in one, 0 for all others (m,)."""
    side = np.zeros(len(curve), dtype=np.int64)
    rows = np.flatnonzero(curves.kind[curve] == LINE)
    for column, sign in ((curves.first, 1), (curves.second, -1)):
        sphere = sticks.ends.sphere[column[curve[rows]] - count]
        side[rows[_joint_of(sticks, stick[rows], sphere)]] = sign
    return side


def _up_to_joints(hidden: Hidden, side: Ints, begins: Bools, ends: Bools) -> Hidden:
    """The same intervals, but for those that begin or end in the silhouette plane of another stick of the line's joint.

    There the line is inside that stick, from its elbow to the joint; where it looks as if it were just on the elbow,
    rounding would say which of the two comes first. So what is hidden behind the stick goes on to the joint, and what
    would be hidden behind it nearer to the joint than that lies inside it anyway.
    """
    last = np.mod(hidden.start + hidden.sweep, TURN)
    begins, ends = begins & (hidden.start < np.pi), ends & (last < np.pi)
    before, after = np.where(begins & (side > 0), hidden.start, 0.0), np.where(ends & (side < 0), np.pi - last, 0.0)
    hidden = hidden._replace(start=hidden.start - before, sweep=hidden.sweep + before + after)
    rows = np.flatnonzero(~((ends & (side > 0)) | (begins & (side < 0))))
    return Hidden(*(column[rows] for column in hidden))  # type: ignore[arg-type]


def _ends(margins: Linear) -> tuple[Floats, Bools]:
    """The end points (10, m) of the five conditions in [0, 2π), two each, and which of them count."""
    middle, half = above(margins.a, margins.b, -margins.c)
    cuts = (half > 0) & (half < np.pi)
    angle = np.mod(np.stack([middle - half, middle + half], axis=1).reshape(2 * CONDITIONS, -1), TURN)
    real = np.repeat(cuts, 2, axis=0)
    place, column = np.nonzero(real)
    real[place, column] = _all_hold(margins, column, angle[place, column], place // 2)
    return angle, real


def _all_hold(margins: Linear, column: Ints, angle: Floats, but: Ints | None = None) -> Bools:
    """Whether all conditions, ``but`` one each, hold on functions of the given columns (k,) at angles (k,)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    hold = np.ones(len(column), dtype=bool)
    for condition, (a, b, c) in enumerate(zip(*margins, strict=True)):
        holds = a[column] * cosine + b[column] * sine + c[column] > 0
        hold &= holds if but is None else holds | (but == condition)
    return hold


def _contour(condition: Ints, stick: Ints, count: int) -> Ints:
    return np.where(condition < LINES, count + 2 * stick + condition, NO_CONTOUR)


def _joint_of(sticks: StickOccluders, stick: Ints, sphere: Ints) -> Bools:
    """Whether the spheres are joints at an end of the sticks."""
    ends = 2 * stick
    one, other = (sticks.ends.joint[end] & (sticks.ends.sphere[end] == sphere) for end in (ends, ends + 1))
    return np.asarray(one | other)
