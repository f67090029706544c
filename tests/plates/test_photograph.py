"""Photographs from files: kinds, facts, orientation, alpha, and files that are none."""

import struct

import numpy as np
import OpenImageIO as oiio
import pytest
import tifffile

from daguerre.errors import InputError
from daguerre.frame.picture import Picture
from daguerre.plates.files import read
from daguerre.plates.photograph import encoded
from daguerre.plates.shot_facts import exif_number, shot_facts
from tests.support.pictures.plate_frames import FACTS, of_light, ramp

SHAPE = (64, 96)
TOLD = {"isoSpeed": 400, "lensMake": "Canon", "lensModel": "EF50mm f/1.8 STM", "focus": 2.5}


def raw(name="sony-a7r-ii"):
    return of_light(ramp(SHAPE), 0.1, **TOLD).expose(name, 400)


def with_orientation(path, turn):
    """Writes the EXIF orientation of a file of ours: one entry of its main directory."""
    data = bytearray(path.read_bytes())
    at = data.find(struct.pack("<HHIH", 274, 3, 1, 1))
    assert at > 0
    struct.pack_into("<H", data, at + 8, turn)
    path.write_bytes(bytes(data))


@pytest.mark.parametrize("ending", ["dng", "jpg", "png", "tif", "exr"])
def test_facts_come_back(tmp_path, ending):
    path = tmp_path / f"x.{ending}"
    raw().save(path)
    found = read(path)
    assert found.size == (96, 64)
    kinds = {"dng": "raw", "exr": "linear"}
    assert found.kind == kinds.get(ending, "display")
    for name, value in (FACTS | TOLD).items():
        assert found.facts[name] == pytest.approx(value), name
    assert found.notes == ()
    assert len(found.sha256()) == 64


@pytest.mark.parametrize("name", ["sony-a7r-ii", "raspberry-pi-hq", "fujifilm-x-t4", "ideal-mono"])
def test_mosaics_are_as_they_were_read(tmp_path, name):
    shot = raw(name)
    shot.save(tmp_path / "x.dng")
    found = read(tmp_path / "x.dng").raw
    np.testing.assert_array_equal(found.mosaic, shot.mosaic)
    np.testing.assert_array_equal(found.cells, shot.sensor.pattern.cells)
    assert found.channels == shot.sensor.channels
    assert found.black.tolist() == [shot.black_level] * len(found.channels)
    assert found.white == shot.white_level
    assert found.white_balance == pytest.approx((0.3127, 0.329), abs=2e-3)


@pytest.mark.parametrize("turn", [1, 3, 6, 8])
def test_dng_is_turned_with_its_mosaic(tmp_path, turn):
    shot, path = raw(), tmp_path / "x.dng"
    shot.save(path)
    with tifffile.TiffFile(path, mode="r+b") as file:
        file.pages[0].tags["Orientation"].overwrite(turn)
    found = read(path)
    turns = {1: 0, 3: 2, 6: 3, 8: 1}[turn]
    np.testing.assert_array_equal(found.raw.mosaic, np.rot90(shot.mosaic, turns))
    cells = np.rot90(shot.channel_map(), turns)
    height, width = cells.shape
    tiled = np.tile(found.raw.cells, (height // 2, width // 2))
    np.testing.assert_array_equal(tiled, cells)
    size = FACTS["sensorOverallDimensions"]
    assert found.facts["sensorOverallDimensions"] == pytest.approx(size[:: -1 if turn > 4 else 1])
    assert len(found.notes) == (turn != 1)


@pytest.mark.parametrize("turn", [6, 8])
def test_jpeg_is_turned(tmp_path, turn):
    path = tmp_path / "x.jpg"
    raw().save(path, quality=100)
    upright = read(path)
    with_orientation(path, turn)
    found = read(path)
    assert found.size == (64, 96)
    np.testing.assert_array_equal(found.pixels, np.rot90(upright.pixels, {6: 3, 8: 1}[turn]))
    assert found.facts["sensorOverallDimensions"] == pytest.approx((24, 36))
    assert found.notes == (f"turned upright: EXIF orientation {turn}",)


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_alpha_is_noted(tmp_path, count):
    values = np.full((8, 8, count), 200, np.uint8)
    if count in (2, 4):
        values[:, :, -1] = 255
    values[0, :3, -1] = 100
    path = tmp_path / "x.png"
    out = oiio.ImageOutput.create(str(path))
    spec = oiio.ImageSpec(8, 8, count, oiio.UINT8)
    spec.attribute("oiio:UnassociatedAlpha", 1)
    out.open(str(path), spec)
    out.write_image(values)
    out.close()
    found = read(path)
    assert found.pixels.shape == (8, 8, 3)
    assert found.pixels[5, 5].tolist() == [200] * 3
    told = ("alpha is ignored: 3 of 64 pixels are not opaque",)
    assert found.notes == (told if count in (2, 4) else ())


def test_light_is_decoded(tmp_path):
    pixels = np.full((4, 4, 3), 0.5, np.float32)
    Picture(pixels).save(tmp_path / "x.tif", bits=16)
    found = read(tmp_path / "x.tif")
    assert encoded(found.pixels)[0, 0, 0] == pytest.approx(0.5, abs=1e-5)
    assert found.linear()[0, 0, 0] == pytest.approx(0.21404, abs=1e-4)
    Picture(pixels).save(tmp_path / "x.exr")
    assert read(tmp_path / "x.exr").linear()[0, 0, 0] == pytest.approx(0.21404, abs=1e-4)


@pytest.mark.parametrize(
    ("tags", "size"),
    [
        ({"FocalPlaneXResolution": 4000 / 36, "FocalPlaneResolutionUnit": 4}, (36, 24)),
        ({"FocalPlaneXResolution": (101600, 36), "FocalPlaneResolutionUnit": 2}, (36, 24)),
        # A picture of half the size keeps the tags of the whole one.
        (
            {"FocalPlaneXResolution": 8000 / 3.6, "FocalPlaneResolutionUnit": 3,
             "PixelXDimension": 8000}, (36, 24),
        ),
        ({"FocalLength": 50, "FocalLengthIn35mmFilm": 75}, (24, 16)),
        ({"FocalLength": 50, "FocalLengthIn35mmFilm": 0}, None),
        ({"FocalPlaneXResolution": 1, "FocalPlaneResolutionUnit": 2}, None),
        ({"FocalPlaneXResolution": "x"}, None),
    ],
)  # fmt: skip
def test_sensor_sizes(tags, size):
    found = shot_facts(tags, (4000, 4000 * 2 // 3)).get("sensorOverallDimensions")
    assert found == (None if size is None else pytest.approx(size, rel=1e-3))


@pytest.mark.parametrize("value", [None, "x", (1, 0), (), [[]], float("nan"), float("inf")])
def test_numbers_that_are_none(value):
    assert exif_number(value) is None


def test_files_that_are_no_photographs(tmp_path):
    cases = {
        "missing.jpg": (None, "no such file"),
        "text.jpg": (b"hello", "cannot be decoded"),
        "text.dng": (b"hello", "LibRaw cannot read"),
        "text.exr": (b"hello", "OpenEXR"),
        "text.xyz": (b"hello", "LibRaw cannot read"),
        "empty.png": (b"", "cannot be decoded"),
    }
    raw().save(tmp_path / "whole.jpg")
    raw().save(tmp_path / "whole.dng")
    cases["cut.jpg"] = ((tmp_path / "whole.jpg").read_bytes()[:-600], "truncated JPEG")
    cases["cut.dng"] = ((tmp_path / "whole.dng").read_bytes()[:400], "LibRaw cannot read")
    for name, (data, wanted) in cases.items():
        if data is not None:
            (tmp_path / name).write_bytes(data)
        with pytest.raises(InputError, match=wanted) as error:
            read(tmp_path / name)
        assert name in str(error.value)
    with pytest.raises(InputError, match="a folder"):
        read(tmp_path)
