"""Docstrings, comments and helps begin with a verb or a noun of the field, such as "Returns"."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
import typer.main

from daguerre import cli
from daguerre.post.effects.catalogue import EFFECTS

ROOT = Path(__file__).resolve().parents[2]
#: Words that leave readers to guess the subject, also behind a parameter: "seed: Of the noise."
BAD = re.compile(r"(?:#:?|//[/!]?<?)?\s*(?:\*{0,2}\w+(?:, \w+)*: )?(?:Of|What|As)\b")


def blocks(text: str, mark: str) -> Iterator[str]:
    """First lines of comment blocks."""
    above = ""
    for line in map(str.strip, text.splitlines()):
        if line.startswith(mark) and not above.startswith(mark):
            yield line
        above = line


def docstrings(text: str) -> Iterator[str]:
    """Lines of docstrings that begin a paragraph, or explain a parameter."""
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    for node in ast.walk(ast.parse(text)):
        found = ast.get_docstring(node) if isinstance(node, documented) else None
        above = ""
        for line in map(str.strip, (found or "").splitlines()):
            if not above or re.match(r"[*\w, ]+: ", line):
                yield line
            above = line


def of_python(text: str) -> list[str]:
    return [line for line in (*docstrings(text), *blocks(text, "#")) if BAD.match(line)]


def of_cpp(text: str) -> list[str]:
    return [line for line in blocks(text, "//") if BAD.match(line)]


def is_python(path: Path) -> bool:
    return path.suffix == ".py" or (
        not path.suffix and path.is_file() and b"python" in path.read_bytes().split(b"\n")[0]
    )


FOLDERS = ("python/daguerre", "bench", "examples", "scenes", "script", "tests")


@pytest.mark.parametrize("folder", FOLDERS)
def test_python(folder: str) -> None:
    files = [path for path in (ROOT / folder).rglob("*") if is_python(path)]
    assert files
    assert [(path.name, line) for path in files for line in of_python(path.read_text())] == []


def test_core() -> None:
    files = [path for kind in ("*.h", "*.cpp") for path in (ROOT / "core").rglob(kind)]
    assert files
    assert [(path.name, line) for path in files for line in of_cpp(path.read_text())] == []


def test_helps() -> None:
    """Every command, flag and effect also says something by itself: at least two words."""
    root = typer.main.get_command(cli.app)
    commands = [root, *root.commands.values()]
    helps = {f"{c.name} {p.opts}": p.help or "" for c in commands for p in c.params}
    helps |= {str(command.name): command.help or "" for command in commands}
    for effect in EFFECTS.values():
        helps |= {f"{effect.name}.{p.name}": p.meaning for p in effect.parameters}
        helps[effect.name] = effect.summary
    assert {n: h for n, h in helps.items() if BAD.match(h.capitalize()) or len(h.split()) < 2} == {}


@pytest.mark.parametrize(
    "bad",
    [
        *('"""Of the lens, mm."""', "#: What is seen.\nSEEN = 1", "# As above.\n# More."),
        'def f(seed):\n    """Draws.\n\n    Args:\n        seed: Of the noise.\n    """',
        'class A:\n    """A thing.\n\n    Attributes:\n        a, b: As given.\n    """',
    ],
)
def test_planted_words_are_found(bad: str) -> None:
    assert len(of_python(bad)) == 1
    assert of_cpp("int a;\n/// Of the lens, mm.\ndouble b;  // What follows\n// As it is.") == [
        "/// Of the lens, mm.",
        "// As it is.",
    ]
