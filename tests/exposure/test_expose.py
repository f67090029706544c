"""From frames to numbers: noise by EMVA 1288, exposure by ISO 12232, clipping, bad input."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import stats

import daguerre as dg
from daguerre.color import illuminants
from daguerre.frame.frame import Frame
from daguerre.sensors import DarkCurrent, HotPixels, load
from tests.support.pictures.flats import flat, lux_s_for, mono


def one_to_one(**values):
    """A monochrome sensor whose numbers are electrons."""
    sensor = mono(bit_depth=16, black_level=0, full_well=60000, **values)
    iso = sensor.saturation_iso * 60000 / 65535
    assert sensor.gain(iso) == pytest.approx(1)
    return sensor, iso


@pytest.mark.parametrize("mean", [0.5, 5, 50, 500])
def test_counts_of_electrons_follow_poisson(mean: float) -> None:
    sensor, iso = one_to_one()
    frame = flat(lux_s_for(sensor, mean), (400, 400))
    counts = np.bincount(frame.expose(sensor, iso, seed=1).mosaic.ravel())
    law = stats.poisson(mean)
    low, high = int(law.ppf(1e-4)), int(law.ppf(1 - 1e-4))
    seen = np.append(counts[low:high], [counts[:low].sum(), counts[high:].sum()])
    wanted = np.append(law.pmf(np.arange(low, high)), [law.cdf(low - 1), law.sf(high - 1)])
    kept = wanted * counts.sum() > 5
    seen = np.append(seen[kept], seen[~kept].sum())
    wanted = np.append(wanted[kept], wanted[~kept].sum()) * counts.sum()
    if wanted[-1] == 0:
        seen, wanted = seen[:-1], wanted[:-1]
    assert stats.chisquare(seen, wanted * seen.sum() / wanted.sum()).pvalue > 1e-3
    numbers = np.repeat(np.arange(counts.size), counts)
    assert numbers.mean() == pytest.approx(mean, abs=4 * math.sqrt(mean / numbers.size))
    assert numbers.var() == pytest.approx(mean, rel=4 * math.sqrt((2 + 1 / mean) / numbers.size))


def photon_transfer(sensor, iso: float, levels: int = 24, size: int = 300):
    """Pairs of flats from dark to 80 % of the well: photons, mean and temporal variance in DN.

    EMVA 1288 4.0 Linear, 6.5: the variance is that of the difference of two, halved.
    """
    photons, means, variances = [], [], []
    per_lux_s = illuminants.integral(illuminants.photons_per_lux_s(illuminants.d65()))
    for i, part in enumerate(np.linspace(0, 0.8, levels)):
        lux_s = lux_s_for(sensor, max(part * sensor.full_well, 1e-6))
        frame = flat(lux_s, (size, size))
        a, b = (frame.expose(sensor, iso, seed=2 * i + k).mosaic.astype(float) for k in (0, 1))
        photons.append(lux_s * per_lux_s * sensor.photosite_area if part else 0.0)
        means.append((a.mean() + b.mean()) / 2)
        variances.append((a - b).var() / 2)
    return np.array(photons), np.array(means), np.array(variances)


def test_photon_transfer_recovers_gain_efficiency_and_dark_noise() -> None:
    """The linear model of EMVA 1288 4.0, equations 8 to 13."""
    sensor = mono(read_noise=6.0, prnu=0.02, dsnu=3.0)
    iso = sensor.base_iso
    photons, means, variances = photon_transfer(sensor, iso)
    signal, noise = means - means[0], variances - variances[0]
    gain = float(signal @ noise / (signal @ signal))
    response = float(photons @ signal / (photons @ photons))
    dark = math.sqrt(variances[0] - 1 / 12) / gain
    assert gain == pytest.approx(sensor.gain(iso), rel=0.01)
    assert response / gain == pytest.approx(0.6, rel=0.01)
    assert dark == pytest.approx(6.0, rel=0.01)


def test_emva1288_recovers_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the reference implementation of the standard (PyPI emva1288)."""
    pytest.importorskip("emva1288")
    if not hasattr(np, "asfarray"):  # numpy 2 has not; the package was written before
        monkeypatch.setattr(np, "asfarray", lambda a: np.asarray(a, float), raising=False)
    from emva1288.process.data import Data1288
    from emva1288.process.loader import LoadImageData
    from emva1288.process.results import Results1288

    sensor = mono(read_noise=6.0, prnu=0.02, dsnu=3.0)
    per_lux_s = illuminants.integral(illuminants.photons_per_lux_s(illuminants.d65()))

    def shots(part: float, first_seed: int, count: int):
        frame = flat(lux_s_for(sensor, max(part * sensor.full_well, 1e-6)), (300, 300))
        return [
            frame.expose(sensor, sensor.base_iso, seed=first_seed + k).mosaic for k in range(count)
        ]

    class Loader(LoadImageData):
        def _load_imgs(self, images):
            self._shape = {images[0].shape}
            return images

    def photons(part: float) -> float:
        electrons = part * sensor.full_well
        return float(lux_s_for(sensor, electrons) * per_lux_s * sensor.photosite_area)

    parts = np.linspace(0, 0.95, 24)
    temporal = {photons(p): shots(p, 2 * i, 2) for i, p in enumerate(parts)}
    spatial = {photons(p): shots(p, 1000 + 20 * i, 16) for i, p in enumerate((0.0, 0.5))}
    loaded = Loader({"temporal": {0.01: temporal}, "spatial": {0.01: spatial}}, loglevel=50)
    data = Data1288(loaded.data, loglevel=50)
    results = Results1288(data.data, pixel_area=sensor.photosite_area, loglevel=50)
    assert pytest.approx(sensor.gain(sensor.base_iso), rel=0.01) == results.K
    assert pytest.approx(60, rel=0.01) == results.QE
    assert results.sigma_d == pytest.approx(6.0, rel=0.01)
    assert pytest.approx(2.0, rel=0.02) == results.PRNU1288
    assert pytest.approx(3.0, rel=0.02) == results.DSNU1288


def test_dark_current_doubles_in_so_many_kelvin() -> None:
    sensor, iso = one_to_one(dark_current=DarkCurrent(50, 20, 6))
    means = [
        flat(1e-12, (128, 128), expTime=2.0).expose(sensor, iso, temperature=t).mosaic.mean()
        for t in (None, 26.0, 32.0)
    ]
    assert means == pytest.approx([100, 200, 400], rel=0.01)


def test_hot_pixels_stay_where_they_are() -> None:
    sensor, iso = one_to_one(hot_pixels=HotPixels(0.01, 5000), serial=3)
    frame = flat(1e-12, (100, 100), expTime=1.0)
    first, second = (frame.expose(sensor, iso, seed=s).mosaic > 0 for s in (0, 1))
    assert 60 < first.sum() < 140
    assert (first == second).mean() > 0.999
    other = frame.expose(sensor.with_(serial=4), iso).mosaic > 0
    assert (first & other).sum() < 20


def test_numbers_are_of_the_seed_and_nothing_else() -> None:
    frame = flat(0.1)
    first = frame.expose("ideal", 400, seed=5)
    assert (first.mosaic == frame.expose("ideal", 400, seed=5).mosaic).all()
    assert (first.mosaic != frame.expose("ideal", 400, seed=6).mosaic).mean() > 0.9


def test_iso_12232_saturation() -> None:
    """D65 of 78 / S lux s is the highest number; middle grey of 18 % is 10 / S."""
    sensor = load("ideal").with_(black_level=1000)
    for iso in (100, 400, 1600):
        for lux_s, part in ((77.5, 77.5 / 78), (55.6, 55.6 / 78), (10, 10 / 78)):
            raw = flat(lux_s / iso, (64, 64)).expose(sensor, iso)
            green = raw.mosaic[raw.channel_map() == 1].mean()
            assert green == pytest.approx(1000 + part * 64535, rel=0.004)
            assert not raw.saturated.any() or lux_s > 77
        over = flat(85 / iso, (64, 64)).expose(sensor, iso)
        assert over.saturated[over.channel_map() == 1].all()
        assert (over.mosaic[over.channel_map() == 1] == 65535).mean() > 0.9


def test_a_stop_is_a_stop() -> None:
    """Half the ISO, half the time and half the light are the same to the mean."""
    sensor = load("ideal")

    def signal(lux_s: float, iso: float, ev: float = 0) -> float:
        raw = flat(lux_s, (64, 64)).expose(sensor, iso, ev=ev)
        return float(raw.mosaic[raw.channel_map() == 1].mean())

    full = signal(0.04, 400)
    for half in (signal(0.04, 200), signal(0.02, 400), signal(0.04, 400, -1)):
        assert full / half == pytest.approx(2, rel=0.002)


def test_iso_amplifies_light_and_its_noise_alike() -> None:
    sensor = mono()
    frame = flat(lux_s_for(sensor, 400), (300, 300))
    for stops in (0, 1, 2, 4):
        iso = sensor.base_iso * 2**stops
        electrons = frame.expose(sensor, iso).electrons()
        quantised = 1 / 12 / sensor.gain(iso) ** 2
        assert electrons.mean() == pytest.approx(400, rel=0.002)
        assert electrons.var() == pytest.approx(400 + quantised, rel=0.02)


def test_d65_grey_balances() -> None:
    for name in dg.sensors.names():
        sensor = load(name)
        if len(sensor.channels) == 1:
            continue
        raw = flat(0.3, (128, 128)).expose(sensor, 100)
        means = [raw.electrons()[raw.channel_map() == i].mean() for i in range(3)]
        balanced = np.array(means) / raw.neutral
        assert balanced / balanced[1] == pytest.approx(1, rel=2e-3)


def test_bit_depth_and_no_empty_numbers() -> None:
    """A ramp fills every number unless electrons are more numbers than one."""
    for bits in (8, 10, 12):
        sensor = mono(bit_depth=bits, black_level=0, full_well=20000)
        ramp = flat(lux_s_for(sensor, 20000), (64, 8192))
        ramp.xyz *= np.linspace(0, 1, 8192, dtype=np.float32)[None, :, None]
        raw = ramp.expose(sensor, sensor.base_iso)
        assert raw.white_level == 2**bits - 1
        counts = np.bincount(raw.mosaic.ravel(), minlength=2**bits)
        assert counts.size == 2**bits
        assert (counts > 0).all()


def test_saturation_is_told_beside_the_picture() -> None:
    sensor = load("ideal")
    frame = flat(78 / 100, (32, 64))
    frame.xyz[:, :32] *= 0.5
    truth = frame.exposure_truth(sensor, 100)
    assert truth["exposure.Y"][0, 0] == pytest.approx(0.39)
    assert truth["exposure.Y"][0, 63] == pytest.approx(0.78)
    assert not truth["saturated.R"].any()
    frame.metadata["luminance_exposure"] *= 1.01
    truth = frame.exposure_truth(sensor, 100)
    assert truth["saturated.G"][:, 32:].all()
    assert not truth["saturated.G"][:, :32].any()
    assert not truth["saturated.B"].any()
    raw = frame.expose(sensor, 100)
    np.testing.assert_allclose(raw.exposure(), truth["exposure.Y"])


@pytest.mark.parametrize("pattern", [name for name in dg.sensors.PATTERNS if name != "mono"])
@pytest.mark.parametrize("crosstalk", [0.0, 0.2])
def test_each_photosite_of_a_pattern_sees_its_channel(pattern: str, crosstalk: float) -> None:
    """And with crosstalk as much of the others as the sensor's own matrices say."""
    sensor = load("sony-a7r-ii").with_(pattern=pattern, crosstalk=crosstalk)
    frame = flat(0.3, (180, 180))
    frame.channels = np.broadcast_to(np.array([1, 0.5, 0.25], np.float32), (180, 180, 3))
    frame.metadata["sensor_hash"] = sensor.hash
    raw = frame.expose(sensor, 100)
    light = np.array([1, 0.5, 0.25]) * sensor.electrons_per_lux_s() * 0.3
    inner, channel = raw.electrons()[6:-6, 6:-6], raw.channel_map()[6:-6, 6:-6]
    means = [inner[channel == i].mean() for i in range(3)]
    assert means == pytest.approx(sensor.mixing @ light, rel=5e-3)


def test_truth_travels_in_openexr(tmp_path) -> None:
    frame = flat(0.5, (16, 16))
    frame.aovs |= frame.exposure_truth("ideal", 200)
    frame.save(tmp_path / "truth.exr")
    back = dg.load_frame(tmp_path / "truth.exr")
    assert back.aovs["exposure.Y"][8, 8] == pytest.approx(0.5)
    assert back.aovs["saturated.G"].all()
    assert not back.aovs["saturated.B"].any()


def test_where_numbers_come_from_is_told() -> None:
    sensor = load("ideal")
    frame = flat(0.1)
    assert frame.expose(sensor).metadata["sensor_from"] == "xyz"
    frame.channels = np.ones((64, 64, 3), np.float32)
    frame.metadata |= {"sensor": "ideal", "sensor_hash": sensor.hash}
    raw = frame.expose(iso=100)
    assert raw.metadata["sensor_from"] == "channels"
    means = [raw.electrons()[raw.channel_map() == i].mean() for i in range(3)]
    assert means == pytest.approx(0.1 * sensor.electrons_per_lux_s(), rel=2e-3)
    frame.metadata["sensor_hash"] = "another"
    assert frame.expose(sensor).metadata["sensor_from"] == "xyz"


def test_light_below_zero_is_counted() -> None:
    frame = flat(0.1)
    frame.xyz[:8] = (-0.1, -0.1, -0.1)
    raw = frame.expose("ideal")
    assert raw.metadata["negative_photosites"] == 8 * 64
    assert any("clipped to 0 at 12.50%" in note for note in raw.notes)


def test_the_renders_own_noise_is_told() -> None:
    frame = flat(0.01)
    frame.variance = np.zeros((64, 64, 3), np.float32)
    assert not any("own noise" in note for note in frame.expose("ideal").notes)
    # 0.01 lux s makes 1467 e- in the strongest channel: shot noise is 2.6 % of it.
    frame.variance[:16] = 0.03**2
    frame.variance[16:] = 0.02**2
    notes = frame.expose("ideal").notes
    assert any("larger than photon noise in 25% of the pixels" in note for note in notes)


def test_another_pitch_is_told() -> None:
    assert not flat(0.1, sensorPhotositePitch=6.03).expose("ideal").notes
    notes = flat(0.1, sensorPhotositePitch=(37.5, 37.5)).expose("ideal").notes
    assert "37.5 um wide on the film" in notes[0]


@pytest.mark.parametrize("field", ["luminance_exposure", "expTime", "h0"])
@pytest.mark.parametrize("value", [-1.0, float("nan"), "much"])
def test_bad_exposure_is_named(field: str, value: object) -> None:
    frame = flat(0.1)
    if field == "h0":
        del frame.metadata["luminance_exposure"]
    frame.metadata[field] = value
    with pytest.raises(dg.InputError, match=f"frame: {field}: wanted"):
        frame.expose("ideal")


def test_a_frame_without_exposure_is_refused() -> None:
    frame = Frame(rgb=np.ones((4, 4, 3), np.float32))
    with pytest.raises(dg.InputError, match="frame: expTime: wanted"):
        frame.expose("ideal")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"sensor": "ideel"}, "sensor 'ideel': no sensor of the library"),
        ({"iso": 2e6}, r"sensor ideal: iso: wanted 1 \.\. 1e\+06, got 2000000"),
        ({"iso": float("nan")}, "iso: wanted"),
        ({"ev": float("inf")}, "ev: wanted"),
        ({"seed": -1}, "seed: wanted"),
        ({"seed": 1.5}, "seed: wanted a whole number"),
        ({"white_balance": 100}, r"white_balance: wanted 1000 \.\. 25000 K"),
        ({"white_balance": (0.9, 0.9)}, "white_balance: wanted a chromaticity"),
        ({"temperature": -400}, "temperature: wanted"),
    ],
)
def test_bad_settings_are_named(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(dg.DaguerreError, match=message):
        flat(0.1).expose(**{"sensor": "ideal"} | arguments)


def test_light_that_is_not_finite_is_placed() -> None:
    frame = flat(0.1)
    frame.xyz[3, 5] = np.nan
    with pytest.raises(dg.InputError, match=r"frame: xyz: wanted finite .* first at \(5, 3\)"):
        frame.expose("ideal")


@pytest.mark.parametrize("lens", ["thin", "double-gauss-50mm-f2"])
def test_a_rendered_white_world_gives_the_number_of_iso_12232(lens: str) -> None:
    """A world of L cd/m2 at f/N, t, ISO: H = (pi / 4) L t T / N^2 on the axis; the number follows.

    The real lens's own H0 has its losses and its true aperture, so it is near, not equal.
    """
    luminance, stop, seconds, iso = 400.0, 4.0, 1 / 60, 200
    scene = dg.Scene()
    scene.set_environment(np.full((4, 8, 3), luminance, np.float32))
    camera = dg.Camera(lens=lens, f_stop=stop, shutter_time=seconds, iso=iso, exposure="manual")
    camera = camera.with_(sensor_size=(0.6, 0.4), focus_distance=1e6)
    frame = dg.render(scene, camera, resolution=(30, 20), spp=256)
    exposure = math.pi / 4 * luminance * seconds / stop**2
    if lens != "thin":
        exposure = luminance * frame.metadata["h0"] * seconds
        assert exposure == pytest.approx(math.pi / 4 * luminance * seconds / stop**2, rel=0.1)
    raw = frame.expose("ideal")
    assert raw.iso == iso
    green = raw.mosaic[raw.channel_map() == 1].mean()
    assert green / 65535 == pytest.approx(exposure * iso / 78, rel=0.005)


def colours() -> dg.Scene:
    """A sky of four blocks: white, and reddish, greenish and bluish."""
    sky = np.array([[1, 1, 1], [1, 0.3, 0.2], [0.2, 1, 0.3], [0.2, 0.3, 1]], np.float32)
    scene = dg.Scene()
    scene.set_environment(np.repeat(np.tile(sky, (4, 1))[None], 8, axis=0))
    return scene


def test_channels_bands_and_xyz_of_a_render_agree() -> None:
    """The film's own channels are the truth; bands come near, and the fit of XYZ less so."""
    camera = dg.Camera(sensor="sony-a7r-ii", lens="pinhole", focal_length=24, shutter_time=0.1)
    frame = dg.render(colours(), camera, resolution=(60, 40), spp=64, bands=24)
    frame.metadata["luminance_exposure"] = 0.3
    told = frame.expose()
    assert told.sensor.name == "sony-a7r-ii"
    assert told.metadata["sensor_from"] == "channels"
    frame.metadata["sensor_hash"] = ""
    by_bands = frame.expose()
    assert by_bands.metadata["sensor_from"] == "bands"
    assert any("made from its bands" in note for note in by_bands.notes)
    frame.bands = None
    by_xyz = frame.expose()
    assert by_xyz.metadata["sensor_from"] == "xyz"
    wanted = told.electrons()
    for raw, error in ((by_bands, 0.004), (by_xyz, 0.01)):
        for i in range(3):
            of_channel = raw.channel_map() == i
            total = raw.electrons()[of_channel].sum() / wanted[of_channel].sum()
            assert total == pytest.approx(1, abs=error)


def test_a_frame_whose_sensor_is_gone_asks_for_its_file() -> None:
    frame = flat(0.1, sensor="mine")
    with pytest.raises(dg.InputError, match=r"frame: sensor 'mine': .* give its file as sensor"):
        frame.expose()
