"""Balls and sticks in many views: masks of random molecules against a z-buffer, and all checks of maps of samples.

    python -m tests.stick_soak [--seed 0] [--scenes 200] [--views 300]

Scene and view k of a seed are always the same.
"""

import argparse
import sys
import time
from itertools import product

import numpy as np

from molviz.errors import InternalError
from molviz.picture.options import DrawOptions
from molviz.picture.palette import load_palette
from molviz.pipeline.draw import DrawRequest, drawings_of
from molviz.pipeline.inputs import InputOptions, load
from molviz.pipeline.solids import SolidOptions
from tests.test_stick_masks import SAMPLES, random_molecule, views_of, wrong_pixels

NAMES = ("ball-and-stick", "sticks")
DIRECTIONS = 6  # of each scene, every other one central
LARGEST = 8000  # atoms of a sample that is checked, so that none takes all the time


def masks(seed: int, scenes: int) -> int:
    """Return how many masks have wrong pixels, in SVG and PostScript."""
    failed = 0
    for number in range(scenes):
        loaded = random_molecule(1000 * seed + number, 4 + number % 9)
        options = SolidOptions((("all", NAMES[number % 2]),))
        for suffix in (".svg", ".eps"):
            for view, wrong in enumerate(wrong_pixels(loaded, options, views_of(loaded, number, DIRECTIONS), suffix)):
                if wrong:
                    failed += 1
                    print(f"scene {number}, view {view}, {suffix}: {wrong} pixels", flush=True)
    return failed


def checks(seed: int, views: int) -> int:
    """Return how many maps of samples, in every representation in turn, are not as maps must be."""
    samples = [path for path in sorted(SAMPLES.iterdir()) if path.suffix in (".pdb", ".gz", ".cif", ".xyz", ".extxyz")]
    molecules = [load(str(path), InputOptions())[0] for path in samples]
    molecules = [loaded for loaded in molecules if len(loaded.molecule) <= LARGEST]
    turns = list(product(molecules, (*NAMES, "spacefill")))
    look, failed = DrawOptions(load_palette("tide")), 0
    for number in range(views):
        loaded, name = turns[number % len(turns)]
        view = views_of(loaded, 1000 * seed + number, 2)[int(np.random.default_rng([seed, number]).integers(2))]
        request = DrawRequest(look, solids=SolidOptions((("all", name),)))
        try:
            drawings_of(loaded, request, [view], check=True)
        except InternalError as wrong:
            failed += 1
            print(f"view {number} of {loaded.source}, {name}: {wrong}", flush=True)
    return failed


def main() -> None:
    """Try what is asked for."""
    parser = argparse.ArgumentParser(description="Try balls and sticks in many views; prints what is wrong.")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--views", type=int, default=300)
    asked, began = parser.parse_args(), time.monotonic()
    wrong = masks(asked.seed, asked.scenes)
    print(f"{2 * DIRECTIONS * asked.scenes} masks of {asked.scenes} scenes, {wrong} wrong", flush=True)
    failed = checks(asked.seed, asked.views)
    print(f"{asked.views} maps checked, {failed} failed, {time.monotonic() - began:.0f} s")
    sys.exit(bool(wrong or failed))


if __name__ == "__main__":
    main()
