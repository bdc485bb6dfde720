"""A picture becomes bytes, piece by piece: one writer per format, chosen by suffix."""

from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from typing import TypeAlias

from molviz.picture.picture import Picture

Writer: TypeAlias = Callable[[Picture], Iterable[bytes]]


def _lazily(module: str, name: str) -> Writer:
    """Return a writer that is imported when it is first used: no run needs all the packages behind them."""

    def writer(picture: Picture) -> Iterable[bytes]:
        writer_of_module: Writer = getattr(import_module(f"molviz.write.{module}"), name)
        return writer_of_module(picture)

    return writer


WRITERS: dict[str, Writer] = {
    ".svg": _lazily("svg", "write_svg"),
    ".svgz": _lazily("svg", "write_svgz"),
    ".ps": _lazily("postscript", "write_postscript"),
    ".eps": _lazily("postscript", "write_eps"),
    ".pdf": _lazily("pdf", "write_pdf"),
    ".hpgl": _lazily("hpgl", "write_hpgl"),
}
MANY = {  # formats that hold several pictures: their modules and functions
    ".svg": ("svg_frames", "write_animated"),
    ".svgz": ("svg_frames", "write_animated_svgz"),
    ".ps": ("postscript", "write_postscript_pages"),
    ".pdf": ("pdf", "write_pdf_pages"),
}


def write_many(pictures: Sequence[Picture], suffix: str) -> Iterable[bytes]:
    """Yield pictures of one size in one file: pages, or an animation. Raises KeyError for formats not in ``MANY``."""
    module, name = MANY[suffix]
    writer: Callable[[Sequence[Picture]], Iterable[bytes]] = getattr(import_module(f"molviz.write.{module}"), name)
    return writer(pictures)


def pieces(picture: Picture, suffix: str) -> Iterable[bytes]:
    """Yield the picture in the format of a suffix such as ``".svg"``; the same picture gives the same bytes.

    Raises KeyError where no writer has that suffix.
    """
    return WRITERS[suffix](picture)
