"""Brackets of known light: merged light, the camera's curve, and photographs that do not fit."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import InputError, UsageError
from daguerre.plates.probe import response
from tests.support.pictures.light_probes import exposure, grid, save, world

SECONDS = (1 / 500, 1 / 125, 1 / 30, 1 / 8)


def camera(light):
    """Curve of a camera that is not sRGB: a shoulder and a toe."""
    y = np.maximum(light, 0) ** (1.6 / 1.9)
    return np.clip(1.28 * y / (0.5 + y), 0, 1)


def light_of(codes):
    x = np.linspace(0, 12, 1 << 18)
    return np.interp(codes, camera(x), x)


def radiance(width=256):
    """A panorama over 12 EV without a pattern; the brightest is clipped in no shortest shot."""
    rng = np.random.default_rng(3)
    smooth = np.kron(rng.uniform(-6, 4, (width // 16, width // 8)), np.ones((8, 8)))
    return (2.0**smooth)[..., None] * world(grid(width, width // 2)) / 2


def shots(folder, light, *, bits=8, curve=camera, seconds=SECONDS, suffix=".png", top=500):
    rng, paths = np.random.default_rng(4), []
    for i, time in enumerate(seconds):
        exposed = light * time * top / 40
        noisy = exposed + rng.normal(size=light.shape) * np.sqrt(1e-4 * exposed + 4e-8)
        high = 2**bits - 1
        codes = np.rint(curve(noisy) * high).astype(np.uint8 if bits == 8 else np.uint16)
        paths.append(save(folder / f"{i}{suffix}", codes, exposure(time)))
    return paths


def off(made, light):
    """Difference after a common factor: middle grey of the curve sets the unit."""
    ratio = made / light
    return np.abs(ratio / np.median(ratio) - 1)


@pytest.mark.parametrize("bits", [8, 16])
def test_light_comes_back_through_an_unknown_curve(tmp_path, bits):
    """Turns red with exposures of the wrong sign, or with sRGB in the place of the curve."""
    light = radiance()
    made = dg.light_probe(shots(tmp_path, light, bits=bits), sun="off")
    assert made.facts["response"] == "recovered"
    assert made.facts["clipped"] is None
    seen = light.max(axis=2) > 2.0**-4
    assert off(made.image, light)[seen].mean() < 0.015
    assert np.quantile(off(made.image, light)[seen], 0.95) < 0.04
    wrong = dg.light_probe(shots(tmp_path, light, bits=bits), sun="off", response="srgb")
    assert off(wrong.image, light)[seen].mean() > 0.05


def test_the_curve_is_that_of_the_camera():
    rng = np.random.default_rng(5)
    light = np.exp(rng.uniform(np.log(0.003), np.log(60), (120, 160, 3)))
    stops = (0.0, 1.7, 4.0, 6.0)
    codes = [
        np.rint(255 * camera(light * 2**s / 16 * (1 + 0.01 * rng.normal(size=light.shape))))
        for s in stops
    ]
    found = response.recover([c.astype(np.uint8) for c in codes], stops)
    truth = light_of(np.arange(256) / 255)
    assert (np.diff(found, axis=0) >= 0).all()
    for c in range(3):
        ratio = found[20:246, c] / truth[20:246]
        assert np.abs(ratio / np.median(ratio) - 1).max() < 0.02


def test_a_person_who_walks_by_does_not_bend_the_curve(tmp_path):
    light = radiance()
    paths = shots(tmp_path, light)
    moved = light.copy()
    moved[40:90, 100:120] *= 5
    shots(tmp_path, moved, seconds=SECONDS[:2])
    made = dg.light_probe(paths, sun="off")
    still = (light.max(axis=2) > 2.0**-4) & (grid(256, 128)[..., 0] > 0.1)
    assert off(made.image, light)[still].mean() < 0.02


def test_one_photograph_by_srgb_in_candela(tmp_path):
    """L = 4 / pi * 10 / 0.18 * N^2 / (t S) for a value of 1: 70.7 * 64 / (1/100 * 100) = 4527."""
    codes = np.full((64, 128, 3), 188, np.uint8)
    made = dg.light_probe(save(tmp_path / "one.jpg", codes, exposure(0.01)), sun="off")
    value = ((188 / 255 + 0.055) / 1.055) ** 2.4
    assert made.absolute
    assert made.image.mean() == pytest.approx(4527.07 * value, rel=1e-3)
    assert any("decoded as sRGB" in note for note in made.notes)
    half = dg.light_probe(tmp_path / "one.jpg", sun="off", scale=10)
    assert half.image.mean() == pytest.approx(10 * value, rel=1e-3)


def test_without_exif_the_unit_is_unknown(tmp_path):
    path = save(tmp_path / "one.png", np.full((64, 128, 3), 188, np.uint8))
    made = dg.light_probe(path, sun="off")
    assert not made.absolute
    assert made.facts["unit"] == "unknown"
    assert any("EXIF lacks exposure time, f-number, ISO" in note for note in made.notes)


def test_linear_files_with_ev(tmp_path):
    light = radiance().astype(np.float32)
    paths = [save(tmp_path / f"{ev}.exr", np.minimum(light * 2.0**ev, 8)) for ev in (-2, 2)]
    made = dg.light_probe(paths, ev=(-2, 2), sun="off")
    fine = light.max(axis=2) < 30
    assert made.image[fine] == pytest.approx(light[fine], rel=1e-4)
    with pytest.raises(InputError, match=r"linear files do not store it; give --ev, such as "):
        dg.light_probe(paths)


def test_raw_files(tmp_path):
    """Our own sensor takes an even light; the probe reads its luminance back from the DNG."""
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1), scale=100)
    lens = dg.Camera(focal_length=50, f_stop=8, focus_distance=5, shutter_time=0.1)
    scene.add_camera("c", lens.with_(exposure="manual"))
    frame = dg.render(scene, resolution=(64, 32), spp=4)
    frame.expose("ideal", 100, seed=1).save(tmp_path / "shot.dng")
    made = dg.light_probe(tmp_path / "shot.dng", sun="off")
    assert made.absolute
    assert made.image.mean(axis=(0, 1)) == pytest.approx([100, 100, 100], rel=0.03)


def test_missing_exposures(tmp_path):
    codes = np.full((64, 128, 3), 90, np.uint8)
    one = save(tmp_path / "a.jpg", codes, exposure(0.01))
    two = save(tmp_path / "b.jpg", codes)
    with pytest.raises(
        InputError, match=r"b.jpg: EXIF: wanted the exposure time, got none; give --ev"
    ):
        dg.light_probe([one, two])
    with pytest.raises(UsageError, match=r"--ev: wanted 2, one for each photograph, got 3"):
        dg.light_probe([one, two], ev=(0, 1, 2))


def test_other_sizes_and_kinds(tmp_path):
    paths = shots(tmp_path, radiance(), seconds=SECONDS[:2])
    save(paths[1], np.full((60, 128, 3), 90, np.uint8), exposure(0.1))
    with pytest.raises(InputError, match=r"1.png: size: wanted 256x128 px like .*got 128x60"):
        dg.light_probe(paths)
    light = save(tmp_path / "l.exr", np.ones((128, 256, 3), np.float32))
    with pytest.raises(InputError, match="photographs of one kind"):
        dg.light_probe([paths[0], light], ev=(0, 1))


def test_exposures_in_the_wrong_order(tmp_path):
    paths = shots(tmp_path, radiance())
    with pytest.raises(InputError, match=r"exposure: wanted a picture brighter than"):
        dg.light_probe(paths, ev=(6, 4, 2, 0))


def test_shifted_photographs(tmp_path):
    light = radiance()
    paths = shots(tmp_path, light)
    codes = np.rint(camera(np.roll(light, (3, -7), (0, 1)) * SECONDS[2] * 12.5) * 255)
    save(paths[2], codes.astype(np.uint8), exposure(SECONDS[2]))
    with pytest.raises(InputError, match=r"shifted by -7, 3 px"):
        dg.light_probe(paths)


def test_turned_photographs_stand_upright(tmp_path):
    """Orientation 3 is half a turn."""
    light = radiance()
    paths = shots(tmp_path, light)
    upright = dg.light_probe(paths, sun="off")
    for path, time in zip(paths, SECONDS, strict=True):
        codes = np.rint(camera(light * time * 12.5) * 255).astype(np.uint8)
        save(path, codes[::-1, ::-1], exposure(time), orientation=3)
    made = dg.light_probe(paths, sun="off")
    assert np.median(np.abs(made.image / upright.image - 1)) < 0.02
    assert any("EXIF orientation" in note for note in made.notes)


def test_clipped_everywhere(tmp_path):
    path = save(tmp_path / "white.jpg", np.full((64, 128, 3), 255, np.uint8), exposure(1))
    with pytest.raises(InputError, match="nearly all light is clipped"):
        dg.light_probe(path)
    path = save(tmp_path / "black.jpg", np.zeros((64, 128, 3), np.uint8), exposure(1))
    with pytest.raises(InputError, match="the picture is black"):
        dg.light_probe(path)


def test_recovery_needs_brackets(tmp_path):
    path = save(tmp_path / "one.png", np.full((64, 128, 3), 90, np.uint8), exposure(1))
    with pytest.raises(
        UsageError, match=r"--response recover needs photographs at least 0.3 EV apart"
    ):
        dg.light_probe(path, response="recover")
