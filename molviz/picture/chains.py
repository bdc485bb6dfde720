"""Arcs that continue each other become one path, and pieces of one curve one arc."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.curves import PlaneArcs
from molviz.geometry.intervals import TURN
from molviz.geometry.rows import lists_taken


class Chains(NamedTuple):
    """Half-edges (arc k forwards is 2k, backwards 2k + 1) in the order in which a pen runs; CSR in one level."""

    half_edge: Ints  # (m,)
    start: Ints  # (chains + 1,)
    closed: Bools  # (chains,)

    def take(self, rows: Ints) -> "Chains":
        """Return the given chains, in that order."""
        place, start = lists_taken(self.start, rows)
        return Chains(self.half_edge[place], start, self.closed[rows])


def linked(origin: Ints, target: Ints, curve: Ints, arcs: Ints) -> Chains:
    """Return the given arcs as chains, as long as they can be.

    Where arcs meet in a vertex, two on the same curve continue each other; of what is left, two that are alone do.
    """
    vertex = np.stack([origin[arcs], target[arcs]], axis=1).ravel()
    partner = _partners(vertex, np.repeat(curve[arcs], 2))
    local, start, closed = _walked(partner)
    return Chains(2 * arcs[local >> 1] + (local & 1), start, closed)


def linked_apart(origin: Ints, target: Ints, curve: Ints, arcs: Ints, owner: Ints) -> tuple[Chains, Ints]:
    """Return the given arcs as chains, none of which has arcs of two owners (k,), and the owner of each, ascending."""
    of_arc, count = np.zeros(len(curve), dtype=np.int64), int(owner.max(initial=0)) + 1
    of_arc[arcs] = owner
    chains = linked(origin * count + of_arc, target * count + of_arc, curve, arcs)
    of_chain = of_arc[chains.half_edge[chains.start[:-1]] >> 1]
    order = np.argsort(of_chain, kind="stable")
    place, start = lists_taken(chains.start, order)
    return Chains(chains.half_edge[place], start, chains.closed[order]), of_chain[order]


def _partners(vertex: Ints, curve: Ints) -> Ints:
    """For each end of an arc (2k its start, 2k + 1 its end) the end it continues with, or −1."""
    partner = np.full(len(vertex), -1)
    for key in (curve, np.zeros(len(vertex), dtype=np.int64)):
        free = np.flatnonzero(partner < 0)
        order = free[np.lexsort((key[free], vertex[free]))]
        new = np.append(True, (np.diff(vertex[order]) != 0) | (np.diff(key[order]) != 0))[: len(order)]
        group = np.cumsum(new) - 1
        pairs = np.flatnonzero(new & (np.bincount(group)[group] == 2)) if len(order) else group
        partner[order[pairs]], partner[order[pairs + 1]] = order[pairs + 1], order[pairs]
    return partner


def _walked(partner: Ints) -> tuple[Ints, Ints, Bools]:
    """Walk from end to partner: first the open chains from their loose ends, then the closed ones."""
    link = partner.tolist()
    seen = [False] * (len(link) // 2)
    order: list[int] = []
    start, closed = [0], []
    loose = np.flatnonzero(partner < 0).tolist()
    for first in (*loose, *range(0, len(link), 2)):
        end = first
        while end >= 0 and not seen[end >> 1]:
            seen[end >> 1] = True
            order.append(end)
            end = link[end ^ 1]
        if len(order) > start[-1]:
            start.append(len(order))
            closed.append(end >= 0)
    return np.array(order, dtype=np.int64), np.array(start), np.array(closed, dtype=bool)


def merged_arcs(arcs: PlaneArcs, curve: Ints, chains: Chains) -> tuple[PlaneArcs, Ints]:
    """Return the chains' arcs and CSR offsets, with neighbours on one curve merged into one arc.

    A closed chain that lies on one curve altogether becomes a whole turn.
    """
    chains = _from_break(chains, _breaks(curve, chains))
    breaks = _breaks(curve, chains)
    breaks[chains.start[:-1]] = True
    first = np.flatnonzero(breaks)
    length = np.add.reduceat(arcs.sweep[chains.half_edge >> 1], first) if len(first) else np.empty(0)
    rows = arcs.take(chains.half_edge[first] >> 1)
    back = (chains.half_edge[first] & 1).astype(bool)
    begin = np.where(back, rows.start + rows.sweep, rows.start)
    length = _whole_turns(length, chains, first)
    offset = np.searchsorted(first, chains.start)
    return rows._replace(start=begin, sweep=np.where(back, -length, length)), offset


def _breaks(curve: Ints, chains: Chains) -> Bools:
    """Which rows do not continue the row before (in a closed chain, the first row the last) on the same curve."""
    row = chains.half_edge
    before = np.arange(len(row)) - 1
    before[chains.start[:-1]] = chains.start[1:] - 1
    same = (curve[row >> 1] == curve[row[before] >> 1]) & ((row & 1) == (row[before] & 1))
    alone = before == np.arange(len(row))
    breaks: Bools = ~same | alone
    opens = chains.start[:-1][~chains.closed]
    breaks[opens] = True
    return breaks


def _from_break(chains: Chains, breaks: Bools) -> Chains:
    """Turn closed chains so that they begin where no arc is cut in two."""
    count = np.diff(chains.start)
    chain = np.repeat(np.arange(len(count)), count)
    place = np.arange(len(chain)) - chains.start[chain]
    first = np.full(len(count), np.iinfo(np.int64).max)
    np.minimum.at(first, chain[breaks], place[breaks])
    first = np.where(first == np.iinfo(np.int64).max, 0, first)
    order = np.lexsort((np.mod(place - first[chain], count[chain]), chain))
    return chains._replace(half_edge=chains.half_edge[order])


def _whole_turns(length: Floats, chains: Chains, first: Ints) -> Floats:
    """A closed chain of a single merged arc is a whole turn exactly, not to rounding."""
    offset = np.searchsorted(first, chains.start)
    single = chains.closed & (np.diff(offset) == 1)
    turned = length.copy()
    turned[offset[:-1][single]] = TURN
    return turned
