"""Development: exposure, white balance, colours, highlights, looks."""

import numpy as np
import pytest

import daguerre as dg
from daguerre.color import illuminants, spaces
from daguerre.development import LOOKS, develop
from daguerre.sensors import load, names
from tests.support.pictures.colour_chart import (
    PATCH,
    delta_e,
    greys,
    lab,
    patch_means,
    raw_of,
    reflectances,
    truth,
)

METADATA = {"expTime": 0.01, "aperture": 4.0, "isoSpeed": 200, "version": "x"}


def frame(rgb, **metadata):
    """A frame of one row of colours, with a luminance exposure of 1 that is middle grey x 1."""
    rgb = np.asarray(rgb, np.float32)
    facts = METADATA | {"luminance_exposure": 10 / 0.18 / 200} | metadata
    return dg.Frame(rgb=rgb if rgb.ndim == 3 else rgb.reshape(1, -1, 3), metadata=facts)


def test_delta_e_is_that_of_the_publication():
    pairs = [  # Sharma, Wu and Dalal 2005, table 1, pairs 1, 7, 17, 25
        ((50, 2.6772, -79.7751), (50, 0, -82.7485), 2.0425),
        ((50, 0, 0), (50, -1, 2), 2.3669),
        ((50, 2.5, 0), (73, 25, -18), 27.1492),
        ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
    ]
    for one, other, wanted in pairs:
        assert delta_e(np.array(one), np.array(other)) == pytest.approx(wanted, abs=1e-4)


@pytest.mark.parametrize("name", names())
@pytest.mark.parametrize("white", [None, 2856, 3500])
def test_a_chart_has_its_colours_in_the_light_that_it_was_taken_in(name, white):
    sensor = load(name)
    if len(sensor.channels) == 1:
        pytest.skip("no colours")
    got = patch_means(raw_of(sensor, reflectances(), white=white).develop().linear())
    apart = delta_e(lab(got), lab(truth(reflectances(), white).clip(0, 1)))
    assert apart.mean() < 3
    assert apart[3].max() < 2.5  # greys, which are a little coloured
    grey = patch_means(raw_of(sensor, greys(0.05, 0.18, 0.7), white=white).develop().linear(), 1, 3)
    if white != 3500:  # between the lights that the matrices are of, they are mixed
        one = 0.0015  # a digital number of 12 bits, in the blue of the redder light
        np.testing.assert_allclose(grey, grey[..., 1:2].repeat(3, axis=2), rtol=0.02, atol=one)


@pytest.mark.parametrize("pattern", ["bayer-gbrg", "xtrans", "quad-bayer-rggb"])
def test_each_mosaic_gives_the_same_picture(pattern):
    sensor = load("ideal")
    one = patch_means(raw_of(sensor, reflectances()).develop().linear())
    other = raw_of(sensor.with_(pattern=pattern), reflectances()).develop().linear()
    np.testing.assert_allclose(patch_means(other), one, atol=2e-3)


@pytest.mark.parametrize("name", ["ideal", "ideal-mono"])
@pytest.mark.parametrize("look", LOOKS)
def test_middle_grey_of_iso_12232_is_118(name, look):
    raw = raw_of(name, greys(0.18), iso=400)  # 10 / 400 lux s
    values = raw.develop(look=look).bytes8()
    assert np.abs(values.astype(int) - 118).max() <= 1


def test_a_frame_is_exposed_by_the_same_rule():
    assert develop(frame([0.18, 0.18, 0.18])).bytes8().tolist() == [[[118] * 3]]
    # 10 / ISO lux s is middle grey, whatever the number in the file is
    facts = {"luminance_exposure": 0.05, "isoSpeed": 200}
    assert develop(frame([1, 1, 1], **facts)).bytes8().tolist() == [[[118] * 3]]


@pytest.mark.parametrize(("source", "shape"), [("raw", (4, 6)), ("frame", (1, 1))])
def test_half_the_exposure_is_half_the_light(source, shape):
    if source == "raw":
        full, half = (raw_of("ideal", reflectances() * 0.8, ev=ev) for ev in (0, -1))
    else:
        colours = np.repeat(np.repeat([[[0.8, 0.4, 0.2]]], 3, axis=0), 3, axis=1)
        full, half = frame(colours), frame(colours / 2)
    one, dark, bright = (
        patch_means(develop(shot, ev=ev).linear(), *shape)
        for shot, ev in ((full, 0), (half, 0), (half, 1))
    )
    np.testing.assert_allclose(dark, one / 2, atol=2e-4)
    np.testing.assert_allclose(bright, one, atol=4e-4)


@pytest.mark.parametrize("name", ["nikon-d5100", "fujifilm-x-t4", "sony-imx571-mono"])
@pytest.mark.parametrize("demosaic", ["fast", "good", "best", "vng"])
def test_even_light_is_even_up_to_the_border(name, demosaic):
    values = raw_of(name, greys(0.18, 0.18)).develop(demosaic=demosaic).bytes8()
    assert np.abs(values.astype(int) - 118).max() <= 1


def test_colour_noise_goes_and_brightness_stays():
    flat = dg.Frame(rgb=np.full((96, 96, 3), 0.05, np.float32), metadata=dict(METADATA))
    flat.metadata["luminance_exposure"] = 10 / 0.18 / 6400
    raw = flat.expose("sony-a7r-ii", iso=6400, seed=1)
    one, other = (raw.develop(colour_noise=passes).linear() for passes in (0, 4))
    colours = [(light - light.mean(axis=2, keepdims=True)).std() for light in (one, other)]
    assert colours[1] < 0.6 * colours[0]
    assert other.mean() == pytest.approx(one.mean(), rel=0.03)


@pytest.mark.parametrize("source", ["picture.jpg", None, np.ones((4, 4, 3))])
def test_sources_that_are_none(source):
    with pytest.raises(dg.UsageError, match="source: wanted a raw picture or a frame"):
        develop(source)


def test_light_near_saturation_is_in_proportion():
    """LibRaw would stretch such pictures to the highest number that they have."""
    raw = raw_of("ideal", greys(0.7, 1.2))
    got = patch_means(raw.develop(ev=-1, highlights="reconstruct").linear(), 1, 2)
    np.testing.assert_allclose(got[0, :, 1], [0.35, 0.6], rtol=2e-3)


def test_white_balance_by_kelvin_chromaticity_and_eye():
    raw = raw_of("ideal", greys(0.2, 0.5, 0.8), white=2856)
    warm = patch_means(raw.develop(wb=6504).linear(), 1, 3)
    assert (warm[0, :, 0] > 1.5 * warm[0, :, 2]).all()
    lamp = illuminants.white_xy(2856)
    for wb in (None, "as-shot", 2856, "2856", "2856K", lamp, "{},{}".format(*lamp), "auto"):
        grey = patch_means(raw.develop(wb=wb).linear(), 1, 3)
        np.testing.assert_allclose(grey, grey[:, :, 1:2].repeat(3, axis=2), rtol=0.01)
    for wb in ("green", 200, (0.9, 0.9), "1,2,3"):
        with pytest.raises(dg.UsageError, match="wb"):
            raw.develop(wb=wb)


def test_overexposed_white_is_white_and_not_magenta():
    raw = raw_of("ideal", greys(1.0), ev=2, white=2856)
    assert raw.saturated.any()
    for highlights in ("clip", "blend", "reconstruct"):
        assert raw.develop(highlights=highlights).bytes8().min() >= 254
    for highlights in ("blend", "reconstruct"):  # less exposure shows more light, still neutral
        got = raw.develop(highlights=highlights, ev=-2).linear()
        clipped = raw.develop(highlights="clip", ev=-2).linear()
        assert got[PATCH // 2, PATCH // 2].mean() > clipped.mean() * 1.05
        assert np.ptp(got, axis=2).max() < 0.02


def test_edges_of_overexposed_lamps_have_no_colour():
    raw = raw_of("sony-a7r-ii", greys(1.0, 1.0, 1.0, 1.0).repeat(4, axis=0))
    x = np.arange(raw.width) - raw.width / 2
    lamp = 0.02 + 8 / (1 + np.exp((np.hypot(x, x[:, None]) - 30) / 1.5))
    numbers = (raw.mosaic - 1.0 * raw.black_level) * lamp + raw.black_level
    raw.mosaic = np.minimum(numbers, raw.white_level).astype(np.uint16)
    assert np.ptp(raw.develop().linear(), axis=2).max() < 0.15


def test_colours_that_a_screen_lacks_keep_luminance_and_hue():
    laser = np.array([-0.3, 0.6, -0.05])  # a green that no screen has
    got = develop(frame(laser)).linear()[0, 0]
    luminance = spaces.xyz_from_rgb(spaces.COLOR_SPACES["srgb"])[1]
    assert luminance @ got == pytest.approx(luminance @ laser, abs=1e-3)
    assert got.min() == pytest.approx(0, abs=1e-6)
    wide = develop(frame(laser), colour_space="rec2020").linear()[0, 0]
    assert wide.min() > 0.002  # Rec.2020 has it: nothing had to change
    lamp = develop(frame([40, 3, -0.5])).bytes8()[0, 0]
    assert lamp.min() > 240  # as bright as that it is nearly white, not a red hole
    rim = develop(frame([1.5, 0.3, -0.1])).linear()[0, 0]
    assert rim[0] == pytest.approx(1)
    assert rim[1] > rim[2] > 0.05


@pytest.mark.parametrize("space", spaces.ENCODED)
def test_spaces_have_the_same_colours(space):
    colours = [[0.2, 0.5, 0.1], [0.18, 0.18, 0.18], [0.9, 0.1, 0.3]]
    picture = develop(frame(colours), colour_space=space)
    xyz = picture.linear() @ spaces.xyz_from_rgb(spaces.COLOR_SPACES[space]).T
    wanted = np.array(colours) @ spaces.xyz_from_rgb(spaces.COLOR_SPACES["srgb"]).T
    np.testing.assert_allclose(xyz[0], wanted, atol=2e-4)


@pytest.mark.parametrize("look", LOOKS)
def test_looks_rise_and_end_in_white(look):
    steps = np.geomspace(1e-4, 20, 200)
    got = develop(frame(steps[:, None].repeat(3, axis=1)), look=look).pixels[0]
    assert np.diff(got, axis=0).min() > -1e-6
    assert got[-1].min() > 0.999
    assert np.ptp(got, axis=1).max() < 1e-5
    assert got[0, 0] < 0.06


def test_film_and_filmic_hold_highlights_that_neutral_clips():
    lamps = frame([[2.0] * 3, [4.0] * 3])
    assert develop(lamps).bytes8().min() == 255
    for look in ("film", "filmic"):
        low, high = develop(lamps, look=look).bytes8()[0, :, 0]
        assert low < high < 255


def test_sharpening_steepens_edges_and_leaves_flats():
    raw = raw_of("ideal", greys(0.1, 0.6))
    soft, sharp = raw.develop().pixels, raw.develop(sharpen=1).pixels
    np.testing.assert_allclose(sharp[:, :8], soft[:, :8], atol=1e-4)
    assert np.diff(sharp[12, :, 1]).max() > 1.2 * np.diff(soft[12, :, 1]).max()


def test_grain_has_the_mean_of_the_light_and_belongs_to_the_seed():
    flat = raw_of("ideal", greys(0.18, 0.18, 0.18, 0.18))
    plain = flat.develop().linear()
    one, same, other = (flat.develop(grain=20, seed=seed).linear() for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert (one != other).any()
    assert one.std() > 20 * plain.std()
    assert one.mean() == pytest.approx(plain.mean(), rel=0.02)


def test_an_ocio_view():
    pytest.importorskip("PyOpenColorIO")
    view = "ocio:ACES 2.0 - SDR 100 nits (Rec.709)"
    got = develop(frame([[0.18] * 3, [100.0] * 3, [0, 0, 0]]), look=view).pixels[0]
    # ACES 2.0 shows middle grey at 10 nits of 100: 0.349 in sRGB.
    assert got[0] == pytest.approx([0.349] * 3, abs=0.01)
    assert got[1].min() > 0.99
    assert got[2].max() < 0.01
    with pytest.raises(dg.UsageError, match="look: wanted ocio: and a view of"):
        develop(frame([0, 0, 0]), look="ocio:nothing")


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        ({"look": "flimic"}, "did you mean 'film"),
        ({"colour_space": "adobe"}, "colour_space: wanted one of srgb"),
        ({"highlights": "keep"}, "highlights: wanted one of clip"),
        ({"ev": float("nan")}, "ev"),
        ({"sharpen": -1}, "sharpen"),
        ({"colour_noise": 1.5}, "colour_noise"),
        ({"grain": -1}, "grain"),
        ({"demosaic": "amaze"}, "demosaic: wanted one of best"),
    ],
)
def test_wrong_parameters_are_named(wrong, named):
    with pytest.raises(dg.UsageError, match=named):
        raw_of("ideal", greys(0.18)).develop(**wrong)


def test_light_that_is_no_number_is_refused_and_infinite_light_is_white():
    light = frame([[1.0] * 3, [np.inf] * 3])
    assert develop(light).bytes8()[0, 1].tolist() == [255, 255, 255]
    light.rgb[0, 1, 2] = np.nan
    if light.xyz is not None:
        light.xyz[0, 1, 2] = np.nan
    with pytest.raises(
        dg.InputError, match=r"got NaN or infinity in 1 pixels, the first at \(1, 0\)"
    ):
        develop(light)


@pytest.mark.parametrize("field", ["expTime", "aperture", "luminance_exposure"])
def test_frames_without_exposure_name_the_field(field):
    facts = {"expTime": 0.01, "aperture": 4.0}
    broken = facts | {field: -1.0} if field == "luminance_exposure" else facts | {field: None}
    rgb = np.ones((1, 1, 3), np.float32)
    with pytest.raises(dg.InputError, match=field):
        develop(dg.Frame(rgb=rgb, metadata=broken))
