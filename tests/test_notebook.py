"""A notebook, executed: what it shows of a molecule is the drawing."""

from pathlib import Path
from xml.etree import ElementTree

import nbclient
import nbformat
import pytest

import molviz

CAFFEINE = str(Path(__file__).parent.parent / "samples" / "caffeine.xyz")
CELLS = {
    "a path": f"import molviz\nmolviz.draw({CAFFEINE!r})",
    "an object of ASE": f"import ase.io\nmolviz.draw(ase.io.read({CAFFEINE!r}), color_by='index')",
    "arrays": "molviz.draw(([[0, 0, 0], [1, 0, 0.5]], [1.2, 1.5]), width='5cm')",
}


@pytest.fixture(scope="module")
def outputs() -> dict[str, str]:
    """The SVG in the output of each cell."""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in CELLS.values()])
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    shown = {}
    for name, cell in zip(CELLS, notebook.cells, strict=True):
        (output,) = cell.outputs
        assert output.output_type == "execute_result" and output.data["text/plain"].startswith("<Drawing of ")
        shown[name] = output.data["image/svg+xml"]
    return shown


def paths(svg: str) -> int:
    return sum(element.tag.endswith("path") for element in ElementTree.fromstring(svg).iter())


def test_a_path_is_shown(outputs: dict[str, str]) -> None:
    drawing = molviz.draw(CAFFEINE)
    assert outputs["a path"] == drawing.svg()
    assert paths(outputs["a path"]) > drawing.visible  # a region for each atom that is seen, and the lines


def test_an_object_of_another_library_is_shown(outputs: dict[str, str]) -> None:
    expected = molviz.draw(CAFFEINE, color_by="index").svg()
    assert paths(outputs["an object of ASE"]) == paths(expected)
    assert outputs["an object of ASE"].replace("C8H10N4O2", "caffeine") == expected


def test_arrays_are_shown(outputs: dict[str, str]) -> None:
    assert outputs["arrays"] == molviz.draw(([[0, 0, 0], [1, 0, 0.5]], [1.2, 1.5]), width="5cm").svg()
    assert paths(outputs["arrays"]) >= 3  # two regions, a crease and a silhouette
