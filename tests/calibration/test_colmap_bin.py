"""COLMAP's binary models: the same as their text, or one error."""

from __future__ import annotations

import random
import struct
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from daguerre import calibration
from daguerre.calibration.colmap_bin import NAMES
from daguerre.errors import InputError

#: Files that are kept beside the project.
CASES = Path(__file__).parents[3] / "shared" / "cases" / "files"
CAMERAS = """# Camera list
1 SIMPLE_RADIAL_FISHEYE 640 480 300 320.5 239.5 0.02
2 FULL_OPENCV 640 480 500 501 321 241 0.1 -0.05 0.001 -0.002 0.01 0.05 -0.01 0.002
3 FOV 640 480 400 401 320 240 0.8
4 OPENCV_FISHEYE 640 480 300 301 320 240 0.01 0.002 -0.001 0.0003
5 RADIAL 640 480 500 320 240 -0.1 0.02
6 RADIAL_FISHEYE 640 480 300 320 240 0.02 -0.003
7 SIMPLE_RADIAL 640 480 500 320 240 -0.1
8 OPENCV 640 480 520 515 331.8 237.3 -0.28 0.09 0.001 -0.002
9 PINHOLE 640 480 500 501 320 240
4000000000 SIMPLE_PINHOLE 640 480 500 320 240
"""
IMAGES = """# Image list with two lines of data per image
1 0.982103 0.100215 -0.150322 0.0501073 0.1 0.2 3.0 1 a.jpg
10 20 -1 30 40 5
2 1 0 0 0 0 0 0 2 b with space.jpg

3 1 0 0 0 0 0 0 4000000000 sub/\u00e9.jpg

"""


def written(folder: Path, cameras: str = CAMERAS, images: str | None = IMAGES) -> Path:
    """Writes a model as COLMAP does, from its text: little-endian, points behind each picture."""
    rows = [line.split() for line in cameras.splitlines() if not line.startswith("#")]
    data = struct.pack("<Q", len(rows))
    for camera, model, width, height, *numbers in rows:
        number = NAMES.index(model) if model in NAMES else int(model)
        data += struct.pack("<IiQQ", int(camera), number, int(width), int(height))
        data += struct.pack(f"<{len(numbers)}d", *map(float, numbers))
    (folder / "cameras.bin").write_bytes(data)
    if images is not None:
        lines = [line for line in images.split("\n") if not line.startswith("#")]
        pairs = list(zip(lines[0::2], lines[1::2], strict=False))
        data = struct.pack("<Q", len(pairs))
        for line, points in pairs:
            image, *pose, camera, name = line.split(maxsplit=9)
            data += struct.pack("<I7dI", int(image), *map(float, pose), int(camera))
            numbers = points.split()
            data += name.encode() + b"\0" + struct.pack("<Q", len(numbers) // 3)
            for x, y, point in zip(numbers[::3], numbers[1::3], numbers[2::3], strict=True):
                data += struct.pack("<2dq", float(x), float(y), int(point))
        (folder / "images.bin").write_bytes(data)
    return folder


def as_text(folder: Path) -> Path:
    (folder / "cameras.txt").write_text(CAMERAS)
    (folder / "images.txt").write_text(IMAGES, encoding="utf-8")
    return folder


def test_binary_models_are_those_of_their_text(tmp_path: Path) -> None:
    for name in ("text", "binary"):
        (tmp_path / name).mkdir()
    text = calibration.read_all(as_text(tmp_path / "text"), unit_m=0.5)
    binary = calibration.read_all(written(tmp_path / "binary"), unit_m=0.5)
    assert list(binary) == list(text) == ["a.jpg", "b with space.jpg", "sub/\u00e9.jpg"]
    for name, one in text.items():
        assert binary[name].projection == one.projection
        np.testing.assert_array_equal(binary[name].settings["transform"], one.settings["transform"])
    by_file = calibration.read_all(tmp_path / "binary" / "images.bin", unit_m=0.5)
    assert list(by_file) == list(text)
    for name in ("text", "binary"):
        for images in (tmp_path / name).glob("images.*"):
            images.unlink()
    text, binary = (calibration.read_all(tmp_path / name) for name in ("text", "binary"))
    assert {k: v.projection for k, v in binary.items()} == {
        k: v.projection for k, v in text.items()
    }


def test_text_goes_before_binary(tmp_path: Path) -> None:
    written(as_text(tmp_path))
    (tmp_path / "cameras.bin").write_bytes(b"")
    assert len(calibration.read_all(tmp_path)) == 3


@pytest.mark.parametrize(
    ("cameras", "images", "message"),
    [
        ("1 10 640 480 1 2 3 4 5 6 7 8 9 10 11 12", None, r"camera 1: model: .*THIN_PRISM"),
        ("1 99 640 480 1 2 3", None, "got number 99"),
        ("1 -1 640 480 1 2 3", None, "got number -1"),
        ("1 PINHOLE 640 0 500 500 320 240", None, "whole numbers of 1 .. 65536 px, got 0"),
        ("1 PINHOLE 640 480 nan 500 320 240", None, "finite number"),
        ("1 PINHOLE 640 480 500 500 320 240\n" * 2, None, "camera 1 appears twice"),
        ("", None, "no cameras"),
        (CAMERAS, "", "no pictures"),
        (CAMERAS, "1 2 0 0 0 0 0 0 1 a\n\n", "quaternion of length 1"),
        (CAMERAS, "1 nan 0 0 0 0 0 0 1 a\n\n", "finite number"),
        (CAMERAS, "1 1 0 0 0 0 0 0 77 a\n\n", "CAMERA_ID of cameras.bin, got '77'"),
        (CAMERAS, "1 1 0 0 0 0 0 0 1 a\n\n" * 2, "picture 'a' appears twice"),
    ],
)
def test_bad_models(tmp_path: Path, cameras: str, images: str | None, message: str) -> None:
    with pytest.raises(InputError, match=message):
        calibration.read_all(written(tmp_path, cameras, images))


def test_cut_and_damaged_files_are_errors_of_ours(tmp_path: Path) -> None:
    written(tmp_path)
    whole = {name: (tmp_path / name).read_bytes() for name in ("cameras.bin", "images.bin")}
    for name, data in whole.items():
        for end in range(0, len(data), 7):
            (tmp_path / name).write_bytes(data[:end])
            with pytest.raises(InputError, match=r"truncated|no (cameras|pictures)"):
                calibration.read_all(tmp_path)
        (tmp_path / name).write_bytes(data)
    dice = random.Random(3)
    for i in range(400):
        name = ("cameras.bin", "images.bin")[i % 2]
        data = bytearray(whole[name])
        for _ in range(dice.randrange(1, 4)):
            data[dice.randrange(len(data))] = dice.randrange(256)
        (tmp_path / name).write_bytes(data)
        with suppress(InputError):  # and nothing else
            calibration.read_all(tmp_path)
        (tmp_path / name).write_bytes(whole[name])


def test_a_count_of_thousands_of_millions_is_no_loop(tmp_path: Path) -> None:
    written(tmp_path)
    (tmp_path / "images.bin").write_bytes(struct.pack("<Q", 1 << 62) + b"\0" * 100)
    with pytest.raises(InputError, match="truncated"):
        calibration.read_all(tmp_path)


@pytest.mark.skipif(not CASES.is_dir(), reason="../shared/cases/files is not here")
def test_a_stub_of_a_model_is_an_error_of_its_file() -> None:
    with pytest.raises(InputError, match=r"cameras\.bin: truncated"):
        calibration.read_all(CASES / "colmap_bin")
