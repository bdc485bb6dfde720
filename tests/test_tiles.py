"""Maps made tile by tile are those of the whole scene: the same arcs, vertices and faces, to the last bit."""

import pickle
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.model.spheres import Spheres
from molviz.visibility import tiles
from molviz.visibility.map import VisibilityMap
from molviz.visibility.scene import Scene, labelled_map
from molviz.visibility.view import View, principal_axes
from tests.oracle import random_spheres


def crowd(seed: int, count: int) -> Spheres:
    """Balls of which each meets some others and hides some."""
    return random_spheres(seed, count, 2.5 * count ** (1 / 3))


def tables_of(view_map: VisibilityMap) -> list[Any]:
    named = (view_map.spheres, view_map.curves, view_map.curve_arcs, view_map.arcs, view_map.edges, view_map.loops)
    return [column for table in named for column in table]


def assert_same_in_tiles(whole: VisibilityMap, scene: Scene, view: View, size: int) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tiles, "TILE_SPHERES", size)
        in_tiles = scene.map(view)[0]
    for one, other in zip(tables_of(whole), tables_of(in_tiles), strict=True):
        assert np.array_equal(one, other)


@given(st.integers(0, 10**6), st.integers(2, 60), st.integers(1, 20), st.sampled_from([None, 40.0]))
def test_tiles_make_the_map_of_the_whole(seed: int, count: int, size: int, distance: float | None) -> None:
    spheres = crowd(seed, count)
    view = principal_axes(spheres, distance)
    scene = Scene(spheres)
    assert_same_in_tiles(scene.map(view)[0], scene, view, size)


@given(st.integers(0, 10**6), st.integers(1, 9))
def test_tiles_make_the_map_of_labels(seed: int, size: int) -> None:
    spheres = crowd(seed, 30)
    label = np.random.default_rng(seed).integers(0, 3, 30)
    view = principal_axes(spheres)
    whole = labelled_map(spheres, label, view)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tiles, "TILE_SPHERES", size)
        in_tiles = labelled_map(spheres, label, view)
    assert all(map(np.array_equal, tables_of(whole), tables_of(in_tiles)))


def test_each_tile_can_be_sent_away_and_holds_its_neighbourhood_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 2,000 balls, a tile of 50 knows those near them, and others may do it in any order."""
    spheres = crowd(1, 2000)
    view = principal_axes(spheres)
    whole = Scene(spheres).map(view)[0]
    seen: list[tiles.Tile] = []

    def sent(work: Any, parts: Iterable[tiles.Tile]) -> list[Any]:
        seen.extend(pickle.loads(pickle.dumps(part)) for part in parts)
        done = {k: work(seen[k]) for k in reversed(range(len(seen)))}
        return [done[k] for k in range(len(seen))]

    monkeypatch.setattr(tiles, "TILE_SPHERES", 50)
    in_tiles = Scene(spheres, each=sent).map(view)[0]
    assert all(map(np.array_equal, tables_of(whole), tables_of(in_tiles)))
    own = np.concatenate([tile.sphere[tile.own] for tile in seen])
    assert np.array_equal(np.sort(own), np.arange(len(whole.spheres.radius)))
    assert max(len(tile.own) for tile in seen) <= 50 and max(len(tile.sphere) for tile in seen) < 700
