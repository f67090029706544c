"""Sensors: what their numbers compute to, and what is refused."""

from __future__ import annotations

import json

import numpy as np
import pytest

import daguerre as dg
from daguerre.color import illuminants
from daguerre.sensors import PATTERNS, Curve, Mosaic, load

PLANCK_LIGHT = 6.62607015e-34 * 299792458.0


def test_a_lux_second_of_green_light_is_as_many_photons_as_physics_says() -> None:
    """555 nm: 683 lm/W (CIE 1931 y is 1 there), so 1 lux s on 1 um2 is 1e-12 J / 683."""
    at = np.abs(illuminants.NM - 555).argmin()
    line = np.zeros_like(illuminants.NM)
    line[at] = 1
    photons = illuminants.integral(illuminants.photons_per_lux_s(line))
    energy = PLANCK_LIGHT / (illuminants.NM[at] * 1e-9)
    assert photons == pytest.approx(1e-12 / 683 / energy, rel=1e-3)


def test_the_ideal_monochrome_sensor_counts_every_photon_of_d65() -> None:
    sensor = load("ideal-mono")
    light = illuminants.photons_per_lux_s(illuminants.d65())
    wanted = illuminants.integral(light) * 36  # um2
    assert sensor.electrons_per_lux_s()[0] == pytest.approx(wanted, rel=1e-9)
    assert wanted / 36 == pytest.approx(13900, rel=0.01)  # 380 to 780 nm


def test_channels_of_the_ideal_sensor_are_a_matrix_of_xyz() -> None:
    matrix = load("ideal").channels_from_xyz()
    white = illuminants.observer().T @ illuminants.d65()
    np.testing.assert_allclose(matrix, np.diag(1 / white), atol=2e-4)


def test_iso_12232_saturation_of_the_ideal_sensor() -> None:
    """78 / S lux s of D65 reaches the highest number in the strongest channel."""
    sensor = load("ideal")
    for iso in (100, 400, 1600):
        electrons = sensor.electrons_per_lux_s().max() * 78 / iso
        assert sensor.gain(iso) * electrons == pytest.approx(65535)
    assert sensor.saturation_iso == pytest.approx(100)
    assert sensor.white_level(100) == pytest.approx(65535, abs=1)
    assert sensor.white_level(50) == pytest.approx(32768, abs=1)  # the well is full before


def test_white_of_a_colour_temperature() -> None:
    assert illuminants.white_xy(2856) == pytest.approx((0.44757, 0.40745), abs=3e-4)  # A
    assert illuminants.white_xy(5003) == pytest.approx((0.34567, 0.35850), abs=2e-4)  # D50
    assert illuminants.xy_of(illuminants.d65()) == pytest.approx(illuminants.D65_XY, abs=1e-6)


@pytest.mark.parametrize("white", [None, 2856, 4500, (0.34567, 0.3585)])
def test_a_white_surface_balances_to_grey(white: object) -> None:
    sensor = load("ideal")
    neutral = sensor.neutral(white)
    assert neutral.max() == 1
    native = sensor.white_electrons() / sensor.white_electrons().max()
    rgb = sensor.rgb_from_channels(white) @ (neutral / native)
    np.testing.assert_allclose(rgb / rgb[1], 1, atol=1e-5)


def test_crosstalk_mixes_what_stands_side_by_side() -> None:
    bayer = Mosaic.of("bayer-rggb", ("R", "G", "B"))
    np.testing.assert_allclose(bayer.neighbors(), [[0, 1, 0], [0.5, 0, 0.5], [0, 1, 0]])
    quad = Mosaic.of("quad-bayer-rggb", ("R", "G", "B"))
    np.testing.assert_allclose(quad.neighbors()[0], [0.5, 0.5, 0])


def test_patterns_have_the_shares_of_their_makers() -> None:
    shares = {name: Mosaic.of(name, ("R", "G", "B")).shares for name in PATTERNS if name != "mono"}
    np.testing.assert_allclose(shares.pop("xtrans"), [8 / 36, 20 / 36, 8 / 36])
    for share in shares.values():
        np.testing.assert_allclose(share, [0.25, 0.5, 0.25])
    cells = Mosaic.of("xtrans", ("R", "G", "B")).cells
    for line in (*cells, *cells.T):
        assert set(line) == {0, 1, 2}  # of all columns and rows, as its patent says


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pattern": "xtranz"}, "pattern: wanted one of .*did you mean 'xtrans'"),
        ({"pattern": "mono"}, "pattern: mono: wanted a sensor with channels Y, got R, G, B"),
        (
            {"pattern": "xtrans", "channels": ("R", "G", "B" * 999)},
            f"channels B, G, R, got R, G, {'B' * 40}$",
        ),
        ({"full_well": 0}, "full_well: wanted a number of at least 1"),
        ({"full_well": float("nan")}, "full_well: wanted a number"),
        ({"quantum_efficiency": -np.ones((3, 401))}, "quantum_efficiency: R: wanted 0 to 1"),
        ({"quantum_efficiency": np.ones((2, 401))}, "wanted a curve for each of R, G, B, got 2"),
        ({"quantum_efficiency": np.ones((3, 7))}, "wanted 401 numbers, .* got 7"),
        ({"wavelengths": np.zeros(401)}, "wavelengths: wanted at least two .* in ascending order"),
        (
            {"quantum_efficiency": np.full((3, 401), 0.5)},
            "the curves of R, G, B must be linearly independent",
        ),
        ({"read_noise": ((400, 2), (100, 3))}, "read_noise: iso: wanted a number above 400"),
        ({"iso_range": (400, 100)}, "iso_range: highest"),
        ({"black_level": 65535}, "black_level"),
        ({"quantum": 1}, "sensor: wanted one of name, .*; got 'quantum'"),
    ],
)
def test_bad_values_are_named(change: dict[str, object], message: str) -> None:
    with pytest.raises(dg.DaguerreError, match=message):
        load("ideal").with_(**change)


def test_filters_of_their_own_can_be_taken_off() -> None:
    cut = Curve(np.array([600.0, 700.0]), np.array([1.0, 0.0]))
    glass = Curve(np.array([380.0, 780.0]), np.array([0.9, 0.9]))
    bare = load("ideal-mono").with_(fill_factor=0.5)
    filtered = bare.with_(infrared_cut=cut, cover_glass=glass)
    nm = np.array([500.0, 650.0, 750.0])
    assert bare.efficiency(nm)[0] == pytest.approx([0.5, 0.5, 0.5])
    assert filtered.efficiency(nm)[0] == pytest.approx([0.45, 0.225, 0])
    assert filtered.with_(infrared_cut=None).efficiency(nm)[0] == pytest.approx([0.45] * 3)
    assert filtered.hash != bare.hash
    with pytest.raises(
        dg.InputError, match=r"infrared_cut: transmittance: wanted 0 to 1, got 1\.2"
    ):
        bare.with_(infrared_cut=Curve(np.array([400.0, 700.0]), np.array([1.2, 0])))


def test_iso_beyond_the_sensor_is_refused() -> None:
    sensor = load("ideal").with_(iso_range=(100, 6400))
    for iso in (50, 12800, float("nan"), -100, "400"):
        with pytest.raises(dg.UsageError, match=r"iso: wanted (100 \.\. 6400|a number), got"):
            sensor.gain(iso)  # type: ignore[arg-type]


def test_no_such_sensor() -> None:
    with pytest.raises(dg.InputError, match="did you mean 'ideal'"):
        load("ideel")


FILE = {
    "schema": "daguerre-sensor/0.1",
    **{"name": "n", "make": "m", "model": "o", "source": "s", "licence": "l"},
    **{"pixel_pitch_um": 4, "resolution": [60, 40], "pattern": "bayer-rggb"},
    "wavelengths_nm": [400, 550, 700],
    "quantum_efficiency": {"R": [0, 0.1, 0.4], "G": [0, 0.5, 0], "B": [0.4, 0.1, 0]},
    **{"full_well_e": 20000, "read_noise_e": [[100, 3], [800, 1.5]]},
    **{"black_level_dn": 512, "bit_depth": 14, "iso_range": [100, 6400], "base_iso": 100},
}


def test_a_file_is_read(tmp_path) -> None:
    path = tmp_path / "mine.json"
    path.write_text(
        json.dumps(
            FILE
            | {
                "dark_current": dict(
                    zip(("rate_e_per_s", "temperature_c", "doubling_k"), (0.5, 25, 6), strict=True)
                )
            }
        )
    )
    sensor = load(path)
    assert sensor.size == pytest.approx((0.24, 0.16))
    assert sensor.read_noise_at(100) == 3
    assert sensor.read_noise_at(200) == pytest.approx(2.5)  # linear in stops
    assert sensor.read_noise_at(6400) == 1.5
    assert sensor.dark_current.factor(37) == pytest.approx(4)
    assert sensor.efficiency([475.0])[0, 0] == pytest.approx(0.05)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"name": "a" * 5000}, "name: too long: wanted at most 200 characters, got 5000"),
        ({"quantum_efficiency": None}, "quantum_efficiency: .*an object"),
        (
            {"quantum_efficiency": {"R": [0, 1, 0], "G": [0, 1, 0]}},
            "wanted a sensor with channels B, G, R",
        ),
        (
            {"quantum_efficiency": {**FILE["quantum_efficiency"], "B": [1, 2]}},  # type: ignore[dict-item]
            r"quantum_efficiency.B: wrong length: wanted 3 numbers, .* got 2",
        ),
        (
            {"quantum_efficiency": {**FILE["quantum_efficiency"], "B": [0, -0.1, 1]}},  # type: ignore[dict-item]
            r"quantum_efficiency.B\[1\]: out of range: wanted 0 .. 1, got -0.1",
        ),
        ({"pattern": "bayer"}, "pattern: wanted one of"),
        ({"full_wel_e": 3}, "full_wel_e: unknown member .did you mean 'full_well_e'"),
        ({"schema": "daguerre-lens/0.1"}, "schema: wanted 'daguerre-sensor/0.1'"),
        ({"read_noise_e": []}, "read_noise: empty"),
    ],
)
def test_bad_files_are_named(tmp_path, change: dict[str, object], message: str) -> None:
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(FILE | change))
    with pytest.raises(dg.InputError, match=message) as caught:
        load(path)
    assert str(caught.value).startswith(str(path))


@pytest.mark.parametrize("name", FILE)
def test_what_a_file_lacks_is_named(tmp_path, name: str) -> None:
    path = tmp_path / "mine.json"
    path.write_text(json.dumps({k: v for k, v in FILE.items() if k != name}))
    with pytest.raises(dg.InputError, match=f"{name}: missing"):
        load(path)
