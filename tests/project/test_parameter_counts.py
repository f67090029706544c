"""No function of the package has more than eight parameters; more are rows of a table.

A function that takes rows names none of them: ``**keywords`` are of a TypedDict, and
``parameters.keywords.takes`` shows them.
"""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "python" / "daguerre"
MOST = 8


def too_long(text: str) -> list[str]:
    """Functions with too many parameters, the object itself not counted."""
    functions = (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, functions):
            every = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
            count = sum(one.arg not in ("self", "cls") for one in every)
            if count > MOST:
                name = getattr(node, "name", "lambda")
                found.append(f"line {node.lineno}: {name} has {count} parameters")
    return found


def test_functions_of_the_package() -> None:
    files = {path.relative_to(PACKAGE): path.read_text() for path in PACKAGE.rglob("*.py")}
    assert len(files) > 300
    found = [f"{path}: {line}" for path, text in files.items() for line in too_long(text)]
    assert found == []


@pytest.mark.parametrize(
    ("head", "count"),
    [
        ("(self, a, b, c, d, /, e, f, *, g, h, **k)", 0),
        ("(self, a, b, c, d, e, f, *, g, h, i)", 1),
        ("(a, b, c, d, e, f, g, h, i)", 1),
    ],
)
def test_planted_functions_are_counted(head: str, count: int) -> None:
    assert len(too_long(f"async def one{head}: pass\ndef other{head}: pass")) == 2 * count
