"""Polymer chains, copies of one entity, ligands, ions and water."""

import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from molviz.arrays import Ints
from molviz.model.entities import ION, LIGAND, POLYMER, WATER, chain_entities, entities_of, is_metal
from molviz.model.molecule import Molecule
from molviz.model.residues import AMINO_ACIDS
from molviz.picture.coloring import chain_colors, entity_colors, order_of_appearance
from molviz.picture.oklab import lightness
from molviz.picture.palette import load_palette
from molviz.picture.tints import tinted
from molviz.readers import read

SAMPLES = Path(__file__).parent.parent / "samples"
NAMES = np.array(sorted(AMINO_ACIDS))[:20]
BASES = np.array(["A", "C", "G", "U"])
RANDOM = np.random.default_rng(11)


def molecule(*rows: tuple[str, str, str, str, str, float]) -> Molecule:
    """Atoms given as chain, residue, residue name, atom name, element and place on the x axis."""
    chain, residue, residue_name, atom_name, element, x = (np.array(column) for column in zip(*rows, strict=True))
    position = np.column_stack([x, np.zeros((len(rows), 2))])
    columns = {"chain": chain, "residue": residue, "residue_name": residue_name, "atom_name": atom_name}
    return Molecule.of("made", position, element, **columns)


def entities(*sequences: list[str]) -> list[int]:
    name = np.concatenate([np.array(sequence, dtype="U3") for sequence in sequences])
    chain = np.repeat(np.arange(len(sequences)), [len(sequence) for sequence in sequences])
    return chain_entities(name, chain, len(sequences)).tolist()


def sequence(length: int, of: np.ndarray = NAMES) -> list[str]:
    return RANDOM.choice(of, length).tolist()


def mutated(one: list[str], places: Ints, of: np.ndarray = NAMES) -> list[str]:
    """The sequence with another residue at each of the places."""
    other = list(one)
    for place in places.tolist():
        other[place] = str(RANDOM.choice(of[of != one[place]]))
    return other


# ---- copies


def test_copies_lack_loops_and_ends() -> None:
    whole = sequence(200)
    assert entities(whole, whole[6:60] + whole[75:], sequence(200), whole[:150]) == [0, 0, 1, 0]


def test_fragments_are_no_copies() -> None:
    whole = sequence(200)
    assert entities(whole, whole[:99]) == [0, 1]
    assert entities(whole, whole[:100]) == [0, 0]


@pytest.mark.parametrize("of", [NAMES, BASES], ids=["protein", "nucleic"])
def test_equal_lengths_agree_at_eight_of_ten_places(of: np.ndarray) -> None:
    one = sequence(100, of)
    near, far = RANDOM.permutation(100)[:20], np.arange(1, 100, 4)  # in every word of a protein
    assert entities(one, mutated(one, near, of), mutated(one, far, of)) == [0, 0, 1]


def test_shifted_mutants_are_found_by_their_words() -> None:
    one = sequence(300)
    assert entities(one, mutated(one, RANDOM.permutation(300)[:30])[7:]) == [0, 0]


def test_short_chains() -> None:
    assert entities(["ALA", "GLY"], ["ALA", "GLY"], ["GLY", "ALA"], ["A", "C"], ["DA", "DC"]) == [0, 0, 1, 2, 3]
    assert entities(["ALA"]) == [0]
    assert chain_entities(np.empty(0, dtype="U3"), np.empty(0, dtype=np.int64), 0).tolist() == []


def test_rows_of_chains_may_be_mixed() -> None:
    name, chain = np.array(["ALA", "GLY", "GLY", "ALA"]), np.array([0, 1, 0, 1])
    assert chain_entities(name, chain, 2).tolist() == [0, 1]
    assert chain_entities(name[[0, 3, 2, 1]], chain, 2).tolist() == [0, 0]


@given(st.lists(st.integers(0, 4), min_size=1, max_size=12), st.integers(0, 2**32 - 1))
def test_numbers_are_those_of_first_appearance(which: list[int], seed: int) -> None:
    random = np.random.default_rng(seed)
    kinds = [random.choice(NAMES, 40).tolist() for _ in range(4)] + [random.choice(BASES, 60).tolist()]
    order = list(dict.fromkeys(which))
    assert entities(*(kinds[kind] for kind in which)) == [order.index(kind) for kind in which]


def test_a_ribosome_of_strangers_takes_no_time() -> None:
    """80 chains of 3,000 residues, half of them RNA: nobody is anybody's copy, and long RNA is not alike by chance."""
    chains = [sequence(3000, NAMES if number % 2 else BASES) for number in range(80)]
    begun = time.process_time()
    assert entities(*chains) == list(range(80))
    assert time.process_time() - begun < 3.0  # a tenth of it where nothing else runs


# ---- kinds


def test_modified_residues_are_part_of_the_chain_that_they_are_bonded_to() -> None:
    made = molecule(
        ("A", "1", "PCA", "C", "C", 0.0), ("A", "1", "PCA", "CA", "C", 9.0),
        ("A", "2", "GLY", "N", "N", 1.3), ("A", "2", "GLY", "C", "C", 3.0),
        ("A", "3", "CRO", "N1", "N", 4.3), ("A", "3", "CRO", "C3", "C", 6.0),
        ("A", "4", "XYZ", "N1", "N", 50.0), ("A", "4", "XYZ", "C3", "C", 51.0),
        ("B", "1", "GTP", "O3'", "O", 80.0), ("B", "1", "GTP", "PG", "P", 79.0),
        ("B", "2", "G", "P", "P", 81.6), ("B", "2", "G", "O3'", "O", 85.0),
        ("B", "3", "5MU", "P", "P", 86.6), ("B", "3", "5MU", "O3'", "O", 90.0),
        ("B", "4", "7MG", "P", "P", 91.6), ("B", "4", "7MG", "O3'", "O", 95.0),
        ("C", "1", "7MG", "P", "P", 96.0), ("C", "1", "7MG", "O3'", "O", 99.0),
    )  # fmt: skip
    found = entities_of(made)
    assert found.kind.tolist() == [POLYMER] * 6 + [LIGAND] * 2 + [POLYMER] * 8 + [LIGAND] * 2
    assert found.polymer.tolist() == [0] * 6 + [-1] * 2 + [1] * 8 + [-1] * 2
    assert found.entity.tolist() == found.polymer.tolist()
    assert found.chain.tolist() == ["A", "B"]


def test_bonds_reach_modified_residues_one_after_the_other() -> None:
    rows = [("A", "1", "GLY", "C", "C", 0.0), ("A", "1", "GLY", "N", "N", -2.0)]
    for number in range(2, 7):
        x = 3.0 * number - 4.7
        rows += [("A", str(number), "DAL", "N", "N", x), ("A", str(number), "DAL", "C", "C", x + 1.7)]
    made = molecule(*rows)
    assert (entities_of(made).kind == POLYMER).all()
    assert (entities_of(made.take(np.arange(2, 12))).kind == LIGAND).all()


def test_a_free_amino_acid_is_a_ligand() -> None:
    """Only where it stands away from more of its chain; a chain of one residue is a chain."""
    made = molecule(
        ("A", "1", "GLY", "CA", "C", 0.0), ("A", "9", "GLY", "CA", "C", 3.8), ("B", "1", "GLY", "CA", "C", 20.0),
        ("A", "101", "GLU", "CA", "C", 40.0), ("A", "101", "GLU", "C", "C", 41.5),
    )  # fmt: skip
    assert entities_of(made).kind.tolist() == [POLYMER] * 3 + [LIGAND] * 2
    assert (entities_of(made.take(np.array([2, 3, 4]))).kind == POLYMER).all()


def test_ions_water_and_unknown_names() -> None:
    made = molecule(
        ("A", "1", "MG", "MG", "Mg", 0.0), ("A", "2", "CL", "CL", "Cl", 5.0),
        ("A", "3", "HOH", "O", "O", 9.0), ("A", "4", "HEM", "FE", "Fe", 20.0), ("A", "4", "HEM", "NA", "N", 22.0),
        ("A", "5", "UNK", "C1", "C", 30.0), ("A", "5", "UNK", "C2", "C", 31.5),
        ("B", "1", "UNK", "CA", "C", 40.0), ("B", "2", "UNK", "CA", "C", 43.8),
        ("", "", "", "C", "C", 60.0),
    )  # fmt: skip
    found = entities_of(made)
    assert found.kind.tolist() == [ION, ION, WATER, LIGAND, LIGAND, LIGAND, LIGAND, POLYMER, POLYMER, LIGAND]
    assert is_metal(made).tolist() == [True, False, False, True] + [False] * 6


def test_nothing_at_all() -> None:
    found = entities_of(Molecule.of("", np.empty((0, 3)), np.empty(0, dtype="U2")))
    assert [len(column) for column in found] == [0] * 5


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("1tii.pdb.gz", {"D": 0, "E": 0, "F": 0, "G": 0, "H": 0, "A": 1, "C": 2}),
        ("2beg.cif.gz", {"A": 0, "B": 0, "C": 0, "D": 0, "E": 0}),
        ("1hpv.pdb.gz", {"A": 0, "B": 0}),
        ("caffeine.xyz", {}),
        ("nacl.extxyz", {}),
    ],
)
def test_samples(file: str, expected: dict[str, int]) -> None:
    found = entities_of(read(str(SAMPLES / file)).models[0])
    assert dict(zip(found.chain.tolist(), found.chain_entity.tolist(), strict=True)) == expected
    assert np.array_equal(found.polymer >= 0, found.kind == POLYMER)
    assert np.array_equal(found.entity >= 0, found.kind == POLYMER)
    inside = found.polymer >= 0
    assert np.array_equal(found.chain_entity[found.polymer[inside]], found.entity[inside])


# ---- colours


def test_colours_of_a_protease_with_its_inhibitor() -> None:
    made = read(str(SAMPLES / "1hpv.pdb.gz")).models[0]
    found, tide = entities_of(made), load_palette("tide")
    tint = np.array([0, 1])
    colors = entity_colors(made, found, tide, tint)
    carbon = np.isin(made.element, ("C", "H", "D"))
    inside, ligand = found.kind == POLYMER, found.kind == LIGAND
    first, second = inside & (found.polymer == 0), inside & (found.polymer == 1)
    assert (colors.fill[first & carbon] == tide.entity[0].carbon).all()
    assert (colors.fill[first & ~carbon] == tide.entity[0].hetero).all()
    assert (colors.fill[second & carbon] == tinted(tide.entity[0], tide.tint)[1, 0]).all()
    assert (colors.ink[inside] == tide.entity[0].ink).all() and (colors.shade[inside] == tide.entity[0].shade).all()
    assert ligand.any() and (colors.fill[ligand & carbon] == tide.ligand.carbon).all()
    assert (colors.fill[ligand & ~carbon] == tide.ligand.hetero).all()
    assert (colors.ink[ligand] == tide.ligand.ink).all()
    assert abs(lightness(colors.fill[first & carbon][0]) - lightness(colors.fill[second & carbon][0])) >= 8


def test_metals_water_and_many_entities() -> None:
    rows = [("A", "1", "MG", "MG", "Mg", 0.0), ("A", "2", "HOH", "O", "O", 5.0), ("A", "3", "MSE", "SE", "Se", 9.0)]
    rows += [(name, "1", name, "CA", "C", 0.0) for name in NAMES[:7].tolist()]
    made, tide = molecule(*rows), load_palette("tide")
    found = entities_of(made)
    fill = entity_colors(made, found, tide, np.zeros(len(found.chain), dtype=np.int64)).fill
    assert tuple(fill[0]) == tide.metal and tuple(fill[1]) == tide.haze and tuple(fill[2]) == tide.entity[0].hetero
    assert found.entity.tolist() == [-1, -1, 0, 1, 2, 3, 4, 5, 6, 7]
    assert [tuple(row) for row in fill[3:].tolist()] == [tide.entity[k % 6].carbon for k in range(1, 8)]


def test_chain_colours_are_shared_only_when_all_are_used_up() -> None:
    tide = load_palette("tide")
    names = np.repeat([f"C{number}" for number in range(25)], 2)
    colors = chain_colors(order_of_appearance(names), tide)
    assert len(np.unique(colors[:48], axis=0)) == 24
    assert np.array_equal(colors[48:], colors[:2])
    assert chain_colors(order_of_appearance(names[:0]), tide).shape == (0, 3)
    assert order_of_appearance(np.array(["B", "B", "A", "B"])).tolist() == [0, 0, 1, 0]
