"""script/same-bytes sees each kind of difference that a change could make."""

from __future__ import annotations

import runpy
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest

HERE = Path(__file__).resolve().parents[1]
ROOT = next(folder for folder in HERE.parents if (folder / "script").is_dir())
SCRIPT = runpy.run_path(str(ROOT / "script" / "same-bytes"), run_name="same_bytes")


def exr(path: Path, value: float = 0.25, **attributes: Any) -> Path:
    """A grey picture of 4 x 3 pixels."""
    pixels = np.full((3, 4), 0.5, np.float32)
    pixels[1, 2] = value
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header | attributes, {"Y": pixels}).write(str(path))
    return path


def outcome(files: dict[str, Path], code: int = 0, said: str = "wrote a.exr") -> Any:
    return SCRIPT["Outcome"](code, said, files, 0.0)


def test_versions_and_times_are_no_difference(tmp_path: Path) -> None:
    said = "wrote a.exr (4 samples per pixel, {} s)\ndaguerre {}\n"
    pair = [
        outcome(
            {"a.exr": exr(tmp_path / f"{version}.exr", software=f"daguerre {version}", iso=100.0)},
            said=said.format(*words),
        )
        for version, words in (("0.1.0", ("0.2", "0.1.0")), ("0.2.0", ("1:40", "0.2.0")))
    ]
    assert list(SCRIPT["compare"]("render", *pair)) == []


@pytest.mark.parametrize(
    ("change", "seen"),
    [
        ({"value": np.nextafter(np.float32(0.25), np.float32(1))}, "channel Y: 1 of 12 values"),
        ({"iso": 100.5}, "attribute iso: 100.0, 100.5"),
        ({"look": "film"}, "attribute look: nothing, 'film'"),
    ],
)
def test_pixels_and_attributes(tmp_path: Path, change: dict[str, Any], seen: str) -> None:
    one = exr(tmp_path / "one.exr", iso=100.0)
    two = exr(tmp_path / "two.exr", **({"iso": 100.0} | change))
    found = list(SCRIPT["compare"]("render", outcome({"a": one}), outcome({"a": two})))
    assert len(found) == 1
    assert found[0].startswith(f"a: {seen}")


def test_codes_words_and_files(tmp_path: Path) -> None:
    text, other = tmp_path / "a.json", tmp_path / "b.json"
    text.write_text("1.0")
    other.write_text("1.1")
    first = outcome({"a.json": text})
    for change, seen in (
        ({"code": 3}, "exit code 0, 3"),
        ({"said": "wrote b.exr"}, "says: -wrote a.exr | +wrote b.exr"),
        ({"files": {}}, "a.json: only by this"),
        ({"files": {"a.json": other}}, "a.json: other bytes (of 3, 3)"),
    ):
        found = list(SCRIPT["compare"]("post", first, replace(first, **change)))
        assert found == [seen]


def test_each_command_of_the_program_is_in_the_list() -> None:
    from daguerre.cli import app

    commands = SCRIPT["read_commands"](SCRIPT["COMMANDS"].read_text())
    names = [command.name for command in commands]
    assert len(names) == len(set(names)) > 100
    used = {command.arguments[0] for command in commands if command.arguments}
    assert {command.name for command in app.registered_commands} <= used
    assert {2, 3, 4, 5} <= {command.code for command in commands}
