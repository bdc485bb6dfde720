"""Pictures as pixels, without anti-aliasing: every pixel is some exact colour of the picture."""

import io
import re
import subprocess
from shutil import which

import numpy as np
import pytest
import resvg_py
from PIL import Image

needs_ghostscript = pytest.mark.skipif(which("gs") is None, reason="ghostscript (gs) is not installed")
needs_pdftotext = pytest.mark.skipif(which("pdftotext") is None, reason="poppler (pdftotext) is not installed")


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
