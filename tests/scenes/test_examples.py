"""The scene of the demo: made the same twice, small, and full of what the demo is to show."""

from __future__ import annotations

import json
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg

ROOT = Path(__file__).resolve().parents[2]


def make(path: Path) -> None:
    script = ROOT / "scenes" / "night_table.py"
    subprocess.run([sys.executable, str(script), str(path)], check=True, capture_output=True)


@pytest.fixture(scope="module")
def night_table(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("scenes") / "night_table.glb"
    make(path)
    return path


def test_same_bytes_every_time(night_table, tmp_path):
    make(tmp_path / "again.glb")
    assert (tmp_path / "again.glb").read_bytes() == night_table.read_bytes()


def test_file_is_small(night_table):
    assert night_table.stat().st_size < 5_000_000


def test_uses_what_it_says(night_table):
    data = night_table.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    gltf = json.loads(data[20 : 20 + length])
    assert set(gltf["extensionsUsed"]) == {
        "EXT_camera_physical",
        "KHR_lights_punctual",
        "KHR_materials_emissive_strength",
        "KHR_materials_ior",
        "KHR_materials_transmission",
        "KHR_materials_volume",
    }
    assert {image["mimeType"] for image in gltf["images"]} == {"image/png", "image/jpeg"}


def test_camera_is_a_fifty_at_two(night_table):
    scene = dg.load(night_table)
    camera = scene.camera("Camera")
    assert camera.focal_length == pytest.approx(50, abs=1e-6)
    assert camera.f_stop == 2
    assert camera.focus_distance == pytest.approx(0.728, abs=1e-3)
    assert not scene.warnings


def test_planets_move(night_table):
    places = []
    for time in (0.0, 3.0):
        scene = dg.load(night_table, time=time)
        found = {i.name: np.asarray(i.transform)[:3, 3] for i in scene.instances}
        places.append((found["jupiter"], found["table"]))
    assert np.linalg.norm(places[1][0] - places[0][0]) > 0.05  # 2 turns in 24 s: a quarter turn
    assert np.array_equal(places[0][1], places[1][1])
