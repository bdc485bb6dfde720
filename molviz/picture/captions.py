"""What is written beside a drawing: the legend of its colours, and labels of atoms."""

from collections.abc import Callable

import numpy as np

from molviz.arrays import Bools, Floats, Ints, among
from molviz.model.entities import ION, LIGAND, WATER
from molviz.model.molecule import Molecule
from molviz.picture.coloring import CARBON_TONE, CONTINUOUS
from molviz.picture.furniture import Label, Ramp, Swatches
from molviz.picture.oklab import colors_of
from molviz.picture.options import DrawOptions, Labelled, Subject
from molviz.picture.picture import Color

PLACEHOLDERS = {  # and the columns of a molecule that they stand for
    "{resn}": "residue_name", "{resi}": "residue", "{chain}": "chain", "{name}": "atom_name", "{element}": "element",
}  # fmt: skip
OF_ATOMS = ("{name}", "{element}")  # placeholders that differ from atom to atom


def legend_of(subject: Subject, options: DrawOptions, fill: Ints) -> Ramp | Swatches:
    """Return what explains the colours: ``fill`` (n, 3) are those of the atoms, before fog."""
    scheme = str(options.color_by)
    if scheme in CONTINUOUS:
        return Ramp(CONTINUOUS[scheme], *subject.bounds, options.chosen_style().colors.ramp)
    painted = np.zeros(len(subject.molecule), dtype=bool)
    for one in subject.painted:
        painted |= one.atoms
    names = _names(subject, scheme)
    wanted = ~painted & (names != "")
    entries = _entries(names, wanted, among(subject.molecule.element, CARBON_TONE), fill)
    return Swatches([*entries, *((one.name, (one.color,)) for one in subject.painted)], _TITLES.get(scheme, ""))


_TITLES = {"chain": "chains", "residue": "residues"}


def _names(subject: Subject, scheme: str) -> "np.ndarray[tuple[int], np.dtype[np.str_]]":
    """What the legend calls each atom (n,), "" for what it leaves out."""
    molecule, entities = subject.molecule, subject.entities
    if scheme == "chain":
        return np.where(molecule.chain == "", "-", molecule.chain)
    if scheme == "residue":
        return molecule.residue_name
    if scheme != "entity":
        return molecule.element
    chains = [
        ", ".join(entities.chain[entities.chain_entity == number].tolist())
        for number in range(int(entities.chain_entity.max(initial=-1)) + 1)
    ]
    of_polymer = np.array([f"chain {name}" if "," not in name else f"chains {name}" for name in chains] or [""])
    kinds = np.select(
        [entities.kind == LIGAND, entities.kind == ION, entities.kind == WATER],
        [molecule.residue_name, molecule.element, "water"], "",
    )  # fmt: skip
    return np.where(entities.entity >= 0, of_polymer[entities.entity], kinds)


def _entries(
    names: "np.ndarray[tuple[int], np.dtype[np.str_]]", wanted: Bools, main: Bools, fill: Ints
) -> list[tuple[str, tuple[Color, ...]]]:
    """Each name once, in order of appearance, with the different colours of its ``main`` atoms (n,) or else its first.

    Copies of an entity in several tints have as many.
    """
    rows = np.flatnonzero(wanted)
    known, name = np.unique(names[rows], return_inverse=True)
    is_main = main[rows]
    first = np.unique(name, return_index=True)[1]
    is_main[first[~np.isin(np.arange(len(known)), name[is_main])]] = True
    rows, name = rows[is_main], name[is_main]
    keys = np.column_stack([name, fill[rows]])
    place = np.sort(np.unique(keys, axis=0, return_index=True)[1])
    colors: dict[str, list[Color]] = {str(known[k]): [] for k in np.argsort(first).tolist()}
    for number, color in zip(name[place].tolist(), colors_of(fill[rows[place]]), strict=True):
        colors[str(known[number])].append(color)
    return [(one, tuple(several)) for one, several in colors.items()]


def labels_of(subject: Subject, seen: Ints, area: Floats, place: Callable[[int], Floats]) -> list[Label]:
    """Return the labels of ``seen`` spheres; ``area`` (s,) is what is seen of each of all, ``place`` tells where (2,).

    A text that names atoms stands at each atom, one that names residues at each residue, any other once; at the
    one of its atoms of which most is seen, and nowhere if none is.
    """
    return [label for wanted in subject.labelled for label in _labels(subject, wanted, seen, area, place)]


def _labels(
    subject: Subject, wanted: Labelled, seen: Ints, area: Floats, place: Callable[[int], Floats]
) -> list[Label]:
    spheres = seen[wanted.atoms[subject.atom[seen]]]
    if not len(spheres):
        return []
    molecule = subject.molecule.take(subject.atom[spheres])
    template = wanted.template or _usual_template(molecule)
    order = np.lexsort((-area[spheres], _units(molecule, template)))
    unit = _units(molecule, template)[order]
    first = order[np.append(True, unit[1:] != unit[:-1])]
    places = [(place(int(spheres[k])), k) for k in np.sort(first).tolist()]
    return [Label(float(x), float(y), _filled(template, molecule, k)) for (x, y), k in places]


def _usual_template(molecule: Molecule) -> str:
    return "{resn} {resi}" if np.any(molecule.residue_name != "") else "{name}"


def _units(molecule: Molecule, template: str) -> Ints:
    """Equal numbers (k,) for atoms that have one label together."""
    if any(word in template for word in OF_ATOMS):
        return np.arange(len(molecule))
    if "{resn}" not in template and "{resi}" not in template and "{chain}" not in template:
        return np.zeros(len(molecule), dtype=np.int64)
    keys = molecule.chain
    if "{resn}" in template or "{resi}" in template:
        keys = np.char.add(np.char.add(keys, "/"), np.char.add(molecule.residue_name, molecule.residue))
    return np.unique(keys, return_inverse=True)[1].ravel()


def _filled(template: str, molecule: Molecule, row: int) -> str:
    for word, column in PLACEHOLDERS.items():
        template = template.replace(word, str(getattr(molecule, column)[row]))
    return template
