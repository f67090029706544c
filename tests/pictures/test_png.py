"""PNG files row by row: what is written, what reaches the disk, and what is noticed."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

from daguerre.errors import OutputError
from daguerre.pictures.png import PngWriter
from daguerre.pictures.png_chunks import is_complete
from daguerre.post.display import Display
from daguerre.post.picture import Canvas

NOISE = np.random.default_rng(5).integers(0, 256, (60, 400, 3), np.uint8)


def written(path: Path, parts: list[np.ndarray]) -> bytes:
    writer = PngWriter(path, 400, sum(len(part) for part in parts))
    for part in parts:
        writer.write(part)
    writer.close()
    return path.read_bytes()


def test_any_bands_are_the_same_picture(tmp_path):
    whole = written(tmp_path / "whole.png", [NOISE])
    assert written(tmp_path / "bands.png", [NOISE[:7], NOISE[7:8], NOISE[8:]]) == whole
    read = oiio.ImageInput.open(str(tmp_path / "bands.png")).read_image(oiio.UINT8)
    assert np.array_equal(read, NOISE)


def test_rows_reach_the_disk_before_the_last_is_made(tmp_path):
    path = tmp_path / "rows.png"
    canvas = Canvas.of((400, 600, 3), (), "test")
    light = np.random.default_rng(2).random((200, 600, 3), np.float32)
    display = Display(path, canvas, path)
    display.write(light)
    assert path.stat().st_size > 0.7 * light.size  # noise cannot be deflated
    display.write(light)
    display.__exit__(None, None, None)


def test_a_full_disk_is_said_in_one_line_and_early(tmp_path):
    full = tmp_path / "full.png"
    full.symlink_to("/dev/full")
    writer = PngWriter(full, 400, 600, target="out.png")
    with pytest.raises(OutputError, match=r"^out.png: cannot write: [^\n]*$"):
        writer.write(np.tile(NOISE, (4, 1, 1)))


def test_files_that_end_early_or_have_a_wrong_bit_are_noticed(tmp_path):
    good = written(tmp_path / "good.png", [NOISE[:2]])
    assert is_complete(io.BytesIO(good))
    for cut in range(8, len(good), 97):
        assert not is_complete(io.BytesIO(good[:cut]))
        wrong = bytearray(good)
        wrong[cut] ^= 4
        assert not is_complete(io.BytesIO(bytes(wrong)))
    assert not is_complete(io.BytesIO(good + b"\0"))
