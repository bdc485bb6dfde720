"""One colour per atom, by what the user asks about."""

from collections.abc import Callable, Sequence

import numpy as np

from molviz.arrays import Floats, Strings
from molviz.model.molecule import Molecule
from molviz.picture.picture import Color
from molviz.picture.style import Style


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


def by_index(molecule: Molecule, style: Style) -> list[Color]:
    """Atom k has the colour whose RGB value is k + 1, exactly: a picking mask."""
    return [(k >> 16 & 255, k >> 8 & 255, k & 255) for k in range(1, len(molecule) + 1)]


SCHEMES: dict[str, Callable[[Molecule, Style], Sequence[Color]]] = {
    "element": by_element,
    "chain": by_chain,
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
