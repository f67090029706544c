"""Pictures of environments, and the decoder of textures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

from daguerre.color.srgb import to_linear
from daguerre.errors import InputError
from daguerre.pictures.images import decode
from daguerre.pictures.light import read_environment
from daguerre.pictures.reading import size
from tests.support.formats.make_gltf import jpeg, png

HDRI = Path(__file__).parents[3] / "shared" / "data" / "hdri"


def write(path, pixels, kind=oiio.FLOAT, names=None, **attributes):
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, kind)
    if names:
        spec.channelnames = names
    for key, value in attributes.items():
        if key in ("x", "y", "full_width", "full_height"):
            setattr(spec, key, value)
        else:
            spec.attribute(key, value)
    out = oiio.ImageOutput.create(str(path))
    assert out.open(str(path), spec), out.geterror()
    assert out.write_image(np.ascontiguousarray(pixels)), out.geterror()
    out.close()
    return path


def ramp(height=4, width=8, channels=3):
    values = np.arange(height * width * channels, dtype=np.float32)
    return values.reshape(height, width, channels) * 2


def rgbe(path, lines=b"", width=8, height=4):
    """Flat RGBE pixels (below width 8 nothing is packed): 1.0, 0.5, 0.25 each."""
    pixel = bytes((128, 64, 32, 129))
    size = f"-Y {height} +X {width}\n".encode()
    head = b"#?RADIANCE\n" + lines + b"FORMAT=32-bit_rle_rgbe\n\n" + size
    path.write_bytes(head + pixel * (width * height))
    return path


def test_exr_is_taken_as_it_is(tmp_path):
    image = read_environment(write(tmp_path / "a.exr", ramp() + 5000))
    assert image.dtype == np.float32
    assert np.array_equal(image, ramp() + 5000)


def test_half_exr_with_alpha_in_any_order(tmp_path):
    pixels = np.zeros((2, 4, 4), np.float32)
    pixels[:] = (0.5, 3, 2, 1)
    image = read_environment(write(tmp_path / "a.exr", pixels, oiio.HALF, ("A", "B", "G", "R")))
    assert image.shape == (2, 4, 3)
    assert image[0, 0].tolist() == [1, 2, 3]


def test_grey_exr(tmp_path):
    image = read_environment(write(tmp_path / "a.exr", ramp(channels=1), names=("Y",)))
    assert image[1, 2].tolist() == [20, 20, 20]


def test_exr_data_window_is_put_into_its_display_window(tmp_path):
    path = write(tmp_path / "a.exr", ramp(2, 2) + 1, x=3, y=1, full_width=8, full_height=4)
    image = read_environment(path)
    assert image.shape == (4, 8, 3)
    assert image[1:3, 3:5].tolist() == (ramp(2, 2) + 1).tolist()
    assert image.sum() == (ramp(2, 2) + 1).sum()


def test_radiance_and_its_exposure(tmp_path):
    image = read_environment(rgbe(tmp_path / "a.hdr", width=4))
    assert image.shape == (4, 4, 3)
    assert image[0, 0] == pytest.approx([1, 0.5, 0.25])
    lines = b"EXPOSURE=2\nEXPOSURE=4\n"
    image = read_environment(rgbe(tmp_path / "b.hdr", lines, width=4))
    assert image[0, 0] == pytest.approx([1 / 8, 1 / 16, 1 / 32])


def test_integer_formats_are_srgb(tmp_path):
    pixels = np.array([[[0, 10, 255], [128, 128, 128]]], np.uint8)
    (tmp_path / "a.png").write_bytes(png(pixels))
    image = read_environment(tmp_path / "a.png")
    assert image[0, 0] == pytest.approx([0, 10 / 255 / 12.92, 1])
    assert image[0, 1] == pytest.approx([((128 / 255 + 0.055) / 1.055) ** 2.4] * 3)
    (tmp_path / "b.png").write_bytes(png(pixels.astype(np.uint16) * 257))
    assert read_environment(tmp_path / "b.png") == pytest.approx(image, abs=1e-6)


@pytest.mark.parametrize("orientation", range(1, 9))
def test_exif_orientation(tmp_path, orientation):
    upright = np.zeros((4, 8, 3), np.float32)
    upright[0, 0], upright[0, -1] = (1, 0, 0), (0, 1, 0)  # corners that tell all eight apart
    # A camera would have stored this so that the orientation undoes it (Exif 2.3, 4.6.4 A).
    stored = {
        1: upright,
        2: upright[:, ::-1],
        3: upright[::-1, ::-1],
        4: upright[::-1],
        5: upright.transpose(1, 0, 2),
        6: upright.transpose(1, 0, 2)[::-1],
        7: upright.transpose(1, 0, 2)[::-1, ::-1],
        8: upright.transpose(1, 0, 2)[:, ::-1],
    }[orientation]
    path = write(tmp_path / "a.tif", stored, Orientation=orientation)
    assert read_environment(path).tolist() == upright.tolist()


def test_bad_environments(tmp_path):
    with pytest.raises(InputError, match=r"none\.hdr: no such file"):
        read_environment(tmp_path / "none.hdr")
    with pytest.raises(InputError, match="wanted a file, got a folder"):
        read_environment(tmp_path)
    (tmp_path / "text.hdr").write_text("hello")
    with pytest.raises(InputError, match=r"text\.hdr: cannot be decoded"):
        read_environment(tmp_path / "text.hdr")
    whole = rgbe(tmp_path / "cut.hdr", width=64, height=64)
    whole.write_bytes(whole.read_bytes()[:500])
    with pytest.raises(InputError, match=r"cut\.hdr: cannot be decoded"):
        read_environment(whole)
    whole = write(tmp_path / "cut.exr", ramp(64, 64))
    whole.write_bytes(whole.read_bytes()[:900])
    with pytest.raises(InputError, match=r"cut\.exr: .*the file is cut off"):
        read_environment(whole)
    with pytest.raises(InputError, match="EXPOSURE: wanted a positive number"):
        read_environment(rgbe(tmp_path / "e.hdr", b"EXPOSURE=zero\n", width=4))
    path = write(tmp_path / "depth.exr", ramp(channels=2), names=("Z", "ZBack"))
    with pytest.raises(InputError, match=r"channels: wanted R, G, B or one grey, got Z, ZBack"):
        read_environment(path)


@pytest.mark.parametrize(
    ("value", "wanted"), [(np.nan, "finite"), (np.inf, "finite"), (-1, "non-negative")]
)
def test_impossible_light(tmp_path, value, wanted):
    pixels = ramp()
    pixels[2, 5, 1] = value
    path = write(tmp_path / "a.exr", pixels)
    with pytest.raises(InputError, match=rf"pixel \(5, 2\): wanted {wanted} light.*\(1 such pix"):
        read_environment(path)


def test_absurd_sizes_are_refused_before_memory_is_taken(tmp_path):
    path = tmp_path / "a.hdr"
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 20000 +X 20000\n" + bytes(100))
    # Newer decoders refuse such a header themselves.
    with pytest.raises(InputError, match=r"20000x20000|corrupt or malicious|exceeds"):
        read_environment(path)


def test_limit_of_size(tmp_path, monkeypatch):
    path = write(tmp_path / "a.exr", ramp(4, 8))
    monkeypatch.setattr(size, "MAX_PIXELS", 32)
    read_environment(path)
    monkeypatch.setattr(size, "MAX_PIXELS", 31)
    with pytest.raises(InputError, match=r"a\.exr: image size: wanted at most 31 .* got 8x4"):
        read_environment(path)


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_decode_png(channels, dtype):
    top = np.iinfo(dtype).max
    pixels = np.linspace(0, top, 6 * channels).astype(dtype).reshape(2, 3, channels)
    decoded = decode(png(pixels), "x")
    assert decoded.shape == pixels.shape
    if dtype == np.uint8:
        assert decoded.tolist() == pixels.tolist()
    else:
        assert decoded == pytest.approx(pixels / top, abs=1e-7)


def test_decode_leaves_no_files_behind(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    decode(png(np.zeros((2, 2, 3), np.uint8)), "x")
    with pytest.raises(InputError):
        decode(jpeg(np.zeros((8, 8, 3), np.uint8), tmp_path)[:50], "x")
    assert [p.name for p in tmp_path.iterdir()] == ["made.jpg"]


def test_decode_prints_nothing(capfd):
    data = png(np.zeros((64, 64, 3), np.uint8))
    for keep in range(0, len(data), 7):
        with pytest.raises(InputError, match=r"^where: "):
            decode(data[:keep], "where")
    assert capfd.readouterr() == ("", "")


def test_transfer_function():
    values = np.linspace(0, 1, 101, dtype=np.float32)
    linear = to_linear(values)
    back = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert back == pytest.approx(values, abs=1e-6)
    assert linear[-1] == pytest.approx(1)


@pytest.mark.skipif(not HDRI.is_dir(), reason="../shared/data/hdri is not here")
@pytest.mark.parametrize(
    ("name", "peak"), [("st_peters_square_night_1k", 9134), ("narrow_moonlit_road_1k", 71126)]
)
def test_shared_environments(name, peak):
    image = read_environment(HDRI / f"{name}.hdr")
    assert image.shape == (512, 1024, 3)
    luminance = image @ np.array([0.2126, 0.7152, 0.0722])
    assert luminance.max() == pytest.approx(peak, rel=0.2)
