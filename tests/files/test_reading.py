"""A file that cannot be read is one error with the same words for every reader."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

import daguerre as dg
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.files.reading import decoded, document, opened, read_bytes
from daguerre.importers.meshes import ply
from daguerre.pictures.exr.reader import ExrReader
from daguerre.pictures.iris import read_grey
from daguerre.pictures.light import read_environment
from daguerre.plates.files import read
from daguerre.post import recipe
from daguerre.rendering.passes import read_pass


def _folder(path: Path) -> None:
    path.mkdir()


def _loop(path: Path) -> None:
    path.symlink_to(path)


FAULTS: dict[str, tuple[Callable[[Path], object], str]] = {
    "missing": (lambda path: None, "no such file"),
    "folder": (_folder, "wanted a file, got a folder"),
    "pipe": (os.mkfifo, "not a regular file"),
    "loop": (_loop, "cannot read: Too many levels of symbolic links"),
}
READERS: dict[str, Callable[[Path], object]] = {
    "a.glb": dg.load,
    "a.xml": dg.load,
    "a.pbrt": dg.load,
    "a.ies": dg.LightProfile.from_ies,
    "a.exr": dg.load_frame,
    "a.zmx": dg.lenses.read,
    "a.yaml": dg.calibration.read_opencv,
    "a.json": dg.Categories.read,
    "recipe.json": recipe.from_file,
    "photo.jpg": read,
    "raw.dng": read,
    "env.hdr": read_environment,
    "psf.exr": read_environment,
    "map.exr": ExrReader,
    "iris.png": read_grey,
    "sensor.json": dg.sensors.read,
    "stock.json": dg.stocks.read,
    "pass.exr": read_pass,
    "a.ply": lambda path: ply.read(path, Notes()),
}


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("fault", FAULTS)
def test_each_reader_has_the_same_words(tmp_path: Path, name: str, fault: str) -> None:
    make, words = FAULTS[fault]
    make(tmp_path / name)
    with pytest.raises(InputError) as caught:
        READERS[name](tmp_path / name)
    assert str(caught.value).startswith(f"{tmp_path / name}: {words}")


@pytest.mark.parametrize("name", ["cameras.txt", "camera.json", "camera.xml", "camera.bin", "c"])
def test_calibrations_wait_for_no_pipe(tmp_path: Path, name: str) -> None:
    os.mkfifo(tmp_path / name)
    with pytest.raises(InputError, match="not a regular file"):
        dg.calibration.read_all(tmp_path / name)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read anything")
def test_a_file_that_may_not_be_read(tmp_path: Path) -> None:
    (tmp_path / "a.glb").touch(mode=0)
    with pytest.raises(InputError, match=r"a\.glb: cannot read: Permission denied"):
        dg.load(tmp_path / "a.glb")


def test_sizes_and_texts(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"12345")
    assert read_bytes(tmp_path / "a", 5) == b"12345"
    with pytest.raises(InputError, match="wanted at most 4 bytes, got 5"):
        read_bytes(tmp_path / "a", 4)
    with pytest.raises(InputError, match="x: wanted UTF-8, got byte 0xff at byte 2"):
        decoded(b"ab\xff", "x")
    with pytest.raises(InputError, match="x: empty file"):
        document(b" \n", "x")


def test_a_pipe_that_takes_the_place_of_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even between check and opening, nothing is waited for."""
    os.mkfifo(tmp_path / "pipe")
    monkeypatch.setattr("daguerre.files.reading.fault_of", lambda path: "")
    with pytest.raises(InputError, match="not a regular file"):
        opened(tmp_path / "pipe")
