"""One SVG that shows several pictures in turn, by CSS alone; the first for readers who want nothing to move."""

import math
from collections.abc import Iterator, Sequence

from svgwrite.container import Group

from molviz.picture.picture import Picture
from molviz.write.gzipped import gzipped
from molviz.write.svg import OWN, Elements, empty_drawing, finished
from molviz.write.text import number

FRAME_TIME = 100  # milliseconds that a picture is shown: a turn of 36 steps takes as long as one takes in the hand
SHORTEST_LOOP = 3000  # milliseconds for all pictures, where they are few
FRAME = f"{OWN}-frame"  # class of the pictures


def write_animated(pictures: Sequence[Picture]) -> Iterator[bytes]:
    """Yield pictures of one size as one SVG in UTF-8; described as the first, which shows where nothing is animated.

    A picture is a group that is visible for its share of the loop. Ids are unique across all pictures.
    """
    drawing = empty_drawing(pictures[0])
    elements = Elements(drawing)
    time = max(FRAME_TIME, math.ceil(SHORTEST_LOOP / len(pictures)))
    for row, picture in enumerate(pictures):
        frame = Group(id=elements.fresh_id(f"frame {row + 1}"), class_=FRAME, factory=drawing)
        frame["style"] = f"animation-delay:{(row - len(pictures)) * time}ms"
        if row:
            frame["visibility"] = "hidden"
        for layer in picture.layers:
            frame.add(elements.layer(layer, picture.height))
        drawing.add(frame)
    return finished(drawing, elements, in_turn(len(pictures), time))


def write_animated_svgz(pictures: Sequence[Picture]) -> Iterator[bytes]:
    """Yield the same gzipped, without a date."""
    return gzipped(write_animated(pictures))


def in_turn(count: int, time: int) -> str:
    """Return the style rules by which each frame is visible for ``time`` ms of every ``count`` times as many.

    Delays are negative: the animation of frame k is ``count − k`` frames old when it starts. The share is rounded up,
    as for an instant two pictures are better than none.
    """
    share = number(math.ceil(1e6 / count) / 1e4, 4)
    return (
        f"@keyframes {FRAME}{{0%{{visibility:visible}}{share}%{{visibility:hidden}}100%{{visibility:hidden}}}}"
        f"@media (prefers-reduced-motion:no-preference)"
        f"{{.{FRAME}{{animation:{FRAME} {count * time}ms step-end infinite}}}}"
    )
