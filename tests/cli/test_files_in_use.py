"""No command writes onto a file that it reads, whatever links and roles the file has."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.errors import UsageError
from daguerre.files import in_use
from daguerre.files.atomic import atomic_path, write_bytes
from daguerre.files.reading import read_bytes
from daguerre.lenses.index import FOLDER

SMALL = ["--res", "16x8", "--spp", "1", "-q"]
SAID = "cannot write: this command reads this file"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a scene, a frame, a grey picture and files of cameras."""
    folder = tmp_path_factory.mktemp("made")
    assert main(["chart", "colour", "-o", str(folder / "s.glb")]) == 0
    assert main(["render", str(folder / "s.glb"), *SMALL, "-o", str(folder / "e.exr")]) == 0
    png = oiio.ImageOutput.create("png")
    png.open(str(folder / "g.png"), oiio.ImageSpec(8, 8, 1, "uint8"))
    png.write_image(np.full((8, 8, 1), 255, np.uint8))
    png.close()
    lens = FOLDER / "double-gauss-50mm-f2.json"
    shutil.copy(lens, folder / "lens.json")
    camera = {"fl_x": 50, "fl_y": 50, "cx": 32, "cy": 24, "w": 64, "h": 48}
    frame = {"file_path": "a", "transform_matrix": np.eye(4).tolist()}
    (folder / "camera.json").write_text(json.dumps({**camera, "frames": [frame]}))
    (folder / "kinds.json").write_text('{"*": "thing"}')
    return folder


@pytest.fixture
def folder(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A fresh copy, which is the current folder."""
    shutil.copytree(made, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(words: list[str], victim: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Checks that a command line is refused, and that the file and its neighbours stay."""
    before = Path(victim).read_bytes(), sorted(Path().iterdir())
    capsys.readouterr()
    code = main(words)
    error = capsys.readouterr().err
    assert (code, SAID in error) == (2, True), error
    assert (Path(victim).read_bytes(), sorted(Path().iterdir())) == before


RENDER = ["render", "s.glb", *SMALL]
LENS = ["--lens", "lens.json"]
VICTIMS = [
    ([*RENDER, "--env", "e.exr", "-o", "e.exr"], "e.exr"),
    ([*RENDER, "--env", "e.exr", "-o", "./../{here}/e.exr"], "e.exr"),
    ([*RENDER, "--env", "e.exr", "-o", "a.png", "-o", "e.exr"], "e.exr"),
    ([*RENDER, "--env", "e.exr", "-o", "a.exr", "--export-raymap", "e.exr"], "e.exr"),
    ([*RENDER, "--env", "e.exr", *LENS, "--export-stmap-undistort", "e.exr"], "e.exr"),
    ([*RENDER, *LENS, "--iris-mask", "g.png", "-o", "g.png"], "g.png"),
    ([*RENDER, *LENS, "--aperture-image", "g.png", "-o", "g.png"], "g.png"),
    ([*RENDER, *LENS, "-o", "a.png", "--coco", "lens.json"], "lens.json"),
    ([*RENDER, "--calibration", "camera.json", "-o", "a.png", "--coco", "camera.json"],
     "camera.json"),
    ([*RENDER, "-o", "a.png", "--coco", "kinds.json", "--categories", "kinds.json"],
     "kinds.json"),
    (["develop", "e.exr", "-o", "e.exr"], "e.exr"),
    (["post", "e.exr", "-o", "g.exr", "--effect", "psf:file=k.exr"], "k.exr"),
    (["post", "e.exr", "-o", "k.exr", "--effect", "stmap:file=k.exr"], "k.exr"),
    (["post", "e.exr", "-o", "a.exr", "--effect",
      "distortion:k1=-0.1,focal_length=50,sensor=36x24,stmap=e.exr"], "e.exr"),
    (["composite", "e.exr", "k.exr", "-o", "k.exr"], "k.exr"),
    (["light-probe", "k.exr", "-o", "k.exr"], "k.exr"),
    (["calibrate", "lens.json", "--res", "64x48", "-o", "lens.json"], "lens.json"),
    (["lens", "lens.json", "--export", "lens.json"], "lens.json"),
]  # fmt: skip


@pytest.mark.parametrize(("words", "victim"), VICTIMS, ids=str)
def test_an_input_is_never_an_output(
    folder: Path, words: list[str], victim: str, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copy("e.exr", "k.exr")
    if words[:3] == ["post", "e.exr", "-o"] and words[3] == "g.exr":
        os.link("k.exr", "g.exr")
    refused([word.format(here=folder.name) for word in words], victim, capsys)


@pytest.mark.parametrize("link", [os.link, os.symlink])
@pytest.mark.parametrize("way", ["output", "input"])
def test_links_are_followed(
    folder: Path, link: Callable[..., None], way: str, capsys: pytest.CaptureFixture[str]
) -> None:
    link(folder / "e.exr", folder / "other.exr")
    names = ("e.exr", "other.exr") if way == "output" else ("other.exr", "e.exr")
    refused([*RENDER, "--env", names[0], "-o", names[1]], "e.exr", capsys)


def test_checkpoint_and_frames_of_a_sequence(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copy("e.exr", "f.0002.exr")
    shutil.copy("e.exr", "a.checkpoint.exr")
    shutil.copy("e.exr", "p.0002.exr")
    shutil.copy("e.exr", "p.0001.exr")
    env = [*RENDER, "--env"]
    refused([*env, "a.checkpoint.exr", "-o", "a.exr"], "a.checkpoint.exr", capsys)
    refused([*env, "f.0002.exr", "-o", "f.####.exr", "--frames", "1-2"], "f.0002.exr", capsys)
    plates = [*RENDER, "--plate", "p.####.exr", "--frames", "1-2", "--catcher", "chart"]
    refused([*plates, "-o", "p.####.exr"], "p.0001.exr", capsys)


def test_what_scenes_name(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    dg.export_scene(dg.load("s.glb"), "s.pbrt")
    Path("s.pbrt").rename("inner.exr")
    Path("o.pbrt").write_text('Include "inner.exr"\n')
    refused(["render", "o.pbrt", *SMALL, "-o", "inner.exr"], "inner.exr", capsys)
    scene = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "b.exr", "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]}],
        "images": [{"uri": "g.png"}],
        "textures": [{"source": 0}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 3]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
        "scenes": [{"nodes": [0, 1]}],
    }  # fmt: skip
    Path("b.exr").write_bytes(np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0]]).tobytes())
    Path("t.gltf").write_text(json.dumps(scene))
    refused(["render", "t.gltf", *SMALL, "-o", "b.exr"], "b.exr", capsys)
    refused(["render", "t.gltf", *SMALL, "-o", "g.png"], "g.png", capsys)


def test_stages_and_their_layers(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pxr")
    Path("in.usda").write_text('#usda 1.0\ndef Camera "C" {}\n')
    Path("s.usda").write_text("#usda 1.0\n(subLayers = [@in.usda@])\n")
    refused(["export-camera", "s.usda", "-o", "s.usda"], "s.usda", capsys)
    refused(["export-camera", "s.usda", "-o", "in.usda"], "in.usda", capsys)


def test_scenes_for_other_renderers(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder of meshes and pictures loses no file of a scene that the command reads."""
    assert main(["export-scene", "s.glb", "-o", "s.pbrt"]) == 0
    refused(["export-scene", "s.pbrt", "-o", "s.pbrt"], "s.pbrt", capsys)
    kept = sorted(path.name for path in Path("s-pbrt-files").iterdir())
    Path("s.pbrt").rename("old.pbrt")
    assert main(["export-scene", "old.pbrt", "-o", "s.pbrt", "--res", "32x16"]) == 0
    assert {path.name for path in Path("s-pbrt-files").iterdir()} >= {*kept}


def test_meant_in_place(folder: Path) -> None:
    """Darkroom and merge may replace their picture, and a render its checkpoint."""
    shutil.copy("e.exr", "k.exr")
    assert main(["post", "k.exr", "-o", "k.exr", "--effect", "saturation-vignetting:k1=-0.1"]) == 0
    assert Path("k.exr").read_bytes() != Path("e.exr").read_bytes()
    for part in ("0:1", "1:2"):
        name = f"part{part[0]}.exr"
        words = ["--samples", part, "--spp", "2", "-o", name]
        assert main(["render", "s.glb", "--res", "16x8", "-q", *words]) == 0
    assert main(["merge", "part0.exr", "part1.exr", "-o", "part0.exr", "-q"]) == 0
    assert main([*RENDER, "-o", "e.exr", "--resume"]) == 0  # it may be there already


def test_outputs_of_effects_differ(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    effect = "distortion:k1=-0.1,focal_length=50,sensor=36x24,stmap=a.exr"
    assert main(["post", "e.exr", "-o", "a.exr", "--effect", effect]) == 2
    assert "another output has this name" in capsys.readouterr().err
    assert not Path("a.exr").exists()


def test_record_of_a_command(tmp_path: Path) -> None:
    """Without a command nothing is refused; within one, numbers of gone files are not."""
    first, other = tmp_path / "first", tmp_path / "other"
    write_bytes(first, b"1")
    read_bytes(first)
    write_bytes(first, b"2")
    with in_use.command():
        with atomic_path(other) as temp:
            temp.write_bytes(b"3")
        read_bytes(other)
        write_bytes(other, b"4")  # its own file
        read_bytes(first)
        with pytest.raises(UsageError, match="reads this file"):
            write_bytes(first, b"5")
        first.unlink()
        write_bytes(first, b"6")
    with in_use.command(), in_use.in_place():
        read_bytes(first)
        write_bytes(first, b"7")
    with in_use.command():
        in_use.claim(first)
        with pytest.raises(UsageError, match="reads this file"):
            in_use.note_read([first])
    assert first.read_bytes() == b"7"


@pytest.mark.parametrize("make", [os.mkfifo, lambda path: Path(path).symlink_to(path)])
def test_odd_outputs(folder: Path, make: Callable[[str], None]) -> None:
    """A pipe is not replaced by a picture, nor a link to itself; neither is an internal error."""
    make("odd.exr")
    assert main([*RENDER, "-o", "odd.exr"]) == 5
    assert Path("odd.exr").is_fifo() or Path("odd.exr").is_symlink()
