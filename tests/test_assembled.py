"""Copies of a molecule are, atom by atom, what they would be if all columns were written out."""

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import molviz
from molviz.errors import InputError
from molviz.model.assembled import Assembled, BallsOfCopies, Copy
from molviz.model.bonds import Bonds
from molviz.model.molecule import Molecule, column_names
from molviz.model.radii import radii
from molviz.model.selection import is_hydrogen, is_water
from molviz.model.spheres import Spheres, box_of
from molviz.readers import Reading

PLAIN = Molecule.of(
    "two chains", np.arange(21.0).reshape(7, 3), ["N", "C", "O", "H", "O", "Xx", "ZN"],
    chain=["A", "A", "A", "B", "B", "", "B"], residue_name=["GLY", "GLY", "GLY", "GLY", "HOH", "", "ZN"],
    residue=["1", "1", "2A", "1", "9", "", "9"], hetero=[False, False, False, False, True, False, True],
    bfactor=np.linspace(0.0, 60.0, 7), row=np.arange(7) + 3,
    stated_bonds=Bonds.of(np.array([[0, 1], [1, 2], [3, 6]]), np.array([1.0, 2.0, 1.0])),
)  # fmt: skip
QUARTER = np.array([[0.0, -1.0, 0.0, 10.0], [1.0, 0.0, 0.0, 20.0], [0.0, 0.0, 1.0, 30.0]])
SHIFT = np.hstack([np.eye(3), [[0.5], [0.0], [-1.0]]])
COPIES = [
    Copy(np.array([0, 1, 2]), SHIFT, ""), Copy(np.array([0, 1, 2]), QUARTER, "-2"),
    Copy(np.array([3, 4, 5, 6]), QUARTER, "-10"), Copy(np.empty(0, dtype=np.int64), SHIFT, "-11"),
]  # fmt: skip


def written_out(copies: list[Copy]) -> Molecule:
    """The same with every column made at once."""
    parts = [PLAIN.take(copy.rows) for copy in copies]
    columns = {name: np.concatenate([getattr(part, name) for part in parts]) for name in column_names()}
    columns["position"] = np.concatenate(
        [part.position @ copy.operator[:, :3].T + copy.operator[:, 3] for part, copy in zip(parts, copies, strict=True)]
    )
    columns["chain"] = [f"{name}{copy.suffix}" for part, copy in zip(parts, copies, strict=True) for name in part.chain]
    start, bonds, order = 0, [], []
    for part in parts:
        bonds.append(part.stated_bonds.atoms + start)
        order.append(part.stated_bonds.order)
        start += len(part)
    return Molecule(PLAIN.name, **columns, stated_bonds=Bonds.of(np.concatenate(bonds), np.concatenate(order)))


def assert_equal(one: Molecule, other: Molecule) -> None:
    assert len(one) == len(other) and one.name == other.name and repr(one) == repr(other)
    for name in column_names():
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)
        assert getattr(one, name).dtype.kind == getattr(other, name).dtype.kind
    np.testing.assert_array_equal(one.stated_bonds.atoms, other.stated_bonds.atoms)
    np.testing.assert_array_equal(one.stated_bonds.order, other.stated_bonds.order)


def test_columns_of_copies() -> None:
    assert_equal(Assembled.of_copies(PLAIN, COPIES), written_out(COPIES))


@given(st.lists(st.integers(0, 9), max_size=15))
@settings(deadline=None)
def test_some_of_the_atoms_in_any_order(rows: list[int]) -> None:
    wanted = np.array(list(dict.fromkeys(rows)), dtype=np.int64)
    taken = Assembled.of_copies(PLAIN, COPIES).take(wanted)
    assert type(taken) is Molecule
    assert_equal(taken, written_out(COPIES).take(wanted))


@given(st.lists(st.booleans(), min_size=10, max_size=10))
@settings(deadline=None)
def test_atoms_that_are_kept_are_copies_still(keep: list[bool]) -> None:
    whole = Assembled.of_copies(PLAIN, COPIES)
    kept = whole.filtered(np.array(keep))
    assert type(kept) is Assembled and (kept is whole) == all(keep)
    assert_equal(kept, written_out(COPIES).filtered(np.array(keep)))


def test_whoever_replaces_a_column_gets_a_molecule_like_any_other() -> None:
    whole = Assembled.of_copies(PLAIN, COPIES)
    changed = replace(whole, bfactor=np.zeros(10))
    assert type(changed) is Molecule
    assert_equal(changed, replace(written_out(COPIES), bfactor=np.zeros(10)))


def test_copies_have_other_names_and_travel_as_copies() -> None:
    whole = Assembled.of_copies(PLAIN, COPIES).named("other")
    for one in (whole, pickle.loads(pickle.dumps(whole))):  # noqa: S301 (made here)
        assert type(one) is Assembled
        assert_equal(one, written_out(COPIES).named("other"))


def test_rules_that_ask_each_atom_alone_say_the_same() -> None:
    whole, plain = Assembled.of_copies(PLAIN, COPIES), written_out(COPIES)
    for rule in (is_water, is_hydrogen):
        np.testing.assert_array_equal(rule(whole), rule(plain))
    for table in ("bondi", "protor"):
        (radius, notes), (expected, told) = radii(whole, table), radii(plain, table)
        np.testing.assert_array_equal(radius, expected)
        assert notes == told != ()


def test_bonds_are_found_between_copies_as_between_any_atoms() -> None:
    np.testing.assert_array_equal(Assembled.of_copies(PLAIN, COPIES).bonds, written_out(COPIES).bonds)


def test_no_other_attribute() -> None:
    with pytest.raises(AttributeError, match="colour"):
        Assembled.of_copies(PLAIN, COPIES).colour  # noqa: B018


def test_places_and_balls_are_those_of_the_atoms() -> None:
    whole, plain = Assembled.of_copies(PLAIN, COPIES), written_out(COPIES)
    firsts, parts = zip(*whole.places(), strict=True)
    assert firsts == (0, 3, 6) and np.array_equal(np.concatenate(parts), plain.position)
    balls, expected = BallsOfCopies(whole, np.arange(1.0, 11.0)), Spheres(plain.position, np.arange(1.0, 11.0))
    np.testing.assert_array_equal(balls.whole().center, expected.center)
    for rows in (np.array([7, 0, 3, 3]), np.array([], dtype=np.int64)):
        for one, other in zip(balls.take(rows), expected.take(rows), strict=True):
            np.testing.assert_array_equal(one, other)
    for part, (first, last) in zip(balls.parts(), ((0, 3), (3, 6), (6, 10)), strict=True):
        np.testing.assert_array_equal(part.radius, expected.radius[first:last])
        np.testing.assert_array_equal(part.center, expected.center[first:last])
    assert balls.cuts.tolist() == [0, 3, 6, 10, 10] and expected.cuts.tolist() == [0, 10]
    for one, other in zip(box_of(balls), expected.box(), strict=True):
        np.testing.assert_array_equal(one, other)


def ring_of_copies() -> Assembled:
    """Six copies of a random coil of three residues, in a ring that hides some of them, one shifted a little."""
    rng = np.random.default_rng(5)
    position = np.cumsum(rng.normal(size=(90, 3)) * 0.9, axis=0) + [9.0, 0.0, 0.0]
    coil = Molecule.of(
        "coil", position, rng.choice(["C", "C", "N", "O"], 90), chain=np.repeat(["A", "B"], 45),
        residue_name=np.repeat(["ALA", "GLY", "LIG"], 30), residue=np.repeat(["1", "2", "3"], 30),
    )  # fmt: skip
    copies = []
    for number, angle in enumerate(np.radians([0, 60, 120, 180, 240, 300])):
        turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
        operator, suffix = np.column_stack([turn, [0.1 * number, 0, 0]]), f"-{number}" if number else ""
        copies.append(Copy(np.arange(90), operator, suffix))
    return Assembled.of_copies(coil, copies)


@pytest.mark.parametrize("options", [
    {"style": "goodsell"}, {"style": "flat", "perspective": 150.0}, {"style": "flat", "color_by": "chain"},
    {"style": "flat", "select": "not chain A-2"}, {"rep": "sticks"}, {"turntable": 2}, {"method": "painter"},
], ids=str)  # fmt: skip
@pytest.mark.filterwarnings("ignore:coil")
def test_assemblies_are_drawn_as_the_same_atoms_written_out(options: dict[str, Any]) -> None:
    """About the file's axes: sums over copies have other last digits, and principal axes may."""
    copies = ring_of_copies()
    written = copies.take(np.arange(len(copies)))
    assert type(written) is Molecule
    drawn, expected = (
        molviz.draw(Reading("coil", "pdb", (one,), operator_chain=(one.chain,)), orient="file", **options)
        for one in (copies, written)
    )
    assert drawn.svg() == expected.svg()
    if options.keys().isdisjoint(("turntable", "method")):
        assert drawn.to("json") == expected.to("json")


def test_of_an_assembly_only_what_may_be_seen_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither the places nor the names of all atoms are written out, but what tells polymers from ligands."""
    copies, made = ring_of_copies(), set()
    column = type(copies._columns).column
    monkeypatch.setattr(
        type(copies._columns), "column", lambda columns, name: made.add(name) or column(columns, name)
    )
    molviz.draw(Reading("coil", "pdb", (copies,)), style="flat", color_by="element").svg()
    assert made.isdisjoint(("position", "element", "bfactor", "row", "segment", "hetero"))


def test_an_operator_beyond_all_numbers_is_refused() -> None:
    whole = Assembled.of_copies(PLAIN, [Copy(np.arange(7), np.full((3, 4), 1e308), "")])
    for use in (molviz.draw, molviz.measure):
        with pytest.raises(InputError, match="position: row 0 is not finite"):
            use(whole)
