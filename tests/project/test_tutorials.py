"""Tutorials run as they stand, step by step, but with one sample per pixel."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path
from typing import Any

import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.cli import main

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGES = [DOCS / "first-picture.md", *sorted((DOCS / "tutorials").glob("*.md"))]
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.DOTALL | re.MULTILINE)
SAVED_AS = re.compile(r"[Ss]ave this as `([^`]+)`")


def blocks(page: Path) -> list[tuple[str, str, str]]:
    """Text before each block, its language, and its code."""
    parts = BLOCK.split(page.read_text())
    return list(zip(parts[::3], parts[1::3], parts[2::3], strict=False))


def commands(code: str) -> list[list[str]]:
    """The command lines of a block, without comments."""
    return [shlex.split(line, comments=True) for line in code.splitlines()]


def test_there_are_eight() -> None:
    assert len(PAGES) == 8


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_form_of_a_tutorial(page: Path) -> None:
    """A picture, at most 600 words without code, and three links to go on."""
    text = page.read_text()
    assert re.search(r"!\[[^\]]+\]\([^)]+\)", text)
    assert len(re.findall(r"^- .*\]\(", text.split("## Next")[1], re.MULTILINE)) == 3
    assert len(BLOCK.sub("", text).split()) <= 600
    assert "daguerre demo" in text
    assert "<!-- install tutorial" in text


def test_lens_of_the_tutorial_is_that_of_the_patent(tmp_path: Path) -> None:
    page = DOCS / "tutorials" / "lens-from-patent.md"
    code = next(code for _, kind, code in blocks(page) if kind == "json")
    (tmp_path / "tessar.json").write_text(code)
    order = lenses.load(tmp_path / "tessar.json").first_order()
    assert f"it is {order.efl:.4f}" in page.read_text()
    assert f"it is {order.bfl:.4f}" in page.read_text()
    wrong = json.loads(code)
    wrong["surfaces"][6]["radius"] *= -1
    (tmp_path / "wrong.json").write_text(json.dumps(wrong))
    with pytest.raises(dg.InputError, match=r"surfaces cross 6\.057 mm off the axis"):
        lenses.load(tmp_path / "wrong.json")


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_a_tutorial_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    render = dg.render

    def quick(*args: Any, **given: Any) -> dg.Frame:
        return render(*args, **given | {"spp": 1})

    monkeypatch.setattr(dg, "render", quick)
    at_hand: dict[str, Any] = {}
    for before, kind, code in blocks(page):
        if kind == "python":
            exec(compile(code, page.name, "exec"), at_hand)
        elif kind:
            Path(SAVED_AS.findall(before)[-1]).write_text(code)
        else:
            for program, *words in commands(code):
                if program == "daguerre":
                    assert main(fewer_samples(words)) == 0, words
                else:
                    assert program in ("pip", "script/setup", "source")


def fewer_samples(words: list[str]) -> list[str]:
    return [
        "1" if before == "--spp" else word
        for before, word in zip(["", *words[:-1]], words, strict=True)
    ]
