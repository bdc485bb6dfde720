"""Copies of one entity that touch on the page get different tints of its colours."""

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.picture.oklab import Colors, lighter, lightness, turn_between, turned
from molviz.picture.palette import Palette, Tones

TURNS = np.array([0.0, 6.0, 8.0, 14.0])  # degrees of hue in OKLab: seen beside each other only
COUNT = len(TURNS)
NEGLIGIBLE = 0.02  # part of the border that a chain has with its likes: so short a touch needs no tint of its own
WHITE = 100.0  # L* of paper, from which a tint is as far as from its copies; else the next one is a darker one
DARKEST, LIGHTEST = 38.0, 95.5  # L* of a tinted carbon: ink is lost on darker ones, the paper's white in lighter ones


def entity_tints(chain_entity: Ints, palette: Palette, one: Ints, other: Ints, weight: Floats, near: Floats) -> Ints:
    """Return a tint (p,) from 0 to 3 for each of p polymer chains: those of one colour that touch differ.

    ``chain_entity`` (p,) says which entity a chain is a copy of; chain ``one[k]`` touches ``other[k]`` with a weight
    (k,), for example the length of their border on the page. A pair may come several times and in either direction;
    rows with a negative number (no polymer) count for nothing. ``near`` (p,) grows towards the eye: among the copies of
    an entity, the tint whose chains are nearest on average is 0, the plain colours; the next is lighter, as haze is, or
    darker where the plain ones are light.
    """
    rows = len(palette.entity)
    like = chain_entity % rows
    known = (one >= 0) & (other >= 0)
    tint = _apart(_borders(like, one[known], other[known], weight[known]))
    for row in range(rows):
        chains = np.flatnonzero(like == row)
        tint[chains] = _nearest_plain(tint[chains], near[chains])
    return tint


def _borders(like: Ints, one: Ints, other: Ints, weight: Floats) -> Floats:
    """Return how much of a border each two like chains have in common (p, p), 0 where nobody would notice it."""
    border = np.zeros((len(like), len(like)))
    alike = (like[one] == like[other]) & (one != other)
    np.add.at(border, (one[alike], other[alike]), weight[alike])
    border += border.T
    whole = border.sum(axis=1)
    border[border < NEGLIGIBLE * np.minimum(whole[:, None], whole)] = 0.0
    return border


def _apart(border: Floats) -> Ints:
    """Return tints (p,) from 0: the least that no neighbour has, or else the one that least border has.

    The next chain is that with most different tints beside it, then with most border. D. Brélaz (1979) New methods to
    color the vertices of a graph. Commun. ACM 22, 251-256.
    """
    tint = np.full(len(border), -1)
    beside = np.zeros((len(border), COUNT))  # border with chains of each tint
    whole = border.sum(axis=1)
    for _ in range(len(border)):
        order = np.lexsort((-whole, -np.count_nonzero(beside, axis=1), tint >= 0))
        chain = order[0]
        tint[chain] = np.argmin(beside[chain])
        beside[:, tint[chain]] += border[chain]
    return tint


def _nearest_plain(tint: Ints, near: Floats) -> Ints:
    """Return the tints (m,) of like chains exchanged, so that 0 is nearest on average, then 1 and so on."""
    _, which = np.unique(tint, return_inverse=True)
    mean = np.bincount(which, near) / np.maximum(np.bincount(which), 1)
    return np.argsort(np.argsort(-mean, kind="stable"))[which]


def shifts(carbon: Colors, step: float) -> Floats:
    """Return by how much L* the tints (..., 4) of colours differ from them: multiples of ``step``, 0 first.

    The nearest multiples that leave L* between the darkest and the lightest that serve, a lighter before a darker one
    unless the colour itself is so light that the next would be nearer to white than to it.
    """
    plain = lightness(carbon)[..., None]
    multiples = np.array([0, 1, -1, 2, -2, 3, -3]) * step * np.where(plain + step > WHITE - step, -1.0, 1.0)
    light = plain + multiples
    refused: Bools = (light < DARKEST) | (light > LIGHTEST)
    refused[..., 0] = False
    order = np.argsort(refused, axis=-1, kind="stable")[..., :COUNT]
    return np.take_along_axis(multiples, order, axis=-1)


def tinted(tones: Tones, step: float) -> Ints:
    """Return carbon and hetero of an entity in all its tints, (4, 2, 3).

    A darker tint turns in hue towards the entity's shade, a lighter one away from it, as colours in daylight do.
    """
    shift = shifts(tones.carbon, step)
    turn = -np.sign(shift) * np.sign(turn_between(tones.carbon, tones.shade)) * TURNS
    both = turned(np.array([tones.carbon, tones.hetero]), turn[:, None])
    return lighter(both, shift[:, None])
