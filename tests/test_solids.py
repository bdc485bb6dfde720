"""Balls and sticks: each stick in its two balls, and outside of these nothing meets, whatever the atoms are."""

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

import molviz
from molviz.cli import main
from molviz.errors import InputError
from molviz.geometry.solids import LONGEST, MOST_STICKS, BallsAndSticks, solids_of
from molviz.model.bonds import Bonds
from molviz.model.molecule import Molecule
from molviz.model.representations import BALL_AND_STICK, REPRESENTATIONS, SPACEFILL, STICKS, USUAL, Sizes
from molviz.model.spheres import Spheres
from molviz.pipeline.inputs import loaded_from
from molviz.pipeline.solids import SolidOptions, parse_representations, shown, solids_for
from molviz.pipeline.subject import reading_of
from molviz.pipeline.values import input_options_from
from tests.test_door import SAMPLES

CAFFEINE = str(SAMPLES / "caffeine.xyz")


def solids(
    center: object, pairs: object, names: object = BALL_AND_STICK, order: object = None, radius: object = 1.7,
    sizes: Sizes = USUAL,
) -> BallsAndSticks:  # fmt: skip
    """Return the solids of atoms that all have one radius, or each its own, and one representation, or each its own."""
    places = np.array(center, dtype=float)
    bonds = Bonds.of(np.array(pairs), None if order is None else np.array(order, dtype=float))
    spheres = Spheres(places, np.broadcast_to(np.array(radius, dtype=float), len(places)).copy())
    return solids_of(spheres, np.broadcast_to(np.array(names), len(places)), bonds, sizes)


# ---- single bonds


def test_a_bond_of_each_representation() -> None:
    far = [[0, 0, 0], [3, 0, 0]]
    one = solids(far, [[0, 1]])
    assert one.balls.radius.tolist() == [0.425, 0.425] and one.sticks.radius.tolist() == [0.15]
    assert not one.sticks.offset.any() and one.notes == ()
    alone = solids(far, [[0, 1]], STICKS)
    assert alone.balls.radius.tolist() == [0.2, 0.2] and alone.sticks.radius.tolist() == [0.2]
    assert len(solids(far, [[0, 1]], SPACEFILL).sticks.radius) == 0
    with_sizes = solids(far, [[0, 1]], sizes=Sizes(0.5, 0.3))
    assert with_sizes.balls.radius.tolist() == [0.85, 0.85] and with_sizes.sticks.radius.tolist() == [0.3]
    assert solids(far, [[0, 1]], STICKS, sizes=Sizes(0.5, 0.3)).balls.radius.tolist() == [0.3, 0.3]


def test_a_bond_of_two_representations_has_the_thinner_stick() -> None:
    far = [[0, 0, 0], [3, 0, 0]]
    assert solids(far, [[0, 1]], [BALL_AND_STICK, STICKS]).sticks.radius.tolist() == [0.15]
    assert solids(far, [[0, 1]], [SPACEFILL, STICKS]).sticks.radius.tolist() == [0.2]


def test_sticks_among_some_balls_are_numbered_as_these_are() -> None:
    chain = solids([[3.0 * k, 0, 0] for k in range(4)], [[0, 1], [1, 2], [2, 3]]).sticks
    some = chain.among(np.array([3, 2, 0]), 4)
    assert (some.first.tolist(), some.second.tolist(), some.radius.tolist()) == ([1], [0], [0.15])
    assert chain.take(np.array([2, 0])).first.tolist() == [2, 0]


def test_sticks_of_which_nothing_is_seen_are_left_out() -> None:
    assert len(solids([[0, 0, 0], [1.5, 0, 0]], [[0, 1]], [SPACEFILL, STICKS]).sticks.radius) == 0
    assert len(solids([[0, 0, 0], [1.5, 0, 0]], [[0, 1]], sizes=Sizes(0.6)).sticks.radius) == 0


def test_bonds_through_the_cell_and_of_crowds_are_not_drawn() -> None:
    across = solids([[0, 0, 0], [LONGEST + 0.1, 0, 0]], [[0, 1]])
    assert len(across.sticks.radius) == 0 and across.notes[0].startswith("1 bonds longer than 6 Å")
    count = MOST_STICKS + 1
    star = np.vstack([[0, 0, 0], np.random.default_rng(1).normal(size=(count, 3))])
    assert len(solids(star, [[0, k] for k in range(1, count + 1)]).sticks.radius) == 0


def test_a_ball_is_as_wide_as_its_stick() -> None:
    assert solids([[0, 0, 0], [3, 0, 0]], [[0, 1]], sizes=Sizes(0.01, 0.3)).balls.radius.tolist() == [0.3, 0.3]


# ---- several sticks of one bond

ETHENE = [[0, 0, 0], [1.33, 0, 0], [-0.5, 0.9, 0], [-0.5, -0.9, 0], [1.83, 0.9, 0], [1.83, -0.9, 0]]
ETHENE_BONDS = [[0, 1], [0, 2], [0, 3], [1, 4], [1, 5]]


@pytest.mark.parametrize("names", [BALL_AND_STICK, STICKS])
def test_a_double_bond_lies_in_the_plane_of_its_neighbours(names: str) -> None:
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    made = solids(np.array(ETHENE) @ turn.T, ETHENE_BONDS, names, [2, 1, 1, 1, 1])
    double = (made.sticks.first == 0) & (made.sticks.second == 1)
    offset = made.sticks.offset[double] @ turn
    if names == STICKS:
        assert not offset.any() and len(offset) == 1
        return
    assert len(offset) == 2 and np.allclose(offset[:, [0, 2]], 0, atol=1e-12)
    assert np.isclose(offset[0, 1], -offset[1, 1]) and abs(offset[0, 1]) > made.sticks.radius[double][0]
    assert not made.sticks.offset[~double].any()


def test_a_triple_bond_has_three_sticks_though_no_neighbour_tells_a_plane() -> None:
    ethyne = [[0, 0, 0], [1.2, 0, 0], [-1.06, 0, 0], [2.26, 0, 0]]
    made = solids(ethyne, [[0, 1], [0, 2], [1, 3]], order=[3, 1, 1])
    triple = made.sticks.second == 1
    offset = made.sticks.offset[triple]
    assert len(offset) == 3 and np.allclose(offset[:, 0], 0) and np.allclose(offset.sum(axis=0), 0)
    assert len(made.sticks.radius) == 5


def test_the_thinner_stick_of_an_aromatic_bond_is_inside_the_ring() -> None:
    turns = np.arange(6) * np.pi / 3
    ring = 1.39 * np.column_stack([np.cos(turns), np.sin(turns), 0 * turns])
    pairs = [[k, (k + 1) % 6] for k in range(6)] + [[k, k + 6] for k in range(6)]
    made = solids(np.vstack([ring, ring * 2.48 / 1.39]), pairs, order=[1.5] * 6 + [1] * 6)
    inner = np.isclose(made.sticks.radius, 0.15 * 0.25)
    middle = (made.balls.center[made.sticks.first] + made.balls.center[made.sticks.second]) / 2
    outward = np.sum(made.sticks.offset * middle, axis=1)
    assert inner.sum() == 6 and (outward[inner] < 0).all()
    outer = np.isclose(made.sticks.radius, 0.15 * 0.5)
    assert outer.sum() == 6 and (outward[outer] > 0).all()


def test_a_double_bond_of_a_ball_that_reaches_its_middle_is_one_stick() -> None:
    for radius, count in (([1.7, 1.2], 1), ([1.6, 1.6], 2)):
        made = solids([[0, 0, 0], [1.2, 0, 0]], [[0, 1]], order=[2], radius=radius, sizes=Sizes(0.36))
        assert len(made.sticks.radius) == count and made.sticks.offset.any() == (count > 1)


@pytest.mark.parametrize(("order", "count"), [(1.5, 2), (2, 2), (3, 3)])
def test_parallel_sticks_end_near_their_true_ends_or_are_one(order: float, count: int) -> None:
    """By the distance of the plane's ellipse from the ball, all around each stick."""
    oxygen, far = 1.52, [[0, 0, 0], [1.2, 0, 0]]
    assert len(solids(far, [[0, 1]], order=[order], radius=[1.7, oxygen]).sticks.radius) == count
    for scale in np.linspace(0.1, 0.39, 30):
        made = solids(far, [[0, 1]], order=[order], radius=oxygen, sizes=Sizes(float(scale)))
        turn, r = np.linspace(0, 2 * np.pi, 100), made.balls.radius[0]
        for s, offset in zip(made.sticks.radius, made.sticks.offset, strict=True):
            o = float(np.linalg.norm(offset))
            true = np.sqrt(r**2 - o**2 - s**2 - 2 * o * s * np.cos(turn))
            depth = np.sqrt(r**2 - o**2 - s**2)
            assert np.abs(true - (depth - o * s / depth * np.cos(turn))).max() < 1.1e-3


# ---- what sticks may not meet


def bent(degrees: float) -> list[list[float]]:
    """Three atoms with bonds of 1.5 Å at an angle about the first."""
    turn = np.radians(degrees)
    return [[0, 0, 0], [1.5, 0, 0], [1.5 * np.cos(turn), 1.5 * np.sin(turn), 0]]


def test_a_ball_grows_for_bonds_at_a_narrow_angle_and_then_they_are_thinned() -> None:
    pairs = [[0, 1], [0, 2]]
    wide, narrow, sharp = (solids(bent(degrees), pairs) for degrees in (110, 40, 30))
    assert wide.balls.radius.tolist() == [0.425] * 3 and wide.notes == ()
    assert narrow.balls.radius[0] == pytest.approx(1.02 * 0.15 / np.sin(np.radians(20))) and narrow.notes == ()
    assert sharp.balls.radius[0] == pytest.approx(0.45) and (sharp.sticks.radius < 0.15).all()
    assert np.arcsin(sharp.sticks.radius / 0.45).sum() < np.radians(30)
    assert sharp.notes[0].startswith("sticks of 2 bonds are thinner")
    assert solids(bent(30), pairs, STICKS).balls.radius.tolist() == [0.2] * 3  # equal sticks meet in a plane


def test_a_stick_bound_to_a_space_filling_atom_comes_out_of_a_larger_ball() -> None:
    names = [STICKS, SPACEFILL, STICKS]
    made = solids(bent(110), [[0, 1], [0, 2]], names)
    assert made.notes == () and len(made.sticks.radius) == 1 and 0.5 < made.balls.radius[0] < 0.9
    leaves = np.sqrt(made.balls.radius[0] ** 2 - 0.2**2) * np.array(bent(110)[2]) / 1.5
    assert np.linalg.norm(leaves - bent(110)[1]) == pytest.approx(1.02 * 1.9)


def test_a_stick_beside_a_foreign_ball_is_thinned_and_one_through_it_left_out() -> None:
    places, names = [[0, 0, 0], [3, 0, 0], [1.5, 1.8, 0]], [STICKS, STICKS, SPACEFILL]
    beside = solids(places, [[0, 1]], names)
    assert beside.sticks.radius == pytest.approx([1.8 / 1.02 - 1.7]) and beside.notes[0].startswith("sticks of 1 bonds")
    through = solids([*places[:2], [1.5, 1.6, 0]], [[0, 1]], names)
    assert len(through.sticks.radius) == 0 and "left out" in through.notes[0]


def test_of_two_crossing_sticks_the_longer_is_left_out() -> None:
    cross = [[-1, 0, 0], [1, 0, 0], [0, -1.5, 0.1], [0, 1.5, 0.1]]
    made = solids(cross, [[0, 1], [2, 3]])
    assert made.sticks.first.tolist() == [0] and "left out" in made.notes[0]


def surface_of(made: BallsAndSticks, stick: int) -> np.ndarray:
    """Return points of a stick that lie outside its own two balls."""
    sticks, balls = made.sticks, made.balls
    first, second, radius, offset = (column[stick] for column in sticks)
    axis = balls.center[second] - balls.center[first]
    across = np.linalg.svd(axis[None])[2][1:]
    t, turn = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 1, 25), np.linspace(0, 2 * np.pi, 24)))
    ring = radius * (np.cos(turn)[:, None] * across[0] + np.sin(turn)[:, None] * across[1])
    points = balls.center[first] + offset + t[:, None] * axis + ring
    outside = [np.linalg.norm(points - balls.center[end], axis=1) > balls.radius[end] + 1e-9 for end in (first, second)]
    return points[outside[0] & outside[1]]


def inside_stick(made: BallsAndSticks, stick: int, points: np.ndarray) -> np.ndarray:
    first, second, radius, offset = (column[stick] for column in made.sticks)
    begin, axis = made.balls.center[first] + offset, made.balls.center[second] - made.balls.center[first]
    t = (points - begin) @ axis / (axis @ axis)
    return (np.linalg.norm(points - begin - t[:, None] * axis, axis=1) < radius - 1e-9) & (t > 0) & (t < 1)


def is_joint(made: BallsAndSticks, ball: int) -> bool:
    sticks = made.sticks
    mine = (sticks.first == ball) | (sticks.second == ball)
    return bool(np.all(sticks.radius[mine] == made.balls.radius[ball]) and not sticks.offset[mine].any())


def check_apart(made: BallsAndSticks) -> None:
    """Assert that sticks lie in their balls, and that outside of these nothing meets but equal sticks of a joint."""
    balls, sticks = made.balls, made.sticks
    beside = np.linalg.norm(sticks.offset, axis=1)
    axis = balls.center[sticks.second] - balls.center[sticks.first]
    assert np.allclose(np.sum(axis * sticks.offset, axis=1), 0, atol=1e-9)
    for end in (sticks.first, sticks.second):
        assert np.all(np.where(beside > 0, sticks.radius + beside < balls.radius[end], True))
        assert np.all(sticks.radius <= balls.radius[end])
    for stick in range(len(sticks.radius)):
        ends = {int(sticks.first[stick]), int(sticks.second[stick])}
        points = surface_of(made, stick)
        for ball in set(range(len(balls.radius))) - ends:
            assert not np.any(np.linalg.norm(points - balls.center[ball], axis=1) < balls.radius[ball] - 1e-9)
        for other in range(len(sticks.radius)):
            shared = ends & {int(sticks.first[other]), int(sticks.second[other])}
            if other != stick and not any(is_joint(made, ball) for ball in shared):
                assert not inside_stick(made, other, points).any()


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 12), st.floats(0.05, 0.6), st.none() | st.floats(0.05, 0.5))
def test_outside_their_balls_sticks_meet_nothing(seed: int, count: int, scale: float, width: float | None) -> None:
    random = np.random.default_rng(seed)
    places = random.uniform(0, 1.3 * count ** (1 / 3) + 0.5, (count, 3))
    names = random.choice(REPRESENTATIONS[:3], count, p=random.dirichlet([0.3, 1, 1]))
    pairs = random.integers(0, count, (2 * count, 2))
    order = random.choice([1, 1, 1.5, 2, 3], 2 * count)
    check_apart(solids(places, pairs, names, order, random.uniform(1.1, 2, count), Sizes(scale, width)))


@pytest.mark.parametrize("names", [BALL_AND_STICK, STICKS])
@pytest.mark.parametrize("sample", ["caffeine.xyz", "c60.xyz", "1a8o.pdb"])
def test_molecules_need_no_thinner_sticks(sample: str, names: str) -> None:
    made = drawn(str(SAMPLES / sample), names)
    assert made.notes == () and len(np.unique(made.sticks.radius)) <= 2
    if names == STICKS:
        assert np.unique(made.balls.radius).tolist() == [0.2]
    else:
        assert made.balls.radius.max() < 0.51


# ---- options


def drawn(path: str, names: str, bonds: str = "file") -> BallsAndSticks:
    options = SolidOptions((("all", names),), bonds)
    return solids_for(*shown(loaded(path), options), options)


def loaded(path: str, **options: object) -> object:
    usual = {"radii": "bondi", "model": 1, "assembly": None, "select": None, "no_water": False, "no_hydrogens": False,
             "chain": None, "scale_radii": 1.0, "probe": 0.0}  # fmt: skip
    return loaded_from(reading_of(path), input_options_from(usual | options))[0]


@pytest.mark.parametrize(
    ("value", "expected"),
    [("sticks", [("all", "sticks")]), ("resn HEM=Sticks", [("resn HEM", "sticks")]),
     ("bfactor>=20=hide", [("bfactor>=20", "hide")]), (("resn HEM", "hide"), [("resn HEM", "hide")]),
     (("hide", "sticks"), [("all", "hide"), ("all", "sticks")]), ((), []),
     (["sticks", "element C=hide"], [("all", "sticks"), ("element C", "hide")]),
     ([("element C", "hide"), "sticks"], [("element C", "hide"), ("all", "sticks")])],
)  # fmt: skip
def test_representations_as_they_are_written(value: object, expected: list[tuple[str, str]]) -> None:
    assert parse_representations(value) == tuple(expected)


def test_the_last_representation_that_applies_wins() -> None:
    pairs = (("element C O", "hide"), ("all", "sticks"), ("element O", "spacefill"), ("element C", "hide"))
    options = SolidOptions(pairs)
    element = molviz.read(CAFFEINE).models[0].element
    expected = np.where(element == "O", "spacefill", "sticks")[element != "C"]
    left, names = shown(loaded(CAFFEINE), options)
    assert names.tolist() == expected.tolist() and len(left.molecule) == len(left.spheres.radius) == 16


def test_what_is_hidden_is_not_drawn_and_does_not_turn_the_picture() -> None:
    more = {"legend": True, "label": "element O", "color_by": "exposure"}
    hidden = molviz.draw(CAFFEINE, rep="hydrogens=hide", **more)
    assert hidden.svg() == molviz.draw(CAFFEINE, no_hydrogens=True, **more).svg() and hidden.atoms_drawn == 14
    assert molviz.draw(CAFFEINE, rep="within 1.2 of element H=hide", bonds="none").atoms_drawn == 10
    with pytest.raises(InputError, match="all atoms are hidden"):
        molviz.draw(CAFFEINE, rep="hide")


def test_of_elements_that_share_a_site_the_first_has_the_ball_that_sticks_lead_to() -> None:
    center = np.array([[0, 0, 0], [0, 0, 0], [1.6, 0, 0], [3.2, 0, 0], [3.2, 0, 0]], dtype=float)
    site = Molecule.of("zeolite", center, np.array(["Si", "Al", "O", "Si", "Al"]))
    for name, drawn in (("sticks", 3), ("ball-and-stick", 3), ("spacefill", 5)):
        scene = molviz.Scene(site, rep=name)
        assert len(scene.spheres.radius) == drawn and len(scene.sticks.radius) == (2 if drawn == 3 else 0)


def test_a_scene_has_balls_and_sticks() -> None:
    scene = molviz.Scene(CAFFEINE, rep=["sticks", "hydrogens=hide"], stick_radius=0.3)
    assert scene.sticks.radius.tolist() == [0.3] * 15 and scene.spheres.radius.tolist() == [0.3] * 14
    assert len(scene.molecule) == 14 and (scene.molecule.element != "H").all()
    shown = molviz.Scene(CAFFEINE, no_hydrogens=True)
    assert np.array_equal(scene.view.rotation, shown.view.rotation)


def test_bonds_of_the_file_by_distance_or_none() -> None:
    counts = {source: len(drawn(CAFFEINE, "sticks", source).sticks.radius) for source in ("file", "distance", "none")}
    assert counts == {"file": 25, "distance": 25, "none": 0}


@pytest.mark.parametrize(
    ("words", "told"),
    [(["--rep", "stick"], "did you mean 'sticks'?"), (["--rep", "elment C=sticks"], "did you mean 'element'?"),
     (["--rep", "element C="], "expected one of spacefill"), (["--bonds", "files"], "--bonds"),
     (["--ball-scale", "0"], "--ball-scale"), (["--stick-radius", "x"], "--stick-radius")],
)  # fmt: skip
def test_options_that_cannot_be_used_exit_2(words: list[str], told: str) -> None:
    result = CliRunner().invoke(main, ["draw", CAFFEINE, "-o", "-", "--to", "svg", *words])
    assert result.exit_code == 2 and told in result.stderr


def test_discs_have_no_representations() -> None:
    result = CliRunner().invoke(main, ["hidden-lines", "--random", "9", "--rep", "sticks"])
    assert result.exit_code == 2 and "discs lie flat; expected --rep with fused spheres only" in result.stderr
