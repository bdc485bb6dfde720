"""The visible arcs of large scenes of balls, tile by tile of the page, joined by the names of their ends.

Every sphere belongs to the tile of its centre, with its horizon and the creases of which it is the first. What hides
any of them are spheres whose images overlap its own: the tile's window. These decide the arcs and why they end as if
there were no others, so that no seam has to be sewn: arcs and names are those of the whole scene.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple, TypeAlias

import numpy as np

from molviz.arrays import Bools, Ints, distinct
from molviz.geometry.grid import Neighbours
from molviz.geometry.rows import expand, lists_taken
from molviz.visibility.curves import Curves
from molviz.visibility.named_arcs import Hidden, NamedArcs, joined, visible_arcs
from molviz.visibility.names import TEE, WHOLE
from molviz.visibility.occluders.sphere import SphereOccluders
from molviz.visibility.occlusion import creases_hidden, discs_of, horizons_hidden
from molviz.visibility.own_occlusion import beyond_own_plane
from molviz.visibility.projection import Projection

TILE_SPHERES = 1 << 13  # that belong to a tile: some 5,000 bytes each while it is at work

Each: TypeAlias = Callable[[Callable[["Tile"], NamedArcs], Iterable["Tile"]], Iterable[NamedArcs]]


class Tile(NamedTuple):
    """Spheres that decide the arcs of a tile, in the order of the scene, and the curves that belong to it.

    Curves are the creases, then the horizons of the tile's own spheres.
    """

    spheres: SphereOccluders  # (m,) the window
    near: Neighbours  # (o,) for each own sphere those of the window whose images overlap its own
    creases: Curves  # (c,) between spheres of the window
    inside: Hidden  # what balls hide of the creases
    projection: Projection
    own: Ints  # (o,) spheres of the window, ascending
    sphere: Ints  # (m,) rows of the scene
    curve: Ints  # (c + o,) of the scene


def whole_scene(
    spheres: SphereOccluders, near: Neighbours, creases: Curves, inside: Hidden, projection: Projection
) -> Tile:
    """Return a scene as its only tile.

    ``near`` are the spheres whose images overlap those of each of the n spheres; creases are in the order of their
    first spheres, and ``inside``, what balls hide of them, is in theirs.
    """
    count, balls = len(creases.first), len(near.start) - 1
    rows = np.arange(balls)
    return Tile(spheres, near, creases, inside, projection, rows, rows, np.arange(count + balls))


def visible_arcs_of(scene: Tile, each: Each) -> NamedArcs:
    """Return the visible arcs of all creases and horizons of a scene, ordered by curve.

    ``each`` does the tiles in turn, as ``map`` does, or has others do them.
    """
    if len(scene.own) <= TILE_SPHERES:
        return arcs_of_tile(scene)
    found = list(each(arcs_of_tile, _tiles(scene)))
    arcs = NamedArcs(*(np.concatenate(column) for column in zip(*found, strict=True)))
    return _numbered(arcs.take(np.argsort(arcs.curve, kind="stable")))


def arcs_of_tile(tile: Tile) -> NamedArcs:
    """Return the visible arcs of a tile's own curves, with curves and spheres as the scene numbers them."""
    horizons, count = tile.spheres.horizons(), len(tile.creases.first)
    curves = tile.creases.followed_by(horizons.take(tile.own))
    hidden = joined([tile.inside, *hidden_by_balls(tile, horizons)])
    arcs = visible_arcs(curves, np.arange(count + len(tile.own)), hidden)
    sphere = np.append(tile.sphere, -1)  # row −1 stays −1
    for name in (arcs.origin, arcs.target):
        rows = np.flatnonzero(~_numbers_arc(name))
        name[rows, 1] = sphere[name[rows, 1]]
        name[:, 2:] = sphere[name[:, 2:]]
    curve = tile.curve[arcs.curve]
    return arcs._replace(curve=curve, instance=curve)


def hidden_by_balls(tile: Tile, horizons: Curves) -> list[Hidden]:
    """Return what their own spheres and those in front hide of the creases, curves 0 onwards, and horizons of a tile.

    ``horizons`` are those of the window.
    """
    spheres, creases, nearness = tile.spheres, tile.creases, tile.spheres.nearness()
    count = len(creases.first)
    nearer = np.where(nearness[creases.first] > nearness[creases.second], creases.first, creases.second)
    lists = np.searchsorted(tile.own, creases.first)
    discs = discs_of(horizons, tile.projection)
    return [
        beyond_own_plane(spheres, creases, np.arange(count), nearer),
        horizons_hidden(spheres, horizons, tile.own, tile.near, count),
        *creases_hidden(spheres, creases, tile.projection, tile.near, lists, discs),
    ]


def _tiles(scene: Tile) -> Iterator[Tile]:
    """The scene in tiles of equally many spheres: columns of the page from left to right, each cut from below."""
    center = discs_of(scene.spheres.horizons(), scene.projection).center
    number = math.ceil(len(center) / TILE_SPHERES)
    columns = math.ceil(math.sqrt(number))
    for column in np.array_split(np.argsort(center[:, 0], kind="stable"), columns):
        upwards = column[np.argsort(center[column, 1], kind="stable")]
        for part in np.array_split(upwards, math.ceil(number / columns)):
            yield _tile(scene, np.sort(part))


def _tile(scene: Tile, own: Ints) -> Tile:
    """The tile of some spheres of the scene, ascending."""
    row, start = lists_taken(scene.near.start, own)
    item, crease = scene.near.item[row], _rows_of(scene.creases.first, own)[0]
    creases, (hidden, number_of) = scene.creases.take(crease), _rows_of(scene.inside.curve, crease)
    inside = scene.inside.take(hidden)
    known: Ints = np.concatenate([own, item, creases.second, inside.leaves, inside.enters, [-1]])
    window = distinct(known)[1:]  # without −1, for none

    def number(spheres: Ints) -> Ints:
        return np.where(spheres < 0, -1, np.searchsorted(window, spheres))

    return Tile(
        scene.spheres.take(window),
        Neighbours(start, number(item)),
        creases._replace(first=number(creases.first), second=number(creases.second)),
        inside._replace(curve=number_of, leaves=number(inside.leaves), enters=number(inside.enters)),
        scene.projection,
        number(own),
        window,
        np.append(crease, len(scene.creases.first) + own),
    )


def _rows_of(owner: Ints, items: Ints) -> tuple[Ints, Ints]:
    """The rows of ascending owners (m,) that the given items own, and which item owns each."""
    begin, end = (np.searchsorted(owner, items, side=side) for side in ("left", "right"))
    number, row = expand(begin, end)
    return row, number


def _numbered(arcs: NamedArcs) -> NamedArcs:
    """The arcs with their own rows in the names that number them."""
    for name in (arcs.origin, arcs.target):
        rows = np.flatnonzero(_numbers_arc(name))
        name[rows, 1] = rows
    return arcs


def _numbers_arc(name: Ints) -> Bools:
    """Whether the first number of each name (k, 4) is that of an arc, and not of a sphere."""
    return np.isin(name[:, 0] >> 1, (TEE, WHOLE))
