"""A picture becomes bytes: one writer per format, chosen by suffix."""

from collections.abc import Callable

from molviz.picture.picture import Picture


def _svg(picture: Picture) -> bytes:
    from molviz.write.svg import write_svg

    return write_svg(picture)


def _svgz(picture: Picture) -> bytes:
    from molviz.write.svg import write_svgz

    return write_svgz(picture)


def _ps(picture: Picture) -> bytes:
    from molviz.write.postscript import write_postscript

    return write_postscript(picture)


def _eps(picture: Picture) -> bytes:
    from molviz.write.postscript import write_eps

    return write_eps(picture)


def _pdf(picture: Picture) -> bytes:
    from molviz.write.pdf import write_pdf

    return write_pdf(picture)


def _hpgl(picture: Picture) -> bytes:
    from molviz.write.hpgl import write_hpgl

    return write_hpgl(picture)


# Each writer is imported when it is first used: no run needs all the packages behind them.
WRITERS: dict[str, Callable[[Picture], bytes]] = {
    ".svg": _svg, ".svgz": _svgz, ".ps": _ps, ".eps": _eps, ".pdf": _pdf, ".hpgl": _hpgl,
}  # fmt: skip


def write(picture: Picture, suffix: str) -> bytes:
    """Return the picture in the format of a suffix such as ``".svg"``; the same picture gives the same bytes.

    Raises KeyError where no writer has that suffix.
    """
    return WRITERS[suffix](picture)
