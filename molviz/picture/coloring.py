"""One colour per atom, by what the user asks about."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats, Ints, Strings
from molviz.model.entities import WATER, Entities, entities_of, is_metal
from molviz.model.molecule import Molecule
from molviz.picture.oklab import colors_of
from molviz.picture.palette import DEFAULT, Palette, load_palette
from molviz.picture.picture import Color
from molviz.picture.style import Style
from molviz.picture.tints import tinted

CARBON_TONE = ("C", "H", "D")  # elements in an entity's carbon tone; all others are in its hetero tone


def by_element(molecule: Molecule, style: Style) -> list[Color]:
    """The style's colour of each element."""
    return [style.element.get(symbol, style.unknown) for symbol in molecule.element.tolist()]


def by_residue(molecule: Molecule, style: Style) -> list[Color]:
    """The style's colour of each residue name."""
    return [style.residue.get(name, style.unknown) for name in molecule.residue_name.tolist()]


def by_chain(molecule: Molecule, style: Style) -> list[Color]:
    """The style's chain colours in turn, in the order in which chains appear."""
    number = order_of_appearance(molecule.chain)
    return [style.chain[number[name] % len(style.chain)] for name in molecule.chain.tolist()]


def by_entity(molecule: Molecule, style: Style) -> list[Color]:
    """The default palette's tones of each entity, whatever the style, and no tints."""
    entities = entities_of(molecule)
    tint = np.zeros(len(entities.chain), dtype=np.int64)
    return colors_of(entity_colors(molecule, entities, load_palette(DEFAULT), tint).fill)


def by_index(molecule: Molecule, style: Style) -> list[Color]:
    """Atom k has the colour whose RGB value is k + 1, exactly: a picking mask."""
    return [(k >> 16 & 255, k >> 8 & 255, k & 255) for k in range(1, len(molecule) + 1)]


SCHEMES: dict[str, Callable[[Molecule, Style], Sequence[Color]]] = {
    "element": by_element,
    "chain": by_chain,
    "entity": by_entity,
    "residue": by_residue,
    "index": by_index,
}
CONTINUOUS = {  # schemes that colour by a number per atom, and what their legends say
    "bfactor": "B factor, Å²",
    "exposure": "exposed area, Å²",
}


def atom_colors(scheme: str, molecule: Molecule, values: Floats, style: Style) -> Sequence[Color]:
    """Return the colour of each atom; ``values`` (n,) are the numbers of a continuous scheme."""
    return on_ramp(values, style.ramp, style.unknown) if scheme in CONTINUOUS else SCHEMES[scheme](molecule, style)


class EntityColors(NamedTuple):
    """What an atom is filled with, and its entity's inner lines and contact shade: sRGB, 0 to 255."""

    fill: Ints  # (n, 3)
    ink: Ints  # (n, 3)
    shade: Ints  # (n, 3)


def entity_colors(molecule: Molecule, entities: Entities, palette: Palette, tint: Ints) -> EntityColors:
    """Return the colours of n atoms by entity; ``tint`` (p,) is that of each polymer chain, 0 for none.

    Polymers have the tones of their entity (the palette's rows in turn), everything else those of ligands; metals
    outside of polymers have their own colour, and water that of the haze with plain ink.
    """
    tones = [*palette.entity, palette.ligand]
    other, water, outside = len(palette.entity), entities.kind == WATER, entities.polymer < 0
    row = np.where(outside, other, entities.entity % other)
    tint_of_atom = np.where(outside, 0, np.append(tint, 0)[entities.polymer])
    hetero = np.where(np.isin(molecule.element, CARBON_TONE), 0, 1)
    fills = np.array([tinted(one, palette.tint) for one in tones])
    fill = fills[row, tint_of_atom, hetero]
    fill[outside & is_metal(molecule)] = palette.metal
    fill[water] = palette.haze
    ink, shade = np.array([one.ink for one in tones])[row], np.array([one.shade for one in tones])[row]
    ink[water] = shade[water] = palette.ink
    return EntityColors(fill, ink, shade)


def chain_colors(chain: Strings, palette: Palette) -> Ints:
    """Return the palette's chain colours (n, 3) in turn, in the order in which chains appear.

    They repeat where there are more chains than colours: ``palette.repeats`` tells.
    """
    number = order_of_appearance(chain)
    places = np.array([number[name] for name in chain.tolist()], dtype=np.int64)
    return np.array(palette.chain)[places % len(palette.chain)]


def order_of_appearance(names: Strings) -> dict[str, int]:
    """Return a running number for each distinct name."""
    return {name: number for number, name in enumerate(dict.fromkeys(names.tolist()))}


def on_ramp(values: Floats, ramp: Sequence[Color], unknown: Color) -> list[Color]:
    """Return the colours of values between their least and greatest, linear between the ramp's; NaN is unknown."""
    known = np.isfinite(values)
    low, high = (values[known].min(), values[known].max()) if known.any() else (0.0, 1.0)
    place = np.where(known, (values - low) / max(high - low, np.finfo(float).tiny), 0.0) * (len(ramp) - 1)
    stops = np.array(ramp, dtype=float)
    channels = [np.interp(place, np.arange(len(stops)), stops[:, channel]) for channel in range(3)]
    rows = np.where(known[:, None], np.round(np.stack(channels, axis=1)), unknown).astype(int)
    return [(int(r), int(g), int(b)) for r, g, b in rows.tolist()]
