"""How the user wants a picture, and whose picture it is."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np

from molviz.arrays import Bools, Floats, Ints
from molviz.model.entities import POLYMER, Entities
from molviz.model.molecule import Molecule
from molviz.picture.coloring import AtomColors, ColorSubject, atom_colors, order_of_appearance
from molviz.picture.page import NO_MARGINS, Margins, Page
from molviz.picture.palette import Palette
from molviz.picture.picture import Color
from molviz.picture.style import Style, load_style

Depth: TypeAlias = tuple[float, float]  # the least and the greatest nearness

MOST_CEL = 2000  # atoms: larger things that are no polymers are drawn flat


@dataclass(frozen=True)
class Painted:
    """Atoms that have a colour of their own, and what the legend calls them."""

    atoms: Bools  # (n,)
    color: Color
    name: str


@dataclass(frozen=True)
class Labelled:
    """Atoms that are labelled; ``template`` may name {resn} {resi} {name} {chain} {element}, "" for what is usual."""

    atoms: Bools  # (n,)
    template: str
    name: str  # the selection as it was written


@dataclass(frozen=True)
class DrawOptions:
    """How the user wants a picture; widths in points, None for what is usual or the style's.

    Lengths of the drawing, and those that styles state in ångström, are in lengths of ``unit`` ångström.
    """

    palette: Palette
    style: Style | None = None
    color_by: str | None = None
    fill: str | None = None
    parts: str | None = None
    outline: float | None = None
    crease: float | None = None
    background: Color | None = None
    page: Page = Page()
    legend: bool = False
    title: str = ""
    scale_bar: float | None = None
    unit: float = 1.0  # ångström

    @property
    def is_mask(self) -> bool:
        """Whether colours are names of atoms, which nothing may change."""
        return self.color_by == "index"

    def settled(self, entities: Entities, painted: bool = False) -> "DrawOptions":
        """Return the options with style and scheme chosen by what is drawn; masks and painted pieces are flat."""
        has_polymer = bool(np.any(entities.kind == POLYMER))
        style = self.style or load_style(_usual_style(has_polymer, len(entities.kind)))
        if self.is_mask or painted:
            flat = load_style("flat")
            lines = flat.lines if self.is_mask or not style.lines.outline.width else style.lines
            style = replace(flat, lines=lines, fill="flat" if self.is_mask else _plain(style.fill), colors=style.colors)
        scheme = self.color_by or style.colors.scheme
        if scheme == "entity" and not has_polymer:
            scheme = "element"
        return replace(self, style=style, color_by=scheme)

    def in_unit(self, unit: float) -> "DrawOptions":
        """Return the options for a drawing in lengths of ``unit`` ångström, from those for one in ångström."""
        page = replace(self.page, scale=self.page.scale and self.page.scale * unit)
        return replace(self, page=page, scale_bar=self.scale_bar and self.scale_bar / unit, unit=unit)

    def chosen_style(self) -> Style:
        """Return the style, once settled."""
        assert self.style is not None, "options are settled before a picture is made"
        return self.style


def _plain(fill: str) -> str:
    return "flat" if fill == "ball" else fill


def _usual_style(has_polymer: bool, atoms: int) -> str:
    if has_polymer:
        return "goodsell"
    return "cel" if atoms <= MOST_CEL else "flat"


@dataclass(frozen=True)
class Alike:
    """What the pictures of one set share, so that nothing jumps from one to the next; None for each its own."""

    free: Margins = NO_MARGINS  # points that are kept free beside the drawing
    depth: tuple[Depth, Depth] | None = None  # of what is seen: of the surfaces that fog fades, of centres
    tint: Mapping[str, int] | None = None  # of each polymer chain
    values: tuple[float, float] | None = None  # least and greatest that a continuous scheme shows


@dataclass(frozen=True)
class Subject:
    """The molecule of a drawing, and how its atoms and its size relate to the geometry."""

    molecule: Molecule
    entities: Entities  # of its atoms
    atom: Ints  # (s,) the atom of each sphere
    low: Floats  # (2,) ångström, of the bounding box of all images
    high: Floats  # (2,)
    values: Floats  # (n,) per atom, what a continuous scheme colours by
    painted: tuple[Painted, ...] = ()
    labelled: tuple[Labelled, ...] = ()
    description: str = ""
    alike: Alike = Alike()

    @cached_property
    def seen_molecule(self) -> Molecule:
        """The atoms of the spheres, in their order."""
        return self.molecule.take(self.atom)

    @cached_property
    def chain_number(self) -> Ints:
        """The number of each atom's chain (n,), in order of appearance."""
        return order_of_appearance(self.molecule.chain)

    @property
    def bounds(self) -> tuple[float, float]:
        """The least and the greatest value that a continuous scheme shows, those of the whole set in a set."""
        known = self.values[np.isfinite(self.values)]
        own = (float(known.min()), float(known.max())) if len(known) else (0.0, 0.0)
        return self.alike.values or own

    def colors(self, options: DrawOptions, tint: Ints) -> AtomColors:
        """Return the colours of all atoms (n,); ``options`` are settled."""
        return self._colors(self._about, options, tint, np.arange(len(self.molecule)))

    def seen_colors(self, options: DrawOptions, tint: Ints) -> AtomColors:
        """Return the colours of the spheres (s,) alone, which may be few; ``options`` are settled."""
        return self._colors(self._about.take(self.atom), options, tint, self.atom)

    @property
    def _about(self) -> ColorSubject:
        number = np.arange(len(self.molecule))
        return ColorSubject(self.molecule, self.entities, self.values, self.bounds, number, self.chain_number)

    def _colors(self, about: ColorSubject, options: DrawOptions, tint: Ints, rows: Ints) -> AtomColors:
        style = options.chosen_style()
        colors = atom_colors(str(options.color_by), about, style, options.palette, tint)
        for one in self.painted:
            colors = colors.painted(one.atoms[rows], one.color, style.lines.color)
        return colors
