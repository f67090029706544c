"""Whole pictures as OpenEXR, read back by OpenEXR's own module."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest

from daguerre.pictures.exr.header import LONG_NAMES, read_headers
from daguerre.pictures.exr.layout import NONE
from daguerre.pictures.exr.whole import WholePart, planes_of, write_whole

LONG = "daguerre:a name of more than thirty-one bytes"


def part(name: str, height: int = 37, **more: Any) -> WholePart:
    """A part with a channel of each type, rows that fill no last block, and a window beside 0."""
    corner = np.array([3, -2], np.int32)
    window = corner, corner + np.array([20, height - 1], np.int32)
    random = np.random.default_rng(len(name))
    planes = {
        "RGB": random.random((height, 21, 3), np.float32),
        "b": np.linspace(0, 1, height * 21, dtype=np.float16).reshape(height, 21),
        "A_id": random.integers(0, 1 << 32, (height, 21), np.uint32),
        "flare": np.zeros((height, 21, 3), np.float32),
    }
    full = np.zeros(2, np.int32), np.array([99, 99], np.int32)  # the same in each part
    values = {"dataWindow": window, "displayWindow": full} | more
    return WholePart(name, values, planes_of(planes))


@pytest.mark.parametrize("names", [("one",), ("first", "second", "third")])
def test_openexr_reads_what_was_written(tmp_path: Path, names: tuple[str, ...]) -> None:
    matrix = np.arange(16, dtype=np.float32).reshape(4, 4)
    values = {"rate": Fraction(24000, 1001), "text": "grüße", "count": -3, "half": 0.5}
    values |= {"m": matrix, "v": np.array([1, 2], np.float32), LONG: "told"}
    parts = [part(name, height=1 + 18 * i, **values) for i, name in enumerate(names)]
    write_whole(tmp_path / "a.exr", parts)
    assert read_headers(tmp_path / "a.exr").parts[0].flags & LONG_NAMES
    with OpenEXR.File(str(tmp_path / "a.exr"), separate_channels=True) as file:
        assert len(file.parts) == len(parts)
        for read, made in zip(file.parts, parts, strict=True):
            header = read.header
            assert header["name"] == made.name
            assert header["compression"] == OpenEXR.ZIP_COMPRESSION
            assert tuple(header["dataWindow"][0]) == (3, -2)
            assert (header["rate"], header["text"]) == (values["rate"], values["text"])
            assert (header["count"], header["half"], header[LONG]) == (-3, 0.5, "told")
            np.testing.assert_array_equal(header["m"], matrix)
            assert list(read.channels) == sorted(made.planes)
            for name, plane in made.planes.items():
                np.testing.assert_array_equal(read.channels[name].pixels, plane)
                assert read.channels[name].pixels.dtype == plane.dtype


def test_pixels_may_be_plain(tmp_path: Path) -> None:
    write_whole(tmp_path / "a.exr", [made := part("one", compression=NONE)])
    with OpenEXR.File(str(tmp_path / "a.exr"), separate_channels=True) as file:
        assert file.header()["compression"] == OpenEXR.NO_COMPRESSION
        np.testing.assert_array_equal(file.channels()["G"].pixels, made.planes["G"])
