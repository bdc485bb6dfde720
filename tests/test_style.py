"""Functions stay short, and what others may call says what it does."""

import ast
import statistics
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parent.parent / "molviz"
TREES = {path: ast.parse(path.read_text(encoding="utf-8")) for path in sorted(PACKAGE.rglob("*.py"))}
MOST_USUAL, MOST = 12, 40  # lines of a function: the median is below the first, none (docstring aside) above the second


def lines(node: ast.stmt) -> int:
    return (node.end_lineno or node.lineno) - node.lineno + 1


def beside_docstring(node: ast.FunctionDef) -> int:
    """How long a function is below signature and docstring: those of ``molviz.draw`` hold all of its options."""
    first = node.body[1 if ast.get_docstring(node) and len(node.body) > 1 else 0]
    return (node.end_lineno or node.lineno) - first.lineno + 1


def public(body: list[ast.stmt]) -> Iterator[ast.FunctionDef]:
    """Functions and methods that others may call: not those within functions, nor anything of a private class."""
    for node in body:
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield node
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            yield from public(node.body)


def test_functions_are_short() -> None:
    functions = {
        f"{path.name}:{node.lineno} {node.name}": node
        for path, tree in TREES.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
    }
    assert statistics.median(map(lines, functions.values())) < MOST_USUAL
    assert [name for name, node in functions.items() if beside_docstring(node) > MOST] == []


def test_public_functions_say_what_they_do() -> None:
    found = [(path, node) for path, tree in TREES.items() for node in public(tree.body)]
    assert [f"{path.name}:{node.lineno} {node.name}" for path, node in found if not ast.get_docstring(node)] == []


def dataclasses_of(tree: ast.Module) -> Iterator[tuple[ast.ClassDef, ast.expr]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            yield from ((node, one) for one in node.decorator_list if "dataclass" in ast.unparse(one))


def test_values_do_not_change() -> None:
    """What is handed on from stage to stage is frozen, so that no stage changes what another holds."""
    found = [(path, node, one) for path, tree in TREES.items() for node, one in dataclasses_of(tree)]
    assert len(found) > 15
    assert [f"{path.name}: {node.name}" for path, node, one in found if "frozen=True" not in ast.unparse(one)] == []
