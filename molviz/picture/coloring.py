"""One colour per atom, by what the user asks about."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Strings, among
from molviz.model.entities import WATER, Entities, is_metal
from molviz.model.molecule import Molecule
from molviz.picture.oklab import colors_of, mix
from molviz.picture.palette import Palette
from molviz.picture.picture import Color
from molviz.picture.style import Style
from molviz.picture.tints import tinted

CARBON_TONE = ("C", "H", "D")  # elements in an entity's carbon tone; all others are in its hetero tone


DISCRETE = ("element", "chain", "entity", "residue", "index")
CONTINUOUS = {  # schemes that colour by a number per atom, and what their legends say
    "bfactor": "B factor, Å²",
    "exposure": "exposed area, Å²",
}
DARKER_INK = 0.8  # share of the lines' colour in the inner lines of colours that have none of their own
DARKER_SHADE = 0.7  # the same for their shade


class ColorSubject(NamedTuple):
    """What is to be coloured: a molecule, what its atoms belong to, and what a continuous scheme tells of them."""

    molecule: Molecule
    entities: Entities
    values: Floats  # (n,) NaN unless the scheme is continuous
    bounds: tuple[float, float]  # the values at the ends of the ramp
    number: Ints  # (n,) of each atom in the drawing, from 0
    chain: Ints  # (n,) of each atom's chain, in order of appearance

    def take(self, rows: Ints) -> "ColorSubject":
        """Return the given atoms, whose numbers stay as they are."""
        return ColorSubject(
            self.molecule.take(rows), self.entities.take(rows), self.values[rows], self.bounds, self.number[rows],
            self.chain[rows],
        )  # fmt: skip


class AtomColors(NamedTuple):
    """What an atom is filled with, and the inner lines and contact shade of what it belongs to: sRGB, 0 to 255."""

    fill: Ints  # (n, 3)
    ink: Ints  # (n, 3)
    shade: Ints  # (n, 3)

    def painted(self, atoms: Bools, color: Color, ink: Color) -> "AtomColors":
        """Return the same with the given atoms (n,) in one colour, and darks of it and the ink."""
        own = with_own_darks(np.array([color]), ink)
        columns = (np.where(atoms[:, None], new, old) for new, old in zip(own, self, strict=True))
        return AtomColors(*columns)


def atom_colors(scheme: str, subject: ColorSubject, style: Style, palette: Palette, tint: Ints) -> AtomColors:
    """Return the colours of n atoms; ``tint`` (p,) is that of each polymer chain in the scheme ``entity``."""
    molecule = subject.molecule
    if scheme == "entity":
        return entity_colors(molecule, subject.entities, palette, tint)
    if scheme == "index":
        fill = by_index(subject.number)
    elif scheme in CONTINUOUS:
        fill = np.array(on_ramp(subject.values, style.colors.ramp, style.colors.unknown, subject.bounds))
    elif scheme == "chain":
        fill = chain_colors(subject.chain, palette)
    else:
        table, names = (
            (style.colors.element, molecule.element) if scheme == "element" else
            (style.colors.residue, molecule.residue_name)
        )  # fmt: skip
        fill = np.array([table.get(name, style.colors.unknown) for name in names.tolist()])
    return with_own_darks(fill, style.lines.color)


def with_own_darks(fill: Ints, ink_of_lines: Color) -> AtomColors:
    """Return colours with inks and shades made of them and the colour of the style's lines."""
    distinct, number = np.unique(fill, axis=0, return_inverse=True)
    ink, shade = (mix(distinct, ink_of_lines, share)[number.ravel()] for share in (DARKER_INK, DARKER_SHADE))
    return AtomColors(fill, ink, shade)


def by_index(number: Ints) -> Ints:
    """Return for each atom (n,) the colour whose RGB value is its number plus 1, exactly: a picking mask."""
    value = number + 1
    return np.stack([value >> 16 & 255, value >> 8 & 255, value & 255], axis=1)


def entity_colors(molecule: Molecule, entities: Entities, palette: Palette, tint: Ints) -> AtomColors:
    """Return the colours of n atoms by entity; ``tint`` (p,) is that of each polymer chain, 0 for none.

    Polymers have the tones of their entity (the palette's rows in turn), everything else those of ligands; metals
    outside of polymers have their own colour, and water that of the haze with plain ink.
    """
    tones = [*palette.entity, palette.ligand]
    other, water, outside = len(palette.entity), entities.kind == WATER, entities.polymer < 0
    row = np.where(outside, other, entities.entity % other)
    tint_of_atom = np.where(outside, 0, np.append(tint, 0)[entities.polymer])
    hetero = np.where(among(molecule.element, CARBON_TONE), 0, 1)
    fills = np.array([tinted(one, palette.tint) for one in tones])
    fill = fills[row, tint_of_atom, hetero]
    fill[outside & is_metal(molecule)] = palette.metal
    fill[water] = palette.haze
    ink, shade = np.array([one.ink for one in tones])[row], np.array([one.shade for one in tones])[row]
    ink[water] = shade[water] = palette.ink
    return AtomColors(fill, ink, shade)


def chain_colors(number: Ints, palette: Palette) -> Ints:
    """Return the palette's chain colours (n, 3) in turn, for atoms by the numbers (n,) of their chains.

    They repeat where there are more chains than colours: ``palette.repeats`` tells.
    """
    return np.array(palette.chain)[number % len(palette.chain)]


def order_of_appearance(names: Strings) -> Ints:
    """Return for each name (n,) a running number of the distinct ones; equal names in a row cost little."""
    begins = np.append(True, names[1:] != names[:-1])[: len(names)]
    of_run = names[begins].tolist()
    number = {name: place for place, name in enumerate(dict.fromkeys(of_run))}
    of_each: Ints = np.array([number[name] for name in of_run], dtype=np.int64)
    return of_each.take(np.cumsum(begins) - 1)


def on_ramp(
    values: Floats, ramp: Sequence[Color], unknown: Color, bounds: tuple[float, float] | None = None
) -> list[Color]:
    """Return the colours of values between the bounds, or their least and greatest, linear between the ramp's.

    NaN is unknown.
    """
    known = np.isfinite(values)
    low, high = bounds or ((values[known].min(), values[known].max()) if known.any() else (0.0, 1.0))
    place = np.where(known, (values - low) / max(high - low, np.finfo(float).tiny), 0.0) * (len(ramp) - 1)
    stops = np.array(ramp, dtype=float)
    channels = [np.interp(place, np.arange(len(stops)), stops[:, channel]) for channel in range(3)]
    rows = np.where(known[:, None], np.round(np.stack(channels, axis=1)), unknown).astype(int)
    return colors_of(rows)
