"""DNG: what LibRaw, dcraw and a reader of EXIF make of the raw pictures that we write."""

import shutil
import subprocess

import numpy as np
import pytest

import daguerre as dg
from daguerre.color import spectra
from daguerre.development import bayer_of
from daguerre.development.dng import baseline_exposure, noise_profile
from daguerre.development.raw_files import write_dng
from daguerre.sensors import load, names
from tests.support.pictures.colour_chart import (
    PATCH,
    delta_e,
    greys,
    lab,
    patch_means,
    raw_of,
    reflectances,
    saved_large,
    truth,
)

exifread = pytest.importorskip("exifread")
rawpy = pytest.importorskip("rawpy")

LIBRAW = {"use_camera_wb": True, "no_auto_bright": True, "gamma": (1, 1), "output_bps": 16}


def sensor_with(pattern, **changes):
    """A camera's colours, in 12 bits above a black level, with a mosaic."""
    return load("nikon-d5100").with_(pattern=pattern, bit_depth=12, black_level=256, **changes)


def libraw_linear(path):
    """Linear Rec.709 as LibRaw develops the file, 1 at the white level."""
    with rawpy.imread(str(path)) as opened:
        return opened.postprocess(**LIBRAW, adjust_maximum_thr=0.0) / 65535.0


@pytest.mark.parametrize(
    "pattern", ["bayer-rggb", "bayer-bggr", "bayer-grbg", "bayer-gbrg", "xtrans"]
)
def test_mosaic_levels_and_pattern_come_back(tmp_path, pattern):
    raw = raw_of(sensor_with(pattern), reflectances())
    raw.save(tmp_path / "x.dng")
    with rawpy.imread(str(tmp_path / "x.dng")) as opened:
        np.testing.assert_array_equal(opened.raw_image, raw.mosaic)
        assert opened.black_level_per_channel[:3] == [256] * 3
        assert opened.white_level == raw.white_level
        channel = np.array([0, 1, 2, 1])[opened.raw_colors]  # LibRaw counts two greens
        np.testing.assert_array_equal(channel, raw.channel_map())
        neutral = 1 / np.array(opened.camera_whitebalance[:3])
        np.testing.assert_allclose(neutral / neutral.max(), raw.neutral, rtol=1e-4)
        # LibRaw keeps the inverse, rows scaled so that white is 1: the same matrix in all.
        ours = raw.sensor.colour_matrix() @ np.linalg.inv(spectra.rgb_from_xyz())
        ours /= ours.sum(axis=1, keepdims=True)
        inverse = np.linalg.inv(opened.color_matrix[:, :3])
        np.testing.assert_allclose(inverse, ours, atol=2e-3)


def test_mono(tmp_path):
    sensor = load("ideal-mono").with_(bit_depth=12, black_level=64)
    raw = raw_of(sensor, greys(0.02, 0.18, 0.9))
    raw.save(tmp_path / "x.dng")
    with rawpy.imread(str(tmp_path / "x.dng")) as opened:
        np.testing.assert_array_equal(opened.raw_image, raw.mosaic)
        assert opened.num_colors == 1
        assert (opened.black_level_per_channel[0], opened.white_level) == (64, raw.white_level)


def test_quad_bayer_is_binned_without_loss(tmp_path):
    raw = raw_of(sensor_with("quad-bayer-rggb"), reflectances())
    raw.save(tmp_path / "x.dng")
    four = raw.mosaic.astype(int).reshape(raw.height // 2, 2, raw.width // 2, 2).sum(axis=(1, 3))
    with rawpy.imread(str(tmp_path / "x.dng")) as opened:
        np.testing.assert_array_equal(opened.raw_image, four)
        assert opened.black_level_per_channel[0] == 4 * 256
        assert opened.white_level == 4 * raw.white_level
    small = bayer_of(raw)
    np.testing.assert_allclose(
        small.electrons(), 4 * raw.electrons()[::2, ::2], rtol=0.02, atol=4 / raw.gain
    )
    assert baseline_exposure(small) == pytest.approx(baseline_exposure(raw))


def test_quad_bayer_of_16_bits_fits_into_16_bits():
    raw = raw_of(load("ideal").with_(pattern="quad-bayer-rggb"), greys(0.5, 1.0))
    small = bayer_of(raw)
    assert small.gain == raw.gain / 4
    assert small.mosaic.max() <= small.white_level <= 65535
    np.testing.assert_allclose(small.mosaic[0, 0], raw.mosaic[:2, :2].mean(), atol=1)


@pytest.mark.parametrize("name", names())
def test_libraw_develops_a_chart_in_its_colours(tmp_path, name):
    sensor = load(name)
    if len(sensor.channels) == 1:
        pytest.skip("no colours")
    raw = raw_of(sensor, reflectances())
    saved_large(raw, tmp_path / "x.dng")
    got = libraw_linear(tmp_path / "x.dng")[: raw.height, : raw.width]
    got *= 2 ** baseline_exposure(bayer_of(raw))
    apart = delta_e(lab(patch_means(got)), lab(truth(reflectances()).clip(0, 1)))
    assert apart.mean() < 3
    assert apart[3].max() < 2.5  # greys, which are a little coloured


def test_dcraw_reads_it(tmp_path):
    if not shutil.which("dcraw"):
        pytest.skip("dcraw is not installed")
    raw = raw_of(sensor_with("bayer-rggb"), reflectances())
    raw.save(tmp_path / "x.dng")
    said = subprocess.run(
        ["dcraw", "-i", "-v", tmp_path / "x.dng"], check=True, capture_output=True, text=True
    ).stdout
    assert "Shutter: 1/125.0 sec" in said
    assert "Filter pattern: RG/GB" in said
    multipliers = said.split("Camera multipliers: ")[1].split()[:3]
    neutral = 1 / np.array(multipliers, float)
    np.testing.assert_allclose(neutral / neutral.max(), raw.neutral, rtol=1e-4)
    # -D: the mosaic as it is; -4: 16 bits; -t 0: not turned; a PGM.
    numbers = subprocess.run(
        ["dcraw", "-D", "-4", "-t", "0", "-c", tmp_path / "x.dng"], check=True, capture_output=True
    ).stdout
    pixels = np.frombuffer(numbers[-raw.mosaic.nbytes :], ">u2").reshape(raw.mosaic.shape)
    np.testing.assert_array_equal(pixels, raw.mosaic)


def test_exif_as_a_camera_writes_it(tmp_path):
    raw = raw_of(load("ideal"), greys(0.18), iso=400)
    raw.save(tmp_path / "x.dng")
    with (tmp_path / "x.dng").open("rb") as file:
        tags = exifread.process_file(file, details=False)
    said = {name: str(tags[name]) for name in tags}
    assert said["EXIF ExposureTime"] == "1/125"
    assert said["EXIF FNumber"] == "14/5"
    assert said["EXIF ISOSpeedRatings"] == "400"
    assert said["EXIF FocalLength"] == "58"
    assert said["EXIF FocalLengthIn35mmFilm"] == "58"
    assert said["EXIF LensModel"] == "Biotar 58 mm"
    assert (said["Image Make"], said["Image Model"]) == ("Daguerre", "ideal")
    assert said["Image Software"].startswith("daguerre")


def test_noise_profile_is_the_variance_of_numbers():
    sensor = sensor_with("bayer-rggb", read_noise=((100.0, 3.0),))
    raw = raw_of(sensor, greys(0.5))
    slope, dark = noise_profile(raw)
    span = raw.white_level - raw.black_level
    electrons = 0.4 * span / raw.gain
    variance = raw.gain**2 * (electrons + 9) + 1 / 12  # DN2: photons, reading, rounding
    assert (slope * 0.4 + dark) * span**2 == pytest.approx(variance)


def test_preview_is_the_picture(tmp_path):
    import tifffile

    raw = raw_of(load("ideal"), reflectances())
    write_dng(tmp_path / "x.dng", raw)
    with tifffile.TiffFile(tmp_path / "x.dng") as file:
        small = file.pages[0].asarray()
    assert small.dtype == np.uint8
    wanted = raw.develop().bytes8()[PATCH // 2 :: PATCH, PATCH // 2 :: PATCH]
    rows, columns = (side // count for side, count in zip(small.shape, (4, 6), strict=False))
    got = small[rows // 2 :: rows, columns // 2 :: columns][:4, :6]
    assert np.abs(got.astype(int) - wanted).max() <= 4


def test_nothing_is_left_of_a_file_that_fails(tmp_path):
    raw = raw_of(load("ideal"), greys(0.18))
    with pytest.raises(dg.OutputError, match="no such folder"):
        raw.save(tmp_path / "no" / "x.dng")
    with pytest.raises(dg.UsageError, match=r"a DNG is not developed: leave out wb"):
        raw.save(tmp_path / "x.dng", wb="auto")
    with pytest.raises(dg.UsageError, match=r"did you mean '\.dng'"):
        raw.save(tmp_path / "x.dgn")
    assert not list(tmp_path.iterdir())
