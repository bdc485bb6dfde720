"""The sides of painter's pieces that are curves of sticks.

Where two solids meet, the one painted later is cut off there, and the other runs on inside it, under what is painted
over it: a ball into a stick that comes towards the eye, a stick of a joint into a nearer one.
"""

import numpy as np

from molviz.arrays import Bools, Ints
from molviz.visibility.curves import BORDER, LINE, Curves
from molviz.visibility.named_arcs import Hidden, joined
from molviz.visibility.names import BALL, OWN
from molviz.visibility.stack import Sides, Stack, hidden_of
from molviz.visibility.stick_curves import NO_CUTS, StickCurves, caps_on_horizons, hidden_of_own, stick_curves
from molviz.visibility.thirds import PARTS, running_on


def stick_sides(stack: Stack, first_curve: int) -> tuple[Curves, list[Sides]]:
    """Return the curves of sticks, numbered from ``first_curve``, and which pieces they bound."""
    solids, count = stack.solids, stack.solids.balls
    sticks, end = solids.sticks, np.arange(len(solids.sticks.ends.sphere))
    exact = stick_curves(sticks, NO_CUTS, count)
    under = running_on(sticks, stack.later(sticks.ends.sphere, count + end))
    of = stick_curves(under, stack.thirds.cuts(count), count)
    own = joined(hidden_of_own(under, solids.spheres, of, 0))
    own_of_rims = joined(hidden_of_own(sticks, solids.spheres, exact, 0))
    sides = [_rims_of_balls(stack, own_of_rims), *(
        part._replace(curve=part.curve + len(end))
        for part in (_rims(stack, own), _elbows(stack, of, own), _borders(of, own), _lines(stack, of, own))
    )]  # fmt: skip
    curves = exact.curves.take(end).followed_by(of.curves)
    return curves, [part._replace(curve=part.curve + first_curve) for part in sides]


def caps_of_sticks(stack: Stack, horizons: Curves) -> Hidden:
    """Return what sticks that are painted before their balls hide of the horizons of these, by sphere."""
    sticks, count = stack.solids.sticks, stack.solids.balls
    exact = stick_curves(sticks, NO_CUTS, count)
    hidden = caps_on_horizons(sticks, stack.solids.spheres, horizons, exact, count)
    return hidden.take(np.flatnonzero(stack.later(hidden.curve, hidden.leaves)))


def _rims_of_balls(stack: Stack, own: Hidden) -> Sides:
    """The rims of balls that are painted after the sticks."""
    sphere = stack.solids.sticks.ends.sphere
    rim = np.flatnonzero(stack.later(sphere, stack.solids.balls + np.arange(len(sphere))))
    hidden = _that_bounds(stack, hidden_of(own, rim), sphere[rim])
    return Sides(rim, sphere[rim], np.ones(len(rim), dtype=bool), hidden)


def _rims(stack: Stack, own: Hidden) -> Sides:
    """The rims of all sticks."""
    rim = np.arange(len(stack.solids.sticks.ends.sphere))
    solid = stack.solids.balls + rim
    hidden = _that_bounds(stack, hidden_of(own, rim), solid)
    return Sides(rim, stack.piece[solid], np.zeros(len(rim), dtype=bool), hidden)


def _elbows(stack: Stack, of: StickCurves, own: Hidden) -> Sides:
    """The elbows of the later of their sticks."""
    elbow = np.flatnonzero(of.other >= 0)
    first, second = of.curves.first[elbow], of.curves.second[elbow]
    on_right = stack.later(first, second)
    solid = np.where(on_right, first, second)
    return Sides(elbow, stack.piece[solid], on_right, _that_bounds(stack, hidden_of(own, elbow), solid))


def _that_bounds(stack: Stack, hidden: Hidden, solid: Ints) -> Hidden:
    """Of what hides the curves those rows that matter to the given solid of each: where it turns away from the eye
    itself, and what lies inside balls or sticks that are painted before it."""
    mine = solid[hidden.curve]
    turns_away = (hidden.reason == OWN) & (hidden.leaves == mine)
    inside = (hidden.reason == BALL) & ((hidden.leaves < stack.solids.balls) | stack.later(mine, hidden.leaves))
    return hidden.take(np.flatnonzero(turns_away | inside))


def _borders(of: StickCurves, own: Hidden) -> Sides:
    """The ends of parts of sticks, then their beginnings."""
    border = np.flatnonzero(of.curves.kind == BORDER)
    on_right = np.arange(len(border)) < len(border) // 2
    piece = np.where(on_right, of.curves.first[border], of.curves.second[border])
    return Sides(border, piece, on_right, hidden_of(own, border))


def _lines(stack: Stack, of: StickCurves, own: Hidden) -> Sides:
    """The lines of each part of a stick, outside the sticks of its joints that are painted before it."""
    count = stack.solids.balls
    line, part = stack.thirds.on_lines()
    curve = np.flatnonzero(of.curves.kind == LINE)[line]
    hidden = hidden_of(own, curve)
    kept = np.flatnonzero((hidden.reason == OWN) | _inside_earlier(stack, hidden, line >> 1))
    hidden = joined([hidden.take(kept), stack.thirds.cut_off(line, part, count)])
    return Sides(curve, count + PARTS * (line >> 1) + part, np.zeros(len(line), dtype=bool), hidden)


def _inside_earlier(stack: Stack, hidden: Hidden, stick: Ints) -> Bools:
    """Whether what hides a line of each stick is one that is painted before the end of the line at their joint."""
    count, sphere = stack.solids.balls, stack.solids.sticks.ends.sphere
    own = 2 * stick[hidden.curve]
    own += sphere[own] != sphere[hidden.leaves - count]
    return stack.later(count + own, hidden.leaves)
