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


def render_svg(svg: bytes, width: int) -> np.ndarray:
    """Return an SVG as (h, w, 4) bytes, ``width`` pixels wide; alpha is 0 where nothing is painted, else 255.

    crispEdges paints the pixels whose centre is covered, whatever the file says of its rendering.
    """
    page_width, page_height = map(float, re.findall(rb'viewBox="0 0 (\S+) ([^"]+)"', svg)[0])
    height = round(width * page_height / page_width)
    sized = re.sub(rb'height="[^"]*pt"', b'height="%d"' % height, svg, count=1)
    sized = re.sub(rb'width="[^"]*pt"', b'width="%d"' % width, sized, count=1)
    crisp = "* { shape-rendering: crispEdges }"
    png = resvg_py.svg_to_bytes(
        svg_string=sized.decode(), skip_system_fonts=True, style_sheet=crisp, shape_rendering="crisp_edges"
    )
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGBA"))


def render_ps(document: bytes, dpi: float) -> np.ndarray:
    """Return page one of a PS, EPS or PDF as (h, w, 3) bytes on white; an EPS is cut to its bounding box.

    Raises AssertionError if ghostscript says anything at all. It paints every pixel that a fill touches
    ("any part of pixel"), unless told to look at pixel centres.
    """
    command = ["gs", "-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-dEPSCrop", "-sDEVICE=png16m", f"-r{dpi}"]
    command += ["-dGraphicsAlphaBits=1", "-dPDFSTOPONERROR", "-sOutputFile=%stdout%", "-sstdout=%stderr", "-"]
    done = subprocess.run(command, input=document, capture_output=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stderr.decode(errors="replace")
    return np.asarray(Image.open(io.BytesIO(done.stdout)).convert("RGB"))
