"""Objects of other libraries, made by these themselves, are the molecules that their files are."""

import re
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import ase
import ase.io
import biotite.structure
import gemmi
import MDAnalysis
import numpy as np
import pytest
from biotite.structure.io.pdb import PDBFile
from hypothesis import given, settings
from hypothesis import strategies as st
from rdkit import Chem
from rdkit.Geometry import Point3D

import molviz
from molviz.errors import InputError
from molviz.model.molecule import Molecule
from molviz.pipeline.subject import reading_of
from tests.pdb_lines import atom

SAMPLES = Path(__file__).parent.parent / "samples"
CAFFEINE = str(SAMPLES / "caffeine.xyz")
PROTEIN = str(SAMPLES / "1a8o.pdb")


# ---- the same molecule as an object of each library


def as_ase(molecule: Molecule) -> object:
    return ase.Atoms(molecule.element.tolist(), molecule.position)


def as_structure(molecule: Molecule) -> gemmi.Structure:
    residue = gemmi.Residue()
    residue.name = "LIG"
    for number, (symbol, position) in enumerate(zip(molecule.element.tolist(), molecule.position, strict=True)):
        one = gemmi.Atom()
        one.name, one.element, one.pos = f"{symbol}{number}", gemmi.Element(symbol), gemmi.Position(*position)
        residue.add_atom(one)
    chain, model, structure = gemmi.Chain("A"), gemmi.Model(1), gemmi.Structure()
    chain.add_residue(residue)
    model.add_chain(chain)
    structure.add_model(model)
    return structure


def as_biotite(molecule: Molecule) -> object:
    array = biotite.structure.AtomArray(len(molecule))
    array.coord = molecule.position.astype(np.float32)
    array.element = np.char.upper(molecule.element)
    return array


def as_universe(molecule: Molecule) -> MDAnalysis.Universe:
    universe = MDAnalysis.Universe.empty(len(molecule), trajectory=True)
    universe.add_TopologyAttr("elements", molecule.element.tolist())
    universe.atoms.positions = molecule.position
    return universe


def as_rdkit(molecule: Molecule) -> object:
    mol, conformer = Chem.RWMol(), Chem.Conformer(len(molecule))
    for row, (symbol, position) in enumerate(zip(molecule.element.tolist(), molecule.position.tolist(), strict=True)):
        mol.AddAtom(Chem.Atom(symbol))
        conformer.SetAtomPosition(row, Point3D(*position))
    mol.AddConformer(conformer)
    return mol.GetMol()


MAKERS: dict[str, Callable[[Molecule], object]] = {
    "Molecule": lambda molecule: Molecule.of("made", molecule.position.tolist(), molecule.element.tolist()),
    "ase Atoms": as_ase,
    "gemmi Structure": as_structure,
    "gemmi Model": lambda molecule: as_structure(molecule)[0],
    "biotite AtomArray": as_biotite,
    "MDAnalysis Universe": as_universe,
    "MDAnalysis AtomGroup": lambda molecule: as_universe(molecule).atoms,
    "rdkit Mol": as_rdkit,
}
OPENERS: dict[str, Callable[[], object]] = {
    "Path": lambda: Path(CAFFEINE),
    "Reading": lambda: molviz.read(CAFFEINE),
    "ase file": lambda: ase.io.read(CAFFEINE),
    "MDAnalysis file": lambda: MDAnalysis.Universe(CAFFEINE).atoms,
    "rdkit file": lambda: Chem.MolFromXYZFile(CAFFEINE),
}


def caffeine() -> Molecule:
    return molviz.read(CAFFEINE).models[0]


def strokes_and_fills(svg: str) -> list[tuple[str | None, ...]]:
    """Every path with its colours as they are in force, in the order of drawing."""
    found: list[tuple[str | None, ...]] = []
    sheet = dict(re.findall(r"\.(\w+)\{fill:(#\w+)", svg))

    def walk(element: ElementTree.Element, style: tuple[str | None, ...]) -> None:
        own = ("fill", "stroke", "stroke-width")
        style = tuple(element.get(name, usual) for name, usual in zip(own, style, strict=True))
        painted = [sheet[name] for name in element.get("class", "").split() if name in sheet]
        style = (*painted, *style[len(painted) :])
        if element.tag.endswith("path"):
            found.append((element.get("d"), *style))
        for child in element:
            walk(child, style)

    walk(ElementTree.fromstring(svg), (None, None, None))
    return found


OPTIONS = [{}, {"orient": "file", "rotate": "y,40", "method": "painter"}]


@pytest.mark.parametrize("options", OPTIONS, ids=["map", "pieces"])
@pytest.mark.parametrize("kind", [*MAKERS, *OPENERS])
def test_caffeine_is_the_same_picture_from_every_object(kind: str, options: dict[str, str]) -> None:
    x = MAKERS[kind](caffeine()) if kind in MAKERS else OPENERS[kind]()
    expected = strokes_and_fills(molviz.draw(CAFFEINE, **options).svg())
    assert len(expected) > 24 and {row[1] for row in expected} >= {"#b8bcbf", "#7f9fe0", "#f4f4f2", "#e8776c"}
    assert strokes_and_fills(molviz.draw(x, **options).svg()) == expected


def test_a_pair_of_arrays_is_what_a_file_of_balls_is(tmp_path: Path) -> None:
    rows = [[0.1, 0.2, 0.3, 1.5], [1.7, 0.0, 0.1, 1.2], [0.4, 1.1, -0.7, 0.9]]
    path = tmp_path / "balls.xyzr"
    path.write_text("\n".join(" ".join(map(str, row)) for row in rows), encoding="ascii")
    expected = strokes_and_fills(molviz.draw(path).svg())
    table = np.array(rows)
    for precision in (np.float64, np.float32):
        balls = table.astype(precision)
        assert strokes_and_fills(molviz.draw((balls[:, :3], balls[:, 3])).svg()) == expected
    assert strokes_and_fills(molviz.draw([table[:, :3].tolist(), table[:, 3].tolist()]).svg()) == expected


coordinate = st.integers(-99999, 99999).map(lambda number: number / 1000)


@settings(max_examples=30)
@given(
    st.lists(
        st.tuples(st.sampled_from(["H", "C", "N", "Fe", "Cl", "U"]), coordinate, coordinate, coordinate),
        min_size=1, max_size=6, unique_by=lambda row: row[1:],
    )
)  # fmt: skip
def test_elements_and_coordinates_go_through_every_object(rows: list[tuple[str, float, float, float]]) -> None:
    position, element = np.array([row[1:] for row in rows]), np.array([row[0] for row in rows])
    for kind, maker in MAKERS.items():
        found = reading_of(maker(Molecule.of("any", position, element))).models[0]
        assert found.position.tolist() == position.tolist(), kind
        assert found.element.tolist() == element.tolist(), kind


# ---- what libraries know of a protein

READERS: dict[str, Callable[[], object]] = {
    "ase": lambda: ase.io.read(PROTEIN),
    "gemmi": lambda: gemmi.read_structure(PROTEIN),
    "biotite": lambda: PDBFile.read(PROTEIN).get_structure(model=1, extra_fields=["b_factor"]),
    "MDAnalysis": lambda: MDAnalysis.Universe(PROTEIN),
    "rdkit": lambda: Chem.MolFromPDBFile(PROTEIN, sanitize=False, removeHs=False),
}
NOT_KEPT = {"ase": {"chain"}}  # what the library's own reader loses


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("library", READERS)
def test_names_residues_chains_and_b_factors_are_kept(library: str) -> None:
    expected = molviz.read(PROTEIN).models[0]
    found = reading_of(READERS[library]()).models[0]
    columns = {"position", "element", "atom_name", "residue_name", "residue", "chain", "bfactor"}
    for name in columns - NOT_KEPT.get(library, set()):
        assert getattr(found, name).tolist() == getattr(expected, name).tolist(), name


def test_what_an_object_does_not_know_stays_empty() -> None:
    for kind in ("ase Atoms", "biotite AtomArray", "MDAnalysis Universe", "rdkit Mol"):
        found = reading_of(MAKERS[kind](caffeine())).models[0]
        assert set(found.chain.tolist()) == set(found.residue.tolist()) == {""}, kind
        assert np.isnan(found.bfactor).all() and np.isnan(found.radius).all(), kind


def test_alternate_locations_of_gemmi_go_as_those_of_a_file() -> None:
    lines = [atom(), atom(" CB ", alternate="A"), atom(" CB ", alternate="B")]
    text = "\n".join(lines) + "\n"
    expected = molviz.read("-", text.encode(), "pdb").models[0]
    reading = reading_of(gemmi.read_pdb_string(text))
    assert reading.models[0].atom_name.tolist() == expected.atom_name.tolist()
    assert "1 atoms at alternate locations left out" in reading.warnings[0]


def test_models_of_a_structure_and_conformers_are_counted_from_one() -> None:
    structure = as_structure(caffeine())
    structure.add_model(as_structure(caffeine().take(np.arange(5)))[0])
    with pytest.warns(UserWarning, match="the models differ in atoms: from 5 to 24"):
        assert molviz.draw(structure, model=2).atoms_read == 5
    mol = Chem.Mol(as_rdkit(caffeine()))
    mol.AddConformer(mol.GetConformer(), assignId=True)
    assert len(reading_of(mol).models) == 2


def test_deuterium_of_rdkit_is_kept_apart() -> None:
    mol = Chem.MolFromSmiles("[2H]O[H]", sanitize=False)
    mol.AddConformer(Chem.Conformer(mol.GetNumAtoms()))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # all atoms at the origin
        assert reading_of(mol).models[0].element.tolist() == ["D", "O", "H"]


# ---- bonds


def carbonyl_far_apart() -> Molecule:
    """Three atoms too far apart for bonds by distance."""
    return Molecule.of("made", [[0, 0, 0], [4, 0, 0], [0, 4, 0]], ["C", "O", "C"])


def bonded_rdkit() -> object:
    mol = Chem.RWMol(as_rdkit(carbonyl_far_apart()))
    mol.AddBond(0, 1, Chem.BondType.DOUBLE)
    mol.AddBond(2, 0, Chem.BondType.SINGLE)
    mol.AddBond(1, 2, Chem.BondType.HYDROGEN)
    return mol.GetMol()


def bonded_biotite() -> object:
    array = as_biotite(carbonyl_far_apart())
    array.bonds = biotite.structure.BondList(3, np.array([[0, 1, 2], [2, 0, 1]]))
    return array


def bonded_universe() -> MDAnalysis.Universe:
    universe = as_universe(carbonyl_far_apart())
    universe.add_bonds([(0, 1), (2, 0)], order=["2", None])
    return universe


@pytest.mark.parametrize("maker", [bonded_rdkit, bonded_biotite, bonded_universe])
def test_bonds_and_orders_of_an_object(maker: Callable[[], object]) -> None:
    molecule = reading_of(maker()).models[0]
    assert molecule.bonds.tolist() == [[0, 1], [0, 2]] and molecule.bond_orders.tolist() == [2, 1]


def test_bonds_that_leave_a_group_are_left_out() -> None:
    assert reading_of(bonded_universe().atoms[[2, 0]]).models[0].bonds.tolist() == [[0, 1]]


def test_connections_of_a_structure_are_bonds() -> None:
    structure = as_structure(carbonyl_far_apart())
    names = [f"{symbol}{number}" for number, symbol in enumerate("COC")]
    for kind, asu, other in (("Covale", "Any", 1), ("Hydrog", "Same", 2), ("MetalC", "Different", 2)):
        connection = gemmi.Connection()
        connection.type, connection.asu = getattr(gemmi.ConnectionType, kind), getattr(gemmi.Asu, asu)
        seqid = structure[0]["A"][0].seqid
        connection.partner1 = gemmi.AtomAddress("A", seqid, "LIG", names[0])
        connection.partner2 = gemmi.AtomAddress("A", seqid, "LIG", names[other])
        structure.connections.append(connection)
    assert reading_of(structure).models[0].bonds.tolist() == [[0, 1]]


def test_objects_without_bonds_are_bonded_by_distance() -> None:
    for maker in MAKERS.values():
        assert len(reading_of(maker(caffeine())).models[0].bonds) == 25


# ---- what has no coordinates, and what nobody knows


def test_objects_without_coordinates_are_refused() -> None:
    for x in (Chem.MolFromSmiles("CCO"), MDAnalysis.Universe.empty(3)):
        with pytest.raises(InputError, match=r"^x: .*coordinates"):
            molviz.draw(x)
    for x in (ase.Atoms(), gemmi.Structure(), biotite.structure.AtomArray(0)):
        with pytest.raises(InputError, match="no atoms"):
            molviz.draw(x)


def test_other_objects_of_the_libraries_are_refused() -> None:
    for x in (gemmi.Chain("A"), biotite.structure.AtomArrayStack(1, 2), object()):
        with pytest.raises(InputError, match=f"^x: {type(x).__name__} is nothing made of spheres"):
            molviz.draw(x)


def test_a_subclass_is_what_it_derives_from() -> None:
    class Mine(ase.Atoms):
        pass

    assert molviz.draw(Mine("CO", [[0, 0, 0], [0, 0, 1.1]])).atoms_read == 2


def test_libraries_and_adapters_are_imported_by_nobody_but_their_owner() -> None:
    code = f"""
import sys, molviz
molviz.draw({CAFFEINE!r}).svg()
assert not {{"ase", "gemmi", "biotite", "MDAnalysis", "rdkit"}} & set(sys.modules)
import ase
molviz.draw(ase.Atoms("CO", [[0, 0, 0], [0, 0, 1.1]]))
adapters = {{name for name in sys.modules if name.startswith("molviz.adapters.from_")}}
assert adapters == {{"molviz.adapters.from_ase"}}, adapters
assert not {{"gemmi", "biotite", "MDAnalysis", "rdkit"}} & set(sys.modules)
"""
    subprocess.run([sys.executable, "-c", code], check=True)
