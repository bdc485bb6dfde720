"""``molviz.view`` in notebooks: what a kernel sends, and the widget's module in a browser, asking it."""

import base64
import json
from pathlib import Path
from typing import Any

import nbclient
import nbformat
import pytest

import molviz
from molviz.errors import OptionError
from molviz.viewer.notebook import joined
from tests.browser import ARGUMENTS, PATIENCE, browsers
from tests.render import needs_chromium

CAFFEINE = str(Path(__file__).parent.parent / "samples" / "caffeine.xyz")
BALLS = ([[0, 0, 0], [1, 0, 0.5]], [1.2, 1.5])
MODEL = """() => {
  const model = { on: (event, then) => { model.then = then; }, send: async (question) => {
    const [head, body] = await window.kernel(JSON.stringify(question));
    const bytes = Uint8Array.from(atob(body), (letter) => letter.charCodeAt(0));
    model.then(JSON.parse(head), [new DataView(bytes.buffer)]); } };
  window.widget.render({ model, el: document.querySelector('#viewer') });
}"""


def test_a_notebook_that_cannot_run_shows_the_drawing() -> None:
    cells = [nbformat.v4.new_code_cell(f"import molviz\nmolviz.view({CAFFEINE!r}, style='flat', view='1,0,0,0')")]
    notebook = nbformat.v4.new_notebook(cells=cells)
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    (shown,) = [output for output in notebook.cells[0].outputs if output.output_type != "stream"]
    assert shown.data["image/svg+xml"] == molviz.draw(CAFFEINE, style="flat", view="1,0,0,0").svg()
    assert "application/vnd.jupyter.widget-view+json" in shown.data


@pytest.mark.parametrize("options", [{"stile": "flat"}, {"turntable": 3}, {"style": "godsell"}, {"model": "all"}])
def test_what_is_no_option_is_refused(options: dict[str, Any]) -> None:
    with pytest.raises(OptionError):
        molviz.view(BALLS, **options)


def test_all_modules_are_joined_once_and_import_nothing() -> None:
    text = joined("notebook.js")
    assert "import {" not in text and text.count("class Viewer ") == 1 and text.count("export ") == 1


@needs_chromium
def test_the_widget_turns_and_saves(tmp_path: Path) -> None:
    widget = molviz.view(BALLS, style="flat")
    sent: list[tuple[Any, bytes]] = []
    widget.send = lambda head, buffers: sent.append((head, buffers[0]))  # type: ignore[method-assign]

    def kernel(question: str) -> tuple[str, str]:
        widget._handle_custom_msg(json.loads(question), [])
        head, body = sent.pop()
        return json.dumps(head), base64.b64encode(body).decode()

    with browsers() as start:
        page = start(ARGUMENTS).new_page()
        page.set_default_timeout(PATIENCE)
        page.expose_function("kernel", kernel)
        page.set_content("<div id='viewer'></div>")
        page.add_script_tag(type="module", content=joined("notebook.js").replace("export default", "window.widget ="))
        page.add_style_tag(content=str(widget._css))
        page.evaluate(MODEL)
        page.wait_for_selector("#viewer[data-state=exact]")
        assert page.inner_text(".command") == "molviz.draw(x, style='flat')"
        page.locator(".stage").focus()
        page.keyboard.press("ArrowLeft")
        page.wait_for_function("() => document.querySelector('.command').textContent.includes('view=')")
        with page.expect_download() as saved:
            page.get_by_role("button", name="Save", exact=True).click()
        drawn = eval(page.inner_text(".command"), {"molviz": molviz, "x": BALLS})  # noqa: S307
        assert Path(saved.value.path()).read_bytes() == drawn.to("svg")
