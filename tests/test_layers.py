"""The law of imports: a stage imports only stages to its left, and each third-party package has one home."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parent.parent / "molviz"
COMMON = {"arrays", "curves", "errors", "rounding", "threads", "toml", "vectors"}
STAGES = {  # what each stage may import, besides itself and COMMON
    "model": set(),
    "readers": {"model"},
    "adapters": {"model", "readers"},
    "geometry": {"model"},
    "visibility": {"model", "geometry"},
    "discs": {"model", "geometry"},
    "picture": {"model", "geometry", "visibility", "discs"},
    "write": {"picture"},
    "pipeline": {"model", "readers", "adapters", "geometry", "visibility", "discs", "picture", "write"},
    "viewer": {"model", "readers", "geometry", "picture", "pipeline"},
    "cli": {"model", "pipeline", "picture", "viewer"},
}
WHEN_ASKED = {("model/molecule.py", "molviz.geometry.bonds")}  # imported by a property, not with the module
HOMES = {
    "click": {"cli"},
    "gemmi": {"readers", "model"},
    "svgwrite": {"write"},
    "pydyf": {"write"},
    "fontTools": {"write"},
    "starlette": {"viewer"},
    "uvicorn": {"viewer"},
    "anywidget": {"viewer"},
    "traitlets": {"viewer"},
    "resvg_py": {"viewer"},
    "rich": {"viewer"},
    "textual_image": {"viewer"},
    "trimesh": {"write"},
    "mapbox_earcut": {"geometry"},
}
FILES = sorted(path for path in PACKAGE.rglob("*.py") if path.parent != PACKAGE or path.stem in STAGES)


def stage_of(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def imported(path: Path) -> list[str]:
    names = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            names.append(node.module or "")
    return names


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_obey_the_law(path: Path) -> None:
    stage = stage_of(path)
    for name in imported(path):
        if (path.relative_to(PACKAGE).as_posix(), name) in WHEN_ASKED:
            continue
        top, _, rest = name.partition(".")
        if top == "molviz" and rest:
            assert rest.split(".")[0] in STAGES[stage] | COMMON | {stage}, f"{stage} imports {name}"
        assert stage in HOMES.get(top, {stage}), f"{stage} imports {top}"
