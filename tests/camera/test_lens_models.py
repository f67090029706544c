"""Pinhole, thin, thick and exact: one framing, one focus, one exposure; each its own fall-off."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre import lenses
from daguerre.setup.camera import set_up
from tests.support.scene import scenes

Array = NDArray[np.float64]
LENS = "double-gauss-50mm-f2"
MODELS = ("pinhole", "thin", "thick", "exact")


def rays(camera: dg.Camera, film_mm: list[tuple[float, float]], count: int = 256) -> Any:
    """Origins, directions (points, count, 3) and weights of the camera's own rays, m."""
    core = set_up(dg.Scene(), camera, (36, 24), None).core
    u = np.random.default_rng(1).random((count, 2), np.float32)
    film = np.repeat(np.asarray(film_mm, np.float32), count, axis=0)
    nm = np.full(len(film), 587.5618, np.float32)
    found = core.rays(np.ascontiguousarray(film), np.tile(u, (len(film_mm), 1)), nm)
    return [np.asarray(part, np.float64).reshape(len(film_mm), count, -1) for part in found]


def meeting(origins: Array, directions: Array, weights: Array) -> Array:
    """The point (3,) nearest to all rays that passed."""
    passed = weights[:, 0] > 0
    o, d = origins[passed], directions[passed]
    d = d / np.linalg.norm(d, axis=1, keepdims=True)  # better than single precision
    across = np.eye(3) - d[:, :, None] * d[:, None, :]
    return np.linalg.solve(across.sum(axis=0), np.einsum("nij,nj->i", across, o))


def white(model: str, **changes: Any) -> dg.Frame:
    camera = dg.Camera(lens=LENS, lens_model=model, focus_distance=3.0).with_(**changes)
    return dg.render(scenes.furnace(), camera, resolution=(36, 24), spp=64, filter="box")


@pytest.mark.parametrize("model", MODELS)
def test_a_white_world_is_one_on_the_axis(model: str) -> None:
    stop = {} if model == "pinhole" else {"f_stop": 4.0}
    luminance = np.asarray(white(model, **stop).xyz)[11:13, 17:19, 1]
    assert luminance.mean() == pytest.approx(1, abs=0.01)


def test_a_pinhole_heeds_no_f_stop() -> None:
    """A file's camera may be faster than the lens that takes its place."""
    found = []
    for stop in ({}, {"f_stop": 1.2}):
        camera = dg.Camera(lens=LENS, lens_model="pinhole", focus_distance=3.0).with_(**stop)
        found.append(rays(camera, [(3.0, 2.0)], 4)[1])
    np.testing.assert_array_equal(found[0], found[1])
    with pytest.raises(dg.DaguerreError, match=r"f_stop: wanted \S+ or more, .* opens to f/"):
        white("exact", f_stop=1.2)


@pytest.mark.parametrize("model", ["thin", "thick", "exact"])
def test_a_grey_iris_takes_no_exposure(model: str) -> None:
    """Pictures of the iris count as their own unit, grey and black parts alike."""
    grey = np.full((8, 8), 0.3, np.float32)
    grey[:, 4:] = 1
    picture = white(model, f_stop=4.0, aperture_image=grey)
    assert np.asarray(picture.xyz)[11:13, 17:19, 1].mean() == pytest.approx(1, abs=0.02)


def test_all_models_frame_alike_near_the_axis() -> None:
    film = [(0.0, 0.0), (1.0, 0.5), (-0.6, 1.2)]
    directions = []
    for model in MODELS:
        stop = {} if model == "pinhole" else {"f_stop": 16.0}
        camera = dg.Camera(lens=LENS, lens_model=model, focus_distance=1.2).with_(**stop)
        found = []
        for o, d, w in zip(*rays(camera, film), strict=True):
            passed = w[:, 0] > 0
            o, d = o[passed], d[passed]
            found.append((o + d * ((-1.2 - o[:, 2:]) / d[:, 2:])).mean(axis=0))  # in focus there
        directions.append(found)
    for model_found in directions[1:]:
        np.testing.assert_allclose(model_found, directions[0], atol=4e-5)  # of 30 mm


@pytest.mark.parametrize("model", ["thin", "thick", "exact"])
def test_all_models_focus_where_they_are_told(model: str) -> None:
    camera = dg.Camera(lens=LENS, lens_model=model, focus_distance=1.2, f_stop=11.0)
    o, d, w = rays(camera, [(0.0, 0.0)], 512)
    assert meeting(o[0], d[0], w[0])[2] == pytest.approx(-1.2, rel=5e-3)


def test_the_fall_off_of_a_thick_lens_is_that_of_its_exit_pupil() -> None:
    lens = lenses.load(LENS)
    order = lens.first_order()
    frame = white("thick", f_stop=2.8)
    offset = frame.metadata["entrancePupilOffset"] + order.entrance_pupil.z
    distance = offset - order.exit_pupil.z
    radius = order.exit_pupil.diameter / 2 * order.f_number / 2.8
    q = (np.arange(64) + 0.5) / 64
    angle = 2 * np.pi * (np.arange(64) + 0.5) / 64
    x = radius * np.sqrt(q)[:, None] * np.cos(angle)
    y = radius * np.sqrt(q)[:, None] * np.sin(angle)

    def exposure(film: float) -> float:  # Kolb 1995: cos^4 / Z^2 over the disc
        return float(np.mean((1 + ((x - film) ** 2 + y**2) / distance**2) ** -2.0))

    picture = np.asarray(frame.xyz)[..., 1]
    rows, columns = np.mgrid[:24, :36] + 0.5
    r = np.hypot(columns - 18, rows - 12)
    for inner in (6, 12, 18):
        ring = (r > inner - 1) & (r < inner + 1)
        expected = np.mean([exposure(v) for v in r[ring]]) / exposure(0)
        assert picture[ring].mean() == pytest.approx(expected, rel=4e-3)


@pytest.mark.parametrize("model", ["thin", "thick", "exact"])
def test_all_models_hold_their_iris_alike(model: str) -> None:
    """Three blades, turned: the third moment of where rays cross the entrance pupil."""
    camera = dg.Camera(
        lens=LENS, lens_model=model, f_stop=4.0, focus_distance=3.0, blades=3, blade_rotation=20.0
    )
    o, d, w = (part[0] for part in rays(camera, [(0.0, 0.0)], 4096))
    o, d = o[w[:, 0] > 0], d[w[:, 0] > 0]
    at = o[:, :2] - d[:, :2] * (o[:, 2:] / d[:, 2:])
    z = at[:, 0] + 1j * at[:, 1]
    third = (z**3).mean() / (abs(z) ** 3).mean()
    assert abs(third) > 0.2
    assert math.degrees(np.angle(third)) == pytest.approx(3 * 20.0, abs=10)  # a corner at 20 deg


def test_exposures_of_thick_and_exact_lens_are_one_number() -> None:
    thick, exact = (white(model, f_stop=8.0).metadata["h0"] for model in ("thick", "exact"))
    assert thick == pytest.approx(exact, rel=0.01)  # the exact pupil is a little smaller


def test_a_thick_lens_changes_while_the_shutter_is_open() -> None:
    """Focus pulled from near to far: a state is the lens of its moment, in one body."""
    focus = dg.keys([(0.0, 1.0), (1.0, 4.0)])
    camera = dg.Camera(lens=LENS, lens_model="thick", f_stop=2.0, focus_distance=focus)
    camera = camera.with_(shutter_time=1.0, shutter_offset=0.0, fps=1.0)
    frame = dg.render(scenes.furnace(), camera, resolution=(12, 8), spp=16, filter="box")
    assert np.asarray(frame.xyz)[4, 6, 1] == pytest.approx(1, abs=0.05)


@pytest.mark.parametrize(
    ("camera", "wanted"),
    [
        (dg.Camera(lens_model="thick"), "lens_model: thick needs a lens with a prescription"),
        (dg.Camera(lens=LENS, lens_model="thick", natural_vignetting=True), "its own vignetting"),
        (dg.Camera(lens=LENS, lens_model="thick", aperture_diameter=3.0), "takes f_stop instead"),
        (dg.Camera(tilt=(70, 0)), "tilt"),
        (dg.Camera(tilt=(1, math.nan)), "tilt"),
    ],
)
def test_what_cannot_be_honoured_is_refused(camera: dg.Camera, wanted: str) -> None:
    with pytest.raises(dg.UsageError, match=wanted):
        set_up(dg.Scene(), camera, (36, 24), None)
