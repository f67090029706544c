"""Channels of a sensor on the film, bands of wavelengths, and what the one makes of the other."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import _core, sensors
from daguerre.errors import InputError, UsageError
from daguerre.rendering import diffraction as waves
from daguerre.rendering import rounds
from daguerre.rendering.diffraction import Diffraction
from daguerre.rendering.merging import merge
from daguerre.rendering.session import Session
from daguerre.sensors import Sensor, bands
from daguerre.sensors.bands import weights_of_bands
from tests.rendering import test_flare
from tests.support.formats.pass_files import through_files
from tests.support.scene import scenes

SIZE = (36, 24)


def gaussians(*peaks: tuple[float, float], **changes: Any) -> Sensor:
    """A sensor whose channels are bells about wavelengths (nm) of widths (sigma, nm)."""
    nm = np.arange(350.0, 851.0)
    rows = np.stack([0.5 * np.exp(-0.5 * ((nm - at) / width) ** 2) for at, width in peaks])
    names = ("R", "G", "B") if len(peaks) == 3 else ("Y",)
    return sensors.ideal("ideal" if len(peaks) == 3 else "ideal-mono").with_(
        name="bells", channels=names, wavelengths=nm, quantum_efficiency=rows, **changes
    )


def observer() -> Sensor:
    """A sensor that sees as the CIE's observer does, to the last bit of the tables."""
    nm = np.arange(380.0, 781.0)
    curves = np.asarray(_core.colour_tables(nm.tolist()))[:, :3].T
    return sensors.ideal().with_(
        name="observer", wavelengths=nm, quantum_efficiency=curves / nm * 200
    )


BODY = gaussians((600, 35), (535, 40), (460, 25))
OBSERVER = observer()


def camera(sensor: Sensor | str | None = BODY, **more: Any) -> dg.Camera:
    return dg.Camera(sensor=sensor, **({"f_stop": 2.8, "focus_distance": 5.0} | more))


def drawn(eye: dg.Camera, spp: int = 4, scene: dg.Scene | None = None, **more: Any) -> Session:
    one = Session(scene or scenes.lamp_room(), eye, resolution=SIZE, **more)
    one.draw(0, spp)
    return one


def seen(sensor: Sensor, emission: tuple[float, float, float]) -> np.ndarray:
    """By the definition: integral L QE lambda over that of D65 of luminance 1."""
    nm = np.linspace(380, 780, 8001)
    table = np.asarray(_core.colour_tables(nm.tolist()))
    d65 = table[:, 3]
    radiance = d65 * (table[:, 4:] @ np.asarray(emission))
    rows = sensor.efficiency(nm) * nm
    return np.asarray((rows @ radiance) / (rows @ d65))


def test_channels_of_the_eye_are_xyz() -> None:
    frame = drawn(camera(OBSERVER), light_paths=(2.0, 1.0)).frame()
    white = np.linalg.inv(np.array([_core.rgb_from_xyz(u) for u in np.eye(3).tolist()]).T).sum(1)
    np.testing.assert_allclose(frame.channels, frame.xyz / white, rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("lens", ["thin", "pinhole"])
def test_a_white_world_is_one_in_each_channel(lens: str) -> None:
    eye = camera(lens=lens) if lens == "thin" else dg.Camera(sensor=BODY, lens=lens)
    frame = drawn(eye, 256, scenes.furnace(), filter="box").frame()
    np.testing.assert_allclose(frame.channels.mean(axis=(0, 1)), 1, atol=2e-3)


def test_glass_that_disperses_is_as_bright_to_a_sensor_as_to_the_eye() -> None:
    glass = dg.Gltf(metallic=0, roughness=0, transmission=1, ior=1.5, thickness=1, dispersion=5)
    through, bare = (
        drawn(camera(lens="pinhole", f_stop=None), 2048, scenes.furnace(material), bands=5).frame()
        for material in (dg.Material(glass), None)
    )
    middle = slice(10, 14), slice(15, 21)  # where the ball is
    for name in ("channels", "bands", "rgb"):
        lit, world = (getattr(frame, name)[middle].mean(axis=(0, 1)) for frame in (through, bare))
        np.testing.assert_allclose(lit, world, rtol=0.03, err_msg=name)


@pytest.mark.parametrize("emission", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0.2, 3.0, 0.7)])
@pytest.mark.parametrize("sensor", [BODY, gaussians((580, 4))], ids=["body", "narrow"])
def test_light_is_weighed_by_quantum_efficiency(sensor: Sensor, emission: Any) -> None:
    scene = dg.Scene()
    scene.set_environment(color=emission)
    frame = drawn(camera(sensor), 512, scene, filter="box").frame()
    found = frame.channels.mean(axis=(0, 1))
    expected = seen(sensor, emission)
    np.testing.assert_allclose(found, expected, rtol=0.006, atol=1e-3 * max(expected))


def test_a_frame_says_what_its_channels_are() -> None:
    one = drawn(camera(), 1)
    facts = one.metadata
    assert facts["sensor_channels"] == ["R", "G", "B"]
    assert (facts["sensor"], facts["sensor_hash"]) == ("bells", BODY.hash)
    assert facts["sensor_from"] == "channels"
    assert one.frame().channels.shape == (SIZE[1], SIZE[0], 3)
    mono = drawn(camera(gaussians((550, 60))), 1).frame()
    assert mono.channels.shape == (SIZE[1], SIZE[0], 1)


def test_a_sensor_brings_its_size_unless_another_is_given() -> None:
    small = BODY.with_(pixel_pitch=2.0, resolution=(3000, 2000))
    assert camera(small).sensor_size == (6.0, 4.0)
    assert dg.Camera().with_(sensor=small).sensor_size == (6.0, 4.0)
    assert camera(small, sensor_size=(3.0, 2.0)).sensor_size == (3.0, 2.0)
    assert camera(small).with_(sensor=BODY).sensor_size == BODY.size
    assert camera(small).with_(f_stop=4.0).sensor_size == (6.0, 4.0)


def test_a_sensor_changes_no_picture() -> None:
    """To the bit; XYZ, variance and counts are those of a film without channels."""
    with_it = drawn(camera(BODY), light_paths=(2.0, 1.0), bands=5).frame()
    without = drawn(camera(None), light_paths=(2.0, 1.0)).frame()
    for name in ("rgb", "xyz", "variance", "samples"):
        assert np.array_equal(getattr(with_it, name), getattr(without, name)), name
    assert without.channels is None
    assert without.bands is None


WAYS: dict[str, Any] = {
    "plain": ({}, {"light_paths": "off"}),
    "light paths": ({}, {"light_paths": (3.0, 2.0)}),
    "dispersion": (
        {"lens": "double-gauss-50mm-f2", "focus_distance": 5.0},
        {"light_paths": (3.0, 0.0)},
    ),
    "bands": ({}, {"light_paths": (3.0, 0.0), "bands": 4}),
}


@pytest.mark.parametrize("way", WAYS)
def test_passes_add_up_to_the_bits_of_one(tmp_path: Path, way: str) -> None:
    eye, options = WAYS[way]
    whole = drawn(camera(**eye), 6, threads=2, **options)
    parts = []
    for begin, end in ((4, 6), (0, 4)):
        part = Session(scenes.lamp_room(), camera(**eye), resolution=SIZE, threads=1, **options)
        part.draw(begin, end)
        parts.append(part)
    frame, total = merge(through_files(tmp_path, *parts))
    for name, words in whole.state().items():
        assert np.array_equal(words, total.state[name]), name
    assert np.array_equal(frame.channels, whole.frame().channels)
    assert frame.metadata["sensor_channels"] == ["R", "G", "B"]
    if "bands" in options:
        assert np.array_equal(frame.bands, whole.frame().bands)


@pytest.mark.parametrize(
    "changes",
    [
        {"eye": camera(gaussians((600, 35), (535, 40), (460, 26)))},
        {"bands": 4},
        {"eye": dg.Camera(f_stop=2.8, focus_distance=5.0, sensor_size=BODY.size)},
    ],
    ids=["curves", "bands", "none"],
)
def test_other_channels_do_not_add(tmp_path: Path, changes: dict[str, Any]) -> None:
    other = Session(
        scenes.lamp_room(), changes.pop("eye", camera()), resolution=SIZE, seed=0, **changes
    )
    other.draw(1, 2)
    with pytest.raises(dg.MismatchError, match="diffraction, sensor, bands"):
        merge(through_files(tmp_path, drawn(camera(), 1), other))


def test_a_crop_has_the_bits_of_the_frame() -> None:
    whole = drawn(camera(), light_paths="off").frame()
    part = drawn(camera(), light_paths="off", crop=(5, 3, 20, 17)).frame()
    assert np.array_equal(part.channels, whole.channels[3:17, 5:20])


def test_a_checkpoint_goes_on() -> None:
    whole, half = drawn(camera(), 8, bands=3), drawn(camera(), 4, bands=3)
    again = Session(scenes.lamp_room(), camera(), resolution=SIZE, bands=3)
    again.set_state({part: words.copy() for part, words in half.state().items()}, half.ranges)
    again.draw(4, 8)
    assert np.array_equal(again.frame().channels, whole.frame().channels)


def test_adaptive_rounds_bring_channels() -> None:
    eye = camera(OBSERVER)
    one = Session(scenes.lamp_room(), eye, resolution=SIZE, light_paths="off")
    for _ in rounds.rounds(one, 0.1, 64):
        pass
    frame = one.frame()
    assert len(np.unique(frame.samples)) > 1
    np.testing.assert_allclose(frame.channels[..., 1], frame.xyz[..., 1], rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("of", ["flare", "scatter"])
def test_ghosts_and_scatter_land_in_channels(of: str) -> None:
    """Nothing else shines on the film here."""
    options: dict[str, Any] = {"light_paths": "off", of: 2000.0, "max_depth": 1}
    eye = test_flare.camera(f_stop=11.0).with_(sensor=OBSERVER, sensor_size=(1.8, 1.2))
    one = Session(test_flare.sunny(), eye, resolution=SIZE, **options)
    one.draw(0, 2)
    frame = one.frame()
    assert frame.flare is not None
    assert frame.flare.sum() > 0.9 * frame.rgb.sum() > 0
    np.testing.assert_allclose(
        frame.channels[..., 1], frame.xyz[..., 1], rtol=1e-4, atol=1e-4 * frame.xyz.max()
    )


def colours() -> dg.Scene:
    """A sky of eight colours, in blocks."""
    rng = np.random.default_rng(7)
    scene = dg.Scene()
    scene.set_environment(rng.uniform(0, 1, (4, 8, 3)).astype(np.float32))
    return scene


@pytest.mark.parametrize(("bands", "error"), [(8, 0.02), (16, 0.008), (32, 0.004)])
def test_channels_of_bands_are_those_of_the_film(bands: int, error: float) -> None:
    frame = drawn(camera(focal_length=12.0), 256, colours(), bands=bands).frame()
    made = frame.bands @ weights_of_bands(BODY, frame.bands.shape[2])
    difference = (made - frame.channels).reshape(-1, 3)
    assert np.sqrt((difference**2).mean()) < error
    np.testing.assert_allclose(made.mean(axis=(0, 1)), frame.channels.mean(axis=(0, 1)), rtol=0.003)


def test_bands_know_more_than_xyz() -> None:
    """XYZ is fitted (``Sensor.channels_from_xyz``); a narrow sensor is worse off."""
    narrow = gaussians((640, 8), (520, 8), (420, 8))
    frame = drawn(camera(narrow, focal_length=12.0), 256, colours(), bands=16).frame()
    truth = frame.channels
    fitted = frame.xyz @ narrow.channels_from_xyz().T
    made = frame.bands @ weights_of_bands(narrow, frame.bands.shape[2])
    # Means of the picture's blocks: what their own noise leaves.
    errors = [
        np.abs((x - truth).reshape(4, 6, 6, 6, 3).mean(axis=(1, 3))).mean() for x in (fitted, made)
    ]
    assert errors[1] < 0.5 * errors[0]


def test_diffraction_spreads_channels_as_it_spreads_light(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(waves, "LEAST_WAVELENGTHS", 8)
    scene = dg.Scene()
    place = np.eye(4)
    place[2, 3] = -4
    scene.add_light(dg.SphereLight((900.0, 900.0, 900.0), 0.01), place)
    eye = camera(OBSERVER, f_stop=16.0, focus_distance=4.0, sensor_size=(0.96, 0.64))
    one = Session(scene, eye, resolution=(48, 32), diffraction=Diffraction(8), light_paths="off")
    one.draw(0, 64)
    sharp, wave = one.frame(waves=False), one.frame()
    assert np.abs(wave.channels - sharp.channels).max() > 0.03 * sharp.channels.max()
    total = [f.channels.sum(axis=(0, 1)) for f in (sharp, wave)]
    np.testing.assert_allclose(total[1], total[0], rtol=0.02)
    np.testing.assert_allclose(wave.channels[..., 1], wave.xyz[..., 1], atol=2e-3 * wave.xyz.max())
    kept = Session(scene, eye, resolution=(48, 32), diffraction=True, bands=8, light_paths="off")
    assert kept.settings.diffraction.bands == 8
    kept.draw(0, 64)
    frame = kept.frame()
    made = frame.bands @ weights_of_bands(OBSERVER, frame.bands.shape[2])
    np.testing.assert_allclose(made.sum((0, 1)), frame.channels.sum((0, 1)), rtol=0.02)


def test_what_no_film_holds() -> None:
    with pytest.raises(UsageError, match=r"bands: wanted 3 \.\. 64, got 2"):
        drawn(camera(), 1, bands=2)
    with pytest.raises(UsageError, match="bands: wanted a whole number"):
        drawn(camera(), 1, bands=4.5)
    with pytest.raises(InputError, match="sensor 'nikkon'"):
        camera("nikkon")
    ends = np.array([380.0, 780.0])
    blind = BODY.with_(infrared_cut=sensors.Curve(ends, np.zeros(2)))
    with pytest.raises(InputError, match="channel 0: no sensitivity between"):
        bands.responses(blind)


def test_merged_passes_with_damaged_channels_are_refused(tmp_path: Path) -> None:
    (one,) = through_files(tmp_path, drawn(camera(), 1))
    one.metadata["sensor_channels"] = ["R"]
    with pytest.raises(InputError, match="sensor_channels: wanted 3 names"):
        merge([one])
