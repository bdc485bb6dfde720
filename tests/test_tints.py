"""Copies that touch are told apart, and the nearest have the plain colours."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.picture.oklab import lightness, turn_between
from molviz.picture.palette import PALETTES, load_palette
from molviz.picture.tints import COUNT, entity_tints, shifts, tinted

TIDE = load_palette("tide")


def tints(entity: list[int], contacts: list[tuple[int, int, float]], near: list[float]) -> list[int]:
    one, other, weight = (np.array(column) for column in zip(*contacts, strict=True)) if contacts else [np.empty(0)] * 3
    chosen = entity_tints(
        np.array(entity), TIDE, one.astype(int), other.astype(int), weight.astype(float), np.array(near)
    )
    return chosen.tolist()


def carbon_lightness(entity: int, tint: int) -> float:
    return float(lightness(tinted(TIDE.entity[entity], TIDE.tint)[tint, 0]))


def test_haemoglobin() -> None:
    """Two pairs of copies, all touching: copies differ; the rear is lighter, darker if it would look like paper."""
    contacts = [(a, b, 1.0) for a, b in itertools.combinations(range(4), 2)]
    alpha, beta, other_alpha, other_beta = tints([0, 1, 0, 1], contacts, [3.0, -1.0, 1.0, 2.0])
    assert carbon_lightness(0, other_alpha) - carbon_lightness(0, alpha) >= 8
    assert (alpha, other_beta) == (0, 0)
    assert carbon_lightness(1, other_beta) - carbon_lightness(1, beta) >= 8


def test_who_touches_nothing_alike_has_the_plain_colours() -> None:
    assert tints([0, 1, 0, 2], [(0, 1, 5.0), (1, 2, 1.0), (2, 3, 1.0)], [0.0] * 4) == [0, 0, 0, 0]
    assert tints([], [], []) == []
    assert tints([0, 0], [(0, -1, 5.0), (-1, 1, 5.0), (0, 0, 9.0)], [0.0, 1.0]) == [0, 0]


def test_entities_that_share_a_row_of_the_palette_are_copies_to_the_eye() -> None:
    assert len(set(tints([0, 6], [(0, 1, 1.0)], [0.0, 1.0]))) == 2


def test_a_ring_of_seven_needs_three() -> None:
    ring = [(k, (k + 1) % 7, 1.0) for k in range(7)]
    chosen = tints([0] * 7, ring, [0.0] * 7)
    assert all(chosen[a] != chosen[b] for a, b, _ in ring)
    assert len(set(chosen)) == 3


@given(
    st.lists(st.integers(0, 7), min_size=1, max_size=12),
    st.lists(st.tuples(st.integers(-1, 11), st.integers(-1, 11), st.floats(1.0, 1.5)), max_size=30),
)
def test_any_contacts(entity: list[int], contacts: list[tuple[int, int, float]]) -> None:
    """With fewer than four neighbours alike, no two share a tint; order and direction of contacts do not matter."""
    count = len(entity)
    contacts = [row for row in contacts if row[0] < count and row[1] < count]
    near = [float(7 * k % 5) for k in range(count)]
    chosen = tints(entity, contacts, near)
    assert all(0 <= tint < COUNT for tint in chosen)
    alike = {
        (min(a, b), max(a, b)) for a, b, _ in contacts if a >= 0 <= b and a != b and entity[a] % 6 == entity[b] % 6
    }
    degree = np.bincount([chain for pair in alike for chain in pair], minlength=count)
    if degree.max() < COUNT:
        assert all(chosen[a] != chosen[b] for a, b in alike)
    turned = [(b, a, weight) for a, b, weight in reversed(contacts)]
    if len({weight for _, _, weight in contacts}) == len(contacts):
        assert tints(entity, turned, near) == chosen


def test_a_touch_that_nobody_sees_needs_no_tint() -> None:
    assert tints([0] * 3, [(0, 1, 10.0), (1, 2, 10.0), (0, 2, 0.1)], [2.0, 1.0, 2.0]) == [0, 1, 0]
    assert len(set(tints([0] * 3, [(0, 1, 10.0), (1, 2, 10.0), (0, 2, 0.5)], [2.0, 1.0, 2.0]))) == 3


def test_two_colours_do_for_a_crown() -> None:
    """Six against six, each touching all but its opposite: greedy by number would need a tint for every pair."""
    crown = [(a, 6 + b, 1.0) for a in range(6) for b in range(6) if a != b]
    order = [number // 2 + 6 * (number % 2) for number in range(12)]
    renamed = [(order.index(a), order.index(b), weight) for a, b, weight in crown]
    chosen = tints([0] * 12, renamed, [0.0] * 12)
    assert len(set(chosen)) == 2 and all(chosen[a] != chosen[b] for a, b, _ in renamed)


def test_of_five_that_all_touch_the_least_border_is_given_up() -> None:
    contacts = [(a, b, 10.0) for a, b in itertools.combinations(range(5), 2) if (a, b) != (1, 3)] + [(1, 3, 1.0)]
    chosen = tints([0] * 5, contacts, [0.0] * 5)
    assert [(a, b) for a, b in itertools.combinations(range(5), 2) if chosen[a] == chosen[b]] == [(1, 3)]


@pytest.mark.parametrize("name", PALETTES)
def test_tints_lie_so_far_apart_as_the_palette_says(name: str) -> None:
    palette = load_palette(name)
    for row in palette.entity:
        table = tinted(row, palette.tint)
        assert np.array_equal(table[0], [row.carbon, row.hetero])
        light = np.sort(lightness(table), axis=0)
        assert np.diff(light, axis=0).min() > palette.tint - 0.8
        assert light.max() < 96
    assert np.array_equal(shifts(palette.entity[0].carbon, 0.0), np.zeros(COUNT))


def test_dark_tints_turn_towards_the_shade() -> None:
    for row in TIDE.entity:
        turns = turn_between([row.carbon] * COUNT, tinted(row, TIDE.tint)[:, 0]) * turn_between(row.carbon, row.shade)
        darker = shifts(row.carbon, TIDE.tint) < 0
        assert (turns[darker] > 0).all() and (turns[~darker][1:] < 0).all()


def test_four_copies_differ_by_eight_in_the_default_palette() -> None:
    for row in TIDE.entity:
        assert np.diff(np.sort(lightness(tinted(row, TIDE.tint)[:, 0]))).min() >= 8
