"""The page of ``molviz view`` in a browser: a server, Chromium, and a hand on the pointer."""

import shlex
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.render import CHROMIUM

# WebGL without a graphics card, and pages painted as such machines paint them
ARGUMENTS = ["--no-sandbox", "--enable-unsafe-swiftshader", "--disable-gpu-rasterization"]
WITHOUT_WEBGL = ["--no-sandbox", "--disable-gpu", "--disable-3d-apis"]
PATIENCE = 120_000  # ms: other tests run beside these


@contextmanager
def served(*words: str, folder: Path | None = None) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Run ``molviz view --no-browser`` with these words; yield the process and the page's address."""
    command = [sys.executable, "-m", "molviz", "view", *words, "--no-browser", "--quiet"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=folder)
    assert process.stdout
    try:
        yield process, process.stdout.readline().strip()
    finally:
        process.terminate()
        process.wait(30)
        process.stdout.close()


@contextmanager
def browsers() -> Iterator[Callable[[list[str]], Any]]:
    """Yield a function that starts a browser without a window, with the given arguments."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        yield lambda arguments: playwright.chromium.launch(executable_path=CHROMIUM, args=arguments)


class Hand:
    """Somebody in front of the page."""

    def __init__(self, running: Any, address: str, **about: Any) -> None:
        self.page = running.new_page(**({"viewport": {"width": 1280, "height": 800}} | about))
        self.page.set_default_timeout(PATIENCE)
        self.faults: list[str] = []
        self.page.on("pageerror", lambda fault: self.faults.append(str(fault)))
        self.page.on("console", lambda said: said.type == "error" and self.faults.append(said.text))
        self.page.goto(address)
        self.rested()

    def rested(self) -> None:
        """Wait until the exact picture is there."""
        self.page.wait_for_selector("#viewer[data-state=exact]")

    def after(self, act: Any) -> None:
        """Do something that changes the picture, and wait for the new one."""
        number = self.number
        act()
        self.page.wait_for_function(
            "before => { const { number, state } = document.querySelector('#viewer').dataset;"
            " return number !== before && state === 'exact'; }", arg=number,
        )  # fmt: skip

    @property
    def number(self) -> str:
        """The number of the picture that is shown."""
        return str(self.page.get_attribute("#viewer", "data-number"))

    @property
    def middle(self) -> tuple[float, float]:
        """The middle of the stage."""
        box = self.page.locator(".stage").bounding_box()
        return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    @property
    def command(self) -> list[str]:
        """The words of the command that is shown."""
        return shlex.split(self.page.inner_text(".command"))

    @property
    def image(self) -> dict[str, float]:
        """Where the exact picture is on the stage."""
        box: dict[str, float] = self.page.locator(".stage img").bounding_box()
        return box

    def drag(self, dx: float, dy: float, key: str = "") -> None:
        """Drag from the middle of the stage."""
        x, y = self.middle
        if key:
            self.page.keyboard.down(key)
        self.page.mouse.move(x + 20, y)
        self.page.mouse.down()
        for step in range(1, 5):
            self.page.mouse.move(x + 20 + dx * step / 4, y + dy * step / 4)
        self.page.mouse.up()
        if key:
            self.page.keyboard.up(key)

    def save(self, format: str) -> tuple[str, bytes]:
        """Press Save; return the name and the content of the file."""
        self.page.select_option("[aria-label='Format of the file']", format)
        with self.page.expect_download() as saved:
            self.page.get_by_role("button", name="Save", exact=True).click()
        return saved.value.suggested_filename, Path(saved.value.path()).read_bytes()
