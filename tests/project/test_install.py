"""How to install: pages have it from script/docs/make-install; no other text names an index."""

from __future__ import annotations

import importlib.machinery
import importlib.util
import re
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "script" / "docs" / "make-install"
#: An install of Daguerre by name, which needs an index; a wheel's file and a clone need none.
BY_NAME = re.compile(r"""pip install[^\n`|]*(?<![\w./"-])["']?daguerre(?![\w./-])""")
#: Uploads, and the hint beside a wheel, where pip finds Daguerre itself installed.
ALLOWED = {"docs/releasing.md", "python/daguerre/files/extras.py", "tests/project/test_extras.py"}


@pytest.fixture(scope="module")
def program() -> ModuleType:
    loader = importlib.machinery.SourceFileLoader("make_install", str(PROGRAM))
    spec = importlib.util.spec_from_loader("make_install", loader)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    return module


def test_pages_are_as_the_program_writes_them() -> None:
    done = subprocess.run([sys.executable, PROGRAM, "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_the_program_sees_every_block(program: ModuleType) -> None:
    marked = [
        path for path in program.pages() if "script/docs/make-install -->" in path.read_text()
    ]
    assert {"README.md", "index.md", "install.md", "first-picture.md"} < {p.name for p in marked}
    for path in marked:
        text = path.read_text()
        assert text.count("by script/docs/make-install -->") == len(program.BLOCK.findall(text)), (
            path
        )


def test_a_release_changes_one_line(program: ModuleType) -> None:
    """With an index the same pages say pip install; without one, none does."""
    texts = {path: path.read_text() for path in program.pages()}
    changed = {path for path, text in texts.items() if program.written(text, True) != text}
    assert changed == {path for path, text in texts.items() if program.BLOCK.search(text)}
    for path in changed:
        assert BY_NAME.search(program.written(texts[path], True)), path
        assert not BY_NAME.search(program.written(texts[path], False)), path


@pytest.mark.parametrize("promise", ["pip install daguerre", '`pip install "daguerre[view]"`'])
def test_a_promise_is_found(promise: str) -> None:
    assert BY_NAME.search(promise)


def test_nothing_else_promises_an_index(program: ModuleType) -> None:
    if program.ON_INDEX:
        pytest.skip("an index has Daguerre")
    if shutil.which("git") is None:
        pytest.skip("needs git")
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True)
    if listed.returncode:
        pytest.skip("no checkout here")
    found = []
    for name in listed.stdout.splitlines():
        if name in ALLOWED or name in ("script/docs/make-install", "tests/project/test_install.py"):
            continue
        try:
            text = (ROOT / name).read_text("utf-8")
        except (UnicodeDecodeError, FileNotFoundError, IsADirectoryError):
            continue
        found += [f"{name}: {match[0]}" for match in BY_NAME.finditer(text)]
    assert not found
