"""A file that cannot be read is one error with the same words for every reader."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

import daguerre as dg
from daguerre.errors import InputError
from daguerre.files.reading import decoded, document, read_bytes


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
}


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("fault", FAULTS)
def test_each_reader_has_the_same_words(tmp_path: Path, name: str, fault: str) -> None:
    make, words = FAULTS[fault]
    make(tmp_path / name)
    with pytest.raises(InputError) as caught:
        READERS[name](tmp_path / name)
    assert str(caught.value).startswith(f"{tmp_path / name}: {words}")


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
