"""Copies of a molecule are, atom by atom, what they would be if all columns were written out."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.errors import InputError
from molviz.model.assembled import Assembled, Copy
from molviz.model.bonds import Bonds
from molviz.model.molecule import Molecule, column_names
from molviz.model.radii import radii
from molviz.model.selection import is_hydrogen, is_water

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


def test_an_operator_beyond_all_numbers_is_refused() -> None:
    with pytest.raises(InputError, match="moves atoms to where no number is"):
        Assembled.of_copies(PLAIN, [Copy(np.arange(7), np.full((3, 4), 1e308), "")])
