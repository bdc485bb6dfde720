"""Make again, byte for byte, the samples that are built and not taken from the Protein Data Bank.

Needs molviz, RDKit and ASE: ``python samples/make_samples.py [FOLDER]`` (default: the folder of this script).
"""

import sys
from pathlib import Path

import numpy as np
from ase.build import bulk
from rdkit import Chem
from rdkit.Chem import AllChem

from molviz.model.scenes import random_scene, text_scene
from molviz.model.spheres import Spheres

CAFFEINE = "CN1C=NC2=C1C(=O)N(C(=O)N2C)C"
BOND_OF_PENTAGON, BOND_BETWEEN_PENTAGONS = 1.458, 1.401  # Å; Hedberg et al., Science 254 (1991) 410
SODIUM_CHLORIDE_EDGE = 5.6402  # Å; edge of the conventional cell at 25 °C


def xyz(symbols: list[str], positions: np.ndarray, comment: str) -> str:
    """Return XYZ text of n symbols and (n, 3) positions in Å."""
    rows = [
        f"{symbol:<2} {x:13.8f} {y:13.8f} {z:13.8f}" for symbol, (x, y, z) in zip(symbols, positions + 0.0, strict=True)
    ]
    return "\n".join([str(len(rows)), comment, *rows]) + "\n"


def caffeine() -> str:
    """Return caffeine with hydrogens, embedded with a fixed seed and relaxed with MMFF94."""
    molecule = Chem.AddHs(Chem.MolFromSmiles(CAFFEINE))
    AllChem.EmbedMolecule(molecule, randomSeed=1)
    AllChem.MMFFOptimizeMolecule(molecule, maxIters=2000)
    symbols = [atom.GetSymbol() for atom in molecule.GetAtoms()]
    return xyz(symbols, np.round(molecule.GetConformer().GetPositions(), 4), "caffeine, MMFF94")


def buckminsterfullerene() -> str:
    """Return C60: an icosahedron truncated so that both kinds of bond have their measured lengths."""
    golden = (1 + np.sqrt(5)) / 2
    flat = np.array([(0.0, one, golden * other) for one in (-1, 1) for other in (-1, 1)])
    corners = np.concatenate([np.roll(flat, turn, axis=1) for turn in range(3)])  # an icosahedron of edge 2
    apart = np.linalg.norm(corners[:, None] - corners, axis=2)
    start, end = np.nonzero(np.isclose(apart, 2))
    edge = 2 * BOND_OF_PENTAGON + BOND_BETWEEN_PENTAGONS
    cut = BOND_OF_PENTAGON / edge  # edges meet at 60 degrees, so the side of the cut is as long as what it takes away
    atoms = (corners[start] + cut * (corners[end] - corners[start])) * edge / 2
    return xyz(["C"] * len(atoms), np.round(atoms, 8), "buckminsterfullerene, bonds of 1.458 and 1.401")


def sodium_chloride() -> str:
    """Return 3 x 3 x 3 conventional cells of rock salt as extended XYZ."""
    crystal = bulk("NaCl", "rocksalt", a=SODIUM_CHLORIDE_EDGE, cubic=True).repeat(3)
    lattice = " ".join(f"{length:.4f}" for length in crystal.cell.array.ravel())
    comment = f'Lattice="{lattice}" Properties=species:S:1:pos:R:3 pbc="T T T"'
    return xyz(crystal.get_chemical_symbols(), crystal.positions, comment)


def pile() -> str:
    """Return a cubic close packed octahedron of touching balls with the largest balls that fit in its octahedral holes.

    Centres are integers: balls of radius 1/√2 where x + y + z is even, of radius 1 - 1/√2 where it is odd.
    """
    grid = [(x, y, z) for x in range(-4, 5) for y in range(-4, 5) for z in range(-4, 5)]
    radii = (np.sqrt(0.5), 1 - np.sqrt(0.5))
    rows = [f"{x:2d} {y:2d} {z:2d} {radii[(x + y + z) % 2]:.16f}" for x, y, z in grid if abs(x) + abs(y) + abs(z) <= 4]
    return "\n".join(["# x y z r: every ball touches its neighbours", *rows]) + "\n"


def scene(spheres: Spheres, comment: str) -> str:
    """Return one of Franklin's scenes, a hundred times as large and with the front, his smallest z, turned up."""
    rows = 100 * np.column_stack([spheres.center * [1, 1, -1], spheres.radius])
    return "\n".join([f"# {comment}", *(" ".join(f"{value:.4f}" for value in row) for row in rows.tolist())]) + "\n"


def main() -> None:
    """Write all of them into the folder named on the command line."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    samples = {
        "caffeine.xyz": caffeine,
        "c60.xyz": buckminsterfullerene,
        "nacl.extxyz": sodium_chloride,
        "pile.xyzr": pile,
        "cse.xyzr": lambda: scene(text_scene("CSE"), "layers of spheres that spell CSE, as in Franklin 1980, Fig. 5"),
        "gas.xyzr": lambda: scene(random_scene(1000), "Franklin's 1000 random spheres, ten deep"),
    }
    for name, make in samples.items():
        (folder / name).write_text(make(), encoding="utf-8")


if __name__ == "__main__":
    main()
