"""How each sphere of a map looks: its colours after fog, what it belongs to, and how far away it is."""

from typing import NamedTuple

import numpy as np

from molviz.arrays import Bools, Floats, Ints, Strings, among
from molviz.model.entities import Entities
from molviz.model.molecule import Molecule
from molviz.picture.coloring import CARBON_TONE
from molviz.picture.ink import smooth_step
from molviz.picture.oklab import mix
from molviz.picture.options import Depth
from molviz.picture.picture import Color
from molviz.picture.style import Fog
from molviz.visibility.eye import projection_of
from molviz.visibility.map import BACKGROUND, VisibilityMap
from molviz.visibility.view import View

NEARER_BY = 0.7  # of its radius: where a sphere's surface, on average, lies before its centre
SHALLOWEST = 3.0  # ångström, about an atom: in flatter molecules what is far would be chance, and differ for two eyes


class Looks(NamedTuple):
    """Columns over the s spheres of a map."""

    fill: Ints  # (s, 3) sRGB, after fog
    ink: Ints  # (s, 3) of inner lines
    shade: Ints  # (s, 3) of contact shade
    group: Ints  # (s,) equal for spheres of one polymer chain or one ligand
    far: Floats  # (s,) 0 for the nearest that is seen, 1 for the farthest unless the drawing is shallow


def nearness(view_map: VisibilityMap, view: View) -> Floats:
    """Return how near the centres (s,) are."""
    return projection_of(view).nearness(view_map.spheres.center)


def depths(view_map: VisibilityMap, view: View, seen: Ints) -> tuple[Depth, Depth]:
    """Return between which nearnesses the surfaces of the spheres ``seen`` lie, and between which their centres."""
    center = nearness(view_map, view)[seen]
    surface = center + NEARER_BY * view_map.spheres.radius[seen]
    return (float(surface.min()), float(surface.max())), (float(center.min()), float(center.max()))


def distances(view_map: VisibilityMap, view: View, depth: Depth, nearer_by: float = 0.0) -> Floats:
    """Return how far spheres (s,) are, 0 for the nearest and 1 for the farthest nearness of ``depth``.

    Less than 1 for the farthest where all lie within SHALLOWEST.
    """
    near = nearness(view_map, view) + nearer_by * view_map.spheres.radius
    low, high = depth
    return np.clip((high - near) / max(high - low, SHALLOWEST), 0.0, 1.0)


def groups(molecule: Molecule, entities: Entities) -> Ints:
    """Return for n atoms what they belong to: the number of their polymer chain, or one for each other residue."""
    place = np.char.add(np.char.add(molecule.chain, "/"), np.char.add(molecule.residue_name, molecule.residue))
    residue = np.unique(place, return_inverse=True)[1].ravel()
    return np.where(entities.polymer >= 0, entities.polymer, len(entities.chain) + residue)


def fogged(fill: Ints, far: Floats, fog: Fog, haze: Color) -> Ints:
    """Return colours (s, 3) mixed with the haze, in steps, so that neighbours at almost one depth stay one colour."""
    if not fog.strength:
        return fill
    share = fog.strength * np.round(fog.steps * smooth_step((far - fog.begin) / (1.0 - fog.begin))) / fog.steps
    return mix(fill, haze, share)


def borders(view_map: VisibilityMap, polymer: Ints) -> tuple[Ints, Ints, Floats]:
    """Return the polymers of the spheres on either side of each arc, −1 for none, and the arc's length on the page."""
    named = np.append(polymer, BACKGROUND)
    length = np.abs(view_map.arcs.sweep) * view_map.arcs.major()
    return named[view_map.left], named[view_map.right], length


def tone_names(scheme: str, molecule: Molecule) -> Strings:
    """Return the name of the tone of each atom (n,): what a region of one colour and chain is made of."""
    if scheme == "element":
        return molecule.element
    if scheme == "residue":
        return molecule.residue_name
    if scheme != "entity":
        return np.full(len(molecule), "")
    carbon: Bools = among(molecule.element, CARBON_TONE)
    return np.where(carbon, "carbon", "hetero")
