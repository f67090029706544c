"""Pictures of an iris: light, and files of strangers."""

import struct
import zlib

import numpy as np
import pytest

from daguerre.errors import InputError
from daguerre.pictures.iris import read_grey
from tests.support.formats.make_gltf import png


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def test_grey_is_the_mean_of_the_channels(tmp_path):
    pixels = np.array([[[0, 51, 102], [255, 255, 255]]], np.uint8)
    (tmp_path / "iris.png").write_bytes(png(pixels))
    np.testing.assert_allclose(read_grey(tmp_path / "iris.png"), [[0.2, 1.0]], atol=1e-6)


def test_a_huge_iris_is_refused_before_it_is_decoded(tmp_path):
    data = bytearray(png(np.zeros((1, 1, 3), np.uint8)))
    header = struct.pack(">IIBBBBB", 60000, 60000, 8, 2, 0, 0, 0)
    (tmp_path / "iris.png").write_bytes(data[:8] + chunk(b"IHDR", header) + data[33:])
    with pytest.raises(InputError, match="image size: wanted at most"):
        read_grey(tmp_path / "iris.png")


def test_a_damaged_iris_is_one_line(tmp_path):
    data = png(np.zeros((4, 4, 3), np.uint8))
    bad = chunk(b"IDAT", zlib.compress(bytes([9] * 52)))  # there is no filter 9
    (tmp_path / "iris.png").write_bytes(data[:33] + bad + chunk(b"IEND", b""))
    with pytest.raises(InputError, match=r"iris\.png: cannot be decoded: [^\n]*$"):
        read_grey(tmp_path / "iris.png")
