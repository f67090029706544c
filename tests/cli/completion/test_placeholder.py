"""Placeholders say what can be typed; each flag that takes a file or a choice says so."""

from __future__ import annotations

import sys
import typing
from pathlib import Path
from typing import Any

import pytest
import typer.main

from daguerre import cli
from daguerre.camera.parameters import CAMERA_FLAGS, SHUTTER
from daguerre.cli.completion.placeholder import Takes, takes
from daguerre.rendering.parameters import FLAGS

KINDS = {
    "LENS": {"words": ["tessar", "sonnar"], "suffixes": [".json", ".zmx"]},
    "AOV": {"words": ["depth", "N"]},
    "FILE": {"suffixes": []},
    "DIR": {"folders": True},
    "EFFECT": {"keys": {"glow": ["share"]}},
    "FILTER": {"words": ["box"]},
}
ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "script" / "docs" / "reference"))

from completion_words import kinds  # noqa: E402


@pytest.mark.parametrize(
    ("placeholder", "wanted"),
    [
        ("X,Y", Takes()),
        ("8GB|50%", Takes()),
        ("WxH|50%", Takes()),
        ("M1[,M2]", Takes()),
        ("FIRST-LAST:X,Y[,AX,AY]", Takes()),
        ("NAME=VALUE", Takes()),
        ("EV,EV,...", Takes()),
        ("srgb|soft", Takes(("srgb", "soft"))),
        ("8|16", Takes(("8", "16"))),
        ("as-shot|auto|K|X,Y", Takes(("as-shot", "auto"))),
        ("PX|10%|L,T,R,B|undistort", Takes(("undistort",))),
        ("LENS|thin", Takes(("tessar", "sonnar", "thin"), (".json", ".zmx"))),
        ("FILE", Takes(suffixes=())),
        ("FILE.svg|png|pdf", Takes(suffixes=(".svg", ".png", ".pdf"))),
        ("IN.exr|IN.dng", Takes(suffixes=(".exr", ".dng"))),
        ("PASS.exr...", Takes(suffixes=(".exr",))),
        ("FILE[:NAME,...|all]", Takes(suffixes=())),
        ("DIR", Takes(folders=True)),
        ("box|trapezoid:E|FILE", Takes(("box", "trapezoid:"), ())),
        ("auto[:centre|spot]", Takes(("auto", "auto:centre", "auto:spot"))),
        ("AOV,...", Takes(("depth", "N"), several=True)),
        ("render,proxy", Takes(("render", "proxy"), several=True)),
        ("FILTER[:PX]", Takes(("box",))),
        ("EFFECT:KEY=VALUE,...", Takes(("glow",), keys={"glow": ["share"]})),
    ],
)
def test_a_placeholder_says_what_can_be_typed(placeholder: str, wanted: Takes) -> None:
    assert takes(placeholder, KINDS) == wanted


def _taken() -> list[Any]:
    """Name, placeholder and type of everything that the program takes."""
    found = []
    whole: Any = typer.main.get_command(cli.app)
    for name, command in whole.commands.items():
        hints = typing.get_type_hints(command.callback.__wrapped__)
        for one in command.params:
            found.append((f"{name} {one.opts[-1]}", one.metavar, hints[one.name]))
    return found


def test_whatever_takes_a_path_completes_files_or_folders() -> None:
    known = kinds()
    paths = [row for row in _taken() if "Path" in str(row[2])]
    assert len(paths) > 40
    for name, placeholder, _ in paths:
        found = takes(placeholder, known)
        assert found.suffixes is not None or found.folders, name


def test_choices_are_completed() -> None:
    known = kinds()
    rows = [row for table in (CAMERA_FLAGS, SHUTTER, FLAGS) for row in table if row.flags]
    choices = [row for row in rows if row.kind == "choice"]
    assert len(choices) > 5
    for row in choices:
        assert set(row.choices) <= set(takes(row.placeholder or "", known).words), row.name
