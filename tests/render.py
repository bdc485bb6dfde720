"""Pictures as pixels: without anti-aliasing, so that every pixel is some exact colour of the picture, or as seen."""

import io
import re
import subprocess
import tempfile
from pathlib import Path
from shutil import which

import numpy as np
import pytest
import resvg_py
from PIL import Image

from molviz.picture.picture import Picture
from molviz.write import pieces

CHROMIUM = which("chromium") or which("chromium-browser") or which("google-chrome")
needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
needs_poppler = pytest.mark.skipif(which("pdftoppm") is None, reason="poppler (pdftoppm) is not installed")
needs_ghostscript = pytest.mark.skipif(which("gs") is None, reason="ghostscript (gs) is not installed")
needs_pdftotext = pytest.mark.skipif(which("pdftotext") is None, reason="poppler (pdftotext) is not installed")


def write(picture: Picture, suffix: str) -> bytes:
    """Return a picture as a whole file."""
    return b"".join(pieces(picture, suffix))


def text_of_pdf(document: bytes) -> str:
    """Return the text that a reader finds in a PDF when it is searched or copied."""
    return subprocess.run(["pdftotext", "-", "-"], input=document, capture_output=True, check=True).stdout.decode()


def render_svg(svg: bytes, width: int) -> np.ndarray:
    """Return an SVG as (h, w, 4) bytes, ``width`` pixels wide; alpha is 0 where nothing is painted, else 255.

    crispEdges paints the pixels whose centre is covered, whatever the file says of its rendering.
    """
    head, page_height, page_width = re.findall(r'(^.*? height="(\S+)pt".*? width="(\S+)pt")', svg.decode(), re.S)[0]
    height = round(width * float(page_height) / float(page_width))
    sized = head.replace(f'height="{page_height}pt"', f'height="{height}"')
    sized = sized.replace(f'width="{page_width}pt"', f'width="{width}"')
    png = resvg_py.svg_to_bytes(
        svg_string=svg.decode().replace(head, sized, 1), skip_system_fonts=True,
        style_sheet="* { shape-rendering: crispEdges }", shape_rendering="crisp_edges",
    )  # fmt: skip
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGBA"))


def render_ps(document: bytes, dpi: float) -> np.ndarray:
    """Return page one of a PS, EPS or PDF as (h, w, 3) bytes on white; an EPS is cut to its bounding box.

    Pixels are painted where their centre is covered. Raises AssertionError if ghostscript says anything at all.
    """
    command = ["gs", "-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-dEPSCrop", "-sDEVICE=png16m", f"-r{dpi}"]
    command += ["-dGraphicsAlphaBits=1", "-dPDFSTOPONERROR", "-sOutputFile=%stdout%", "-sstdout=%stderr"]
    command += ["-c", "0 0 .setfilladjust2", "-f", "-"]  # else a fill takes every pixel that it touches
    done = subprocess.run(command, input=document, capture_output=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stderr.decode(errors="replace")
    return np.asarray(Image.open(io.BytesIO(done.stdout)).convert("RGB"))


def sized(svg: bytes, width: int, height: int) -> bytes:
    """Return an SVG whose page is so many pixels wide and high."""
    pixels = re.sub(rb'height="[^"]+pt"', b'height="%d"' % height, svg, count=1)
    return re.sub(rb'width="[^"]+pt"', b'width="%d"' % width, pixels, count=1)


def seen_by_resvg(svg: bytes, width: int, height: int) -> np.ndarray:
    """Return an SVG with a background as (height, width, 3) bytes, anti-aliased."""
    png = resvg_py.svg_to_bytes(svg_string=sized(svg, width, height).decode(), skip_system_fonts=True)
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"))


def seen_by_chromium(svg: bytes, width: int, height: int) -> np.ndarray:
    """Return an SVG with a background as (height, width, 3) bytes, as the browser shows it in a page."""
    with tempfile.TemporaryDirectory() as folder:
        source, shot = Path(folder) / "picture.svg", Path(folder) / "shot.png"
        source.write_bytes(sized(svg, width, height))
        command = [str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
        command += ["--force-device-scale-factor=1", f"--user-data-dir={folder}/profile"]
        command += [f"--window-size={width},{height}", f"--screenshot={shot}", source.as_uri()]
        subprocess.run(command, capture_output=True, check=True, timeout=120)
        return np.asarray(Image.open(shot).convert("RGB"))


def seen_by_ghostscript(document: bytes, dpi: float) -> np.ndarray:
    """Return page one of a PS, EPS or PDF as (h, w, 3) bytes, fills anti-aliased; clips never are."""
    command = ["gs", "-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-dEPSCrop", "-sDEVICE=png16m", f"-r{dpi}"]
    command += ["-dGraphicsAlphaBits=4", "-dPDFSTOPONERROR", "-sOutputFile=%stdout%", "-sstdout=%stderr", "-"]
    done = subprocess.run(command, input=document, capture_output=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stderr.decode(errors="replace")
    return np.asarray(Image.open(io.BytesIO(done.stdout)).convert("RGB"))


def seen_by_cairo(pdf: bytes, dpi: float) -> np.ndarray:
    """Return page one of a PDF as (h, w, 3) bytes, anti-aliased, as readers show it that use cairo with poppler."""
    command = ["pdftocairo", "-r", f"{dpi}", "-png", "-singlefile", "-", "-"]
    done = subprocess.run(command, input=pdf, capture_output=True, check=True)
    assert not done.stderr, done.stderr.decode(errors="replace")
    return np.asarray(Image.open(io.BytesIO(done.stdout)).convert("RGB"))


def seen_by_poppler(pdf: bytes, dpi: float) -> np.ndarray:
    """Return page one of a PDF as (h, w, 3) bytes, anti-aliased."""
    done = subprocess.run(["pdftoppm", "-r", f"{dpi}", "-png", "-"], input=pdf, capture_output=True, check=True)
    assert not done.stderr, done.stderr.decode(errors="replace")
    return np.asarray(Image.open(io.BytesIO(done.stdout)).convert("RGB"))
