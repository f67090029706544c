"""Folder of a written scene: whole at any moment, and nothing else in it is touched."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

import daguerre as dg
from daguerre.exporters.outgoing.folder import OutgoingFolder
from daguerre.exporters.outgoing.picture_file import write_pixels


def test_equal_content_is_one_file(tmp_path: Path) -> None:
    folder = OutgoingFolder(tmp_path / "room.pbrt")
    first, second = folder.add("mesh", ".ply", b"a"), folder.add("mesh", ".ply", b"a")
    other = folder.add("mesh", ".ply", b"b")
    assert first == second != other
    assert (tmp_path / first).read_bytes() == b"a"
    assert first.startswith("room-pbrt-files/mesh-")


def test_files_of_an_earlier_scene_go_after_the_new_one_stands(tmp_path: Path) -> None:
    scene = tmp_path / "room.xml"
    one = OutgoingFolder(scene)
    stale = tmp_path / one.add("mesh", ".ply", b"old")
    kept = tmp_path / one.add("mesh", ".ply", b"kept")
    one.finish("first")
    mine = stale.parent / "notes.txt"
    mine.write_text("mine")
    two = OutgoingFolder(scene)
    two.add("mesh", ".ply", b"kept")
    assert stale.is_file()
    assert scene.read_text() == "first"
    two.finish("second")
    assert scene.read_text() == "second"
    assert not stale.exists()
    assert kept.is_file()
    assert mine.read_text() == "mine"


def test_a_scene_that_fails_leaves_the_earlier_one_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]))
    scene.add_camera("main", dg.Camera(lens="pinhole"))
    file = tmp_path / "room.xml"
    dg.export_scene(scene, file, resolution=(8, 8))
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    scene.add_instance(scene.add_mesh([(0, 0, 1), (1, 0, 1), (0, 1, 1)], [(0, 1, 2)]))
    monkeypatch.setattr(OutgoingFolder, "finish", _full)
    with pytest.raises(dg.OutputError, match="full"):
        dg.export_scene(scene, file, resolution=(8, 8))
    assert before.items() <= {p: p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()}.items()


def _full(*_: object) -> None:
    raise dg.OutputError("the disk is full")


@pytest.mark.parametrize(("dtype", "channels"), [(np.uint8, 3), (np.uint8, 1), (np.float32, 3)])
def test_pixels_come_back_as_they_were(tmp_path: Path, dtype: type, channels: int) -> None:
    rng = np.random.default_rng(2)
    pixels = (rng.random((5, 7, channels)) * 255).astype(dtype)
    path = write_pixels(OutgoingFolder(tmp_path / "a.xml"), "texture", pixels)
    file = oiio.ImageInput.open(str(tmp_path / path))
    found = file.read_image(oiio.UINT8 if dtype == np.uint8 else oiio.FLOAT)
    np.testing.assert_array_equal(np.asarray(found).reshape(pixels.shape), pixels)
    assert file.spec().channelnames == (("Y",) if channels == 1 else ("R", "G", "B"))
