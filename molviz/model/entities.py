"""What the atoms belong to: polymer chains, which of these are copies of one entity, ligands, ions and water."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Strings, among
from molviz.model.molecule import Molecule
from molviz.model.residues import AMINO_ACIDS, NUCLEOTIDES, WATERS

POLYMER, LIGAND, ION, WATER = range(4)  # kinds of atoms

LINK = 1.9  # ångström: longer than any bond between residues (C-N 1.33, O3'-P 1.61), shorter than any contact
AGREEMENT = 0.8  # part of the residues that copies of one entity have in common
SHORTEST = 0.5  # of the longer chain: a shorter one is a fragment, and no copy
# Words of so many residues tell sequences apart: far more are possible (20⁴, 4¹⁰) than the longest chain has.
PROTEIN_WORD, NUCLEIC_WORD = 4, 10
_UNNAMED = "UNK"  # what some programs call any residue they do not know; an amino acid only where it has an α-carbon


_NONMETALS = "H D He B C N O F Ne Si P S Cl Ar Ge As Se Br Kr Sb Te I Xe At Rn X"  # and half-metals


class Entities(NamedTuple):
    """Columns over n atoms, and over p polymer chains in the order in which the file has them.

    ``polymer`` is the number of an atom's polymer chain and ``entity`` that of the entity which the chain is a copy of,
    by order of first appearance; both are −1 for atoms that belong to no polymer.
    """

    kind: Ints  # (n,) POLYMER, LIGAND, ION or WATER
    polymer: Ints  # (n,)
    entity: Ints  # (n,)
    chain: Strings  # (p,) name
    chain_entity: Ints  # (p,)

    def take(self, rows: Ints) -> "Entities":
        """Return the same of the given atoms; chains are all there are."""
        return self._replace(kind=self.kind[rows], polymer=self.polymer[rows], entity=self.entity[rows])


class _Residues(NamedTuple):
    """Runs of atoms with the same chain, residue and residue name, in the order of the file."""

    start: Ints  # (r,) first atom
    of_atom: Ints  # (n,)
    name: Strings  # (r,)
    chain: Strings  # (r,)
    size: Ints  # (r,)


def entities_of(molecule: Molecule) -> Entities:
    """Return what each atom belongs to.

    Polymer: residues named as amino acids or nucleotides, and residues with any other name (modified ones, caps,
    chromophores) that a bond to the C, N, O3' or P of their neighbour in the file joins to such a residue of the same
    chain; not a lone one that stands away from the rest of its chain, behind other chains or ligands. Water by residue
    name. Ion: a named residue of a single atom. Ligand: everything else, so sugars on proteins, free nucleotides (ATP),
    polymers without any standard residue, and whatever comes from a file without residues.

    Chains are copies of one entity where at least 80 % of their residues agree: see ``chain_entities``.
    """
    residues = _residues(molecule)
    water = among(residues.name, WATERS)
    in_polymer = _in_polymer(molecule, residues, water)
    ion = (residues.size == 1) & (residues.name != "")
    kind = np.select([in_polymer, water, ion], [POLYMER, WATER, ION], LIGAND)
    chain, number = _numbered(residues.chain[in_polymer])
    chain_entity = chain_entities(residues.name[in_polymer], number, len(chain))
    polymer = np.full(len(residues.start), -1)
    polymer[in_polymer] = number
    entity = np.full(len(residues.start), -1)
    entity[in_polymer] = chain_entity[number]
    of_atom = residues.of_atom
    return Entities(kind[of_atom], polymer[of_atom], entity[of_atom], chain, chain_entity)


def is_metal(molecule: Molecule) -> Bools:
    """Return which atoms (n,) are metals; half-metals and unknown elements are none."""
    return ~among(molecule.element, _NONMETALS.split())


def _residues(molecule: Molecule) -> _Residues:
    n = len(molecule)
    begins = np.ones(n, dtype=bool)
    begins[1:] = False
    for column in (molecule.chain, molecule.residue, molecule.residue_name):
        begins[1:] |= column[1:] != column[:-1]
    start = np.flatnonzero(begins)
    name = np.char.upper(molecule.residue_name[start])
    return _Residues(start, np.cumsum(begins) - 1, name, molecule.chain[start], np.diff(start, append=n))


def _numbered(names: Strings) -> tuple[Strings, Ints]:
    """Return the distinct names in the order of their first appearance, and the number of each row's."""
    distinct, first, which = np.unique(names, return_index=True, return_inverse=True)
    order = np.argsort(first)
    return distinct[order], np.argsort(order)[which]


# ---- polymers


def _in_polymer(molecule: Molecule, residues: _Residues, water: Bools) -> Bools:
    """Return which residues (r,) are polymeric, spreading from the standard ones over bonds to their neighbours."""
    in_polymer = among(residues.name, AMINO_ACIDS | NUCLEOTIDES)
    has_alpha = np.isfinite(_places(molecule, residues, "CA")[:, 0])
    in_polymer &= (residues.name != _UNNAMED) | has_alpha
    other = ~in_polymer & ~water & (residues.size > 1) & (residues.name != "")
    after = _bonded(molecule, residues, other, 1, ("N", "P"))
    before = _bonded(molecule, residues, other, -1, ("C", "O3'"))
    while True:
        joined = other & ~in_polymer
        joined &= (after & np.append(in_polymer[1:], False)) | (before & np.append(False, in_polymer[:-1]))
        if not joined.any():
            return in_polymer & ~_strayed(residues.chain, in_polymer)
        in_polymer |= joined


def _strayed(chain: Strings, in_polymer: Bools) -> Bools:
    """Return which polymeric residues (r,) stand alone in the file, away from the rest of their chain."""
    pairs = in_polymer[1:] & in_polymer[:-1] & (chain[1:] == chain[:-1])
    alone = in_polymer.copy()
    alone[1:] &= ~pairs
    alone[:-1] &= ~pairs
    return alone & among(chain, set(chain[in_polymer & ~alone].tolist()))


def _bonded(molecule: Molecule, residues: _Residues, of: Bools, step: int, names: tuple[str, ...]) -> Bools:
    """Return which of some residues (r,) are bonded to an atom so named of the next (step 1) or previous one (−1)."""
    count = len(of)
    neighbor = np.arange(count) + step
    inside = (neighbor >= 0) & (neighbor < count)
    neighbor = np.where(inside, neighbor, 0)
    possible = of & inside & (residues.chain[neighbor] == residues.chain)
    atom = np.flatnonzero(possible[residues.of_atom])
    owner = residues.of_atom[atom]
    bonded = np.zeros(count, dtype=bool)
    for name in names:
        place = _places(molecule, residues, name)[neighbor[owner]]
        gap = ((molecule.position_of(atom) - place) ** 2).sum(axis=1)
        bonded[owner[gap <= LINK**2]] = True  # never true of NaN
    return bonded


def _places(molecule: Molecule, residues: _Residues, name: str) -> Floats:
    """Return where each residue's atom of that name is (r, 3), NaN where it has none."""
    place = np.full((len(residues.start), 3), np.nan)
    atom = np.flatnonzero(molecule.atom_name == name)
    place[residues.of_atom[atom]] = molecule.position_of(atom)
    return place


# ---- copies


def chain_entities(name: Strings, chain: Ints, count: int) -> Ints:
    """Return the entity (count,) of each of ``count`` chains of residues with a name (r,) and a chain number (r,).

    The first chain of an entity stands for it, and a later one is its copy if both are nucleic acids or neither, the
    shorter is at least half as long as the longer, and one of two things holds: they are equally long and agree at 80 %
    of all places; or the shorter has so many words of k successive residues in common with the longer as chains have
    that agree at 80 % of their places, 0.8^k of its words (k 4, in nucleic acids 10). No alignment is needed, and loops
    missing in one copy do no harm. After B. D. Ondov et al. (2016) Mash, Genome Biology 17, 132.
    """
    code = np.unique(name, return_inverse=True)[1]
    order = np.argsort(chain, kind="stable")
    code, chain = code[order], chain[order]
    nucleic = 2 * np.bincount(chain, among(name[order], NUCLEOTIDES), count) > np.bincount(chain, None, count)
    sequences = np.split(code, np.flatnonzero(np.diff(chain)) + 1) if count else []
    first: dict[bytes, int] = {}
    distinct = np.array([first.setdefault(sequence.tobytes(), len(first)) for sequence in sequences], dtype=np.int64)
    _, chosen = np.unique(distinct, return_index=True)
    return _grouped([sequences[row] for row in chosen], nucleic[chosen])[distinct]


def _grouped(sequences: list[Ints], nucleic: Bools) -> Ints:
    """Return the entity of each of some different sequences: each is a copy of the first that it agrees with."""
    length = np.array([len(sequence) for sequence in sequences], dtype=np.int64)
    shared_words = _SharedWords(sequences, nucleic)
    entity = np.full(len(sequences), -1)
    number = 0
    for row in range(len(sequences)):
        if entity[row] >= 0:
            continue
        shorter, longer = np.minimum(length, length[row]), np.maximum(length, length[row])
        open_to = (entity < 0) & (nucleic == nucleic[row]) & (shorter >= SHORTEST * longer)
        alike = shared_words.enough_with(row)
        for other in np.flatnonzero(open_to & ~alike & (length == length[row])):
            alike[other] = (sequences[row] == sequences[other]).mean() >= AGREEMENT
        entity[open_to & alike] = number
        entity[row] = number
        number += 1
    return entity


class _SharedWords:
    """How often each sequence has each word that several sequences have."""

    def __init__(self, sequences: list[Ints], nucleic: Bools) -> None:
        self.length = np.where(nucleic, NUCLEIC_WORD, PROTEIN_WORD)
        words = [_words(sequence, int(length)) for sequence, length in zip(sequences, self.length, strict=True)]
        self.total = np.array([len(word) for word in words], dtype=np.int64)
        owner = np.repeat(np.arange(len(words)), self.total)
        _, word = np.unique(np.concatenate([*words, np.empty(0, np.int64)]), return_inverse=True)
        key, count = np.unique(word * max(len(words), 1) + owner, return_counts=True)
        word, owner = key // max(len(words), 1), key % max(len(words), 1)
        common = np.bincount(word, minlength=1)[word] > 1
        self.word, self.owner, self.count = word[common], owner[common], count[common]
        self.start = np.searchsorted(self.word, np.arange(int(self.word.max(initial=0)) + 2))

    def enough_with(self, row: int) -> Bools:
        """Return which sequences share so many words with the given one as copies do."""
        times = np.zeros(len(self.start), dtype=np.int64)
        own = self.owner == row
        times[self.word[own]] = self.count[own]
        shared = np.bincount(self.owner, np.minimum(times[self.word], self.count), len(self.total))
        fewer = np.minimum(self.total, self.total[row])
        enough: Bools = (fewer > 0) & (shared >= AGREEMENT ** self.length[row] * fewer)
        return enough


def _words(sequence: Ints, length: int) -> Ints:
    """Return a number for each word of the sequence (m − length + 1,); numbers that overflow still tell words apart."""
    places = max(len(sequence) - length + 1, 0)
    words = np.full(places, length)
    for step in range(length):
        words = words * _FACTOR + sequence[step : step + places]
    return words


_FACTOR = 1_000_003  # a prime far above the number of residue names
