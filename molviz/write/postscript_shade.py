"""Translucent steps in PostScript, which has no translucency: tones are painted again where steps cover them.

Every set of steps that may cover a point together is a clip inside clips; within it all tones are painted in the colour
that they have below these steps. They close each other's hairlines there as they do below, so that nothing is seen of
the clips but the borders of the steps themselves.
"""

from collections.abc import Iterator, Sequence

from molviz.picture.picture import SPREAD, ShadeLayer
from molviz.write.postscript_path import shape_texts
from molviz.write.text import number

LINES = 6000  # in a procedure, nine words each at most: interpreters hold 65,535 words

# P0 I clips to the path P0, a list of procedures. a V paints all tones, U, each a path and the colours of tone and
# shade, in tone + a (shade - tone).
SHADE_PROCEDURES = r"""/I{newpath{exec}forall clip newpath}bind def
/V{/a exch def U{aload pop/Z exch def/T exch def
0 1 2{dup T exch get dup 3 -1 roll Z exch get exch sub a mul add 255 div}for setrgbcolor
{exec}forall b}forall}bind def"""


def shade_lines(layer: ShadeLayer) -> Iterator[str]:
    """Yield the lines of a shade layer."""
    yield f"{number(SPREAD, 3)} w"
    for row, path in enumerate(shape_texts(layer.steps, True)):
        yield from (f"/P{row}[", *procedures(path), "]def")
    yield "/U["
    for path, tone, clip in zip(shape_texts(layer.tone, True), layer.tone_color, layer.tone_clip, strict=True):
        yield from ("[[", *procedures(path), "][{} {} {}][{} {} {}]]".format(*tone, *layer.color[clip]))
    yield "]def"
    yield from sets_of_steps(layer.opacity, 0, 1.0)


def procedures(path: str) -> Iterator[str]:
    """Yield the procedures that together draw a path."""
    lines = path.split("\n")
    for first in range(0, len(lines), LINES):
        yield from ("{", *lines[first : first + LINES], "}")


def sets_of_steps(opacity: Sequence[float], first: int, seen: float) -> Iterator[str]:
    """Yield what paints the points in every set of steps from ``first`` on, where those so far let ``seen`` through.

    Sets that begin with a later step come first, and each before those that it is the beginning of. So the last
    that paints a point is the set of all steps that cover it, in whatever way steps overlap. n steps have 2ⁿ − 1 sets.
    """
    for step in reversed(range(first, len(opacity))):
        through = seen * (1.0 - opacity[step])
        yield f"gsave P{step} I {number(1.0 - through, 4)} V"
        yield from sets_of_steps(opacity, step + 1, through)
        yield "grestore"
