"""Edited files: the next reading has their new content, whatever still uses the old one."""

from __future__ import annotations

import io
import json
import os
import zipfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.files.formats import time_of_code
from daguerre.lenses.library import FOLDER
from daguerre.setup.checks import prescription_of
from tests.importers.mitsuba.scene_files import text_of
from tests.importers.test_ies import text as ies_text
from tests.importers.test_missing_files import GLTF

pytest.importorskip("pxr")

_CORNERS = "0 0 0\n{} 0 0\n0 1 0\n"
_PLY = (
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    + _CORNERS
    + "3 0 1 2\n"
)
_OBJ = "v 0 0 0\nv {} 0 0\nv 0 1 0\nf 1 2 3\n"
_BALL = """#usda 1.0
(
    defaultPrim = "B"
    metersPerUnit = 1
)
def Xform "B"
{{
    def Sphere "s"
    {{
        double radius = {}
    }}
}}
"""
_CLIPPED = """#usda 1.0
(
    metersPerUnit = 1
)
def Xform "B" (
    clips = {
        dictionary default = {
            asset[] assetPaths = [@./{file}@]
            string primPath = "/B"
            double2[] active = [(0, 0)]
            double2[] times = [(0, 0), (3, 3)]
            asset manifestAssetPath = @./manifest.usda@
        }
    }
)
{
    double3 xformOp:translate
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Sphere "s"
    {
        double radius = 1
    }
}
"""
_CLIP = """#usda 1.0
def Xform "B"
{{
    double3 xformOp:translate.timeSamples = {{ 0: ({0}, 0, 0), 3: ({0}, 0, 0) }}
}}
"""
_PAINTED = """#usda 1.0
def Mesh "m" (
    prepend apiSchemas = ["MaterialBindingAPI"]
)
{
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    rel material:binding = </M>
}
def Material "M"
{
    token outputs:surface.connect = </M/S.outputs:surface>
    def Shader "S"
    {
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor.connect = </M/T.outputs:rgb>
        token outputs:surface
    }
    def Shader "T"
    {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @./{file}@
        float3 outputs:rgb
    }
}
"""


def _refers(kind: str) -> str:
    return f"""#usda 1.0
(
    metersPerUnit = 1
)
def "A" (
    prepend {kind} = @./{{file}}@
)
{{
}}
"""


def _ball(value: int) -> bytes:
    return _BALL.format(value).encode()


def _png(value: int) -> bytes:
    image = pytest.importorskip("PIL.Image")
    with io.BytesIO() as stream:
        image.new("RGB", (4, 4), (50 + value, 9, 9)).save(stream, "PNG")
        return stream.getvalue()


def _package(value: int) -> bytes:
    """A package with one layer, whose bytes begin at a multiple of 64."""
    entry = zipfile.ZipInfo("in.usda")
    entry.extra = b"\x01\x00" + (23).to_bytes(2, "little") + bytes(23)
    with io.BytesIO() as stream:
        with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as made:
            made.writestr(entry, _ball(value))
        return stream.getvalue()


def _buffer(value: int) -> bytes:
    return np.array([[0, 0, 0], [value, 0, 0], [0, 1, 0]], "<f4").tobytes()


def _gltf(**changes: Any) -> bytes:
    return json.dumps(GLTF | changes).encode()


def _widest(scene: dg.Scene) -> float:
    scale = np.linalg.norm(scene.instances[0].transform[:3, 0])
    return float(scene.meshes[0].positions.max() * scale)


def _moved(scene: dg.Scene) -> float:
    return float(scene.instances[0].transform[0, 3])


def _red(scene: dg.Scene) -> float:
    return float(np.asarray(scene.textures[0].pixels).ravel()[0])


def _sky(scene: dg.Scene) -> float:
    assert scene.environment is not None
    return float(np.asarray(scene.environment.image).max())


def _hdr(value: int) -> bytes:
    return (
        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + bytes((100 + value, 9, 9, 130)) * 32
    )


@dataclass
class _Case:
    """A file that is edited, and the scene that reaches it.

    Attributes:
        edited: Name of the file that is edited.
        content: Its bytes with a value.
        value: The value that a scene shows.
        main: Name of the scene's file.
        text: Its content, with the name of the edited file at ``{file}``; empty: it is the file.
        others: Other files.
    """

    edited: str
    content: Callable[[int], bytes]
    value: Callable[[dg.Scene], float]
    main: str = ""
    text: str | bytes = ""
    others: dict[str, str] = field(default_factory=dict)

    def write(self, folder: Path) -> Path:
        for name, text in self.others.items():
            (folder / name).write_text(text)
        (folder / self.edited).write_bytes(self.content(1))
        if not self.main:
            return folder / self.edited
        text = self.text if isinstance(self.text, bytes) else self.text.encode()
        (folder / self.main).write_bytes(text.replace(b"{file}", self.edited.encode()))
        return folder / self.main


_XML_BALL = '<shape type="sphere"><float name="radius" value="{}"/></shape>'
_FILE = '<string name="filename" value="{file}"/>'
_DEEP = _refers("payload").replace("metersPerUnit = 1", 'metersPerUnit = 1 \n defaultPrim = "A"')
_USD = {
    "usd root": _Case("a.usda", _ball, _widest),
    "usd sublayer": _Case(
        "b.usda", _ball, _widest, "a.usda",
        "#usda 1.0\n(\n  metersPerUnit = 1\n  subLayers = [@./{file}@]\n)\n",
    ),
    "usd reference": _Case("b.usda", _ball, _widest, "a.usda", _refers("references")),
    "usd payload": _Case("b.usda", _ball, _widest, "a.usda", _refers("payload")),
    "usd payload of a reference": _Case(
        "c.usda", _ball, _widest, "a.usda", _refers("references").replace("{file}", "b.usda"),
        {"b.usda": _DEEP.replace("{file}", "c.usda")},
    ),
    "usd clip": _Case(
        "b.usda", lambda k: _CLIP.format(k).encode(), _moved, "a.usda", _CLIPPED,
        {"manifest.usda": '#usda 1.0\ndef Xform "B"\n{\n    double3 xformOp:translate\n}\n'},
    ),
    "usd package": _Case("a.usdz", _package, _widest),
    "usd package referred to": _Case("b.usdz", _package, _widest, "a.usda", _refers("references")),
    "usd picture": _Case("b.png", _png, _red, "a.usda", _PAINTED),
}  # fmt: skip
_OTHERS = {
    "gltf": _Case(
        "a.gltf", lambda k: _gltf(nodes=[{"mesh": 0, "translation": [k, 0, 0]}]), _moved
    ),
    "gltf buffer": _Case(
        "b.bin", _buffer, _widest, "a.gltf",
        _gltf(buffers=[{"byteLength": 36, "uri": "{file}"}]),
    ),
    "gltf picture": _Case("b.png", _png, _red, "a.gltf", _gltf(images=[{"uri": "{file}"}])),
    "mitsuba": _Case(
        "a.xml", lambda k: text_of(_XML_BALL.format(k)), _widest
    ),
    "mitsuba include": _Case(
        "b.xml", lambda k: text_of(_XML_BALL.format(k)), _widest, "a.xml",
        text_of('<include filename="{file}"/>'),
    ),
    "mitsuba ply": _Case(
        "b.ply", lambda k: _PLY.format(k).encode(), _widest, "a.xml",
        text_of(f'<shape type="ply">{_FILE}</shape>'),
    ),
    "mitsuba obj": _Case(
        "b.obj", lambda k: _OBJ.format(k).encode(), _widest, "a.xml",
        text_of(f'<shape type="obj">{_FILE}</shape>'),
    ),
    "mitsuba picture": _Case(
        "b.png", _png, _red, "a.xml",
        text_of('<shape type="sphere"><bsdf type="diffuse"><texture type="bitmap" '
                f'name="reflectance">{_FILE}</texture></bsdf></shape>'),
    ),
    "mitsuba sky": _Case(
        "b.hdr", _hdr, _sky, "a.xml",
        text_of(f'<shape type="sphere"/><emitter type="envmap">{_FILE}</emitter>'),
    ),
    "pbrt": _Case(
        "a.pbrt", lambda k: f'WorldBegin\nShape "sphere" "float radius" {k}\n'.encode(), _widest
    ),
    "pbrt include": _Case(
        "b.pbrt", lambda k: f'Shape "sphere" "float radius" {k}\n'.encode(), _widest, "a.pbrt",
        'WorldBegin\nInclude "{file}"\n',
    ),
    "pbrt ply": _Case(
        "b.ply", lambda k: _PLY.format(k).encode(), _widest, "a.pbrt",
        'WorldBegin\nShape "plymesh" "string filename" "{file}"\n',
    ),
    "pbrt picture": _Case(
        "b.png", _png, _red, "a.pbrt",
        'WorldBegin\nTexture "a" "spectrum" "imagemap" "string filename" "{file}"\n'
        'Material "diffuse" "texture reflectance" "a"\nShape "sphere"\n',
    ),
}  # fmt: skip


def _edit(path: Path, data: bytes, by: str) -> None:
    """Replaces the content of a file by as many bytes, with the time of the old ones."""
    before = path.stat()
    assert len(data) == before.st_size
    if by == "rename":
        (new := path.with_name("new")).write_bytes(data)
        new.replace(path)
    else:
        path.write_bytes(data)
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))


def _check(case: _Case, folder: Path, by: str, **options: Any) -> None:
    path = case.write(folder)
    alive = dg.load(path, **options)
    old = case.value(alive)
    _edit(folder / case.edited, case.content(2), by)
    new = case.value(dg.load(path, **options))
    assert new > old
    assert case.value(alive) == old


@pytest.mark.parametrize("by", ["writing", "rename"])
@pytest.mark.parametrize("in_process", [False, True])
@pytest.mark.parametrize("name", _USD)
def test_a_stage_has_the_new_content(name: str, in_process: bool, by: str, tmp_path: Path) -> None:
    _check(_USD[name], tmp_path, by, in_process=in_process)


@pytest.mark.parametrize("by", ["writing", "rename"])
@pytest.mark.parametrize("name", _OTHERS)
def test_a_scene_has_the_new_content(name: str, by: str, tmp_path: Path) -> None:
    _check(_OTHERS[name], tmp_path, by)


@pytest.mark.parametrize("in_process", [False, True])
def test_a_time_code_counts_by_the_new_rate(in_process: bool, tmp_path: Path) -> None:
    pxr = pytest.importorskip("pxr.Sdf")
    path, text = tmp_path / "a.usda", "#usda 1.0\n(\n    timeCodesPerSecond = {}\n)\n"
    path.write_text(text.format(24))
    alive = pxr.Layer.FindOrOpen(str(path))
    _edit(path, text.format(48).encode(), "writing")
    assert time_of_code(path, 48, in_process=in_process) == 1
    assert alive


def _lens(value: int) -> bytes:
    text = (FOLDER / "double-gauss-50mm-f2.json").read_bytes()
    lens = json.loads(text)
    lens["surfaces"][-1]["thickness"] += value
    return json.dumps(lens).encode()


def _opencv(value: int) -> bytes:
    matrix = {"rows": 3, "cols": 3, "data": [500 + value, 0, 320, 0, 500, 240, 0, 0, 1]}
    found = {
        "image_width": 640,
        "image_height": 480,
        "camera_matrix": matrix,
        "distortion_coefficients": {"rows": 1, "cols": 5, "data": [0.1, 0, 0, 0, 0]},
    }
    return json.dumps(found).encode()


def _of_sky(path: Path) -> float:
    scene = dg.Scene()
    scene.set_environment(path)
    return _sky(scene)


_READ: dict[str, tuple[str, Callable[[int], bytes], Callable[[Path], float]]] = {
    "environment": ("a.hdr", _hdr, _of_sky),
    "photometry": (
        "a.ies",
        lambda k: ies_text(candelas=f"10{k} 60 20").encode(),
        lambda path: dg.LightProfile.from_ies(path).peak,
    ),
    "lens": ("a.json", _lens, lambda path: dg.lenses.read(path).surfaces[-1].thickness),
    "calibration": (
        "a.json",
        _opencv,
        lambda path: dg.calibration.read(path).projection.focal[0],
    ),
}


@pytest.mark.parametrize("by", ["writing", "rename"])
@pytest.mark.parametrize("name", _READ)
def test_other_files_have_the_new_content(name: str, by: str, tmp_path: Path) -> None:
    file, content, value = _READ[name]
    path = tmp_path / file
    path.write_bytes(content(1))
    old = value(path)
    _edit(path, content(2), by)
    assert value(path) > old


def test_a_camera_has_the_new_lens(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    path.write_bytes(_lens(1))
    camera = dg.Camera(lens=str(path))
    old = prescription_of(camera).surfaces[-1].thickness
    _edit(path, _lens(2), "writing")
    assert prescription_of(camera).surfaces[-1].thickness == old + 1
