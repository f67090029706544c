"""The names that `info` lists are those that flags take, in every format of scenes."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.setup.contents import contents
from tests.importers.mitsuba import scene_files
from tests.importers.pbrt import text as pbrt
from tests.support.scene import scenes


def gltf(folder: Path) -> Path:
    """Nodes with a name, without one, with the same one twice, with a colon, and a camera."""
    corners = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], np.float32).tobytes()
    data = {
        "asset": {"version": "2.0"},
        "buffers": [
            {
                "byteLength": 36,
                "uri": "data:application/octet-stream;base64," + base64.b64encode(corners).decode(),
            }
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [
            {
                "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                "min": [-1, -1, 0], "max": [1, 1, 0],
            }
        ],
        "materials": [{"name": "paint"}, {}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]},
            {"primitives": [{"attributes": {"POSITION": 0}, "material": 1}]},
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01}}],
        "nodes": [
            {"name": "table top", "mesh": 0},
            {"mesh": 1},
            {"name": "table top", "mesh": 0},
            {"name": "lamp:gi", "mesh": 0, "children": [5]},
            {"camera": 0, "translation": [0, 0, 5], "name": "main"},
            {"name": "-leaf/'\"", "mesh": 1},
        ],
        "scenes": [{"nodes": [0, 1, 2, 3, 4]}],
    }  # fmt: skip
    path = folder / "scene.gltf"
    path.write_text(json.dumps(data))
    return path


def mitsuba(folder: Path) -> Path:
    return scene_files.written(
        folder,
        scene_files.camera(),
        '<bsdf type="diffuse" id="paint"/>',
        '<shape type="sphere" id="ball"><ref id="paint"/></shape>',
        '<shape type="sphere"><point name="center" x="1" y="0" z="0"/></shape>',
        '<shape type="sphere"><point name="center" x="2" y="0" z="0"/></shape>',
        '<emitter type="point"><point name="position" x="0" y="3" z="3"/></emitter>',
    )


def pbrt_scene(folder: Path) -> Path:
    options = 'LookAt 0 0 -5  0 0 0  0 1 0  Camera "perspective" "float fov" 40'
    world = (
        'LightSource "point" "point3 from" [0 3 -3]\n'
        'MakeNamedMaterial "paint" "string type" "diffuse" NamedMaterial "paint"\n'
        f"{pbrt.SQUARE}\n{pbrt.SQUARE}\n"
        f'ObjectBegin "tree" {pbrt.SQUARE} ObjectEnd\n'
        'ObjectInstance "tree"  Translate 0 0 1  ObjectInstance "tree"\n'
    )
    return pbrt.written(folder, world, options)


def usd(folder: Path) -> Path:
    pytest.importorskip("pxr")
    square = (
        "int[] faceVertexCounts = [3]\n int[] faceVertexIndices = [0, 1, 2]\n"
        "point3f[] points = [(-1, -1, 0), (1, -1, 0), (0, 1, 0)]\n"
    )
    path = folder / "scene.usda"
    path.write_text(
        '#usda 1.0\n(\n metersPerUnit = 1\n upAxis = "Y"\n)\n'
        'def Xform "World"\n{\n'
        f' def Mesh "Top"\n {{\n{square} }}\n'
        f' def Xform "Lamp"\n {{\n  def Mesh "Top"\n  {{\n{square}  }}\n }}\n'
        ' def Camera "Main"\n {\n  double3 xformOp:translate = (0, 0, 5)\n'
        '  uniform token[] xformOpOrder = ["xformOp:translate"]\n }\n'
        ' def SphereLight "Bulb"\n {\n  float inputs:intensity = 1\n }\n}\n'
    )
    return path


FORMATS = [gltf, mitsuba, pbrt_scene, usd]


def listed(capsys: pytest.CaptureFixture[str], path: Path) -> dict[str, Any]:
    assert main(["info", str(path), "--json"]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


@pytest.mark.parametrize("written", FORMATS)
def test_every_listed_name_is_accepted(
    written: Callable[[Path], Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path)
    found = listed(capsys, path)
    nodes = found["nodes"]
    assert len(nodes) >= 3
    assert len({node["name"] for node in nodes}) == len(nodes)
    for node in nodes:
        name = node["name"]
        code = main(["info", str(path), f"--focus-on={name}"])
        error = capsys.readouterr().err
        assert "no node" not in error
        # The camera itself is a node, too, and cannot be in front of itself.
        assert code == 0 or "behind the camera" in error
        code = main(["render", str(path), "--dry-run", "-o", "x.exr", f"--catcher={name}"])
        error = capsys.readouterr().err
        assert "no node" not in error
        assert (code == 0) is (node["instances"] > 0), error
        if node["instances"]:
            command = ["render", str(path), "--dry-run", "-o", "x.exr", f"--catcher={name}:shadow"]
            assert main(command) == 0
            capsys.readouterr()
    for name in [*found["cameras"], *found["camera_aliases"]]:
        assert main(["info", str(path), "--camera", name]) == 0


def test_nodes_without_a_name_get_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = listed(capsys, gltf(tmp_path))
    assert [node["name"] for node in found["nodes"]] == [
        "table top", "node1", "table top.001", "lamp:gi", "-leaf/'\"", "main",
    ]  # fmt: skip
    assert [node["instances"] for node in found["nodes"]] == [1, 1, 1, 2, 1, 0]
    assert found["nodes"][-1]["position_m"] == [0, 0, 5]
    assert found["material_names"] == ["paint", "material1"]


def test_lamps_are_listed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (lamp,) = listed(capsys, mitsuba(tmp_path))["lamps"]
    assert lamp["kind"] == "PointLight"
    assert lamp["position_m"] == [0, 3, 3]


def test_the_text_of_many_nodes_is_short(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = scenes.lamp_room()
    for i in range(10_000):
        scene.add_node(f"node {i}", np.zeros(3))
    scene.add_light(dg.PointLight(name="key"))
    monkeypatch.setattr(dg, "load", lambda path, **_: scene)
    assert main(["info", "room.glb"]) == 0
    text = capsys.readouterr().out
    assert len(text) < 4000
    rows = {line[:12].strip(): line[13:] for line in text.splitlines()}
    assert rows["nodes"].startswith("10004: 'floor', 'ball -1.1', 'ball 1.1', 'lamp', 'node 0', ")
    assert rows["nodes"].endswith("'node 7', ... (--json lists all)")
    assert rows["with meshes"] == "4: 'floor', 'ball -1.1', 'ball 1.1', 'lamp'"
    assert rows["lights"].endswith(": 'bulb', 'key'")
    assert len(contents(scene)["nodes"]) == 10_004
