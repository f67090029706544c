"""Film: speed, tone, granularity and halation are what the stock says; prints and scans."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
import pytest
from scipy.integrate import trapezoid

from daguerre import stocks
from daguerre.cli import main
from daguerre.color import illuminants
from daguerre.convolution.convolve import convolve
from daguerre.development import develop
from daguerre.errors import InputError, UsageError
from daguerre.frame.frame import Frame
from daguerre.stocks import Stock
from daguerre.stocks.curve import GREY
from daguerre.stocks.library import FOLDER
from daguerre.stocks.spread import halo, kernels, reflectance

NAMES = stocks.names()


def plain(stock: Stock) -> Stock:
    return stock.with_(granularity=0.0, halation=None, spread=0.0)


def even(stock: Stock, greys: Any, pitch: float = 6.0, shape: tuple[int, int] = (1, 1)) -> Frame:
    """Patches of so many times middle grey at the stock's ISO, in the light of its balance."""
    light = illuminants.d65()
    if stock.balance != illuminants.D65_KELVIN:
        light = illuminants.planck(stock.balance)
    xyz = illuminants.observer().T @ light
    values = np.atleast_1d(np.asarray(greys, np.float64)) * 10 / stock.iso
    patches = np.repeat(np.tile(values, (shape[0], 1)), shape[1], axis=1)
    picture = (patches[..., None] * xyz).astype(np.float32)
    facts = {"luminance_exposure": 1.0, "sensorPhotositePitch": (pitch, pitch)}
    return Frame(rgb=picture, xyz=picture, metadata=facts)


@pytest.mark.parametrize("name", NAMES)
def test_speed_is_that_of_the_standards(name: str) -> None:
    """ISO 6, ISO 5800 and ISO 2240: at which exposure density is so much above the least."""
    stock = stocks.load(name)
    for layer in stock.layers:
        curve = layer.curve
        if stock.kind == "reversal":
            points = curve.exposure([curve.least + 0.2, curve.least + 2.0])
            assert points.mean() == pytest.approx(1.0, abs=0.005)
        else:
            above, at = (0.1, 0.8) if len(stock.layers) == 1 else (0.15, math.sqrt(2))
            assert curve.density(math.log10(at)) - curve.least == pytest.approx(above, abs=0.002)


@pytest.mark.parametrize("name", NAMES)
def test_density_goes_one_way_and_comes_back(name: str) -> None:
    for layer in stocks.load(name).layers:
        x = np.linspace(layer.curve.toe, layer.curve.shoulder, 50)
        density = layer.curve.density(x)
        assert (np.diff(density) * layer.curve.gamma > 0).all()
        np.testing.assert_allclose(layer.curve.exposure(density), x, atol=2e-3)


@pytest.mark.parametrize("name", NAMES)
def test_grey_in_the_light_of_the_film_is_neutral(name: str) -> None:
    stock = plain(stocks.load(name))
    negative = stock.expose(even(stock, [0.1, 0.5, 1.0, 3.0]))
    for picture in (negative.positive(), negative.scan().rgb):
        tint = np.ptp(picture, axis=2) / picture.mean(axis=2)
        # XYZ of a lamp that is no daylight reach the layers by a fit.
        assert tint.max() < (0.01 if stock.balance > 6000 else 0.35)
    grey = negative.positive()[0, 2].mean()
    if stock.kind == "negative" and stock.balance > 6000:
        assert grey == pytest.approx(0.18, rel=0.01)


@pytest.mark.parametrize("name", [n for n in NAMES if "tungsten" not in n])
def test_a_scan_is_the_light_that_was(name: str) -> None:
    stock = plain(stocks.load(name))
    frame = even(stock, [0.1, 0.3, 1.0, 3.0])
    scanned = stock.expose(frame).scan()
    assert scanned.metadata["isoSpeed"] == stock.iso
    wanted = np.array([0.1, 0.3, 1.0, 3.0]) * 10 / stock.iso
    np.testing.assert_allclose(scanned.rgb[0, :, 1], wanted, rtol=0.02)


def test_a_scan_of_more_light_is_developed_so_much_brighter_once() -> None:
    """Compensation is in the densities: development must not add it again."""
    stock = plain(stocks.load("generic-panchromatic-400"))
    frame = even(stock, [0.5])
    light = [develop(stock.expose(frame, ev=ev).scan()).linear()[0, 0, 1] for ev in (0, 1)]
    assert light[1] / light[0] == pytest.approx(2, rel=0.02)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("ev", [0.0, 1.0])
def test_film_in_light_gets_its_own_speed(name: str, ev: float) -> None:
    """A value of 1 is white, 10 / 0.18 / ISO lux s, whatever time, stop and ISO the camera has."""
    stock = plain(stocks.load(name))
    frame = even(stock, [0.2, 1.0])
    frame.metadata |= {"luminance_exposure": 10 / 0.18 / stock.iso, "exposure": "manual"}
    manual = stock.expose(frame, ev=ev)
    frame.metadata |= {"luminance_exposure": 1e-7, "isoSpeed": 12.0, "exposure": "light"}
    frame.metadata["exposure_compensation"] = ev or None
    light = stock.expose(frame)  # the camera's compensation
    np.testing.assert_allclose(light.density, manual.density, rtol=1e-5)
    for one in (light, manual):
        shown = develop(one.shown()).linear()
        np.testing.assert_allclose(shown, np.clip(one.positive(), 0, 1), atol=2e-3)
    scanned = [develop(one.scan()).linear()[0] for one in (light, manual)]
    np.testing.assert_allclose(*scanned, rtol=1e-3)
    assert stock.expose(frame, ev=0).metadata["exposure_compensation"] is None


@pytest.mark.parametrize("pitch", [4.0, 12.0])
def test_granularity_is_measured_as_it_is_stated(pitch: float) -> None:
    """Through a hole of 48 um, at 1 above base; and by Selwyn's law through others."""
    stock = plain(stocks.load("generic-panchromatic-400")).with_(granularity=16.0)
    curve = stock.layers[0].curve
    grey = 10 ** (float(curve.exposure(curve.least + 1.0)) - GREY)
    frame = even(stock, np.full(512, grey), pitch, (512, 1))
    density = stock.expose(frame, seed=4).density[:, :, 0]
    assert density.mean() - curve.least == pytest.approx(1.0, abs=0.01)
    for hole in (48.0, 96.0):
        at = np.arange(-int(hole / pitch), int(hole / pitch) + 1) * pitch
        disc = (np.hypot(at[:, None], at) < hole / 2).astype(np.float32)
        area = disc.sum() * pitch**2
        through = convolve(density - density.mean(), disc / disc.sum())[40:-40, 40:-40]
        wanted = 0.016 * math.sqrt(math.pi * 24**2 / area)
        assert through.std() == pytest.approx(wanted, rel=0.08)


def test_grain_depends_on_seed_and_place_alone() -> None:
    stock = stocks.load("generic-colour-negative-400").with_(halation=None)
    frame = even(stock, np.full(64, 1.0), 6.0, (300, 1))
    first, again = stock.expose(frame, seed=1), stock.expose(frame, seed=1)
    np.testing.assert_array_equal(first.density, again.density)
    assert (stock.expose(frame, seed=2).density != first.density).any()
    layers = first.density.reshape(-1, 3) - first.density.reshape(-1, 3).mean(axis=0)
    correlation = np.corrcoef(layers.T)
    assert np.abs(correlation - np.eye(3)).max() < 0.05


def test_the_halo_is_a_ring_where_total_reflection_begins() -> None:
    halation = stocks.Halation(base=0.125, share=(0.1,), index=1.5)
    pitch = 5.0
    kernel, share = halo(halation, pitch)
    assert kernel.sum() == pytest.approx(1, abs=1e-5)
    theta = np.linspace(0, np.pi / 2, 20001)
    back = reflectance(np.cos(theta), 1.5) * 2 * np.sin(theta) * np.cos(theta)
    assert share == pytest.approx(trapezoid(back, theta), rel=1e-3)
    # Lambertian light from within glass of 1.5 leaves to 4 / 9 less Fresnel: some 60 % comes back.
    assert 0.55 < share < 0.62
    middle = len(kernel) // 2
    profile = kernel[middle, middle:]
    ring = 2 * 125 / math.sqrt(1.5**2 - 1) / pitch
    assert int(np.argmax(profile)) == pytest.approx(ring, abs=1.5)
    assert profile[int(0.6 * ring)] < 0.25 * profile.max()


def test_a_lamp_has_a_red_halo_on_film_without_backing() -> None:
    stock = stocks.load("generic-tungsten-800-no-backing").with_(granularity=0.0)
    frame = even(stock, np.full(161, 0.02), 5.0, (161, 1))
    assert frame.xyz is not None
    frame.xyz[80, 80] *= 3e6
    picture = stock.expose(frame).positive()
    ring = picture[80, 80 + 45]
    far = picture[2, 2]
    assert ring[0] > 3 * far[0]
    assert ring[0] / far[0] > 1.5 * ring[2] / far[2]
    kernel = kernels(stock, 5.0)
    assert kernel is not None
    sums = kernel.sum(axis=(0, 1), dtype=np.float64)
    assert stock.halation is not None
    np.testing.assert_allclose(sums - 1, 0.593 * np.array(stock.halation.share), rtol=0.02)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kind": "positive"}, "kind: wanted negative or reversal"),
        ({"name": "a" * 201}, "name: too long: wanted at most 200 characters, got 201"),
        ({"iso": -5}, "iso"),
        ({"granularity": -1}, "granularity"),
        ({"grain": 1}, "grain: unknown member"),
        ({"paper": None}, "paper"),
        ({"paper": {"least": 0.1, "gamma": -2, "toe": -1, "shoulder": 0}}, "paper: gamma"),
        ({"layers": {"R": {}}}, "sensitivity"),
        ({"schema": "daguerre-stock/9"}, "wanted 'daguerre-stock/0.1'"),
        ({"halation": {"base_mm": 0.1, "share": [0.1]}}, "share: wanted 3 numbers"),
        ({"halation": {"base_mm": -1, "share": [0, 0, 0]}}, "base"),
        ({"wavelengths_nm": [400, 390]}, "in ascending order"),
        ({"balance_k": 20}, "balance"),
        (
            {"wavelengths_nm": list(range(800, 980, 10))},
            "layers must be sensitive between 380 and 780 nm",
        ),
    ],
)
def test_bad_stock_files_name_the_field(
    tmp_path: Path, change: dict[str, Any], message: str
) -> None:
    data = json.loads((FOLDER / "generic-colour-negative-400.json").read_text())
    path = tmp_path / "bad.json"
    path.write_text(json.dumps(data | change))
    with pytest.raises(InputError, match=message) as caught:
        stocks.load(path)
    assert str(path) in str(caught.value)


def test_wrong_numbers_in_layers_are_named(tmp_path: Path) -> None:
    data = json.loads((FOLDER / "generic-reversal-100.json").read_text())
    data["layers"]["G"]["curve"]["gamma"] = 0.6
    path = tmp_path / "bad.json"
    path.write_text(json.dumps(data))
    with pytest.raises(InputError, match="layer G: gamma"):
        stocks.load(path)
    data["layers"]["G"]["curve"] |= {"gamma": -1.7, "toe": 9.0}
    path.write_text(json.dumps(data))
    with pytest.raises(InputError, match="layer G: shoulder"):
        stocks.load(path)
    data["layers"]["G"] = data["layers"]["R"]
    path.write_text(json.dumps(data))
    with pytest.raises(InputError, match="their curves linearly independent"):
        stocks.load(path)
    data["layers"]["G"] = data["layers"]["R"] | {"sensitivity": [0.1]}
    path.write_text(json.dumps(data))
    with pytest.raises(InputError, match="wanted 18 numbers"):
        stocks.load(path)


def test_unknown_stocks_and_frames_without_exposure_are_one_line() -> None:
    with pytest.raises(InputError, match="generic-reversal-100"):
        stocks.load("generic-reversal")
    stock = stocks.load("generic-reversal-100")
    bare = Frame(rgb=np.ones((4, 4, 3), np.float32))
    with pytest.raises(InputError, match="expTime"):
        stock.expose(bare)
    bare.metadata["luminance_exposure"] = 0.1
    with pytest.raises(InputError, match="sensorPhotositePitch"):
        stock.expose(bare)
    with pytest.raises(UsageError, match="seed"):
        stock.expose(even(stock, 1.0), seed=-1)
    for light in (np.nan, np.inf):
        with pytest.raises(
            InputError, match=r"got NaN or infinity in 1 pixels, the first at \(1, 0\)"
        ):
            stock.expose(even(stock, [1.0, light]))


def test_the_command_line_exposes_film(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    frame = even(stocks.load("generic-panchromatic-400"), np.full(24, 1.0), 37.0, (16, 1))
    frame.save(tmp_path / "grey.exr")
    source, out = str(tmp_path / "grey.exr"), str(tmp_path / "grey.png")
    film = ["--stock", "generic-panchromatic-400"]
    assert main(["develop", source, "-o", out, *film]) == 0
    picture = np.asarray(oiio.ImageBuf(out).get_pixels(oiio.UINT8))
    assert picture.mean() == pytest.approx(118, abs=3)  # 0.18 in sRGB
    assert 0.3 < picture.std() < 10  # grain
    assert "is ISO" not in capsys.readouterr().err
    frame.metadata["isoSpeed"] = 100.0
    frame.save(tmp_path / "set.exr")
    assert main(["develop", str(tmp_path / "set.exr"), "-o", out, *film]) == 0
    assert "the picture is 2.0 EV overexposed; --ev -2.0" in capsys.readouterr().err
    frame.metadata |= {"isoSpeed": 25.0, "exposure": "light"}
    frame.rgb[:] = 0.18
    frame.save(tmp_path / "light.exr")
    assert main(["develop", str(tmp_path / "light.exr"), "-o", out, *film]) == 0
    told = capsys.readouterr().err
    assert "exposed" not in told.replace("develop exposed the picture", "")
    picture = np.asarray(oiio.ImageBuf(out).get_pixels(oiio.UINT8))
    assert picture.mean() == pytest.approx(118, abs=3)
    for extra, message in (
        (["--exposure", "auto"], "film has its own: leave one out"),
        (["--sensor", "ideal"], "--stock"),
        (["--iso", "400"], "--stock"),
        (["-o", str(tmp_path / "x.dng")], "film has no raw data"),
    ):
        assert main(["develop", source, "-o", out, *film, *extra]) == 2
        assert message in capsys.readouterr().err
    assert main(["develop", source, "-o", out, "--stock", "generic"]) == 3
    assert main(["stocks"]) == 0
    assert "RMS granularity" in capsys.readouterr().out
