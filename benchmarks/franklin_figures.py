"""Figures 1 to 5 of Franklin (1980), drawn again: before and after the removal of hidden lines.

    python benchmarks/franklin_figures.py [FOLDER]
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from molviz.geometry.circles import CircleArcs
from molviz.model.scenes import random_scene, text_scene
from molviz.model.spheres import Spheres
from molviz.picture.disc_picture import DiscLook, disc_picture
from molviz.picture.picture import Picture
from molviz.pipeline.hidden_discs import hide_discs, picture_of
from molviz.write import pieces

FINE, PLAIN = DiscLook(outline=0.2), DiscLook(outline=0.4)


def overlaid(spheres: Spheres, look: DiscLook) -> Picture:
    """Every perimeter whole, before hidden lines are removed."""
    count = len(spheres.radius)
    nobody = np.full(count, -1)
    whole = CircleArcs(np.arange(count), np.zeros(count), np.full(count, 2.0 * np.pi), nobody, nobody)
    return disc_picture(spheres, whole, None, look)


def figures() -> dict[str, Picture]:
    """The pictures by file name, with his captions as titles."""
    gas = random_scene(10000, radius=0.0178)
    perspective = random_scene(1000, radius=0.135, shrink=True)
    letters = hide_discs(text_scene("CSE"))
    pictures = {
        "fig1": (overlaid(gas, FINE), "Ten thousand random spheres, overlaid 10 deep"),
        "fig2": (picture_of(hide_discs(gas), FINE), "The same 10,000 spheres with hidden lines removed"),
        "fig3": (overlaid(perspective, PLAIN), "One thousand random spheres overlaid 10 deep, in perspective"),
        "fig4": (picture_of(hide_discs(perspective), PLAIN), "The same 1000 spheres with hidden lines removed"),
        "fig5": (picture_of(letters, PLAIN), "Spheres spelling CSE with hidden lines removed"),
        "fig5-filled": (picture_of(letters, PLAIN, fill=True), "The same with hidden surfaces removed"),
    }
    return {name: replace(picture, title=title) for name, (picture, title) in pictures.items()}


def main() -> None:
    """Write every figure as SVG and PostScript."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/figures")
    folder.mkdir(parents=True, exist_ok=True)
    for name, picture in figures().items():
        for suffix in (".svg", ".ps"):
            data = b"".join(pieces(picture, suffix))
            (folder / f"franklin-{name}{suffix}").write_bytes(data)
            print(f"{folder}/franklin-{name}{suffix}  {len(data):,} bytes")


if __name__ == "__main__":
    main()
