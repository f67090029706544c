"""``dg.export_scene`` and ``daguerre export-scene``: errors, notes, formats."""

from __future__ import annotations

import os
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from tests.support.formats import pbrt_syntax
from tests.support.scene import outgoing_scenes


@pytest.fixture
def chart(tmp_path: Path) -> Path:
    """A scene file with a camera."""
    path = tmp_path / "chart.glb"
    dg.charts.make("slanted-edge").save(path)
    return path


@pytest.mark.parametrize("suffix", ["pbrt", "xml"])
def test_the_command(
    chart: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], suffix: str
) -> None:
    out = tmp_path / f"scene.{suffix}"
    words = ["export-scene", str(chart), "-o", str(out), "--res", "64x48", "--spp", "7"]
    assert main([*words, "--lens", "thin", "--focal-length", "40", "--f-stop", "2"]) == 0
    told = capsys.readouterr().err
    assert f"wrote {out}" in told
    if suffix == "pbrt":
        found = {one.name: one for one in pbrt_syntax.read(out.read_text())}
        assert found["Film"].values("xresolution") == [64]
        assert found["Sampler"].values("pixelsamples") == [7]
        assert found["Camera"].values("lensradius") == [pytest.approx(0.01)]
    else:
        root = ElementTree.fromstring(out.read_text())
        assert root.find("sensor").get("type") == "thinlens"  # type: ignore[union-attr]
        counts = {item.get("name"): item.get("value") for item in root.iter("integer")}
        assert (counts["width"], counts["height"], counts["sample_count"]) == ("64", "48", "7")


def test_a_wrong_command_is_one_error(
    chart: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = str(chart)
    assert main(["export-scene", scene]) == 2
    assert main(["export-scene", scene, "-o", str(tmp_path / "a.usda")]) == 2
    assert main(["export-scene", scene, "-o", str(tmp_path / "none" / "a.xml")]) == 5
    assert main(["export-scene", str(tmp_path / "no.glb"), "-o", str(tmp_path / "a.xml")]) == 3
    assert main(["export-scene", scene, "-o", str(tmp_path / "a.xml"), "-c", "nobody"]) == 3
    assert main(["export-scene", scene, "-o", str(tmp_path / "a.xml"), "--spp", "0"]) == 2
    told = capsys.readouterr().err
    assert "Traceback" not in told
    assert ".pbrt or .xml" in told
    assert {path.stem for path in tmp_path.iterdir()} == {"chart"}


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_that_cannot_be_written_is_one_error(chart: Path, tmp_path: Path) -> None:
    locked = tmp_path / "locked"
    locked.mkdir(mode=0o555)
    assert main(["export-scene", str(chart), "-o", str(locked / "a.xml")]) == 5


def test_a_file_where_the_folder_belongs_is_one_error(tmp_path: Path) -> None:
    (tmp_path / "a-xml-files").write_text("in the way")
    with pytest.raises(dg.OutputError, match="a-xml-files: cannot write"):
        dg.export_scene(outgoing_scenes.box(), tmp_path / "a.xml", resolution=(8, 8))
    assert not (tmp_path / "a.xml").exists()


def test_a_scene_without_a_camera_is_one_error(tmp_path: Path) -> None:
    scene = dg.Scene()
    outgoing_scenes.card(scene)
    scene.add_instance(0)
    with pytest.raises(dg.InputError, match="no camera: the file has none"):
        dg.export_scene(scene, tmp_path / "a.pbrt")
    assert list(tmp_path.iterdir()) == []


def test_a_scene_that_cannot_be_drawn_is_one_error(tmp_path: Path) -> None:
    scene = outgoing_scenes.box()
    scene.add_instance(0, dg.Diffuse((2.0, 0.0, 0.0)))
    with pytest.raises(dg.InputError, match="reflectance"):
        dg.export_scene(scene, tmp_path / "a.xml", resolution=(8, 8))


def test_twice_the_same_is_the_same_bytes(tmp_path: Path) -> None:
    scene = outgoing_scenes.layered()
    for suffix in ("pbrt", "xml"):
        file = tmp_path / f"a.{suffix}"
        dg.export_scene(scene, file, resolution=(8, 8))
        first = {path: path.read_bytes() for path in tmp_path.rglob(f"*{suffix}*/*")}
        text = file.read_bytes()
        dg.export_scene(scene, file, resolution=(8, 8))
        assert file.read_bytes() == text
        assert {path: path.read_bytes() for path in tmp_path.rglob(f"*{suffix}*/*")} == first


#: Parts of a scene or a camera, and words of the note on each, for both formats.
LEFT_OUT: dict[str, tuple[Any, str]] = {
    "range": (lambda s: s.add_light(dg.PointLight((1, 1, 1), range=2.0)), "range of a light"),
    "sun": (lambda s: s.add_light(dg.DirectionalLight((1, 1, 1), angle=1.0)), "sharp"),
    "curves": (
        lambda s: s.add_instance(
            s.add_curves([(0, 0, 0), (1, 0, 0)], [2], 0.1, basis="linear"), dg.Diffuse()
        ),
        "curves are left out",
    ),
    "clearcoat": (lambda s: s.add_instance(0, dg.Gltf(clearcoat=1.0)), "clear coat"),
    "motion": (
        lambda s: s.add_instance(0, None, dg.spin((0, 1, 0), 10.0)), "motion is left out"
    ),
}  # fmt: skip


@pytest.mark.parametrize("suffix", ["pbrt", "xml"])
@pytest.mark.parametrize("name", LEFT_OUT)
def test_what_is_left_out_is_noted_once_with_a_count(
    name: str, suffix: str, tmp_path: Path
) -> None:
    add, words = LEFT_OUT[name]
    scene = outgoing_scenes.room()
    file = tmp_path / f"a.{suffix}"
    before = dg.export_scene(scene, file, resolution=(8, 8))
    assert not [text for text in before if words in text]
    add(scene)
    add(scene)
    (note,) = [text for text in dg.export_scene(scene, file, resolution=(8, 8)) if words in text]
    assert note.endswith("(2 uses)") or name == "motion"


@pytest.mark.parametrize("suffix", ["pbrt", "xml"])
@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"tilt": (3.0, 0.0), "lens": "thin", "f_stop": 2.0}, "tilt of the lens"),
        ({"blades": 6, "lens": "thin", "f_stop": 2.0}, "iris"),
        ({"natural_vignetting": True}, "cos^4"),
        ({"lens": "double-gauss-50mm-f2", "focal_length": None}, "lens"),
    ],
)
def test_what_a_camera_lacks_there_is_noted(
    change: dict[str, Any], words: str, suffix: str, tmp_path: Path
) -> None:
    scene = outgoing_scenes.box()
    plain = {"focal_length": None} if "lens" in change else {}
    camera = outgoing_scenes.camera(**(plain | {"focus_distance": 5.0} | change))
    notes = dg.export_scene(scene, tmp_path / f"a.{suffix}", camera, resolution=(8, 8))
    assert any(words in text for text in notes), notes


def test_hidden_instances_are_not_written(tmp_path: Path) -> None:
    scene = outgoing_scenes.box()
    hidden = outgoing_scenes.letter(scene)
    scene.add_instance(hidden, dg.Diffuse(), shown=False)
    dg.export_scene(scene, tmp_path / "a.xml", resolution=(8, 8))
    root = ElementTree.fromstring((tmp_path / "a.xml").read_text())
    meshes = {item.get("value") for item in root.iter("string") if item.get("name") == "filename"}
    assert len([name for name in meshes if name and name.endswith(".ply")]) == 2


@pytest.mark.parametrize("suffix", ["pbrt", "xml"])
def test_the_scene_itself_is_not_written_over(chart: Path, tmp_path: Path, suffix: str) -> None:
    path, link = tmp_path / f"scene.{suffix}", tmp_path / f"link.{suffix}"
    dg.export_scene(dg.load(chart), path)
    before = path.read_bytes()
    link.symlink_to(path)
    scene = dg.load(path)
    for target in (path, link, tmp_path / "." / path.name):
        with pytest.raises(dg.errors.UsageError, match="this command reads this file"):
            dg.export_scene(scene, target)
    assert path.read_bytes() == before
    dg.export_scene(scene, tmp_path / f"other.{suffix}")


def test_the_shift_of_a_pinhole_comes_back(chart: Path, tmp_path: Path) -> None:
    scene = dg.load(chart)
    camera = dg.Camera(lens="pinhole", sensor_size=(36, 24), shift=(4.0, -2.5))
    for suffix in ("xml", "pbrt"):
        dg.export_scene(scene, tmp_path / f"s.{suffix}", camera, resolution=(60, 40))
        found = dg.load(tmp_path / f"s.{suffix}").camera()
        share = np.divide(found.shift, found.sensor_size)
        assert share == pytest.approx((4 / 36, -2.5 / 24), rel=1e-3)
