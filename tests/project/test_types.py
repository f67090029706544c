"""Type checkers see the package as a user's program has it: every public name, with its type."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import daguerre as dg

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "tests" / "support" / "program" / "typed_user.py"
DOCS = [*ROOT.glob("docs/**/*.md"), *ROOT.glob("examples/*"), ROOT / "README.md"]
IMPORT = re.compile(r"^(?:import|from) daguerre(?:\.(\w+)|.*? import ([\w, ]+))", re.MULTILINE)


def checked(folder: Path, name: str, code: str) -> list[tuple[int, str]]:
    """Lines and codes of the errors that mypy reports for a program outside of the checkout."""
    (folder / name).write_text(code)
    words = ["--strict", "--no-error-summary", "--cache-dir", str(folder / "cache"), name]
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file=", *words],
        cwd=folder,
        capture_output=True,
        text=True,
    )
    found = re.findall(rf"^{name}:(\d+): error: .*\[([\w-]+)\]$", done.stdout, re.MULTILINE)
    assert done.stdout.count("error:") == len(found), done.stdout + done.stderr
    assert done.returncode == (1 if found else 0), done.stdout + done.stderr
    return [(int(line), code) for line, code in found]


def test_mypy_sees_the_package_of_this_install(tmp_path: Path) -> None:
    code = SCRIPT.read_text()
    wrong = [
        (number, found[1])
        for number, line in enumerate(code.splitlines(), 1)
        if (found := re.search(r"# wrong: ([\w-]+)", line))
    ]
    assert len(wrong) == 4
    names = "".join(f"dg.{name}\n" for name in dg.__all__)
    assert checked(tmp_path, "user.py", code + names) == wrong


def test_dir_is_the_public_face() -> None:
    assert dir(dg) == sorted(dg.__all__)
    for name in dir(dg):
        getattr(dg, name)


@pytest.mark.parametrize("page", DOCS, ids=lambda page: str(page.relative_to(ROOT)))
def test_what_a_page_imports_is_public(page: Path) -> None:
    if page.suffix not in (".md", ".py"):
        return
    for module, names in IMPORT.findall(page.read_text()):
        for name in [module] if module else names.split(","):
            assert name.strip() in dir(dg) or name.strip() == "_core", (page, name)
