"""Copies of one entity that touch on the page get different tints of its colours."""

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.picture.oklab import Colors, lighter, lightness, turned
from molviz.picture.palette import Palette, Tones

TURNS = np.array([0.0, 6.0, -8.0, -14.0])  # degrees of hue in OKLab: seen beside each other only
COUNT = len(TURNS)
DARKEST, LIGHTEST = 52.0, 94.5  # L* of a tinted carbon: ink is lost on darker ones, the paper's white in lighter ones


def entity_tints(chain_entity: Ints, palette: Palette, one: Ints, other: Ints, weight: Floats, near: Floats) -> Ints:
    """Return a tint (p,) from 0 to 3 for each of p polymer chains: those of one colour that touch differ.

    ``chain_entity`` (p,) says which entity a chain is a copy of; chain ``one[k]`` touches ``other[k]`` with a weight
    (k,), for example the length of their border on the page. A pair may come several times and in either direction;
    rows with a negative number (no polymer) count for nothing. ``near`` (p,) grows towards the eye: of two copies the
    nearer gets the darker tint, since haze lightens what is far.
    """
    rows = len(palette.entity)
    like = chain_entity % rows
    known = (one >= 0) & (other >= 0)
    tint = _greedy(like, one[known], other[known], weight[known])
    shift = shifts([tones.carbon for tones in palette.entity], palette.tint)
    for row in range(rows):
        chains = np.flatnonzero(like == row)
        tint[chains] = _nearest_darkest(tint[chains], near[chains], shift[row])
    return tint


def _greedy(like: Ints, one: Ints, other: Ints, weight: Floats) -> Ints:
    """Return tints (p,), chains with most border first: the least that no neighbour has, or that least border has."""
    border = np.zeros((len(like), len(like)))
    alike = (like[one] == like[other]) & (one != other)
    np.add.at(border, (one[alike], other[alike]), weight[alike])
    border += border.T
    beside = np.zeros((len(like), COUNT))  # border with chains of each tint
    tint = np.zeros(len(like), dtype=np.int64)
    for chain in np.argsort(-border.sum(axis=1), kind="stable"):
        tint[chain] = np.argmin(beside[chain])
        beside[:, tint[chain]] += border[chain]
    return tint


def _nearest_darkest(tint: Ints, near: Floats, shift: Floats) -> Ints:
    """Return the tints (m,) of like chains exchanged, so that those which are nearest on average are darkest."""
    used, which = np.unique(tint, return_inverse=True)
    mean = np.bincount(which, near, len(used)) / np.bincount(which, minlength=len(used))
    darkness = np.empty_like(used)
    darkness[np.argsort(-mean, kind="stable")] = used[np.argsort(shift[used], kind="stable")]
    return darkness[which]


def shifts(carbon: Colors, step: float) -> Floats:
    """Return by how much L* the tints (..., 4) of colours differ from them: multiples of ``step``, 0 first.

    The nearest multiples that leave L* between the darkest and the lightest that serve, a lighter before a darker one.
    """
    multiples = np.array([0, 1, -1, 2, -2, 3, -3]) * step
    light = lightness(carbon)[..., None] + multiples
    refused: Bools = (light < DARKEST) | (light > LIGHTEST)
    refused[..., 0] = False
    order = np.argsort(refused, axis=-1, kind="stable")[..., :COUNT]
    return multiples[order]


def tinted(tones: Tones, step: float) -> Ints:
    """Return carbon and hetero of an entity in all its tints, (4, 2, 3)."""
    turned_tones = turned(np.array([tones.carbon, tones.hetero]), TURNS[:, None])
    return lighter(turned_tones, shifts(tones.carbon, step)[:, None])
