"""Gain and read noise of raw pictures against the sensors that took them."""

from dataclasses import replace

import numpy as np
import pytest

from daguerre import sensors
from daguerre.errors import InputError
from daguerre.plates.match import cut, transfer
from daguerre.plates.match.blocks import Blocks
from tests.support.pictures.plate_frames import numbers_of, of_light, partly_textured, ramp, wedge
from tests.support.pictures.plate_textures import TEXTURES

SHAPE = (1600, 2400)
MODES = [
    *(("sony-a7r-ii", iso) for iso in (100, 400, 640, 1600, 6400)),
    *(("raspberry-pi-hq", iso) for iso in (75, 150, 300, 600, 1200)),
    *(("fujifilm-x-t4", iso) for iso in (160, 1600)),
]


def shot(name, iso, light=None, seed=1, **changes):
    """A raw picture whose white is just below the highest number."""
    sensor = sensors.load(name).with_(**changes)
    light = wedge(SHAPE) if light is None else light
    return of_light(light, 0.9 * 78 / iso).expose(sensor, iso, seed=seed)


def measured(raw, **parts):
    numbers = replace(numbers_of(raw), **parts)
    span = (-raw.black_level, raw.white_level - raw.black_level)
    found = cut.blocks_of(numbers)
    return transfer.transfer_of(found, span, len(raw.sensor.channels), "plate.dng")


def dark_noise(raw):
    return float(np.hypot(raw.sensor.read_noise_at(raw.iso), raw.sensor.dsnu))


@pytest.mark.parametrize(("name", "iso"), MODES)
def test_flats_give_gain_and_read_noise_within_three_per_cent(name, iso):
    raw = shot(name, iso)
    found = measured(raw)
    assert found.gain == pytest.approx(raw.gain, rel=0.02)
    assert found.read_noise == pytest.approx(dark_noise(raw), rel=0.03)
    assert found.prnu == pytest.approx(raw.sensor.prnu, abs=0.004)
    for gain in found.by_channel:
        assert np.isnan(gain) or gain == pytest.approx(raw.gain, rel=0.04)
    assert not np.isnan(found.by_channel[len(found.by_channel) // 2])


@pytest.mark.parametrize("iso", [100, 1600])
@pytest.mark.parametrize(("light", "error"), [(ramp, 0.02), (partly_textured, 0.03)])
def test_gradients_and_texture_hardly_matter(iso, light, error):
    raw = shot("sony-a7r-ii", iso, light(SHAPE))
    found = measured(raw)
    assert found.gain == pytest.approx(raw.gain, rel=error)
    # Little of these pictures is dark, and the stated error says so.
    assert abs(found.read_noise / dark_noise(raw) - 1) < 4 * found.read_noise_error
    assert found.read_noise_error > 0.02


def test_stated_errors_are_those_of_many_shots_and_nothing_is_biased():
    light = wedge((600, 900))
    shots = [shot("sony-a7r-ii", 800, light, seed, serial=seed) for seed in range(12)]
    found = [measured(one) for one in shots]
    for name, truth in (("gain", shots[0].gain), ("read_noise", dark_noise(shots[0]))):
        values = np.array([getattr(one, name) for one in found])
        told = np.mean([getattr(one, f"{name}_error") for one in found])
        assert values.std(ddof=1) / truth == pytest.approx(told, rel=0.6)
        assert values.mean() == pytest.approx(truth, rel=0.011)


@pytest.mark.parametrize("name", ["sony-a7r-ii", "raspberry-pi-hq", "fujifilm-x-t4"])
def test_blocks_are_those_of_their_channel(name):
    raw = of_light(np.ones((576, 576)), 0.05).expose(name, 400, seed=1)
    found = cut.blocks_of(numbers_of(raw))
    for channel in set(found.channel.tolist()):
        wanted = raw.mosaic[raw.channel_map() == channel].mean() - raw.black_level
        assert found.level[found.channel == channel].mean() == pytest.approx(wanted, rel=0.02)
        # Coefficients of white noise have one variance: what judges is like what measures.
        own = found.only(found.channel == channel)
        assert own.low.mean() == pytest.approx(own.high.mean(), rel=0.3)
        assert own.slope.mean() == pytest.approx(2 * own.high.mean(), rel=0.5)


def test_numbers_at_either_end_are_left_out():
    light = 3 * wedge(SHAPE)  # the brightest steps are clipped
    raw = shot("sony-a7r-ii", 400, light)
    assert raw.saturated.mean() > 0.1
    assert measured(raw).gain == pytest.approx(raw.gain, rel=0.02)
    black = shot("nikon-d5100", 1600)  # its black is 0: half of the noise in the dark is cut off
    assert measured(black).gain == pytest.approx(black.gain, rel=0.025)
    assert measured(black).read_noise == pytest.approx(dark_noise(black), rel=0.15)


def test_a_mosaic_that_is_taken_for_another_is_no_sensor():
    """The planted fault: blocks mix the channels, whose levels differ."""
    raw = shot("sony-a7r-ii", 400)
    with pytest.raises(InputError, match=r"plate\.dng: noise: wanted"):
        measured(raw, cells=np.zeros((1, 1), np.uint8))


def test_texture_alone_tells_nothing():
    rough = np.exp(0.5 * np.random.default_rng(0).standard_normal(SHAPE)) * ramp(SHAPE)
    with pytest.raises(InputError, match="--flat FILE"):
        measured(shot("sony-a7r-ii", 100, rough))


@pytest.mark.parametrize("name", ["sony-a7r-ii", "fujifilm-x-t4"])
@pytest.mark.parametrize("iso", [160, 3200])
@pytest.mark.parametrize("texture", TEXTURES)
def test_fine_texture_is_refused_or_told(texture, iso, name):
    """Either the gain is right within 7 %, or the stated error covers it, or there is none."""
    raw = shot(name, iso, TEXTURES[texture]())
    found, message = None, ""
    try:
        found = measured(raw)
    except InputError as error:
        message = str(error)
    if found is None:
        assert "--flat FILE" in message or "does not grow with light" in message
    else:
        assert abs(found.gain / raw.gain - 1) < max(0.07, 2 * found.gain_error)


@pytest.mark.parametrize("light", [np.full((40, 40), 0.3), np.full((800, 800), 50.0)])
def test_small_and_clipped_pictures_are_refused(light):
    with pytest.raises(InputError, match="wanted at least 64 "):
        measured(shot("sony-a7r-ii", 100, light))


def test_colours_that_tell_another_gain_are_no_sensor():
    """Noise of one channel grows with light, that of a few blocks of the other does not."""
    random = np.random.default_rng(2)
    level = random.uniform(50, 4000, 8000)
    channel = (np.arange(8000) % 40 == 0).astype(np.intp)
    variance = 4 + np.where(channel == 0, level, 0.3 * level)

    def squares(count):
        return variance * random.chisquare(count, 8000) / count

    found = Blocks(level, squares(9), squares(16), 2 * squares(2), channel)
    with pytest.raises(InputError, match="give each colour a different gain"):
        transfer.transfer_of(found, (0, 1e5), 2, "x.dng")
    one = found.only(channel == 0)
    assert transfer.transfer_of(one, (0, 1e5), 2, "x.dng").gain == pytest.approx(1, rel=0.03)
