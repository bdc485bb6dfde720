"""Bonds: those of residues against the chemical components, those by distance against the bonds of drugs."""

from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from molviz.errors import InputError
from molviz.geometry.bonds import CLASH, TOLERANCE, bonds_of, covalent_radii
from molviz.model.bonds import Bonds, run_of_atom, standard_residues
from molviz.model.molecule import Molecule
from molviz.model.residues import AMINO_ACIDS, NUCLEOTIDES
from molviz.readers import read

SAMPLES = Path(__file__).parent.parent / "samples"
FORCE_FIELD_NAMES = {  # of AMBER, CHARMM and GROMOS: the dictionary has other compounds of these names, or none
    "ASH", "CYX", "CYM", "GLH", "HID", "HIE", "HIP", "HSD", "HSE", "HSP", "LYN", "ADE", "CYT", "GUA", "THY", "URA",
}  # fmt: skip
DRUGS = {
    "aspirin": "CC(=O)Oc1ccccc1C(=O)O",
    "caffeine": "Cn1c(=O)c2c(ncn2C)n(C)c1=O",
    "penicillin": "CC1(C)S[C@@H]2[C@H](NC(=O)Cc3ccccc3)C(=O)N2[C@H]1C(=O)O",
    "imatinib": "Cc1ccc(NC(=O)c2ccc(CN3CCN(C)CC3)cc2)cc1Nc1nccc(-c2cccnc2)n1",
    "sildenafil": "CCCc1nn(C)c2c1nc([nH]c2=O)-c1cc(ccc1OCC)S(=O)(=O)N1CCN(C)CC1",
    "atorvastatin": "CC(C)c1c(C(=O)Nc2ccccc2)c(-c2ccccc2)c(-c2ccc(F)cc2)n1CC[C@@H](O)C[C@@H](O)CC(=O)O",
    "chlorpromazine": "CN(C)CCCN1c2ccccc2Sc2ccc(Cl)cc21",
    "sofosbuvir": "C[C@@H](C(=O)OC(C)C)NP(=O)(OC[C@@H]1[C@H]([C@@](C)(F)[C@@H](O1)n1ccc(=O)[nH]c1=O)O)Oc1ccccc1",
    "efavirenz": "O=C1Nc2ccc(Cl)cc2[C@@](C#CC2CC2)(C(F)(F)F)O1",
    "amiodarone": "CCCCc1oc2ccccc2c1C(=O)c1cc(I)c(OCCN(CC)CC)c(I)c1",
}


def molecule(*atoms: str, **columns: object) -> Molecule:
    """Return atoms from words of element, x, y and z."""
    words = [atom.split() for atom in atoms]
    return Molecule.of("m", [[float(word) for word in row[1:]] for row in words], [row[0] for row in words], **columns)


def pairs(bonds: Bonds) -> list[tuple[int, int]]:
    return [(int(first), int(second)) for first, second in bonds.atoms]


def by_distance(*atoms: str, **columns: object) -> list[tuple[int, int]]:
    return pairs(bonds_of(molecule(*atoms, **columns), "distance"))


# ---- by distance


@pytest.mark.parametrize("name", DRUGS)
def test_distances_give_the_bonds_of_drugs(name: str) -> None:
    chem, embed = pytest.importorskip("rdkit.Chem"), pytest.importorskip("rdkit.Chem.rdDistGeom")
    mol = chem.AddHs(chem.MolFromSmiles(DRUGS[name]))
    assert embed.EmbedMolecule(mol, randomSeed=7) == 0
    drug = read("t.sdf", chem.MolToMolBlock(mol).encode()).models[0]
    stated, found = set(pairs(bonds_of(drug))), set(pairs(bonds_of(drug, "distance")))
    assert len(stated) == mol.GetNumBonds() and len(stated ^ found) <= 0.005 * len(stated)


@settings(max_examples=60)
@given(st.integers(0, 10**6), st.integers(1, 60))
def test_distances_are_those_of_all_pairs(seed: int, count: int) -> None:
    random = np.random.default_rng(seed)
    element = random.choice(["C", "N", "O", "S", "Fe", "X", "K"], count)
    atoms = Molecule.of("m", random.uniform(0, 2.2 * count ** (1 / 3), (count, 3)), element)
    radius = covalent_radii(atoms)
    expected = []
    for i, j in combinations(range(count), 2):
        gap, reach = float(np.linalg.norm(atoms.position[i] - atoms.position[j])), radius[i] + radius[j]
        lone_pair = {element[i], element[j]} <= {"K", "N", "O", "S"} and {element[i], element[j]} != {"K"}
        if CLASH * reach <= gap < reach + TOLERANCE and ("K" not in (element[i], element[j]) or lone_pair):
            expected.append((i, j))
    assert pairs(bonds_of(atoms, "distance")) == expected


def test_hydrogens() -> None:
    assert by_distance("H 0 0 0", "H 0.74 0 0", "D 5 0 0", "H 5.74 0 0") == [(0, 1), (2, 3)]
    methylene = ("C 0 0 0", "H 1.09 0 0", "H 1.0 0.9 0")  # hydrogens 0.9 Å apart
    assert by_distance(*methylene) == [(0, 1), (0, 2)]
    assert by_distance("O 0 0 0", "H 0.96 0 0", "C 2.3 0 0") == [(0, 1)]  # 1.34 Å from C: a clash
    assert by_distance("B 0 0 0", "B 1.77 0 0", "H 0.885 0.97 0") == [(0, 1), (0, 2), (1, 2)]  # a bridge of diborane


def test_clashes_and_unknown_elements_make_none() -> None:
    assert by_distance("C 0 0 0", "C 0.7 0 0") == [] and by_distance("C 0 0 0", "C 0 0 0") == []
    assert by_distance("X 0 0 0", "C 1.5 0 0") == []
    assert by_distance("C 0 0 0", "C 1.2 0 0") == [(0, 1)]


def test_of_elements_that_share_a_site_the_first_has_the_bonds() -> None:
    """As aluminium and silicon in zeolites do."""
    assert by_distance("Si 0 0 0", "Al 0 0 0", "O 1.6 0 0", "O 1.6 0 0", "Si 3.2 0 0", "Al 3.2 0 0") == [(0, 2), (2, 4)]


def test_metals_coordinate() -> None:
    assert by_distance("Zn 0 0 0", "S 2.35 0 0", "N 0 2.1 0") == [(0, 1), (0, 2)]
    carboxylate = ("Ca 0 0 0", "C 2.8 0 0", "O 2.1 1.1 0", "O 2.1 -1.1 0")
    assert by_distance(*carboxylate) == [(0, 2), (0, 3), (1, 2), (1, 3)]


def test_water_is_bonded_to_itself_and_to_metals() -> None:
    names = ["HOH", "HOH", "HOH", "HOH", "LIG", "MG"]
    atoms = ("O 0 0 0", "H 0.96 0 0", "H -0.24 0.93 0", "O 0 -1.2 1.0", "C -1.4 -0.6 0", "Mg 0 0 -2.1")
    assert by_distance(*atoms, residue_name=names) == [(0, 1), (0, 2), (0, 5)]


def test_no_bonds_across_a_cell() -> None:
    cell = read(SAMPLES / "nacl.extxyz").models[0]
    bonds = bonds_of(cell)
    length = np.linalg.norm(np.diff(cell.position[bonds.atoms], axis=1)[:, 0], axis=1)
    assert len(bonds.atoms) and length.max() < 3


def test_no_bonds_and_unknown_sources() -> None:
    water = molecule("O 0 0 0", "H 0.96 0 0")
    assert pairs(bonds_of(water, "none")) == [] and pairs(bonds_of(water)) == [(0, 1)]
    assert pairs(bonds_of(molecule())) == []
    with pytest.raises(InputError, match=r"^bonds: 'guess'; expected one of file, distance, none"):
        bonds_of(water, "guess")


# ---- residues


def component_bonds(name: str) -> dict[frozenset[str], int]:
    """Return the bonds of the Chemical Component Dictionary, and their orders as it writes them."""
    info = pytest.importorskip("biotite.structure.info")
    order_of = {"SINGLE": 1, "AROMATIC_SINGLE": 1, "DOUBLE": 2, "AROMATIC_DOUBLE": 2, "TRIPLE": 3}
    return {frozenset(bond): order_of[kind.name] for bond, kind in info.bonds_in_residue(name).items()}


def heavy(name: str) -> set[str]:
    info = pytest.importorskip("biotite.structure.info")
    residue = info.residue(name)
    return {str(atom) for atom, element in zip(residue.atom_name, residue.element, strict=True) if element != "H"}


@pytest.mark.parametrize("name", sorted(set(standard_residues()) - FORCE_FIELD_NAMES))
def test_templates_are_the_chemical_components(name: str) -> None:
    atoms = heavy(name)
    template = {frozenset((first, second)): order for first, second, order in standard_residues()[name]}
    expected = {bond: order for bond, order in component_bonds(name).items() if bond <= atoms}
    assert {bond: order for bond, order in template.items() if bond <= atoms} == expected


def test_every_residue_of_a_polymer_has_a_template() -> None:
    ends = {name for name in NUCLEOTIDES if len(name) == 3 and name[-1] in "35"}  # ends of chains in AMBER: by distance
    assert (AMINO_ACIDS | NUCLEOTIDES) - ends == set(standard_residues()) - {"HEM"}


def newer_name(atom: str) -> str:
    """Return the name since 2007 of an atom of a nucleotide."""
    return {"O1P": "OP1", "O2P": "OP2", "C5M": "C7"}.get(atom, atom.replace("*", "'"))


@pytest.mark.parametrize("sample", ["1a8o.pdb", "1tii.pdb.gz", "1lcd.cif.gz", "1a1f.pdb", "1hpv.pdb.gz", "4cup.cif"])
def test_residues_of_samples_are_bonded_as_the_components_say(sample: str) -> None:
    atoms = read(SAMPLES / sample).models[0]
    run = run_of_atom(atoms.chain, atoms.residue, atoms.residue_name)
    bonds = zip(atoms.bonds.tolist(), atoms.bond_orders.tolist(), strict=True)
    inner = {frozenset(pair): order for pair, order in bonds if run[pair[0]] == run[pair[1]]}
    expected: dict[frozenset[int], int] = {}
    for rows in np.split(np.arange(len(run)), np.flatnonzero(np.diff(run)) + 1):
        row_of = {newer_name(str(atoms.atom_name[row])): int(row) for row in rows}
        for pair, order in component_bonds(str(atoms.residue_name[rows[0]])).items():
            if pair <= row_of.keys():
                expected[frozenset(row_of[name] for name in pair)] = order
    light = set(np.flatnonzero(np.isin(atoms.element, ["H", "D"])).tolist())  # whose names differ among programs
    assert {pair for pair in inner.keys() ^ expected.keys() if not pair & light} == set()
    both, residues = inner.keys() & expected.keys(), standard_residues()
    other = {pair for pair in both if inner[pair] != expected[pair]}
    assert {pair for pair in other if str(atoms.residue_name[min(pair)]) in residues} == set()


def test_chains_are_linked_and_disulfides_closed() -> None:
    atoms = read(SAMPLES / "1tii.pdb.gz").models[0]
    across = {
        frozenset((str(atoms.atom_name[first]), str(atoms.atom_name[second])))
        for first, second in bonds_of(atoms).atoms
        if atoms.residue[first] != atoms.residue[second]
    }
    assert across == {frozenset(("C", "N")), frozenset(("SG",))}


def residue(atoms: str, *places: float, name: str = "ALA") -> Molecule:
    names = atoms.split()
    return Molecule.of(
        "m", [[place, 0, 0] for place in places], [atom[0] for atom in names], atom_name=names,
        residue_name=[name] * len(names), residue=["1"] * len(names),
    )  # fmt: skip


def test_names_go_before_distances_in_standard_residues() -> None:
    assert pairs(bonds_of(residue("CA CB", 0, 2.3))) == [(0, 1)]  # badly refined
    assert pairs(bonds_of(residue("N CB", 0, 1.5))) == []  # a clash
    assert pairs(bonds_of(residue("CA CB", 0, 40))) == []  # torn apart by the cell
    assert pairs(bonds_of(residue("CA XY", 0, 1.5))) == []
    assert pairs(bonds_of(residue("C1* O4*", 0, 1.4, name="DA"))) == [(0, 1)]  # as named before 2007
    assert pairs(bonds_of(residue("CA CB", 0, 2.3), "distance")) == []


@pytest.mark.parametrize(
    ("connections", "orders"),
    [((), [2, 1]), (("CONECT    3    4",), [2, 1]), (("CONECT    3    4", "CONECT    2    3    3"), [1, 2])],
)
def test_orders_are_the_files_if_it_has_any_else_the_residues(connections: tuple[str, ...], orders: list[int]) -> None:
    names = ["N", "CA", "C", "O", "OXT"]
    lines = [hetatm(k + 1, name[0], 1.4 * k, "GLY") for k, name in enumerate(names)]
    named = [line[:12] + f" {name:<3}" + line[16:] for line, name in zip(lines, names, strict=True)]
    glycine = pdb(*named, *connections)
    order = dict(zip(pairs(bonds_of(glycine)), bonds_of(glycine).order.tolist(), strict=True))
    assert [order[2, 3], order[1, 2]] == orders and len(order) == 4


# ---- stated by files


def hetatm(serial: int, element: str, x: float, residue: str = "LIG", number: int = 1, alternate: str = " ") -> str:
    place = f"{residue:>3} A{number:4d}    {x:8.3f}   0.000   0.000"
    return f"HETATM{serial:5d}  {element + str(serial):<3}{alternate}{place}  1.00  0.00          {element:>2}"


def pdb(*lines: str) -> Molecule:
    return read("t.pdb", "\n".join(lines).encode()).models[0]


def test_connections_with_orders() -> None:
    atoms = [hetatm(1, "C", 0), hetatm(2, "O", 1.2), hetatm(7, "C", 5)]
    bonds = bonds_of(pdb(*atoms, "CONECT    1    2    2    7", "CONECT    2    1"))
    assert pairs(bonds) == [(0, 1), (0, 2)] and bonds.order.tolist() == [2, 1]


def test_connections_rule_out_distances_and_missing_atoms() -> None:
    atoms = [hetatm(1, "C", 0), hetatm(2, "C", 1.5), hetatm(3, "C", 3.0)]
    assert pairs(bonds_of(pdb(*atoms))) == [(0, 1), (1, 2)]
    assert pairs(bonds_of(pdb(*atoms, "CONECT    1    2", "CONECT    3   99    1"))) == [(0, 1), (0, 2)]
    twice = [hetatm(1, "C", 0), hetatm(1, "C", 5), hetatm(2, "C", 9)]
    assert pairs(bonds_of(pdb(*twice, "CONECT    1    2"))) == []


def test_connections_are_those_of_every_model() -> None:
    model = [hetatm(1, "C", 0), hetatm(2, "C", 4), "ENDMDL"]
    text = "\n".join(["MODEL        1", *model, "MODEL        2", *model, "CONECT    1    2"])
    assert [pairs(bonds_of(one)) for one in read("t.pdb", text.encode()).models] == [[(0, 1)]] * 2


def test_alternate_locations_make_no_bonds() -> None:
    atoms = [hetatm(1, "C", 0), hetatm(2, "C", 1.5, alternate="A"), hetatm(2, "C", 1.4, alternate="B")]
    atoms[2] = atoms[2].replace("HETATM    2", "HETATM    3")
    kept = pdb(*atoms, "CONECT    1    2    3", "CONECT    2    3")
    assert len(kept) == 2 and pairs(bonds_of(kept)) == [(0, 1)]


def test_links_and_disulfides() -> None:
    link = "LINK         C1  LIG A   1                 O2  LIG A   2A  {} {}  9.00"
    atoms = [hetatm(1, "C", 0), hetatm(2, "O", 9, number=2).replace("   2    ", "   2A   ")]
    for here, there, expected in (("1555", "1555", [(0, 1)]), ("1555", "2555", []), ("    ", "    ", [(0, 1)])):
        assert pairs(bonds_of(pdb(link.format("  " + here, "  " + there), *atoms))) == expected
    cysteines = [hetatm(1, "S", 0, "CYS", 3), hetatm(2, "S", 9, "CYS", 40)]
    cysteines = [line.replace("S1 ", "SG ").replace("S2 ", "SG ") for line in cysteines]
    assert pairs(bonds_of(pdb("SSBOND   1 CYS A    3    CYS A   40", *cysteines))) == [(0, 1)]
    assert pairs(bonds_of(pdb("SSBOND   1 CYS A    3    CYS A   41", *cysteines))) == []


CIF = """data_x
loop_
_struct_conn.id
_struct_conn.conn_type_id
_struct_conn.ptnr1_auth_asym_id
_struct_conn.ptnr1_auth_seq_id
_struct_conn.ptnr1_label_atom_id
_struct_conn.ptnr1_symmetry
_struct_conn.ptnr2_auth_asym_id
_struct_conn.ptnr2_auth_seq_id
_struct_conn.ptnr2_label_atom_id
_struct_conn.ptnr2_symmetry
_struct_conn.pdbx_value_order
1 covale A 1 C1 1_555 A 2 C1 1_555 doub
2 metalc A 1 C2 1_555 A 2 C2 2_655 ?
3 hydrog A 1 C1 1_555 A 2 C2 1_555 ?
loop_
_chem_comp_bond.comp_id
_chem_comp_bond.atom_id_1
_chem_comp_bond.atom_id_2
_chem_comp_bond.value_order
LIG C2 C1 trip
loop_
_atom_site.type_symbol
_atom_site.label_atom_id
_atom_site.label_comp_id
_atom_site.auth_asym_id
_atom_site.auth_seq_id
_atom_site.Cartn_x
_atom_site.Cartn_y
_atom_site.Cartn_z
C C1 LIG A 1 0 0 0
C C2 LIG A 1 9 0 0
C C1 LIG A 2 0 4 0
C C2 LIG A 2 9 4 0
"""


def test_connections_and_components_of_mmcif() -> None:
    atoms = read("t.cif", CIF.encode()).models[0]
    bonds = bonds_of(atoms)
    assert pairs(bonds) == [(0, 1), (0, 2), (2, 3)] and bonds.order.tolist() == [3, 2, 3]
    assert pairs(bonds_of(atoms.take(np.array([2, 0])))) == [(0, 1)]


def test_a_molecule_has_its_bonds_when_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[Molecule] = []
    finder = "molviz.geometry.bonds.bonds_of"
    monkeypatch.setattr(finder, lambda molecule: calls.append(molecule) or bonds_of(molecule))
    carbonyl = pdb(hetatm(1, "C", 0), hetatm(2, "O", 1.2), hetatm(3, "C", -1.5), "CONECT    1    2    2    3")
    assert not calls
    assert carbonyl.bonds.tolist() == [[0, 1], [0, 2]] and carbonyl.bond_orders.tolist() == [2, 1]
    assert carbonyl.take(np.array([2, 0])).bonds.tolist() == [[0, 1]] and len(calls) == 2


def test_copies_of_an_assembly_keep_their_bonds() -> None:
    axes = np.eye(3).tolist()
    rows = [
        f"REMARK 350   BIOMT{k + 1}   {n} {axes[k][0]} {axes[k][1]} {axes[k][2]} {30 * n * (k == 0)}.0"
        for n in (1, 2) for k in range(3)
    ]  # fmt: skip
    head = ["REMARK 350 BIOMOLECULE: 1", "REMARK 350 APPLY THE FOLLOWING TO CHAINS: A", *rows]
    atoms = [hetatm(1, "C", 0), hetatm(2, "C", 4), "CONECT    1    2    2"]
    copies = read("t.pdb", "\n".join([*head, *atoms]).encode()).assembly("1")
    assert pairs(bonds_of(copies)) == [(0, 1), (2, 3)] and bonds_of(copies).order.tolist() == [2, 2]


def test_bonds_to_no_atom_are_refused() -> None:
    wrong = Bonds.of(np.array([[0, 2]]))
    with pytest.raises(InputError, match=r"^stated_bonds: row 0 names an atom that is not there"):
        molecule("C 0 0 0", "C 1 0 0", stated_bonds=wrong)


def test_a_long_chain_is_bonded_in_order() -> None:
    for count in (2, 20_000):
        chain = Molecule.of("m", np.outer(np.arange(count) * 1.5, [1, 0, 0]), np.full(count, "C"))
        assert pairs(bonds_of(chain)) == list(pairwise(range(count)))
