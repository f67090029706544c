r"""Words of strangers on a terminal: escape sequences are written out, never obeyed."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import pytest

import daguerre.cli
from daguerre.cli import console, main
from tests.support.formats.make_gltf import triangle

#: Clears the screen, sets the title, rings, turns the line round; one byte that is not UTF-8.
HOSTILE = "a\x1b[2J\x1b]0;owned\x07b\x9bc\u202ed" + os.fsdecode(b"\xff")
WRITTEN = r"a\x1b[2J\x1b]0;owned\x07b\x9bc\u202ed\udcff"
OBEYED = re.compile(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e\udc80-\udcff]")


def test_a_missing_file_of_a_hostile_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["render", f"{HOSTILE}.glb", "-o", "x.exr"]) in (2, 3)
    error = capsys.readouterr().err
    assert WRITTEN in error.replace("\\\\", "\\")
    assert not OBEYED.search(error)


def test_a_scene_of_a_hostile_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = str(triangle().glb(tmp_path / f"{HOSTILE}.glb"))
    draw = ["render", scene, "--spp", "1", "--res", "8x8", "-o"]
    cases = [
        (["info", scene], 0),
        ([*draw, str(tmp_path / f"{HOSTILE[:-1]}.exr")], 0),
        ([*draw, str(tmp_path / f"{HOSTILE}.exr")], 5),  # OpenEXR takes names in UTF-8
        ([*draw, "x.exr", "--env", scene.replace(".glb", ".hdr")], 3),
    ]
    Path(scene.replace(".glb", ".hdr")).write_bytes(b"#?RADIANCE")
    for words, code in cases:
        assert main(words) == code
        said = capsys.readouterr()
        assert WRITTEN.removesuffix(r"\udcff") in said.out + said.err
        assert not OBEYED.search(said.out + said.err)


def test_hostile_names_inside_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    b = triangle()
    b.add("cameras", {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}})
    b.node(camera=0, name="\x1b[2J\x07\u202e")
    b.json["extensionsUsed"] = ["\x1b[31mEXT_red"]
    assert main(["info", str(b.glb(tmp_path / "s.glb"))]) == 0
    said = capsys.readouterr()
    assert "camera" in said.out
    assert not OBEYED.search(said.out + said.err)


@pytest.mark.parametrize("command", ["lens", "sensor", "calibrate"])
def test_hostile_words_of_a_lens_or_sensor(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "x.json"
    file.write_text(json.dumps({"\x1b[2J\u202e": 1, "schema": "\x1b[2J\u202e"}))
    assert main([command, str(file)]) in (2, 3)
    assert not OBEYED.search(capsys.readouterr().err)


def test_other_words_stay() -> None:
    text = "one\ntwo \u00e9 \u2192 \U0001f600"
    assert console.plain(text) == text
    assert console.plain("\r\t\0") == r"\r\t\x00"


def test_all_words_go_through_the_console() -> None:
    """No command prints past ``console.plain``; the JSON of ``--json-progress`` is ASCII."""
    past = re.compile(r"(?<![\w.])print\(|typer\.echo|std(out|err)\.write")
    files = Path(daguerre.cli.__file__).parent.rglob("*.py")
    assert not [
        path.name
        for path in files
        if path.name not in ("console.py", "progress.py") and past.search(path.read_text())
    ]
