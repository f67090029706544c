"""Test charts: what they show is what their truth says, and what is measured is what was drawn."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import daguerre as dg
import daguerre._core as _core
from daguerre import analysis, charts
from daguerre.cli import main
from daguerre.errors import InputError, UsageError

RESOLUTION = (600, 400)


def _edge(chart: charts.Chart, square: str, side: str) -> np.ndarray:
    found = next(s for s in chart.truth["squares"] if s["name"] == square)
    return np.mean(found["edges"][side], axis=0)


def _around(point: np.ndarray, half: int, resolution: tuple[int, int]) -> tuple[int, ...]:
    """A crop about a point of a chart that fills the frame."""
    x, y = np.round((point * [1, -1] / [0.9, 0.6] + 0.5) * resolution).astype(int)
    return (x - half, y - half, x + half, y + half)


def _shot(chart: charts.Chart, camera: dg.Camera, **options: Any) -> dg.Frame:
    given: dict[str, Any] = {"resolution": RESOLUTION, "filter": "box", "max_depth": 1}
    given["light_paths"] = "off"  # as `auto` finds after a trial: charts shine evenly
    given |= options
    return dg.render(chart.scene(1.0), camera, **given)


@pytest.mark.parametrize("name", ["colour", "step-wedge"])
def test_patches_have_the_light_that_the_truth_says(name: str) -> None:
    chart = charts.make(name)
    frame = _shot(chart, chart.camera(), spp=16)
    seen = charts.means(frame.rgb, chart, frame.metadata)
    wanted = np.array([patch["rgb"] for patch in chart.truth["patches"]])
    np.testing.assert_allclose(seen, wanted, rtol=0.02, atol=0.002)


@pytest.mark.parametrize("side", ["left", "right", "top", "bottom"])
def test_an_edge_without_a_lens_has_the_response_of_a_pixel(side: str) -> None:
    chart = charts.make("slanted-edge")
    crop = _around(_edge(chart, "2,1", side), 28, (1200, 800))
    frame = _shot(chart, chart.camera(), spp=64, resolution=(1200, 800), crop=crop)
    response = charts.edge_response(frame.xyz[..., 1])
    frequency = np.arange(0, 0.501, 0.05)
    np.testing.assert_allclose(response.at(frequency), np.sinc(frequency), atol=0.012)
    assert (response.low, response.high) == pytest.approx((0.2, 0.8), rel=2e-3)
    assert abs(response.angle) == pytest.approx(5, abs=0.1)


@pytest.mark.parametrize(("square", "side"), [("4,1", "right"), ("4,1", "top")])
def test_an_edge_through_a_lens_has_the_mtf_of_the_bench(square: str, side: str) -> None:
    """ISO 12233 on the picture, against rays on the bench, times a pixel: within 0.02."""
    pixels, pitch, f_stop = (3600, 2400), 36 / 3600, 4.0
    chart = charts.make("slanted-edge")
    camera = chart.camera().with_(
        lens="double-gauss-50mm-f2",
        lens_model="exact",
        f_stop=f_stop,
        focal_length=None,
        focus_by="best",
    )
    one = _shot(chart, camera, spp=1, resolution=pixels, crop=(0, 0, 8, 8))
    place = charts.places([_edge(chart, square, side)], one.metadata)[0]
    x, y = np.round(place).astype(int)
    crop = (x - 44, y - 44, x + 44, y + 44)
    frame = _shot(chart, camera, spp=1024, resolution=pixels, crop=crop)
    response = charts.edge_response(frame.xyz[..., 1])

    bench = analysis.set_up(
        dg.lenses.load("double-gauss-50mm-f2"),
        f_stop=f_stop,
        focus_m=camera.focus_distance,
        by="best",
    )
    height = -pitch * float(np.hypot(*(place - np.array(pixels) / 2)))
    light = analysis.pencil(bench, height, distance_mm=1e3 * camera.focus_distance)
    nm = np.arange(410.0, 710.0, 12.0)
    table = np.asarray(_core.colour_tables(nm.tolist()))
    spot = analysis.spot(light, nm, table[:, 1] * table[:, 3], grid=64, jitter=True)
    frequency = np.arange(0, 0.501, 0.05)
    both = analysis.geometric_mtf(spot, frequency / pitch)
    across = 1 if side == "right" else 0  # tangential where the edge lies across the radius
    np.testing.assert_allclose(
        response.at(frequency), both[:, across] * np.sinc(frequency), atol=0.02
    )
    assert both[10, across] < 0.75  # the lens does something


def test_edge_response_of_a_known_blur() -> None:
    """A Gaussian edge in closed form; a response that is off by a tenth would be seen."""
    sigma, rows, columns = 0.8, 60, 64
    y, x = np.mgrid[0:rows, 0:columns] + 0.5
    distance = (x - 31 - (y - 30) * np.tan(np.radians(6))) * np.cos(np.radians(6))
    erf = np.vectorize(__import__("math").erf)
    light = 0.2 + 0.6 * 0.5 * (1 + erf(distance / (sigma * np.sqrt(2))))
    frequency = np.arange(0, 0.401, 0.05)
    wanted = np.exp(-2 * (np.pi * sigma * frequency) ** 2)
    for region in (light, light[:, ::-1], light.T, light[::-1]):
        response = charts.edge_response(region)
        np.testing.assert_allclose(response.at(frequency), wanted, atol=0.01)
    half = np.sqrt(np.log(2) / 2) / (np.pi * sigma)
    assert charts.edge_response(light).mtf50 == pytest.approx(half, rel=0.01)


@pytest.mark.parametrize("profile", ["sine", "bar"])
def test_a_star_has_its_modulation_where_pixels_are_fine(profile: str) -> None:
    chart = charts.make("siemens-star", cycles=24, profile=profile)
    frame = _shot(chart, chart.camera(), spp=32, resolution=(360, 240))
    radii = np.array([50.0, 70.0, 100.0])
    seen = charts.star_modulation(frame.xyz[..., 1], (180, 120), radii, 24)
    pixel = np.sinc(24 / (2 * np.pi * radii))  # about: a square pixel along the circle
    np.testing.assert_allclose(seen, chart.truth["modulation"] * pixel, rtol=0.03)


@pytest.fixture(scope="module")
def leaves() -> tuple[charts.Chart, np.ndarray]:
    """Dead leaves, and the light of their picture."""
    chart = charts.make("dead-leaves", smallest=0.01)
    frame = _shot(chart, chart.camera(), spp=8)
    return chart, np.asarray(frame.xyz[..., 1], np.float64)


def test_leaves_look_alike_at_every_scale_and_cover_the_ground(leaves: Any) -> None:
    chart, light = leaves
    again = charts.make("dead-leaves", smallest=0.01)
    assert len(chart.patches) == len(again.patches)
    other = charts.make("dead-leaves", smallest=0.02, seed=1)
    assert len(chart.patches) != len(other.patches)
    assert light.mean() == pytest.approx(0.5, abs=0.08)
    assert light.std() == pytest.approx(chart.truth["standard_deviation"], rel=0.25)
    # From the largest leaf to the smallest power falls off as f^-2, as that of natural pictures.
    window = np.hanning(400)[:, None] * np.hanning(600)[None]
    power = np.abs(np.fft.fft2((light - light.mean()) * window)) ** 2
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(600), np.fft.fftfreq(400)))
    edges = np.geomspace(0.005, 0.1, 8)
    level = [power[(frequency >= a) & (frequency < b)].mean() for a, b in pairwise(edges)]
    slope = np.polyfit(np.log(np.sqrt(edges[:-1] * edges[1:])), np.log(level), 1)[0]
    assert slope == pytest.approx(-2, abs=0.4)


def test_texture_response_tells_blur_from_noise(leaves: Any) -> None:
    _, sharp = leaves
    f = np.hypot(*np.meshgrid(np.fft.fftfreq(600), np.fft.fftfreq(400)))
    blurred = np.fft.ifft2(np.fft.fft2(sharp) * np.exp(-2 * (np.pi * 1.2 * f) ** 2)).real
    noisy = blurred + 0.01 * np.random.default_rng(3).standard_normal(sharp.shape)
    frequency, response = charts.texture_response(noisy, sharp)
    wanted = np.exp(-2 * (np.pi * 1.2 * frequency) ** 2)
    low = (frequency > 0.02) & (frequency < 0.25)
    np.testing.assert_allclose(response[low], wanted[low], atol=0.03)


@pytest.mark.parametrize("flags", [[], ["--paint"]])
def test_a_chart_on_disk_is_the_chart(tmp_path: Any, flags: list[str]) -> None:
    path = tmp_path / "wedge.glb"
    given = ["--set", "steps=6", "--set", "step=0.25", "--luminance", "50"]
    assert main(["chart", "step-wedge", "-o", str(path), *given, *flags]) == 0
    truth = json.loads(path.with_suffix(".json").read_text())
    assert truth["white_cd_m2"] == (None if flags else 50)
    scene = dg.load(path)
    if flags:
        scene.set_environment(color=(50, 50, 50))
    camera = scene.camera().with_(lens="pinhole")
    frame = dg.render(scene, camera, resolution=(300, 200), spp=16, filter="box")
    chart = charts.make("step-wedge", steps=6, step=0.25)
    seen = charts.means(frame.xyz[..., 1], chart, frame.metadata)
    wanted = [50 * 10 ** -p["density"] for p in truth["patches"]]
    np.testing.assert_allclose(seen, wanted, rtol=0.02)


def test_the_list_says_what_parameters_are(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chart", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "    width: Width of the chart, m [0.9]" in lines
    assert not [line for line in lines if line.startswith("    ") and ":  [" in line]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["chart"], "wanted CHART -o FILE.glb"),
        (["chart", "siemens", "-o", "x.glb"], "siemens-star"),
        (["chart", "colour", "-o", "x.obj"], "ending in .glb"),
        (["chart", "colour", "-o", "x.glb", "--set", "steps=3"], "steps"),
        (["chart", "step-wedge", "-o", "x.glb", "--set", "steps=1"], "2 .. 100"),
        (["chart", "step-wedge", "-o", "x.glb", "--set", "steps"], "KEY=VALUE"),
        (["chart", "step-wedge", "-o", "x.glb", "--set", "=3"], "KEY=VALUE"),
        (["chart", "siemens-star", "-o", "x.glb", "--set", "profile=saw"], "sine or bar"),
        (["chart", "slanted-edge", "-o", "x.glb", "--set", "angle=0"], "angle"),
        (["chart", "slanted-edge", "-o", "x.glb", "--set", "contrast=1"], "contrast"),
        (["chart", "dead-leaves", "-o", "x.glb", "--set", "smallest=0.4"], "less than largest"),
        (["chart", "colour", "-o", "x.glb", "--luminance", "-1"], "luminance"),
        (["chart", "colour", "-o", "x.glb", "--set", "width=0"], "width"),
    ],
)
def test_bad_charts_are_one_line(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == 2
    captured = capsys.readouterr().err
    assert message in captured
    assert "Traceback" not in captured


def test_bad_measurements_say_so() -> None:
    with pytest.raises(InputError, match="at least 8 x 8"):
        charts.edge_response(np.ones((4, 4)))
    with pytest.raises(InputError, match="finite"):
        charts.edge_response(np.full((16, 16), np.nan))
    upright = np.where(np.arange(32) < 16, 0.2, 0.8) * np.ones((32, 1))
    with pytest.raises(InputError, match="slanted"):
        charts.edge_response(upright)
    with pytest.raises(InputError, match="one edge"):
        charts.edge_response(np.full((32, 32), 0.5))
    with pytest.raises(InputError, match="wanted the picture's shape"):
        charts.texture_response(np.ones((4, 4)), np.ones((4, 5)))
    with pytest.raises(InputError, match="wanted texture"):
        charts.texture_response(np.eye(8), np.ones((8, 8)))
    with pytest.raises(UsageError, match="bend"):
        charts.edge_response(upright, bend=-1)
    for radius in (100, -3, 0, np.nan):
        with pytest.raises(InputError, match="radii: wanted circles in the picture"):
            charts.star_modulation(np.ones((40, 40)), (20, 20), [radius], 8)
    with pytest.raises(InputError, match="light on the circle"):
        charts.star_modulation(np.zeros((40, 40)), (20, 20), [10], 8)
    with pytest.raises(InputError, match="star: picture: wanted"):
        charts.star_modulation(np.ones((40, 40, 3)), (20, 20), [10], 8)
    with pytest.raises(UsageError, match="center"):
        charts.star_modulation(np.ones((40, 40)), (20,), [10], 8)
    with pytest.raises(InputError, match="worldToNDC"):
        charts.places([[0, 0]], {})
    with pytest.raises(InputError, match="patches"):
        charts.means(np.ones((4, 4)), charts.make("slanted-edge"), {})
    with pytest.raises(UsageError, match="did you mean"):
        charts.make("color")
