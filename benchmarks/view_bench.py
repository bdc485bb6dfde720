"""Frames a second while the page of ``molviz view`` is dragged, and seconds from rest to the exact picture.

Run as ``python benchmarks/view_bench.py [FILE...]``; without files a sample is turned. Chromium draws without a
graphics card, so that figures are those of the processor alone; a card does far better.
"""

import os
import sys
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parent.parent))
from tests.browser import ARGUMENTS, Hand, browsers, served

SAMPLE = Path(__file__).parent.parent / "samples" / "1tii.pdb.gz"
STYLES = ("flat", "goodsell")
RESTS = 3
DRAG = """(seconds) => new Promise((done) => {
  const stage = document.querySelector('.stage');
  const { left, top, width, height } = stage.getBoundingClientRect();
  const send = (type, dx, dy) => stage.dispatchEvent(new PointerEvent(type, { pointerId: 1, buttons: 1, bubbles: true,
    clientX: left + width / 2 + dx, clientY: top + height / 2 + dy }));
  stage.setPointerCapture = () => {};
  send('pointerdown', 0, 0);
  const first = Number(stage.dataset.frames ?? 0);
  const began = performance.now();
  const step = () => {
    const passed = (performance.now() - began) / 1000;
    send('pointermove', 100 * Math.sin(2 * passed), 60 * Math.sin(3 * passed));
    if (passed < seconds) { requestAnimationFrame(step); return; }
    const frames = Number(stage.dataset.frames) - first;
    const root = document.querySelector('#viewer');
    const number = root.dataset.number;
    const rested = performance.now();
    send('pointerup', 0, 0);
    const watch = () => {
      if (root.dataset.state !== 'exact' || root.dataset.number === number) { requestAnimationFrame(watch); return; }
      const wide = document.querySelector('.stage canvas').width;
      done([frames / passed, (performance.now() - rested) / 1000, wide]);
    };
    requestAnimationFrame(watch);
  };
  requestAnimationFrame(step);
})"""


def report(start: object, source: str, style: str) -> None:
    """Print the figures of one file in one style."""
    with served(source, "--style", style) as (_, address):
        hand = Hand(start, address)
        runs = [hand.page.evaluate(DRAG, 4) for _ in range(RESTS)]
        hand.page.close()
    frames, rest, wide = (median(column) for column in zip(*runs, strict=True))
    name = Path(source).name
    print(f"{name:<24} {style:<10} {frames:5.1f} frames/s ({wide:.0f} pixels wide)  exact {rest:.2f} s after rest")


if __name__ == "__main__":
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
    with browsers() as starting:
        browser = starting(ARGUMENTS)
        for file in sys.argv[1:] or [str(SAMPLE)]:
            for look in STYLES:
                report(browser, file, look)
