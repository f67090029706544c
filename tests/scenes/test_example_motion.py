"""The scenes of scenes/motion.py: the same every time, read without a note, and they move."""

from __future__ import annotations

import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.pictures.images import decode
from tests.support.scene.example_scenes import make

ROOT = Path(__file__).resolve().parents[2]
#: Moving nodes or cameras by name, and two times at which to look.
MOVING = {
    "billiards": ("9", 0.2, 0.3),
    "racer": ("body", 0.4, 0.6),
    "plane": ("blades", 0.0, 0.01),
    "cradle": ("ball", 0.0, 0.15),
    "lamp": ("bulb", 0.0, 0.5),
    "street": ("drive", 0.0, 1.0),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("motion")
    make("motion", made)
    return made


def test_same_bytes_every_time(folder: Path, tmp_path: Path) -> None:
    make("motion", tmp_path)
    assert sorted(p.stem for p in folder.iterdir()) == sorted(MOVING)
    for name in MOVING:
        first, again = (d / f"{name}.glb" for d in (folder, tmp_path))
        assert first.read_bytes() == again.read_bytes()


@pytest.mark.parametrize("name", MOVING)
def test_it_is_read_without_a_note_and_moves(folder: Path, name: str) -> None:
    what, begin, end = MOVING[name]
    places = []
    for time in (begin, end):
        scene = dg.load(folder / f"{name}.glb", time=time)
        assert scene.warnings == []
        found = [i.transform for i in scene.instances if i.name == what]
        places.append(found[0] if found else scene.camera(what).transform)
    assert np.abs(places[1] - places[0]).max() > 0.02


def test_the_racing_cars_wheels_roll(folder: Path) -> None:
    angle = way = 0.0
    scenes = [dg.load(folder / "racer.glb", time=0.5 + k * 0.005) for k in range(9)]
    poses = [next(i.transform for i in s.instances if i.name == "tyre") for s in scenes]
    for a, b in pairwise(poses):
        turned = np.linalg.inv(a[:3, :3]) @ b[:3, :3]
        angle += np.arccos(np.clip((np.trace(turned) - 1) / 2, -1, 1))
        way += b[0, 3] - a[0, 3]
    assert way == pytest.approx(angle * 0.36, rel=1e-3)


def test_the_street_zooms(folder: Path) -> None:
    cameras = [dg.load(folder / "street.glb", time=t).camera("zoom") for t in (0.0, 1.0)]
    assert [camera.focal_length for camera in cameras] == pytest.approx([28, 70])


def test_propellers_agree_or_differ_as_their_interpolations_say(
    folder: Path, tmp_path: Path
) -> None:
    script, sheet = ROOT / "script" / "docs" / "gallery" / "propellers.py", tmp_path / "sheet.png"
    flags = ["--scene", folder / "plane.glb", "--size", "32", "--spp", "4"]
    subprocess.run([sys.executable, script, sheet, *flags], check=True, capture_output=True)
    pixels = decode(sheet.read_bytes(), "sheet").astype(float)
    assert pixels.shape == (26 + 4 * 38, 96 + 6 + 4 * 38 - 6, 3)  # labels above and to the left
    cells = pixels[26:, 102 - 6 :].reshape(4, 38, 4, 38, 3).swapaxes(1, 2)[:, :, :32, 6:]

    def unlike(row: int, a: int, b: int) -> float:
        return float(np.abs(cells[row, a] - cells[row, b]).mean())

    linear, twist, decomposed, spin = range(4)
    rigid, shrinking, turns = (0, 1), 2, 3
    for row in rigid:
        assert unlike(row, twist, decomposed) < 0.5  # of 255: the same times, the same poses
        assert unlike(row, twist, spin) < 0.5  # the same angle, said in two ways
        assert unlike(row, linear, twist) > 4
    assert cells[shrinking, twist].mean() > 150  # grey paper that says why there is no picture
    assert unlike(shrinking, decomposed, spin) < 4 < unlike(shrinking, linear, decomposed)
    assert unlike(turns, twist, spin) > 4  # three turns: between keys nothing turns
    assert unlike(turns, linear, twist) < 0.5
