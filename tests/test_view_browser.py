"""``molviz view`` as people use it: in a browser, with the pointer, the wheel, fingers and keys."""

import io
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tests.browser import ARGUMENTS, WITHOUT_WEBGL, Hand, browsers, served
from tests.render import needs_chromium

pytestmark = needs_chromium
SAMPLES = Path(__file__).parent.parent / "samples"
FORMATS = ("svg", "pdf", "eps", "ps", "hpgl")


@pytest.fixture(scope="module")
def start() -> Iterator[Any]:
    with browsers() as one:
        yield one


@pytest.fixture(scope="module")
def running(start: Any) -> Any:
    return start(ARGUMENTS)


@pytest.fixture
def hand(running: Any) -> Iterator[Hand]:
    """A hand on caffeine."""
    with served(str(SAMPLES / "caffeine.xyz")) as (_, address):
        found = Hand(running, address)
        yield found
        assert not found.faults
        found.page.close()


def drawn_by(command: list[str], folder: Path) -> bytes:
    """What a command that the page shows writes."""
    assert command[:2] == ["molviz", "draw"] and command[-2] == "-o"
    subprocess.run([sys.executable, "-m", *command], cwd=folder, check=True, capture_output=True)
    return (folder / command[-1]).read_bytes()


@pytest.mark.parametrize("eye", [[], ["--perspective", "90"]], ids=["parallel", "central"])
@pytest.mark.parametrize(
    ("name", "selection"), [("caffeine.xyz", "not element H"), ("1a8o.pdb", "resi 160-200"), ("c60.xyz", "all")]
)
def test_what_is_saved_is_what_the_command_draws(
    running: Any, name: str, selection: str, eye: list[str], tmp_path: Path
) -> None:
    with served(str(SAMPLES / name), *eye) as (_, address):
        hand = Hand(running, address)
        hand.after(lambda: hand.drag(90, 40))
        hand.page.mouse.wheel(0, -300)
        hand.after(lambda: hand.page.select_option("[name=style]", "shaded"))
        hand.after(lambda: hand.page.fill("[name=select]", selection))
        hand.after(lambda: hand.page.fill("[name=label]", "index 5"))
        for format in FORMATS if name == "caffeine.xyz" else ["svg"]:
            saved, content = hand.save(format)
            assert saved == hand.command[-1] and Path(saved).suffix == f".{format}"
            assert content == drawn_by(hand.command, tmp_path), hand.command
        assert {"--view", "--style", "--select", "--label"} <= set(hand.command)
        assert not hand.faults
        hand.page.close()


def test_sticks_and_hidden_atoms(running: Any, tmp_path: Path) -> None:
    with served(str(SAMPLES / "1hpv.pdb.gz"), "--rep", "all=hide", "--rep", "resn 478=sticks") as (_, address):
        hand = Hand(running, address)
        hand.after(lambda: hand.page.fill("[name=rep]", "all=hide\nresn 478=ball-and-stick\nresi 24-30=sticks"))
        assert hand.page.inner_text(".told").startswith("131 atoms")
        hand.page.fill("[name=outline]", "0")
        hand.after(lambda: hand.page.select_option("[name=style]", "flat"))
        assert_frames_lie_on_the_picture(hand, least=0.05, most=0.02)  # nearly all of thin sticks is edge
        hand.page.close()
    with served(str(SAMPLES / "1hpv.pdb.gz"), "--rep", "all=hide", "--rep", "resn 478=sticks") as (_, address):
        hand = Hand(running, address)
        hand.after(lambda: hand.drag(50, 50))
        assert hand.save("svg")[1] == drawn_by(hand.command, tmp_path) and not hand.faults
        hand.page.close()


def test_a_drag_turns_and_the_wheel_scales(hand: Hand) -> None:
    before, words = hand.image, hand.command
    hand.page.mouse.move(*hand.middle)
    hand.page.mouse.wheel(0, -400)
    hand.page.wait_for_function("wide => document.querySelector('.stage img').width > 1.5 * wide", arg=before["width"])
    assert hand.command == words  # a closer look is no other picture
    hand.after(lambda: hand.drag(80, 0))
    turned = hand.command
    assert "--view" in turned
    hand.after(lambda: hand.drag(0, 80, "Shift"))
    assert hand.command != turned
    hand.page.get_by_role("button", name="Fit").click()
    hand.page.wait_for_function("wide => document.querySelector('.stage img').width < 1.3 * wide", arg=before["width"])


def test_what_is_dragged_follows_the_pointer(hand: Hand) -> None:
    """From the front of a ball to the right: the atom there goes to the right."""
    x, y = hand.middle
    hand.page.mouse.move(x, y)
    hand.after(lambda: hand.page.keyboard.press("Home") or hand.drag(40, 0))
    first = rotation_of(hand)
    hand.after(lambda: hand.drag(40, 0))
    turn = rotation_of(hand) @ first.T
    assert turn[0, 2] > 0.05 and abs(turn[1, 2]) < 1e-3  # the page's z, towards the eye, turns towards x
    hand.after(lambda: hand.drag(0, 40))
    turn = rotation_of(hand) @ (turn @ first).T
    assert turn[1, 2] < -0.05 and abs(turn[0, 2]) < 1e-3  # and down, where the pointer goes


def rotation_of(hand: Hand) -> np.ndarray:
    from molviz.pipeline.values import parse_orientation
    from molviz.pipeline.views import rotation_of as matrix

    return matrix(parse_orientation(hand.command[hand.command.index("--view") + 1]))


BARE = (str(SAMPLES / "c60.xyz"), "--style", "flat", "--outline", "0", "--crease", "0")


@pytest.mark.parametrize("words", [[], ["--perspective", "60"]], ids=["parallel", "central"])
def test_frames_lie_where_the_exact_picture_lies(running: Any, words: list[str]) -> None:
    """While the pointer holds still, spheres cover what the picture covers, to within its lines."""
    with served(*BARE, *words) as (_, address):
        hand = Hand(running, address)
        assert_frames_lie_on_the_picture(hand)
        hand.page.close()


def test_without_webgl_there_are_discs(start: Any) -> None:
    with served(*BARE) as (_, address):
        hand = Hand(start(WITHOUT_WEBGL), address)
        assert hand.page.evaluate("document.createElement('canvas').getContext('webgl2')") is None
        assert_frames_lie_on_the_picture(hand)
        hand.page.close()


def assert_frames_lie_on_the_picture(hand: Hand, least: float = 0.2, most: float = 0.01) -> None:
    hand.after(lambda: hand.drag(30, 30))
    hand.page.mouse.move(5, 5)
    exact = covered(hand)
    x, y = hand.middle
    hand.page.route("**/ask", lambda route: None)  # the exact picture shall not come
    hand.page.mouse.move(x, y)
    hand.page.mouse.down()
    hand.page.mouse.move(x + 30, y)
    hand.page.mouse.move(x, y)
    hand.page.wait_for_selector(".stage canvas:not(.marks):visible")
    time.sleep(0.3)
    moving = covered(hand)
    assert hand.page.locator(".stage img").is_hidden()
    assert least < exact.mean() < 0.8 and (exact != moving).mean() < most


def covered(hand: Hand) -> np.ndarray:
    shot = np.asarray(Image.open(io.BytesIO(hand.page.locator(".stage").screenshot())).convert("L"))
    return shot[3:-3, 3:-3] < 250


def test_the_pointer_names_the_atom_below_it(hand: Hand) -> None:
    hand.page.mouse.move(*hand.middle)
    hand.page.wait_for_selector(".caption:visible")
    assert hand.page.inner_text(".caption")[0] in "CNOH"
    box = hand.page.locator(".stage").bounding_box()
    hand.page.mouse.move(box["x"] + 3, box["y"] + 3)
    hand.page.wait_for_selector(".caption", state="hidden")


def test_a_residue_is_marked_coloured_labelled_and_kept_alone(running: Any) -> None:
    with served(str(SAMPLES / "1a8o.pdb")) as (_, address):
        hand = Hand(running, address)
        hand.page.mouse.click(*hand.middle)
        hand.page.wait_for_selector(".marked strong")
        residue = hand.page.inner_text(".marked strong").split()
        assert len(residue) == 3 and residue[2] == "A"
        hand.after(lambda: hand.page.get_by_role("button", name="Label").click())
        assert f"resn {residue[0]} and resi {residue[1]} and chain A" in hand.command
        hand.page.locator(".stage").focus()
        hand.page.keyboard.press("n")
        hand.page.wait_for_selector(".marked strong")
        hand.after(lambda: hand.page.get_by_role("button", name="Only this").click())
        assert "--select" in hand.command
        assert hand.page.inner_text("small[id$=select-note]").endswith(" of 644 atoms")
        hand.page.close()


def test_options_are_undone_and_done_again(hand: Hand) -> None:
    first = hand.command
    hand.after(lambda: hand.page.select_option("[name=style]", "flat"))
    second = hand.command
    hand.after(lambda: hand.drag(60, 10))
    third = hand.command
    assert first != second != third
    hand.after(lambda: hand.page.get_by_role("button", name="Undo").click())
    assert hand.command == second
    hand.after(lambda: hand.page.get_by_role("button", name="Undo").click())
    assert hand.command == first and hand.page.input_value("[name=style]") == "auto"
    hand.page.locator(".stage").focus()
    hand.after(lambda: hand.page.keyboard.press("Control+y"))
    hand.after(lambda: hand.page.keyboard.press("Control+y"))
    assert hand.command == third


def test_one_drag_is_undone_at_once_however_often_it_pauses(hand: Hand) -> None:
    first = hand.command
    x, y = hand.middle
    hand.page.mouse.move(x, y)
    hand.page.mouse.down()
    for step in range(1, 4):
        hand.after(lambda step=step: hand.page.mouse.move(x + 40 * step, y))  # the pointer rests, and is held down
    hand.page.mouse.up()
    assert hand.command != first
    hand.after(lambda: hand.page.get_by_role("button", name="Undo").click())
    assert hand.command == first and hand.page.get_by_role("button", name="Undo").is_disabled()


def test_the_keyboard_alone_suffices(hand: Hand) -> None:
    """From the address bar: every control is reached by Tab, focus is seen, and keys turn, scale and save."""
    page = hand.page
    reached, outlines = [], set()
    for _ in range(60):
        page.keyboard.press("Tab")
        name, outline = page.evaluate(
            "() => { const e = document.activeElement; const l = e.labels?.[0]?.textContent;"
            " return [l || e.getAttribute('aria-label') || e.textContent || '', getComputedStyle(e).outlineStyle]; }"
        )
        reached.append(name)
        outlines.add(outline if name else "solid")
        if name == "Page":
            break
    wanted = {"molecule", "Turn left", "Scale up", "Centre", "Style", "Colour by", "Palette", "Selection", "Water",
              "Labels", "Title", "Scale bar", "Legend", "Format of the file", "Save", "Copy command", "Load state"}
    assert wanted <= set(reached) and outlines == {"solid"}
    page.locator(".stage").focus()
    hand.after(lambda: page.keyboard.press("ArrowLeft"))
    turned = hand.command
    hand.after(lambda: page.keyboard.press("Shift+ArrowRight"))
    assert "--view" in turned and hand.command != turned
    before = hand.image["width"]
    page.keyboard.press("+")
    page.wait_for_function("wide => document.querySelector('.stage img').width > 1.1 * wide", arg=before)
    page.get_by_role("button", name="Save", exact=True).focus()
    with page.expect_download() as saved:
        page.keyboard.press("Enter")
    assert saved.value.suggested_filename == "caffeine.svg"


def test_a_state_is_saved_and_loaded(hand: Hand, tmp_path: Path) -> None:
    hand.after(lambda: hand.drag(50, 20))
    hand.after(lambda: hand.page.fill("[name=color]", "element N=navy\nelement O=#f80"))
    hand.after(lambda: hand.page.check("[name=legend]"))
    with hand.page.expect_download() as saved:
        hand.page.get_by_role("button", name="Save state").click()
    state = tmp_path / "state.toml"
    saved.value.save_as(state)
    words = hand.command
    hand.after(lambda: hand.page.get_by_role("button", name="Undo").click())
    hand.after(lambda: hand.page.set_input_files("input[type=file]", state))
    assert hand.command == words
    target = tmp_path / "again.svg"
    drawing = [sys.executable, "-m", "molviz", "draw", str(SAMPLES / "caffeine.xyz"), "--view-from", str(state)]
    subprocess.run([*drawing, "-o", str(target)], check=True, capture_output=True)
    after_source = b"</dc:source>"  # which names the command: that of the state file is another
    assert hand.save("svg")[1].partition(after_source)[2] == target.read_bytes().partition(after_source)[2] != b""


def test_what_is_wrong_is_told_and_the_page_goes_on(hand: Hand) -> None:
    hand.page.fill("[name=select]", "elment C")
    hand.page.wait_for_function("() => document.querySelector('.wrong').textContent.includes(\"mean 'element'?\")")
    hand.after(lambda: hand.page.fill("[name=select]", "element C"))
    assert hand.page.inner_text("small[id$=select-note]") == "8 of 24 atoms"
    assert hand.page.locator(".wrong").is_hidden()


def test_two_fingers_scale_roll_and_move(running: Any) -> None:
    with served(str(SAMPLES / "caffeine.xyz")) as (_, address):
        hand = Hand(running, address, viewport={"width": 375, "height": 700}, has_touch=True)
        before = hand.image["width"]
        touch = hand.page.context.new_cdp_session(hand.page)
        x, y = hand.middle

        def fingers(kind: str, *places: tuple[float, float]) -> None:
            points = [{"x": x + dx, "y": y + dy, "id": number} for number, (dx, dy) in enumerate(places)]
            touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        def spread() -> None:
            fingers("touchStart", (-30, 0), (30, 0))
            for step in range(1, 6):
                fingers("touchMove", (-30 - 8 * step, -6 * step), (30 + 8 * step, 6 * step))
            fingers("touchEnd")

        hand.after(spread)
        assert "--view" in hand.command and hand.image["width"] > 1.5 * before
        hand.page.close()


@pytest.mark.parametrize("width", [1280, 375, 320])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_page_fits_screens_light_and_dark(running: Any, width: int, scheme: str) -> None:
    with served(str(SAMPLES / "caffeine.xyz")) as (_, address):
        hand = Hand(running, address, viewport={"width": width, "height": 700}, color_scheme=scheme)
        assert hand.page.evaluate("document.documentElement.scrollWidth") <= width
        for text, ground in hand.page.evaluate(COLORS):
            assert contrast(text, ground) > 4.5
        hand.page.close()


COLORS = """() => [...document.querySelectorAll('.molviz label, .molviz legend, .molviz button:enabled, .molviz p')]
  .filter(e => e.textContent).map(e => { let g = e; while (getComputedStyle(g).backgroundColor === 'rgba(0, 0, 0, 0)')
    g = g.parentElement; return [getComputedStyle(e).color, getComputedStyle(g).backgroundColor]; })"""


def contrast(one: str, other: str) -> float:
    """The ratio of WCAG 2: (L1 + 0.05) / (L2 + 0.05) of relative luminances."""

    def luminance(color: str) -> float:
        channels = np.array([int(part) for part in color[4:-1].split(",")]) / 255
        linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
        return float(linear @ [0.2126, 0.7152, 0.0722])

    low, high = sorted([luminance(one), luminance(other)])
    return (high + 0.05) / (low + 0.05)


def test_hostile_names_are_text(running: Any, tmp_path: Path) -> None:
    source = tmp_path / "<img src=x onerror=alert(1)>.pdb"
    line = "HETATM    1  C   {} A   1      {:6.3f}   0.000   0.000  1.00  0.00           C\n"
    source.write_text(line.format("<b>", 0) + line.format("\"'&", 1.5), encoding="utf-8")
    with served(source.name, "--label", "all={resn}", "--title", "<script>alert(1)</script>", folder=tmp_path) as (
        _, address,
    ):
        hand = Hand(running, address)
        hand.page.on("dialog", lambda dialog: hand.faults.append(dialog.message))
        hand.page.mouse.click(*hand.middle)
        hand.page.wait_for_selector(".marked strong")
        assert hand.page.inner_text("h1") == source.name
        assert hand.page.locator("#viewer b, #viewer script, #viewer h1 img").count() == 0
        assert not hand.faults
        saved, content = hand.save("svg")
        assert content == drawn_by(hand.command, tmp_path)
        hand.page.close()


def test_closing_the_page_ends_the_server(running: Any) -> None:
    with served(str(SAMPLES / "caffeine.xyz")) as (process, address):
        hand = Hand(running, address)
        hand.page.reload()
        hand.rested()
        time.sleep(6)
        assert process.poll() is None  # a page that is loaded anew is open still
        hand.page.close()
        assert process.wait(30) == 0


def test_an_option_of_the_front_door_is_in_the_panel(hand: Hand) -> None:
    from molviz.pipeline.values import CHOICES

    choices = hand.page.eval_on_selector_all("[name=color_by] option", "all => all.map(one => one.value)")
    assert tuple(choices) == CHOICES["color_by"]
