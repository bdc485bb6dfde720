"""What the page of ``molviz view`` looks like, for the README.

Run as ``python benchmarks/view_screenshot.py FILE -o PICTURE.png``.
"""

import io
import sys
from pathlib import Path

from PIL import Image

sys.path.insert(0, str(Path(__file__).parent.parent))
from tests.browser import ARGUMENTS, Hand, browsers, served

COLORS = 64  # of the PNG: the page has few
SIZE = {"width": 1100, "height": 640}

source, _, target = sys.argv[1:]
with browsers() as start, served(Path(source).name, folder=Path(source).parent) as (_, address):
    hand = Hand(start(ARGUMENTS), address, viewport=SIZE)
    hand.after(lambda: hand.drag(60, 20))
    hand.after(lambda: hand.page.select_option("[name=palette]", "clay"))
    x, y = hand.middle
    hand.page.mouse.click(x + 130, y)
    hand.page.wait_for_selector(".marked strong")
    hand.page.wait_for_timeout(500)
    shot = Image.open(io.BytesIO(hand.page.screenshot()))
shot.convert("RGB").quantize(COLORS, dither=Image.Dither.NONE).save(target, optimize=True)
