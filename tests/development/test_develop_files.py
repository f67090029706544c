"""Files of developed pictures: numbers, profiles and EXIF, read by others."""

import errno
import io
from fractions import Fraction

import numpy as np
import pytest

import daguerre as dg
from daguerre.color import spaces
from daguerre.development import Picture
from daguerre.errors import OutputError
from daguerre.pictures import exif, icc

exifread = pytest.importorskip("exifread")
Image = pytest.importorskip("PIL.Image")
ImageCms = pytest.importorskip("PIL.ImageCms")

FACTS = {
    "expTime": float(np.float32(1 / 48)),
    "aperture": float(np.float32(2.8)),
    "isoSpeed": 6400,
    "nominalFocalLength": 23.5,
    "lensMake": "Zeiss",
    "lensModel": "Biotar é",
    "cameraMake": "Daguerre",
    "cameraModel": "ideal",
    "focus": 2.5,
    "sensorOverallDimensions": (23.6, 15.7),
    "version": "x",
}


def picture(space="srgb"):
    ramp = np.linspace(0, 1, 64, dtype=np.float32)
    pixels = np.stack([ramp[None].repeat(32, 0), ramp[None, ::-1].repeat(32, 0)], axis=2)
    blue = np.full((32, 64, 1), 0.4, np.float32)
    return Picture(np.concatenate([pixels, blue], axis=2), space, dict(FACTS))


@pytest.mark.parametrize("space", spaces.ENCODED)
@pytest.mark.parametrize("ending", ["jpg", "png", "tif"])
def test_files_say_colours_and_exposure(tmp_path, space, ending):
    path = tmp_path / f"x.{ending}"
    picture(space).save(path)
    with path.open("rb") as file:
        tags = exifread.process_file(file, details=False)
    said = {name: str(tags[name]) for name in tags}
    assert said["EXIF ExposureTime"] == "1/48"
    assert said["EXIF FNumber"] == "14/5"
    assert said["EXIF ISOSpeedRatings"] == "6400"
    assert said["EXIF FocalLength"] == "47/2"
    assert said["EXIF FocalLengthIn35mmFilm"] == "36"
    assert (said["EXIF LensMake"], said["Image Model"]) == ("Zeiss", "ideal")
    with Image.open(path) as image:
        profile = ImageCms.ImageCmsProfile(io.BytesIO(image.info["icc_profile"]))
        title = ImageCms.getProfileDescription(profile).strip()
        assert title == spaces.COLOR_SPACES[space].title
        if ending != "tif":  # Pillow reads no 16 bits of three colours
            got = np.asarray(image).astype(int)
            assert np.abs(got - picture(space).bytes8()).max() <= (4 if ending == "jpg" else 0)
            assert image.getexif().get_ifd(0x8769)[0x829A] == Fraction(1, 48)


@pytest.mark.parametrize("space", spaces.ENCODED)
def test_profiles_mean_the_colours_that_we_encode(space):
    """lcms, through Pillow, turns numbers of a space into sRGB as our own matrices do."""
    light = np.array([[0.2, 0.5, 0.3], [0.18, 0.18, 0.18], [0.6, 0.4, 0.35], [1, 1, 1]])
    of, srgb = spaces.COLOR_SPACES[space], spaces.COLOR_SPACES["srgb"]
    inside = light @ np.linalg.solve(spaces.xyz_from_rgb(of), spaces.xyz_from_rgb(srgb)).T
    numbers = np.rint(spaces.encoded(inside, space) * 255).astype(np.uint8)
    transform = ImageCms.buildTransform(
        ImageCms.ImageCmsProfile(io.BytesIO(icc.profile(space))),
        ImageCms.createProfile("sRGB"),
        "RGB",
        "RGB",
        renderingIntent=ImageCms.Intent.RELATIVE_COLORIMETRIC,
    )
    shown = np.asarray(ImageCms.applyTransform(Image.fromarray(numbers[None]), transform))[0]
    wanted = np.rint(spaces.encoded(light, "srgb") * 255)
    assert np.abs(shown - wanted).max() <= 2


@pytest.mark.parametrize("space", spaces.ENCODED)
def test_curves_turn_around(space):
    light = np.geomspace(1e-5, 1, 300)
    encoded = spaces.encoded(light, space)
    np.testing.assert_allclose(spaces.decoded(encoded.astype(np.float32), space), light, rtol=2e-5)
    assert (np.diff(encoded) > 0).all()
    assert encoded[-1] == pytest.approx(1)


def test_sixteen_bits(tmp_path):
    import OpenImageIO as oiio

    for ending in ("png", "tif"):
        picture().save(tmp_path / f"x.{ending}", bits=16)
        got = oiio.ImageInput.open(str(tmp_path / f"x.{ending}")).read_image("uint16")
        wanted = np.rint(picture().pixels.astype(np.float64) * 65535)
        assert np.abs(got.astype(int) - wanted).max() <= 1


def test_exr_is_linear_in_its_primaries(tmp_path):
    import OpenEXR

    picture("p3").save(tmp_path / "x.exr")
    with OpenEXR.File(str(tmp_path / "x.exr")) as file:
        part = file.parts[0]
        np.testing.assert_allclose(part.channels["RGB"].pixels, picture("p3").linear())
        assert part.header["chromaticities"][:2] == pytest.approx((0.68, 0.32))
        assert part.header["isoSpeed"] == 6400


def test_binned_pictures_are_whole_and_crops_keep_their_place(tmp_path):
    import OpenEXR

    for facts, wanted in (
        ({"resolution": (128, 64)}, ((0, 0), (63, 31))),  # twice the picture's
        ({"resolution": (128, 64), "crop": (10, 20, 74, 52)}, ((10, 20), (73, 51))),
    ):
        Picture(picture().pixels, "srgb", FACTS | facts).save(tmp_path / "x.exr")
        with OpenEXR.File(str(tmp_path / "x.exr")) as file:
            window = file.parts[0].header["dataWindow"]
            whole = file.parts[0].header["displayWindow"]
        assert tuple(map(tuple, window)) == wanted
        assert tuple(whole[1]) == ((127, 63) if "crop" in facts else (63, 31))


def test_simple_fractions():
    for value, wanted in [
        (1 / 125, (1, 125)),
        (float(np.float32(1 / 8000)), (1, 8000)),
        (float(np.float32(0.4)), (2, 5)),
        (30.0, (30, 1)),
        (1 / 29.97, (100, 2997)),
        (-1 / 3, (-1, 3)),
        (1e12, (2**31 - 1, 1)),
    ]:
        assert exif.rational(value) == wanted


def test_dates(monkeypatch):
    assert exif.date({"capDate": "2026:01:02 03:04:05"}) == "2026:01:02 03:04:05"
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    assert exif.date({}) == "1970:01:02 00:00:00"


def test_the_same_picture_is_the_same_file(tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    for ending in ("jpg", "png", "tif"):
        for name in "ab":
            picture().save(tmp_path / f"{name}.{ending}")
        a, b = (tmp_path / f"{name}.{ending}" for name in "ab")
        assert a.read_bytes() == b.read_bytes()


@pytest.mark.parametrize(
    ("zoom", "wanted"), [(None, (35, 1, 35, 1)), ((70.0, 200.0), (70, 1, 200, 1))]
)
def test_real_lenses_say_their_focal_lengths(zoom, wanted):
    lens = {"lens_sha256": "x", "focal_length_mm": 35.0, "zoom_range_mm": zoom}
    tags = exif.exposure_tags({"camera": lens})
    assert tags[42034][1] == (*wanted, 0, 0, 0, 0)  # 0/0: not known
    assert 42034 not in exif.exposure_tags({"camera": {"focal_length_mm": 50.0}})


def test_unknown_facts_are_left_out():
    odd = {"expTime": 0.0, "aperture": float("inf"), "isoSpeed": None, "focus": float("nan")}
    tags = exif.exposure_tags(odd)
    assert not {33434, 33437, 34855, 37382} & set(tags)


def test_wrong_endings_and_bits(tmp_path):
    with pytest.raises(dg.UsageError, match="wanted a name ending in"):
        picture().save(tmp_path / "x.gif")
    with pytest.raises(dg.UsageError, match=r"bits: wanted 8 for \.jpg"):
        picture().save(tmp_path / "x.jpg", bits=16)
    with pytest.raises(dg.UsageError, match="quality: wanted 1"):
        picture().save(tmp_path / "x.jpg", quality=0)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", [".jpg", ".png", ".tif"])
def test_a_full_disk_is_one_error(tmp_path, monkeypatch, suffix):
    """JPEG and PNG are coded in memory: at a full disk libjpeg ends the whole process."""

    def full(*_, **__):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("pathlib.Path.write_bytes", full)
    monkeypatch.setattr("daguerre.pictures.picture_files.write_tiff", full)
    path = tmp_path / f"picture{suffix}"
    with pytest.raises(OutputError, match="cannot write: No space left") as caught:
        picture().save(path)
    assert str(path) in str(caught.value)
    assert list(tmp_path.iterdir()) == []
