"""Frames: what they show, what they save, and that files are complete or not there."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import OpenEXR
import OpenImageIO as oiio
import pytest

from daguerre.errors import OutputError, UsageError
from daguerre.files import atomic
from daguerre.frame.frame import Frame

METADATA = {
    "isoSpeed": 400.0,
    "expTime": 1 / 48,
    "aperture": 2.0,
    "focus": 1.5,
    "nominalFocalLength": 50.0,
    "captureRate": 24000 / 1001,
    "lensModel": "double-gauss-50mm-f2",
    "sensorPhotositePitch": 37.5,
    "sensorOverallDimensions": (36.0, 24.0),
    "worldToCamera": np.arange(16.0).reshape(4, 4),
    "camera": {"f_stop": 2.0, "transform": np.eye(4)},
    "samples": 64,
    "seed": 2**63,
    "scene_hash": "abc",
    "version": "0.1.0",
    "surprise": object(),
    "shutterAngle": None,
}


def frame(height: int = 5, width: int = 7, **changes: object) -> Frame:
    rng = np.random.default_rng(1)
    planes = {
        name: rng.random((height, width)).astype(np.float32)
        for name in ("depth.Z", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z")
    }
    planes |= {f"albedo.{c}": np.full((height, width), 0.5, np.float32) for c in "RGB"}
    planes["object_id"] = np.full((height, width), 4_000_000_001, np.uint32)
    values: dict = {
        "rgb": rng.random((height, width, 3)).astype(np.float32) * 3,
        "alpha": rng.random((height, width)).astype(np.float32),
        "variance": rng.random((height, width, 3)).astype(np.float32),
        "samples": np.full((height, width), 64, np.uint32),
        "aovs": planes,
        "metadata": dict(METADATA),
    }
    return Frame(**(values | changes))


def test_channel_names_types_and_values(tmp_path: Path) -> None:
    made = frame()
    made.save(tmp_path / "a.exr")
    with OpenEXR.File(str(tmp_path / "a.exr"), separate_channels=True) as file:
        assert len(file.parts) == 1
        channels = {name: c.pixels for name, c in file.channels().items()}
        assert file.header()["compression"] == OpenEXR.ZIP_COMPRESSION
    assert set(channels) == {
        *"RGBA", "depth.Z", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "object_id",
        "albedo.R", "albedo.G", "albedo.B", "variance.R", "variance.G", "variance.B", "samples.Y",
    }  # fmt: skip
    assert channels["object_id"].dtype == np.uint32
    assert all(c.dtype == np.float32 for n, c in channels.items() if n != "object_id")
    for i, name in enumerate("RGB"):
        np.testing.assert_array_equal(channels[name], made.rgb[:, :, i])
    np.testing.assert_array_equal(channels["object_id"], made.aovs["object_id"])
    np.testing.assert_array_equal(channels["depth.Z"], made.aovs["depth.Z"])
    assert (channels["samples.Y"] == 64).all()


def test_attributes_have_the_types_of_the_standard(tmp_path: Path) -> None:
    frame().save(tmp_path / "a.exr")
    with OpenEXR.File(str(tmp_path / "a.exr"), header_only=True) as file:
        header = dict(file.header())
    assert header["captureRate"] == Fraction(24000, 1001)
    assert header["expTime"] == pytest.approx(1 / 48)
    assert header["isoSpeed"] == 400
    assert isinstance(header["isoSpeed"], float)
    np.testing.assert_array_equal(header["sensorOverallDimensions"], np.float32([36, 24]))
    np.testing.assert_array_equal(header["sensorPhotositePitch"], np.float32([37.5, 37.5]))
    np.testing.assert_array_equal(header["worldToCamera"], METADATA["worldToCamera"])
    assert header["chromaticities"] == pytest.approx(
        (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)
    )
    assert header["daguerre:samples"] == 64
    assert header["daguerre:seed"] == str(2**63)
    assert header["daguerre:version"] == "0.1.0"
    assert header["daguerre:scene_hash"] == "abc"
    assert json.loads(header["daguerre:camera"])["transform"][0] == [1, 0, 0, 0]
    assert not {"surprise", "shutterAngle"} & set(header)


def test_attributes_are_read_by_openimageio(tmp_path: Path) -> None:
    frame().save(tmp_path / "a.exr")
    spec = oiio.ImageInput.open(str(tmp_path / "a.exr")).spec()
    types = {a.name: str(a.type) for a in spec.extra_attribs}
    assert types["captureRate"] == "rational"
    assert types["worldToCamera"] == "matrix"
    assert types["sensorOverallDimensions"] == "float2"
    assert types["chromaticities"] == "float[8]"
    assert spec.get_float_attribute("ExposureTime") == pytest.approx(1 / 48)


def test_a_crop_lies_inside_the_display_window(tmp_path: Path) -> None:
    facts = {"resolution": (40, 30), "crop": (10, 20, 17, 25)}
    frame(metadata=facts).save(tmp_path / "a.exr")
    spec = oiio.ImageInput.open(str(tmp_path / "a.exr")).spec()
    assert (spec.x, spec.y, spec.width, spec.height) == (10, 20, 7, 5)
    assert (spec.full_x, spec.full_y, spec.full_width, spec.full_height) == (0, 0, 40, 30)


def test_the_same_frame_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a.exr", "b.exr", "a.png", "b.png"):
        frame().save(tmp_path / name)
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_png_is_the_srgb_curve(tmp_path: Path) -> None:
    rgb = np.zeros((1, 5, 3), np.float32)
    rgb[0, :, 0] = [0.0, 0.0031308, 0.18, 1.0, 50.0]
    rgb[0, 4] = [np.nan, np.inf, -1]
    Frame(rgb, metadata={"lensModel": "x", "aperture": 2.0}).save(tmp_path / "a.png")
    source = oiio.ImageInput.open(str(tmp_path / "a.png"))
    pixels = source.read_image(oiio.UINT8)
    # 12.92 * 0.0031308 * 255 = 10.3; 0.18 is 0.4614 encoded, IEC 61966-2-1.
    assert pixels[0, :4, 0].tolist() == [0, 10, 118, 255]
    assert pixels[0, 4].tolist() == [0, 255, 0]
    assert source.spec().get_float_attribute("FNumber") == 2


def test_soft_tone_keeps_the_dark_and_separates_highlights() -> None:
    grey = np.linspace(0, 8, 200, dtype=np.float32)
    made = Frame(np.repeat(grey[None, :, None], 3, axis=2))
    hard, soft = made.display()[0, :, 0], made.display("soft")[0, :, 0]
    dark = grey <= 0.8
    np.testing.assert_array_equal(hard[dark], soft[dark])
    assert (np.diff(soft.astype(int)) >= 0).all()
    assert soft.max() < 255
    assert len(np.unique(soft[~dark])) > 15
    with pytest.raises(UsageError, match="did you mean 'soft'"):
        made.display("sof")


def test_colours_that_srgb_lacks_keep_their_luminance() -> None:
    from daguerre.color.srgb import to_linear

    laser = np.array([[[-0.3, 0.6, -0.05], [0.2, 0.1, 0.3], [-1, 0.1, 0.1]]], np.float32)
    shown = to_linear(Frame(laser).display()[0] / np.float32(255))
    luminance = np.array([0.2126, 0.7152, 0.0722])
    assert shown[0] @ luminance == pytest.approx(laser[0, 0] @ luminance, abs=0.005)
    assert shown[0].min() == 0
    np.testing.assert_allclose(shown[1], laser[0, 1], atol=0.003)
    assert shown[2].max() == 0  # no light to show


def test_soft_tone_makes_bright_colours_white_and_not_blue() -> None:
    rim = np.array([[[-5, 2, 30], [300, 30, 3], [0.5, 0.2, 0.1]]], np.float32)
    shown = Frame(rim).display("soft")[0].astype(int)
    assert shown[0].min() > 150
    assert shown[1].min() > 230
    np.testing.assert_array_equal(shown[2], Frame(rim).display()[0, 2])


def test_png_says_the_exposure_as_a_camera_does(tmp_path: Path) -> None:
    exifread = pytest.importorskip("exifread")
    facts = {"expTime": float(np.float32(1 / 48)), "aperture": 2.8, "nominalFocalLength": 23.5}
    Frame(np.ones((9, 9, 3), np.float32), metadata=facts).save(tmp_path / "a.png")
    with (tmp_path / "a.png").open("rb") as file:
        tags = exifread.process_file(file, details=False)
    names = ("ExposureTime", "FNumber", "FocalLength")
    assert [str(tags[f"EXIF {name}"]) for name in names] == ["1/48", "14/5", "47/2"]


def test_other_formats_are_refused_by_name(tmp_path: Path) -> None:
    for name in ("a.gif", "a", "a.exr.gz"):
        with pytest.raises(UsageError, match=r"wanted a name ending in \.exr, .* or \.tiff"):
            frame().save(tmp_path / name)
    with pytest.raises(UsageError, match=r"got '\.dng'; a raw file is made by frame\.expose"):
        frame().save(tmp_path / "a.dng")
    assert not list(tmp_path.iterdir())


def test_a_frame_shows_itself() -> None:
    made = frame()
    assert made._repr_png_().startswith(b"\x89PNG")
    assert 'src="data:image/png;base64,' in made._repr_html_()
    assert "f/2" in made._repr_html_()
    assert "&lt;" not in repr(made)
    assert repr(made).startswith("<Frame 7x5, 64 samples, aovs: N P albedo depth object_id")


def test_shapes_are_checked() -> None:
    with pytest.raises(UsageError, match=r"wanted shape \(H, W, 3\)"):
        Frame(np.zeros((3, 4), np.float32))


@pytest.mark.parametrize("ending", ["exr", "png"])
def test_missing_folder_is_an_output_error(tmp_path: Path, ending: str) -> None:
    with pytest.raises(OutputError, match="no such folder"):
        frame().save(tmp_path / "no" / f"a.{ending}")


def test_a_folder_as_output_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.exr").mkdir()
    with pytest.raises(OutputError, match="wanted a file name, got a folder"):
        frame().save(tmp_path / "a.exr")


@pytest.mark.parametrize("ending", ["exr", "png"])
def test_a_full_disk_leaves_the_old_file_and_nothing_else(tmp_path: Path, ending: str) -> None:
    target = tmp_path / f"a.{ending}"
    target.write_bytes(b"old")
    code = (
        "import resource, sys\n"
        "import numpy as np\n"
        "from daguerre.frame.frame import Frame\n"
        "from daguerre.errors import OutputError\n"
        "rgb = np.random.default_rng(0).random((64, 64, 3)).astype(np.float32)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))\n"
        "try:\n"
        "    Frame(rgb).save(sys.argv[1])\n"
        "except OutputError as error:\n"
        "    print(error); sys.exit(error.exit_code)\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, str(target)], capture_output=True, text=True, check=False
    )
    assert run.returncode == 5, run.stderr
    assert str(target) in run.stdout
    assert ".tmp" not in run.stdout
    assert target.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [target]


def test_anything_raised_midway_leaves_nothing(tmp_path: Path) -> None:
    target = tmp_path / "a.bin"
    with pytest.raises(KeyboardInterrupt), atomic.atomic_path(target) as temp:  # noqa: PT012
        temp.write_bytes(b"half")
        raise KeyboardInterrupt
    assert not list(tmp_path.iterdir())


def test_permissions_follow_the_umask_and_links_are_followed(tmp_path: Path) -> None:
    real, link = tmp_path / "real.bin", tmp_path / "link.bin"
    real.write_bytes(b"old")
    link.symlink_to(real)
    before = os.umask(0o027)
    try:
        atomic.write_bytes(link, b"new")
    finally:
        os.umask(before)
    assert link.is_symlink()
    assert real.read_bytes() == b"new"
    assert real.stat().st_mode & 0o777 == 0o640


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_no_permission_is_an_output_error(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(OutputError, match="Permission denied"):
            atomic.check_writable(tmp_path / "a.exr")
    finally:
        tmp_path.chmod(0o700)
