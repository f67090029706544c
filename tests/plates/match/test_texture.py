"""Developed plates of fine texture: noise of their flat parts, or none with a reason."""

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

import daguerre as dg
from daguerre import sensors
from daguerre.plates.match.grain import Grain
from daguerre.plates.match.grain_measure import grain_of
from daguerre.plates.match.likely import white_electrons
from daguerre.plates.photograph import Photograph
from tests.support.pictures.plate_frames import of_light
from tests.support.pictures.plate_textures import SHAPE, TEXTURES, with_strip

SENSOR, STEPS = "sony-a7r-ii", 14
WIDTH = SHAPE[1] // STEPS
WEDGE = np.repeat(np.repeat(2.0 ** (-0.45 * np.arange(STEPS)), WIDTH)[None], SHAPE[0], 0)


def developed(light, iso, ending="png", sensor=SENSOR, seed=1):
    """Numbers of a shot as its file has them."""
    raw = of_light(light, 0.5 * 78 / iso).expose(sensor, iso, seed=seed)
    pixels = np.asarray(raw.develop(look="standard").pixels)
    pixels = np.rint(255 * np.clip(pixels, 0, 1)).astype(np.uint8)
    return pixels if ending == "png" else jpeg(pixels, 92, 0)


def jpeg(pixels, quality, subsampling):
    held = io.BytesIO()
    Image.fromarray(pixels).save(held, "jpeg", quality=quality, subsampling=subsampling)
    return np.asarray(Image.open(held))


def steps(pixels):
    """Levels and deviations of the wedge's steps, (steps, 3) each, from the darkest on."""
    inner = pixels.reshape(SHAPE[0], STEPS, WIDTH, 3)[8:-8, ::-1, 8:-8] / 255
    return inner.mean(axis=(0, 2)), np.sqrt(inner.var(axis=(0, 2)) - 1 / 12 / 255**2)


def measured(pixels, iso, pitch=4.51):
    notes = []
    photograph = Photograph(Path("x.png"), "display", pixels, None, {})
    return grain_of(photograph, white_electrons(iso, pitch), notes), notes


def ratio(found, pixels):
    """Deviations that were found over those of the wedge's steps, (3, L)."""
    levels, truth = steps(pixels)
    return np.array(
        [
            found.deviations[c] / np.interp(found.levels[c], levels[:, c], truth[:, c])
            for c in range(3)
        ]
    )


@pytest.fixture(scope="module")
def wedges():
    return {
        (iso, ending): developed(WEDGE, iso, ending)
        for iso in (100, 3200)
        for ending in ("png", "jpg")
    }


@pytest.fixture(scope="module")
def lights():
    return {name: make() for name, make in TEXTURES.items()}


@pytest.mark.parametrize("ending", ["png", "jpg"])
@pytest.mark.parametrize("iso", [100, 3200])
@pytest.mark.parametrize("name", TEXTURES)
def test_texture_alone_has_no_noise_that_can_be_told(lights, wedges, name, iso, ending):
    """Grass at ISO 3200 keeps a few levels, within a third: it has half of the noise's variance."""
    found, notes = measured(developed(lights[name], iso, ending), iso)
    assert len(notes) == 1
    if found is None:
        assert "noise: not measured, as " in notes[0]
    else:
        assert (name, iso) == ("grass", 3200)
        assert "left out" in notes[0]
        assert ratio(found, wedges[iso, ending]).max() < 1.35


@pytest.mark.parametrize("ending", ["png", "jpg"])
@pytest.mark.parametrize("iso", [100, 3200])
@pytest.mark.parametrize("name", TEXTURES)
def test_a_flat_strip_tells_the_noise(lights, wedges, name, iso, ending):
    found, _ = measured(developed(with_strip(lights[name]), iso, ending), iso)
    hard = name == "grass" and iso == 3200  # its blocks are as strong as noise at its strongest
    np.testing.assert_allclose(ratio(found, wedges[iso, ending]), 1, atol=0.6 if hard else 0.2)
    assert found.levels[1, 0] < 0.45 < 0.7 < found.levels[1, -1]


def smoothed(pixels, light, colours):
    """Noise reduction: blurred noise, of colours alone or of all."""
    rest = pixels / 255 - light
    grey = rest.mean(axis=2, keepdims=True)
    if colours:
        rest = grey + ndimage.gaussian_filter(rest - grey, (4, 4, 0))
    else:
        rest = ndimage.gaussian_filter(rest, (0.7, 0.7, 0))
    return np.rint(255 * np.clip(light + rest, 0, 1)).astype(np.uint8)


@pytest.mark.parametrize(
    "how", ["quality 75", "quality 60", "quality 50", "smooth", "smooth colours", "grey"]
)
def test_noise_that_cameras_have_worked_on_is_noise(wedges, how):
    pixels = wedges[3200, "png"]
    light = np.repeat(steps(pixels)[0][::-1], WIDTH, axis=0)
    if how.startswith("quality"):
        pixels = jpeg(pixels, int(how.split()[1]), 2)
    elif how == "grey":
        pixels = np.repeat(pixels[:, :, 1:2], 3, axis=2)
    else:
        pixels = jpeg(smoothed(pixels, light, how == "smooth colours"), 90, 2)
    found, notes = measured(pixels, 3200)
    assert notes == []
    assert found.levels.shape[1] >= 8
    np.testing.assert_allclose(ratio(found, pixels)[1], 1, atol=0.15)  # colours change in steps


@pytest.mark.parametrize("name", sensors.names())
@pytest.mark.parametrize("iso", [200, 1200])
def test_noise_of_the_library_is_likely(name, iso):
    found, notes = measured(developed(WEDGE, iso, sensor=name), iso, sensors.load(name).pixel_pitch)
    assert notes == []
    assert found.levels.shape[1] >= 8


def test_film_has_more_noise_than_light_explains_and_keeps_it():
    """Layers of film know nothing of each other."""
    random = np.random.default_rng(1)
    rough = ndimage.gaussian_filter(random.standard_normal((*SHAPE, 3)), (1, 1, 0))
    light = np.linspace(0.1, 0.9, SHAPE[1])[:, None] + 0.04 * rough / rough.std()
    found, notes = measured(np.rint(255 * np.clip(light, 0, 1)).astype(np.uint8), 100)
    assert notes == []
    assert np.median(found.deviations) == pytest.approx(0.04, rel=0.15)


def test_steps_of_whole_numbers_are_no_texture():
    """A gradient without noise, whose numbers rise in steps, is flat."""
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    pixels = np.rint(50 + 120 * x / SHAPE[1] + 20 * y / SHAPE[0]).astype(np.uint8)
    found, notes = measured(np.repeat(pixels[:, :, None], 3, 2), 100)
    assert notes == []
    assert found.deviations.max() < 0.1 / 255


def test_a_flat_gives_a_textured_plate_its_grain(tmp_path, lights):
    facts = {"nominalFocalLength": 35.0, "isoSpeed": 400}
    for name, light in (("plate", lights["leaves"]), ("flat", 0.4 * np.ones(SHAPE))):
        raw = of_light(light, 0.5 * 78 / 400, **facts).expose(SENSOR, 400, seed=1)
        raw.save(tmp_path / f"{name}.png", look="standard")
    alone = dg.match_plate(tmp_path / "plate.png")
    assert alone.noise is None
    assert any("no part of the picture is flat" in note for note in alone.notes)
    assert any("--flat FILE" in note for note in alone.notes)
    found = dg.match_plate(tmp_path / "plate.png", flats=[tmp_path / "flat.png"])
    assert isinstance(found.noise, Grain)
    assert any("noise: taken from flat.png" in note for note in found.notes)
    own = dg.match_plate(tmp_path / "flat.png").noise
    np.testing.assert_array_equal(found.noise.deviations, own.deviations)
