"""Files that a scene names and that do not exist: a note in all formats, an error if strict."""

from __future__ import annotations

import base64
import json
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from tests.importers.mitsuba.scene_files import text_of

#: A triangle whose material has a picture.
_CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], "<f4").tobytes()
GLTF = {
    "asset": {"version": "2.0"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [
        {
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.2, 0.4, 0.6, 1.0],
                "baseColorTexture": {"index": 0},
            }
        }
    ],
    "textures": [{"source": 0}],
    "images": [{"uri": "none.png"}],
    "accessors": [
        {
            "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 1, 0],
        }
    ],
    "bufferViews": [{"buffer": 0, "byteLength": len(_CORNERS)}],
    "buffers": [
        {
            "byteLength": len(_CORNERS),
            "uri": "data:application/octet-stream;base64," + base64.b64encode(_CORNERS).decode(),
        }
    ],
}  # fmt: skip
_SHAPE = '<shape type="sphere"/>'
_NONE = '<string name="filename" value="{}"/>'


def _mitsuba(*parts: str) -> bytes:
    return text_of(_SHAPE, *parts)


def _sphere(inside: str) -> str:
    return f'<shape type="sphere">{inside}</shape>'


FILES = {
    "picture.gltf": (json.dumps(GLTF).encode(), "none.png", 1),
    "picture.xml": (
        _mitsuba(
            _sphere(
                '<bsdf type="diffuse"><texture type="bitmap" name="reflectance">'
                + _NONE.format("none.png")
                + "</texture></bsdf>"
            )
        ),
        "none.png",
        2,
    ),
    "mesh.xml": (_mitsuba(f'<shape type="ply">{_NONE.format("none.ply")}</shape>'), "none.ply", 1),
    "curves.xml": (
        _mitsuba(f'<shape type="bsplinecurve">{_NONE.format("none.txt")}</shape>'),
        "none.txt",
        1,
    ),
    "sky.xml": (
        _mitsuba(f'<emitter type="envmap">{_NONE.format("none.exr")}</emitter>'),
        "none.exr",
        1,
    ),
    "spectrum.xml": (
        _mitsuba(
            _sphere(
                '<bsdf type="diffuse"><spectrum name="reflectance" filename="none.spd"/></bsdf>'
            )
        ),
        "none.spd",
        2,
    ),
    "medium.xml": (
        _mitsuba(
            _sphere(
                '<medium type="heterogeneous" name="interior"><volume type="gridvolume" '
                f'name="sigma_t">{_NONE.format("none.vol")}</volume></medium>'
            )
        ),
        "none.vol",
        2,
    ),
    "picture.pbrt": (
        b'WorldBegin\nTexture "a" "spectrum" "imagemap" "string filename" "none.png"\n'
        b'Material "diffuse" "texture reflectance" "a"\nShape "sphere"\n',
        "none.png",
        1,
    ),
    "mesh.pbrt": (
        b'WorldBegin\nShape "sphere"\nShape "plymesh" "string filename" "none.ply"\n',
        "none.ply",
        1,
    ),
}


@pytest.mark.parametrize("name", FILES)
def test_a_missing_file_is_noted(name: str, tmp_path: Path) -> None:
    data, missing, instances = FILES[name]
    path = tmp_path / name
    path.write_bytes(data)
    scene = dg.load(path)
    (note,) = [note for note in scene.warnings if missing in note]
    assert "missing" in note
    assert len(scene.instances) == instances
    with pytest.raises(dg.InputError, match=rf"strict: the file has notes: .*{missing}"):
        dg.load(path, strict=True)


def test_strict_is_an_error_of_the_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "picture.gltf"
    path.write_bytes(FILES["picture.gltf"][0])
    assert main(["info", str(path)]) == 0
    assert main(["info", str(path), "--strict"]) == 3
    assert "none.png" in capsys.readouterr().err


def test_the_factor_of_a_missing_picture_stays(tmp_path: Path) -> None:
    path = tmp_path / "picture.gltf"
    path.write_bytes(FILES["picture.gltf"][0])
    scene = dg.load(path)
    assert scene.textures == []
    bare = json.loads(FILES["picture.gltf"][0])
    del bare["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
    other = tmp_path / "bare.gltf"
    other.write_text(json.dumps(bare))
    assert scene.materials == dg.load(other).materials


def test_names_that_leave_the_folder_are_refused_whether_they_exist_or_not(tmp_path: Path) -> None:
    for name, text in (
        ("picture.gltf", FILES["picture.gltf"][0].replace(b"none.png", b"../none.png")),
        ("mesh.xml", FILES["mesh.xml"][0].replace(b"none.ply", b"../none.ply")),
        ("sky.xml", FILES["sky.xml"][0].replace(b"none.exr", b"/none/none.exr")),
    ):
        path = tmp_path / name
        path.write_bytes(text)
        with pytest.raises(dg.InputError, match="leaves the scene's folder"):
            dg.load(path)


def test_texts_of_the_scene_itself_must_exist(tmp_path: Path) -> None:
    """Without its buffers or includes a scene is not the one in the file."""
    buffer = json.loads(FILES["picture.gltf"][0])
    buffer["buffers"][0]["uri"] = "none.bin"
    for name, data in (
        ("buffer.gltf", json.dumps(buffer).encode()),
        ("include.xml", _mitsuba('<include filename="none.xml"/>')),
    ):
        path = tmp_path / name
        path.write_bytes(data)
        with pytest.raises(dg.InputError, match="no such file"):
            dg.load(path)


def test_parts_of_0_bytes_that_nothing_reads_are_accepted(tmp_path: Path) -> None:
    odd = json.loads(FILES["picture.gltf"][0])
    odd["buffers"].append({"byteLength": 0})
    odd["bufferViews"] += [{"buffer": 0, "byteLength": 0}, {"buffer": 1, "byteLength": 0}]
    path = tmp_path / "odd.gltf"
    path.write_text(json.dumps(odd))
    assert len(dg.load(path).instances) == 1
    odd["accessors"][0]["bufferView"] = 1
    path.write_text(json.dumps(odd))
    with pytest.raises(dg.InputError, match="beyond its bufferView"):
        dg.load(path)


def test_comments_of_mitsuba_may_have_hyphens(tmp_path: Path) -> None:
    """Mitsuba's parser accepts them; places in messages stay."""
    text = b"<!-- a -- b --->\n" + _mitsuba("<!--- x -- <shape/> -->", "<!-- - -->")
    path = tmp_path / "scene.xml"
    path.write_bytes(text)
    assert len(dg.load(path).instances) == 1
    path.write_bytes(text.replace(b"</scene>", b"<!-- -- --> <odd></scene>"))
    with pytest.raises(dg.InputError, match="line 6, column 2"):
        dg.load(path)
