"""Where the drawing lies on the page: sizes in points, 72 to the inch."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from molviz.arrays import Floats

POINTS = {"pt": 1.0, "mm": 72 / 25.4, "cm": 720 / 25.4, "in": 72.0, "px": 0.75}
PAPER = {"a4": (210 * POINTS["mm"], 297 * POINTS["mm"]), "letter": (612.0, 792.0)}
USUAL_SIZE = 14 * POINTS["cm"]  # the longer side of a drawing whose size nobody asked for
LARGEST = 1e6  # points of any length, 350 m
LARGEST_SCALE = 40.0  # points per ångström of such a drawing
SMALLEST = 1.0  # ångström: what is smaller than any atom is drawn as large as that
USUAL_MARGIN = {"fit": 4.0, "a4": 36.0, "letter": 36.0}


@dataclass(frozen=True)
class Page:
    """What the user asked for; lengths in points, None for what is usual."""

    size: str = "fit"  # or a name of PAPER
    width: float | None = None  # of the drawing, margins not counted
    scale: float | None = None  # points per ångström
    margin: float | None = None
    beside: int = 1  # pictures beside each other on the page, each with its share of a fixed width


@dataclass(frozen=True)
class Placement:
    """Page coordinates are ``scale × (drawing) + shift``."""

    scale: float
    shift: Floats  # (2,)
    width: float
    height: float


class Margins(NamedTuple):
    """Points kept free on the four sides of a drawing, the page's own margin not counted."""

    left: float = 0.0
    bottom: float = 0.0
    right: float = 0.0
    top: float = 0.0

    def or_more(self, other: "Margins") -> "Margins":
        """Return the larger of the two on each side."""
        return Margins(*map(max, self, other))


NO_MARGINS = Margins()


def place(page: Page, low: Floats, high: Floats, line: float, free: Margins = NO_MARGINS) -> Placement:
    """Return where a drawing from ``low`` to ``high`` (2,) ångström goes; ``line`` points more around it are painted.

    ``free`` is the room for what stands beside the drawing.

    It is centred, on a page of fixed size as large as the margins let it be unless told otherwise; a page that fits the
    drawing is a whole number of points wide and high, so that it divides into whole pixels.
    """
    margin = (USUAL_MARGIN[page.size] if page.margin is None else page.margin) + line
    extent = np.maximum(high - low, 1e-60)
    paper = PAPER.get(page.size)
    paper = paper and (paper[0] / page.beside, paper[1])
    taken = np.array([free.left + free.right, free.bottom + free.top])
    room = None if paper is None else np.array(paper) - 2 * margin - taken
    scale = page.scale or _scale(page, extent, room)
    needed = extent * scale + 2 * margin + taken
    width, height = paper or tuple(float(np.ceil(side - 1e-9)) for side in needed)
    middle = np.array([width + free.left - free.right, height + free.bottom - free.top]) / 2
    shift = middle - scale * (low + high) / 2
    return Placement(scale, shift, width, height)


def _scale(page: Page, extent: Floats, room: Floats | None) -> float:
    if page.width is not None:
        return page.width / float(extent[0])
    if room is not None:
        return float(np.min(np.maximum(room, 1.0) / extent))
    longest = float(extent.max())
    return min(USUAL_SIZE / longest, LARGEST_SCALE * max(1.0, SMALLEST / longest))


def parse_length(text: str) -> float:
    """Return a length such as ``12cm``, ``80mm``, ``3in``, ``400px`` or ``300`` (points) in points.

    Raises ValueError for anything else and for lengths that are not positive.
    """
    unit = text[-2:] if text[-2:] in POINTS else ""
    try:
        value = float(text.removesuffix(unit)) * POINTS.get(unit, 1.0)
    except ValueError:
        raise ValueError(f"{text!r} is not a length; expected a number and one of {', '.join(POINTS)}") from None
    if not 0 < value < LARGEST:
        raise ValueError(f"{text!r} is not a length for a page; expected more than 0 and less than {LARGEST:g} points")
    return value
