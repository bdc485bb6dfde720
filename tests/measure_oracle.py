"""Area and volume of a few balls in ways that share nothing with ``molviz.geometry.measure`` but the definition.

Arcs: all crossings of a circle with all balls, sorted; the middle of every piece is tested against every ball.
Areas: Gauss–Bonnet, with the Euler characteristic settled by sampling. Volume: Džurina & Plavka as printed, one pole
for all spheres, ``∫ z dx dy`` by J1, J2 and J3, with the misprints of their equation (10) put right.
"""

from typing import NamedTuple

import numpy as np

from molviz.model.spheres import Spheres

TURN = 2 * np.pi


class Arc(NamedTuple):
    """Of the rim of the cap that ball ``ball`` cuts off sphere ``sphere``, clockwise about its axis."""

    sphere: int
    ball: int
    start: float
    sweep: float
    next_ball: int  # entered at the end, −1 for a whole circle


class Rim(NamedTuple):
    """``center + a cos ψ + b sin ψ`` is clockwise about the unit axis."""

    axis: np.ndarray
    center: np.ndarray
    a: np.ndarray
    b: np.ndarray

    def at(self, angle: float | np.ndarray) -> np.ndarray:
        """Points (…, 3) at angles (…)."""
        return self.center + np.multiply.outer(np.cos(angle), self.a) + np.multiply.outer(np.sin(angle), self.b)


def rim(spheres: Spheres, i: int, j: int) -> Rim | None:
    between = spheres.center[j] - spheres.center[i]
    d, own, other = float(np.linalg.norm(between)), float(spheres.radius[i]), float(spheres.radius[j])
    if not abs(own - other) < d < own + other:
        return None
    axis, along = between / d, (d * d + own * own - other * other) / (2 * d)
    helper = np.eye(3)[np.argmin(np.abs(axis))]
    a = np.cross(axis, helper)
    a *= np.sqrt(own * own - along * along) / np.linalg.norm(a)
    return Rim(axis, spheres.center[i] + along * axis, a, -np.cross(axis, a))


def free_arcs(spheres: Spheres, i: int, j: int) -> list[Arc]:
    """All arcs of the rim of j on i that lie outside all other balls."""
    circle = rim(spheres, i, j)
    if circle is None:
        return []
    numbers = np.arange(len(spheres.radius))
    others = numbers[(numbers != i) & (numbers != j)]
    toward = spheres.center[others] - circle.center
    level = (toward**2).sum(1) + circle.a @ circle.a - spheres.radius[others] ** 2
    a, b = 2 * toward @ circle.a, 2 * toward @ circle.b
    reach = np.hypot(a, b)
    cut = np.abs(level) < reach
    middle, half = np.arctan2(b[cut], a[cut]), np.arccos(level[cut] / reach[cut])
    ends = np.concatenate([(middle - half) % TURN, (middle + half) % TURN])
    entered = np.concatenate([others[cut], np.full(cut.sum(), -1)])
    order = np.argsort(ends)
    ends, entered = ends[order], entered[order]
    starts = ends if len(ends) else np.zeros(1)
    sweeps = np.diff(np.append(starts, starts[0] + TURN))
    points = circle.at(starts + sweeps / 2)
    gap = np.linalg.norm(points[:, None] - spheres.center[others], axis=2) - spheres.radius[others]
    after = np.roll(entered, -1) if len(ends) else np.full(1, -1)
    free = np.flatnonzero(np.all(gap > 0, axis=1))
    return [Arc(i, j, float(starts[k]), float(sweeps[k]), int(after[k])) for k in free]


def all_free_arcs(spheres: Spheres) -> list[Arc]:
    count = len(spheres.radius)
    return [arc for i in range(count) for j in range(count) if i != j for arc in free_arcs(spheres, i, j)]


def sampled_fraction(spheres: Spheres, i: int, count: int = 500) -> float:
    """The share of sphere i outside all others by a spiral of points."""
    z = 1 - (2 * np.arange(count) + 1) / count
    turn = np.arange(count) * np.pi * (3 - 5**0.5)
    direction = np.stack([np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z], axis=1)
    others = np.delete(np.arange(len(spheres.radius)), i)
    points = spheres.center[i] + spheres.radius[i] * direction
    gap = np.linalg.norm(points[:, None] - spheres.center[others], axis=2) - spheres.radius[others]
    return float(np.mean(np.all(gap >= 0, axis=1)))


def gauss_bonnet_areas(spheres: Spheres, arcs: list[Arc]) -> np.ndarray:
    """``A / r² = 2πχ − ∫ κ dl − Σ exterior angles``, and χ is the whole number nearest to what sampling gives."""
    turning = np.zeros(len(spheres.radius))
    for arc in arcs:
        circle = rim(spheres, arc.sphere, arc.ball)
        assert circle is not None
        radius = float(spheres.radius[arc.sphere])
        cosine = float((circle.center - spheres.center[arc.sphere]) @ circle.axis) / radius
        turning[arc.sphere] += cosine * arc.sweep
        if arc.next_ball >= 0:
            following = rim(spheres, arc.sphere, arc.next_ball)
            assert following is not None
            normal = (circle.at(arc.start + arc.sweep) - spheres.center[arc.sphere]) / radius
            before, after = np.cross(normal, circle.axis), np.cross(normal, following.axis)
            turning[arc.sphere] -= np.arctan2(np.cross(before, after) @ normal, before @ after)
    sampled = 2 * TURN * np.array([sampled_fraction(spheres, i) for i in range(len(turning))])
    with_arcs = np.isin(np.arange(len(turning)), [arc.sphere for arc in arcs])
    settled = turning + TURN * np.round((sampled - turning) / TURN)
    return spheres.radius**2 * np.where(with_arcs, settled, np.round(sampled / (2 * TURN)) * 2 * TURN)


def paper_volume(spheres: Spheres, arcs: list[Arc], areas: np.ndarray) -> float:
    """``Σ ∫ z dx dy`` with the pole in direction z, by the printed formulas for arcs of circles."""
    volume = 0.0
    for i in np.flatnonzero(areas > 0):
        own = [arc for arc in arcs if arc.sphere == i]
        top = spheres.center[i] + [0, 0, spheres.radius[i]]
        others = np.setdiff1d(np.arange(len(areas)), [i])
        pole_free = np.all(np.linalg.norm(spheres.center[others] - top, axis=1) > spheres.radius[others])
        volume += 4 / 3 * np.pi * spheres.radius[i] ** 3 * bool(pole_free)
        r, z = float(spheres.radius[i]), float(spheres.center[i, 2])
        for arc in own:
            j1, j2, j3 = printed_integrals(spheres, arc)
            volume += 128 / 3 * r**7 * j3 + 8 * r**4 * (r / 3 - (z + r)) * j2 + 2 / 3 * r**3 * j1
    return volume


def printed_integrals(spheres: Spheres, arc: Arc) -> tuple[float, float, float]:
    """J1, J2, J3 of one arc, in the letters of the paper (section 4)."""
    i, j = arc.sphere, arc.ball
    ri, between = float(spheres.radius[i]), spheres.center[i] - spheres.center[j]
    aj = between[:2] @ between[:2] + (between[2] + ri) ** 2 - spheres.radius[j] ** 2
    bj, cj = 8 * ri**2 * between[0], 8 * ri**2 * between[1]
    dj = 4 * ri**2 * (between[:2] @ between[:2] + (between[2] - ri) ** 2 - spheres.radius[j] ** 2)
    t0, s0 = -bj / (2 * aj), -cj / (2 * aj)
    r0 = np.sqrt((bj**2 + cj**2 - 4 * aj * dj) / (4 * aj**2))
    alpha, beta, way = angles_in_plane(spheres, arc, t0, s0)
    A, B, C = (4 * ri**2 + t0**2 + s0**2 + r0**2) / 2, t0 * r0, s0 * r0
    D, half, mean = A**2 - B**2 - C**2, (beta - alpha) / 2, (alpha + beta) / 2
    y = A * np.cos(half) + B * np.cos(mean) + C * np.sin(mean)
    i1 = 2 / np.sqrt(D) * np.arctan2(np.sqrt(D) * max(np.sin(half), 0.0), y)

    def between_ends(numerator_scale: float, power: int) -> float:
        value = [
            numerator_scale * (-B * np.sin(x) + C * np.cos(x)) / (A + B * np.cos(x) + C * np.sin(x)) ** power
            for x in (alpha, beta)
        ]
        return float(value[1] - value[0])

    i2 = (between_ends(1, 1) + A * i1) / D
    i3 = between_ends(1, 2) / (2 * D) + between_ends(1 / A, 1) / (2 * D) + (2 * A**2 + B**2 + C**2) / (2 * A * D) * i2
    k = r0**2 - A
    return way * (half + k / 2 * i1), way * (i1 / 4 + k / 4 * i2), way * (i2 / 8 + k / 8 * i3)


def angles_in_plane(spheres: Spheres, arc: Arc, t0: float, s0: float) -> tuple[float, float, int]:
    """α < β of the image about (t0, s0), and the way Ω asks to run it; seen from above, where the pole is."""
    circle = rim(spheres, arc.sphere, arc.ball)
    assert circle is not None
    r = float(spheres.radius[arc.sphere])
    point = [circle.at(arc.start + part * arc.sweep) - spheres.center[arc.sphere] for part in (0.0, 0.5, 1.0)]
    start, middle, end = (
        np.arctan2(2 * r * p[1] / (r - p[2]) - s0, 2 * r * p[0] / (r - p[2]) - t0) for p in point
    )
    if arc.next_ball < 0:
        quarter = circle.at(arc.start + 0.25 * arc.sweep) - spheres.center[arc.sphere]
        step = np.arctan2(2 * r * quarter[1] / (r - quarter[2]) - s0, 2 * r * quarter[0] / (r - quarter[2]) - t0)
        forward = (step - start) % TURN < (middle - start) % TURN
        return start, start + TURN, -1 if forward else 1
    forward = (middle - start) % TURN < (end - start) % TURN
    if forward:
        return start, start + (end - start) % TURN, -1
    return end, end + (start - end) % TURN, 1
