"""The set of the plate and its pawns: made the same twice, read, told apart; and their page."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path

import numpy as np
import pytest
import typer.main

import daguerre as dg
from daguerre import cli
from daguerre.frame.over import change_of_rgb
from tests.support.scene.example_scenes import made_twice

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "script" / "docs" / "gallery"))

import into_plate  # noqa: E402
import photograph_page  # noqa: E402

GALLERY = ROOT / "docs" / "gallery"
COMMANDS = [
    command
    for sheet in into_plate.sheets()
    for command in (*sheet.first, *(c for shot in sheet.photographs for c in shot.commands))
]
PAWNS = {"glass", "steel", "vermilion", "ochre"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made_twice("plates", tmp_path_factory.mktemp("plates"))


def test_the_shot_is_the_set_and_the_pawns(folder: Path) -> None:
    empty, shot = (dg.load(folder / name) for name in ("empty.glb", "shot.glb"))
    assert not empty.warnings
    assert not shot.warnings
    names = [[thing.name for thing in scene.instances] for scene in (empty, shot)]
    assert names[1][: len(names[0])] == names[0]
    assert set(names[1]) - set(names[0]) == PAWNS
    one, two = (scene.camera() for scene in (empty, shot))
    assert np.array_equal(one.transform, two.transform)
    assert one.f_stop == two.f_stop == 2.8


def test_pawns_come_into_the_picture_and_change_the_set(folder: Path) -> None:
    """One node is the whole set: no lamp and no window is left among the objects."""
    scene = dg.load(folder / "shot.glb")
    scene.set_catcher("set")
    camera = scene.camera()
    frame = dg.render(scene, camera, resolution=(60, 40), spp=16, light_paths="off")
    assert frame.catcher_ratio is not None
    assert 0.05 < float((frame.alpha > 0.5).mean()) < 0.2
    assert frame.alpha[:8].max() == 0  # the paper lamp belongs to the set
    shaded = (frame.alpha == 0) & (frame.catcher_ratio.mean(axis=2) < 0.9)
    assert shaded.mean() > 0.02
    plate = dg.render(dg.load(folder / "empty.glb"), camera, resolution=(60, 40), spp=16)
    assert np.isfinite(change_of_rgb(frame).of(plate.rgb)).all()


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_are_understood(command: str) -> None:
    program, *rest = shlex.split(command)
    if program == "python":
        assert (ROOT / rest[0]).exists()
    else:
        typer.main.get_command(cli.app).commands[rest[0]].make_context(rest[0], rest[1:])


def test_every_picture_is_written_by_a_command() -> None:
    written = set(re.findall(r"out/gallery/(\w+\.png)", " ".join(COMMANDS)))
    shown = {shot.file for sheet in into_plate.sheets() for shot in sheet.photographs}
    assert shown | {file for row in into_plate.OVERVIEW for file in row} == written


def test_the_page_is_what_the_program_says() -> None:
    page = photograph_page.page(into_plate.INTRODUCTION, into_plate.sheets())
    assert (GALLERY / "plates.md").read_text() == page
    for name in ("plates", *(sheet.name for sheet in into_plate.sheets())):
        assert (GALLERY / f"{name}.jpg").stat().st_size < 400_000
