"""A small picture in a terminal that can show pictures, by sixels or kitty's protocol."""

import io

from molviz.errors import InputError

DPI = 96  # pixels of an inch, as browsers have it: lengths in points are none without
CELLS = 64  # columns, at most: half of a usual window
PIXELS = 900  # of the picture's longer side, before it is fitted to the columns
NEEDED = "--show needs packages that draw in terminals; expected: pip install 'molviz[show]'"
UNABLE = "--show: this terminal shows no pictures; expected one with sixels or kitty's protocol, and no pipe"


def show(svg: str) -> bool:
    """Print a picture on a white ground to standard output; return False where the terminal cannot show it.

    Raises InputError where the packages that do it are not installed.
    """
    try:
        import resvg_py
        from rich.console import Console
        from textual_image.renderable import Image, SixelImage, TGPImage
    except ModuleNotFoundError:
        raise InputError(NEEDED) from None
    if Image not in (SixelImage, TGPImage):
        return False
    png = resvg_py.svg_to_bytes(svg_string=svg, width=PIXELS, height=PIXELS, dpi=DPI, background="white")
    console = Console()
    console.print(Image(io.BytesIO(png), width=min(CELLS, console.width), height="auto"))
    return True
