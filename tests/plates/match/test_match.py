"""Photographs matched as a whole: cameras, what is missing, files, and pixels that look alike."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

import daguerre as dg
from daguerre.development import develop
from daguerre.errors import InputError, UsageError
from daguerre.frame.picture import Picture
from daguerre.plates.files import read
from daguerre.plates.match.grain import Grain
from daguerre.plates.match.like import PlateLook
from daguerre.plates.match.plate_raw import raw_of
from daguerre.plates.match.sharpness import FREQUENCIES, sharpness_of
from tests.support.pictures.plate_edges import squares
from tests.support.pictures.plate_frames import of_light, wedge

LENS = {"lensMake": "Canon", "lensModel": "EF24-70mm f/2.8L II USM", "nominalFocalLength": 35.0}
SHAPE = (600, 900)
LIGHT = np.concatenate([squares((300, 900), 0.8), wedge((300, 900))])


def shot(ending, folder, name="sony-a7r-ii", iso=400, light=LIGHT, seed=1, **facts):
    frame = of_light(light, 0.6 * 78 / iso, **(LENS | {"isoSpeed": iso, "focus": 3.0} | facts))
    path = folder / f"plate.{ending}"
    if ending == "exr":
        body = {"cameraMake": "Sony", "cameraModel": "ILCE-7RM2"}
        replace(frame, metadata=frame.metadata | body).save(path)
    else:
        frame.expose(name, iso, seed=seed).save(path)
    return path


@pytest.mark.parametrize("ending", ["dng", "jpg", "exr"])
def test_cameras_come_from_exif(tmp_path, ending):
    found = dg.match_plate(shot(ending, tmp_path))
    camera = found.camera
    assert camera.lens == "canon-ef-24-70mm-f2.8"
    assert camera.zoom == pytest.approx(35)
    assert camera.f_stop == pytest.approx(5.6)
    assert camera.shutter_time == pytest.approx(1 / 125)
    assert camera.focus_distance == pytest.approx(3)
    assert (camera.iso, found.resolution) == (400, (900, 600))
    assert camera.sensor_size == pytest.approx((36, 24), rel=0.005)
    assert (found.sensor is not None) == (ending == "dng")
    assert found.sharpness.edges >= 10
    assert found.changes()["lens"] == camera.lens


@pytest.mark.parametrize("ending", ["dng", "jpg", "exr"])
def test_files_give_the_same_camera(tmp_path, ending):
    found = dg.match_plate(shot(ending, tmp_path))
    found.save(tmp_path / "c.json")
    again = dg.read_plate_camera(tmp_path / "c.json")
    assert again.camera == found.camera
    assert again.sensor == found.sensor
    assert again.changes().keys() == found.changes().keys()
    assert again.changes()["exposure"] == "manual"  # as the plate was exposed
    assert (again.sha256, again.notes, again.look) == (found.sha256, found.notes, found.look)
    np.testing.assert_allclose(again.sharpness.response, found.sharpness.response, atol=1e-5)
    if isinstance(found.noise, Grain):
        np.testing.assert_allclose(again.noise.spectra, found.noise.spectra, atol=1e-5)
        np.testing.assert_allclose(again.noise.deviations, found.noise.deviations, atol=1e-6)
    else:
        assert again.noise == found.noise


def test_a_matched_sensor_is_the_one_that_took_the_plate(tmp_path):
    found = dg.match_plate(shot("dng", tmp_path))
    truth = dg.sensors.load("sony-a7r-ii")
    assert found.sensor.gain(400) == pytest.approx(truth.gain(400), rel=0.02)
    assert found.sensor.read_noise_at(400) == pytest.approx(truth.read_noise_at(400), rel=0.05)
    assert found.sensor.white_level(400) == truth.white_level(400)
    assert found.sensor.pattern.name == truth.pattern.name
    assert found.sensor.neutral() == pytest.approx(truth.neutral())


def patches(numbers, cells=False):
    """Greens of the flat steps of the wedge, without their borders."""
    part = numbers[306:550]
    step = 2 if cells else 7
    return [part[6:-6:step, 75 * k + 11 : 75 * k + 64 : step].ravel() for k in range(9)]


@pytest.mark.parametrize("iso", [100, 400, 1600])
def test_noise_of_raw_objects_is_that_of_the_plate(tmp_path, iso):
    """Kolmogorov and Smirnov, greens of nine steps; the frame is without noise."""
    found = dg.match_plate(shot("dng", tmp_path, iso=iso))
    plate = read(tmp_path / "plate.dng").raw.mosaic
    clean = of_light(LIGHT, 0.6 * 78 / iso, isoSpeed=iso)
    made = clean.expose(found.sensor, iso, seed=9).mosaic
    values = [
        stats.ks_2samp(a, b).pvalue
        for a, b in zip(patches(plate, cells=True), patches(made, cells=True), strict=True)
    ]
    assert min(values) > 1e-3
    assert np.median(values) > 0.1
    # The planted fault: a gain that is a tenth too large.
    wrong = found.sensor.with_(quantum_efficiency=found.sensor.quantum_efficiency / 1.21)
    loud = clean.expose(wrong, iso, seed=9).mosaic
    worse = [
        stats.ks_2samp(a - a.mean(), b - b.mean()).pvalue
        for a, b in zip(patches(plate, cells=True), patches(loud, cells=True), strict=True)
    ]
    assert min(worse) < 1e-2


@pytest.mark.parametrize("ending", ["dng", "jpg", "exr"])
def test_objects_have_the_edges_of_the_plate(tmp_path, ending):
    """Response within 0.05 up to 0.35 cycles per pixel."""
    found = dg.match_plate(shot(ending, tmp_path, light=squares(SHAPE, 0.8)), lens="thin")
    look = PlateLook(found)
    sharp = of_light(squares(SHAPE, 0.0), 0.6 * 78 / 400, isoSpeed=400)
    seen = look.seen(sharp, seed=3)
    path = tmp_path / f"object.{ending}"
    if ending == "dng":
        seen.expose(found.sensor, 400, seed=3).save(path)
    elif ending == "jpg":
        look.finished(develop(seen, look="neutral"), seed=3).save(path)
    else:
        seen.save(path)
    at = FREQUENCIES <= 0.35
    plate = tmp_path / f"plate.{ending}"
    made, wanted = (sharpness_of(read(p)).response[at] for p in (path, plate))
    np.testing.assert_allclose(made, wanted, atol=0.05)


def test_alpha_and_catchers_are_blurred_with_the_light(tmp_path):
    found = dg.match_plate(shot("dng", tmp_path), lens="thin")
    alpha = np.zeros(SHAPE, np.float32)
    alpha[:, 450:] = 1
    frame = replace(of_light(np.where(alpha, 0.5, 0), 0.1), alpha=alpha)
    if hasattr(frame, "catcher_ratio"):
        frame.catcher_ratio = np.full((*SHAPE, 3), 0.5, np.float32)
    seen = PlateLook(found).seen(frame)
    np.testing.assert_allclose(seen.rgb[..., 1], 0.5 * seen.alpha, atol=1e-4)
    assert 0.1 < seen.alpha[300, 450] < 0.9
    if hasattr(frame, "catcher_ratio"):
        np.testing.assert_allclose(seen.catcher_ratio[:, :450], 0.5, atol=1e-3)


def test_vignetting_by_a_flat(tmp_path):
    plate = shot("dng", tmp_path)
    y, x = np.mgrid[-1 : 1 : SHAPE[0] * 1j, -1 : 1 : SHAPE[1] * 1j]
    light = 1 - 0.4 * (x**2 * 9 + y**2 * 4) / 13
    of_light(light, 0.1, isoSpeed=400).expose("sony-a7r-ii", 400).save(tmp_path / "flat.dng")
    found = dg.match_plate(plate, flats=[tmp_path / "flat.dng"])
    assert found.falloff.corner_ev == pytest.approx(math.log2(0.6), abs=0.03)
    assert found.falloff.lens is not None
    assert any("vignetting: measured corners -0.7" in note for note in found.notes)
    thin = dg.match_plate(plate, flats=[tmp_path / "flat.dng"], lens="thin")
    seen = PlateLook(replace(thin, sharpness=None)).seen(of_light(np.ones(SHAPE), 0.1))
    np.testing.assert_allclose(seen.rgb[..., 0], light, atol=0.01)
    found.save(tmp_path / "c.json")
    assert dg.read_plate_camera(tmp_path / "c.json").falloff == found.falloff


def test_flats_of_another_kind(tmp_path):
    plate = shot("dng", tmp_path)
    with pytest.raises(InputError, match="wanted a raw picture of 900x600"):
        dg.match_plate(plate, flats=[shot("jpg", tmp_path)])


def test_flats_tell_the_noise_of_a_picture_without_flat_parts(tmp_path):
    rough = np.exp(0.5 * np.random.default_rng(0).standard_normal(SHAPE))
    plate = shot("dng", tmp_path, light=0.2 * rough)
    with_library = dg.match_plate(plate)
    assert with_library.noise is None
    truth = dg.sensors.load("sony-a7r-ii")
    assert with_library.sensor.gain(400) == pytest.approx(truth.gain(400), rel=1e-3)
    assert with_library.sensor.read_noise_at(400) == truth.read_noise_at(400)
    assert any(
        "gain and noise are taken from the library's sony-a7r-ii" in n for n in with_library.notes
    )
    (tmp_path / "flat").mkdir()
    flats = [shot("dng", tmp_path / "flat", light=np.linspace(0, 1, 900) * np.ones((600, 1)))]
    with pytest.raises(InputError, match="even surface"):
        dg.match_plate(plate, flats=flats)  # a ramp is no flat, and says so
    (tmp_path / "even").mkdir()
    levels = [0.02, 0.1, 0.4, 0.9]
    flats = []
    for i, level in enumerate(levels):
        folder = tmp_path / "even" / str(i)
        folder.mkdir()
        flats.append(shot("dng", folder, light=np.full(SHAPE, level), seed=i))
    found = dg.match_plate(plate, flats=flats)
    assert found.noise.gain == pytest.approx(truth.gain(400), rel=0.03)


def bare(folder, ending="png", **facts):
    """A picture whose file says nothing but these facts."""
    path = folder / f"bare.{ending}"
    raw = of_light(LIGHT, 0.1).expose("sony-a7r-ii", 400, seed=1)
    Picture(raw.develop().pixels, "srgb", {"version": "x"} | facts).save(path)
    return path


def test_no_exif_names_what_is_missing(tmp_path):
    path = bare(tmp_path)
    with pytest.raises(InputError) as error:
        dg.match_plate(path)
    text = str(error.value)
    assert text.startswith(f"{path}: EXIF: wanted a focal length, an f-number, an exposure time")
    for flag in ("--focal-length", "--f-stop", "--shutter", "--iso", "--sensor"):
        assert flag in text
    found = dg.match_plate(
        path, focal_length=85, f_stop=2, shutter_time=0.01, iso=200, sensor=(36, 24)
    )
    assert (found.camera.focal_length, found.camera.iso) == (85, 200)
    assert any("lens: the file names none" in note for note in found.notes)


def test_what_is_given_wins(tmp_path):
    found = dg.match_plate(
        shot("jpg", tmp_path), lens="double-gauss-50mm-f2", iso=800, f_stop=4, sensor="nikon-d5100"
    )
    assert found.camera.lens == "double-gauss-50mm-f2"
    assert (found.camera.iso, found.camera.f_stop) == (800, 4)
    assert found.camera.sensor_size == pytest.approx((23.56, 15.6), abs=0.05)
    with pytest.raises(UsageError, match="wanted a lens with an aperture"):
        dg.match_plate(tmp_path / "plate.jpg", lens="pinhole")
    with pytest.raises(UsageError, match="look"):
        dg.match_plate(tmp_path / "plate.jpg", look="sepia")
    with pytest.raises(InputError, match=r"wanted f/2.* or narrower"):
        dg.match_plate(tmp_path / "plate.jpg", lens="double-gauss-50mm-f2", f_stop=1)


def test_unknown_bodies_get_colours_of_another(tmp_path):
    plate = shot("dng", tmp_path)
    data = plate.read_bytes()
    assert b"ILCE-7RM2" in data
    plate.write_bytes(data.replace(b"ILCE-7RM2", b"ILCE-XXXX"))
    found = dg.match_plate(plate)
    assert any("its colours are taken from the sensor nikon-d5100" in n for n in found.notes)
    truth = dg.sensors.load("sony-a7r-ii")
    iso = found.camera.iso
    assert found.sensor.gain(iso) == pytest.approx(truth.gain(400), rel=0.03)
    assert found.sensor.quantum_efficiency.max() <= 1


@pytest.mark.parametrize("name", ["raspberry-pi-hq", "fujifilm-x-t4", "ideal-mono"])
def test_other_mosaics(tmp_path, name):
    found = dg.match_plate(shot("dng", tmp_path, name))
    truth = dg.sensors.load(name)
    assert found.sensor.pattern.name == truth.pattern.name
    assert found.sensor.gain(400) == pytest.approx(truth.gain(400), rel=0.06)


def test_raw_plates_for_composites(tmp_path):
    path = shot("dng", tmp_path)
    found = dg.match_plate(path)
    raw = raw_of(read(path), found)
    assert raw.sensor is found.sensor
    assert raw.gain == pytest.approx(found.noise.gain)
    np.testing.assert_array_equal(raw.mosaic, read(path).raw.mosaic)
    with pytest.raises(InputError, match="wanted a raw plate"):
        raw_of(read(shot("jpg", tmp_path)), dg.match_plate(tmp_path / "plate.jpg"))


FAULTS = [
    (("schema",), "x", "wanted 'daguerre-plate-camera/0.1'"),
    (("plate", "resolution"), [0, 5], "resolution"),
    (("plate", "kind"), "film", "kind"),
    (("camera", "f_stop"), -1, "camera.f_stop"),
    (("camera", "sensor_size_mm"), [36], "camera.sensor_size_mm"),
    (("camera",), None, "camera"),
    (("sensor",), "../other.json", "in the same folder"),
    (("sensor",), "nul\0.json", "in the same folder"),
    (("sensor",), "\ud800.json", "in the same folder"),
    (("sensor",), "", "in the same folder"),
    (("sensor",), "missing.json", "missing.json"),
    (("noise", "kind"), "display", "noise.kind"),
    (("noise", "gain_dn_per_e"), 0, "noise.gain_dn_per_e"),
    (("sharpness", "blur", "sigma_px"), 1e9, "sharpness.blur.sigma_px"),
    (("development", "look"), "sepia", "development.look"),
    (("mystery",), 1, "unknown member"),
]


@pytest.mark.parametrize(("place", "value", "wanted"), FAULTS)
def test_faults_of_files_have_a_place(tmp_path, place, value, wanted):
    dg.match_plate(shot("dng", tmp_path)).save(tmp_path / "c.json")
    data = json.loads((tmp_path / "c.json").read_text())
    inner = data
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    (tmp_path / "c.json").write_text(json.dumps(data))
    with pytest.raises(InputError) as error:
        dg.read_plate_camera(tmp_path / "c.json")
    assert wanted in str(error.value)
