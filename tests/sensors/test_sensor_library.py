"""The sensors that ship: what their sources say comes out, and the command line shows it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from daguerre.cli import main
from daguerre.color import illuminants
from daguerre.sensors import load, names
from daguerre.sensors.writer import members
from tests.support.pictures.flats import flat

NAMES = names()
BODIES = [name for name in NAMES if not name.startswith("ideal")]


@pytest.mark.parametrize("name", NAMES)
def test_each_says_where_it_comes_from(name: str) -> None:
    sensor = load(name)
    assert sensor.name == name
    assert sensor.source
    assert sensor.licence
    columns, rows = sensor.resolution
    assert sensor.size[0] == pytest.approx(columns * sensor.pixel_pitch / 1000, rel=0.01)
    assert sensor.size[1] == pytest.approx(rows * sensor.pixel_pitch / 1000, rel=0.01)


@pytest.mark.parametrize("name", NAMES)
def test_the_well_is_full_by_the_base_iso(name: str) -> None:
    """Below its saturation speed a body would clip in the well; its makers do not go there."""
    sensor = load(name)
    assert sensor.saturation_iso <= sensor.base_iso * 1.001
    assert sensor.white_level(sensor.base_iso) == sensor.highest_dn


def test_the_page_lists_every_body() -> None:
    page = (Path(__file__).parents[2] / "docs" / "sensors.md").read_text(encoding="utf-8")
    assert [name for name in NAMES if f"| `{name}` |" not in page] == []


@pytest.mark.parametrize("name", BODIES)
def test_each_says_what_was_measured_and_what_is_assumed(name: str) -> None:
    sensor = load(name)
    keys = set(members(sensor))
    for texts in (sensor.measured, sensor.fitted, sensor.assumed):
        assert {text.split(":")[0] for text in texts} <= keys
    assert sensor.measured
    assert sensor.assumed


def test_the_gain_of_the_a7r_ii_is_that_measured() -> None:
    sensor = load("sony-a7r-ii")
    for iso, gain in ((100, 0.315), (400, 1.26), (640, 0.315 * 6.4)):
        assert sensor.gain(iso) == pytest.approx(gain, rel=0.003)
    # DN, measured, at its two conversion gains.
    assert sensor.read_noise_at(100) * 0.315 == pytest.approx(1.413, rel=0.001)
    assert sensor.read_noise_at(3200) * 1.587 * 6.35 == pytest.approx(10.31, rel=0.001)
    assert sensor.read_noise_at(639) == sensor.read_noise_at(500)
    assert sensor.read_noise_at(640) < 1.3


def test_the_gain_of_the_imx477_is_that_measured() -> None:
    sensor = load("raspberry-pi-hq")
    assert sensor.gain(sensor.base_iso) == pytest.approx(0.47, rel=0.005)


def test_the_quantum_efficiency_of_the_imx571_is_that_measured() -> None:
    sensor = load("sony-imx571-mono")
    assert sensor.efficiency([500.0, 640.0])[0] == pytest.approx([0.7782, 0.5206])


@pytest.mark.parametrize("name", [name for name in NAMES if "mono" not in name])
def test_colours_come_back_within_their_error(name: str) -> None:
    """Flat spectra exactly, saturated ones of RGB textures within the fit."""
    sensor = load(name)
    reflected = illuminants.rgb_reflectances() @ np.array([[1, 1, 1], [0.8, 0.2, 0.2]]).T
    seen = reflected.T * illuminants.d65()
    channels = seen @ (sensor.sensitivity(illuminants.NM) * illuminants.STEP).T
    rgb = channels @ sensor.rgb_from_channels().T
    assert rgb[0] == pytest.approx([1, 1, 1], abs=1e-4)
    assert rgb[1] == pytest.approx([0.8, 0.2, 0.2], abs=0.06)


@pytest.mark.parametrize("name", [name for name in NAMES if "mono" not in name])
def test_a_colour_chart_comes_back(name: str) -> None:
    """The 24 colours of ISO 17321-1, by their spectra, as in docs/sensors.md."""
    colour = pytest.importorskip("colour")
    sensor = load(name)
    chart = colour.SDS_COLOURCHECKERS["ISO 17321-1"].values()
    reflected = np.array([np.interp(illuminants.NM, s.wavelengths, s.values) for s in chart])
    seen = reflected * illuminants.d65()
    channels = seen @ (sensor.sensitivity(illuminants.NM) * illuminants.STEP).T
    inverse = np.linalg.pinv(sensor.channels_from_xyz())

    def lab(xyz):
        return colour.XYZ_to_Lab(xyz, illuminants.D65_XY)

    errors = colour.delta_E(
        lab(channels @ inverse.T), lab(seen @ illuminants.observer()), method="CIE 2000"
    )
    assert errors.mean() < 2.1


@pytest.mark.parametrize("name", [name for name in BODIES if "mono" not in name])
@pytest.mark.parametrize(("kelvin", "error"), [(2856, 1e-3), (3500, 0.03)])
def test_neutrals_of_lamps_are_those_of_their_spectra(
    name: str, kelvin: float, error: float
) -> None:
    """At illuminant A the matrix is exact for white, between A and D65 it is near."""
    sensor = load(name)
    seen = sensor.white_electrons(illuminants.planck(kelvin))
    assert sensor.neutral(kelvin) == pytest.approx(seen / seen.max(), abs=error)


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("stops", [0, 4])
def test_every_body_exposes_grey(name: str, stops: int) -> None:
    sensor = load(name)
    iso = sensor.base_iso * 2**stops
    raw = flat(10 / iso, (96, 96)).expose(sensor, iso)
    channel = raw.channel_map() == int(np.argmax(sensor.white_electrons()))
    part = (raw.mosaic[channel].mean() - raw.black_level) / (raw.white_level - raw.black_level)
    assert part == pytest.approx(10 / 78, rel=0.02)


def test_the_library_on_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sensors"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == NAMES
    assert main(["sensors", "--json"]) == 0
    assert [item["name"] for item in json.loads(capsys.readouterr().out)] == NAMES


def test_one_sensor_on_the_command_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sensor", "sony-a7r-ii"]) == 0
    shown = capsys.readouterr().out
    for text in ("4.51 um", "50384 e-", "ISO 12232", "fitted prnu; assumed", "102400"):
        assert text in shown
    assert main(["sensor", "sony-a7r-ii", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    by_iso = {row["iso"]: row for row in facts["by_iso"]}
    assert by_iso[100]["gain_dn_per_e"] == pytest.approx(0.315, rel=0.003)
    assert by_iso[100]["dynamic_range_stops"] == pytest.approx(13.4, abs=0.1)
    # Middle grey at ISO 100 is 6460 e-: shot noise alone would be 38.1 dB.
    assert by_iso[100]["grey_snr_db"] == pytest.approx(38.0, abs=0.1)


@pytest.mark.parametrize("suffix", ["svg", "png", "pdf"])
def test_the_page_of_a_sensor(
    tmp_path: Path, suffix: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"sensor.{suffix}"
    assert main(["sensor", "sony-imx571-mono", "--plot", str(path)]) == 0
    assert f"wrote {path}" in capsys.readouterr().err
    heads = {"svg": b"<?xml", "png": b"\x89PNG", "pdf": b"%PDF"}
    first = path.read_bytes()
    assert first.startswith(heads[suffix])
    assert main(["sensor", "sony-imx571-mono", "--plot", str(path)]) == 0
    assert path.read_bytes() == first


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["sensor", "sony-a7"], 3, "did you mean 'sony-a9', 'sony-a7r-iv' or 'sony-a7r-ii'"),
        (["sensor", "ideal", "--plot", "x.jpg"], 2, "--plot: wanted a name ending in .svg"),
        (["sensor", "no.json"], 3, "no.json: no such file"),
    ],
)
def test_what_the_command_line_refuses(
    arguments: list[str], code: int, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == code
    error = capsys.readouterr().err
    assert message in error
    assert len(error.strip().splitlines()) == 1
