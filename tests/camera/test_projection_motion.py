"""Projections whose numbers change while the shutter is open: tracked zooms, stabilised cameras.

That such a picture is the mean of still ones, and ground truth's motion theirs, is tested with all
else that moves: ``motion_scenes.py``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import DaguerreError

SIZE = (200, 150)
WIDE = dg.Projection("opencv", SIZE, (150.0, 150.0), None, (-0.1, 0.02))
LONG = dg.Projection("opencv", SIZE, (220.0, 225.0), (110.0, 70.0), (-0.3, 0.1, 1e-3))
POINT = (0.3, -0.2, 1.0)  # x right, y down, z ahead, m
OPEN = {"shutter_time": 0.2}


def lamp() -> dg.Scene:
    scene, place = dg.Scene(), np.eye(4)
    place[:3, 3] = np.multiply(POINT, (1, -1, -1))
    scene.add_light(dg.SphereLight((1e3, 1e3, 1e3), 5e-3), place)
    return scene


def streak(camera: dg.Camera, **changes: Any) -> np.ndarray:
    """Light of a lamp in a part of the picture that has all of it."""
    options: dict[str, Any] = {"spp": 16, "filter": "box", "max_depth": 1} | changes
    frame = dg.render(lamp(), camera, resolution=SIZE, crop=(130, 10, 190, 60), **options)
    return np.asarray(np.maximum(frame.xyz[..., 1], 0), np.float64)


def middle_and_width(light: np.ndarray) -> tuple[np.ndarray, float]:
    """Mean of the places (px, pixel centres at integers), and their spread along x."""
    rows, columns = np.indices(light.shape)
    x, y = columns + 130, rows + 10
    mean = np.array([(light * at).sum() for at in (x, y)]) / light.sum()
    return mean, float(np.sqrt((light * (x - mean[0]) ** 2).sum() / light.sum()))


def places(camera: dg.Camera, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where the lamp is at times, px, and how large: its light on the film."""
    seen = [camera.frozen_at(float(t)).projection for t in times]
    x, y, z = POINT
    near = [POINT, (x + 1e-4, y, z), (x, y + 1e-4, z)]
    at = np.array([p.project(near) for p in seen if p is not None])
    across, down = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]
    return at[:, 0], np.abs(across[:, 0] * down[:, 1] - across[:, 1] * down[:, 0])


@pytest.mark.parametrize(
    ("options", "noise"), [({}, 0.1), ({"light_paths": "off", "spp": 256}, 1.0)]
)
def test_a_lamp_is_drawn_from_where_the_first_has_it_to_where_the_last_does(
    options: dict[str, Any], noise: float
) -> None:
    """By light paths, and by camera rays alone, of which few meet it."""
    camera = dg.Camera(projection=dg.keys([(-0.1, WIDE), (0.1, LONG)]), **OPEN)
    light = streak(camera, **options)
    lit = np.argwhere(light > 0.2 * light.max())[:, ::-1] + (130, 10)
    (x0, y0), (x1, y1) = WIDE.project([POINT])[0], LONG.project([POINT])[0]
    assert (lit.min(axis=0), lit.max(axis=0)) == (
        pytest.approx((x0, y1), abs=1.5),
        pytest.approx((x1, y0), abs=1.5),
    )
    way, size = places(camera, np.linspace(-0.0999, 0.0999, 201))
    mean, width = middle_and_width(light)
    wanted = (way * size[:, None]).sum(axis=0) / size.sum()
    np.testing.assert_allclose(mean, wanted, atol=noise)
    spread = np.sqrt(((way[:, 0] - wanted[0]) ** 2 * size).sum() / size.sum())
    assert width == pytest.approx(spread, abs=noise)


def test_keys_that_step_make_two_pictures() -> None:
    camera = dg.Camera(projection=dg.keys([(-0.1, WIDE), (0.05, LONG)], "step"), **OPEN)
    light = streak(camera)
    lit = np.argwhere(light > 0.1 * light.max())[:, ::-1] + (130, 10)
    first, last = WIDE.project([POINT])[0], LONG.project([POINT])[0]
    near = [np.linalg.norm(lit - at, axis=1) < 2 for at in (first, last)]
    assert np.logical_or(*near).all()
    assert near[0].any()
    assert near[1].any()
    share = light[:, 160 - 130 :].sum() / light.sum()  # 160: between both
    _, (small, large) = places(camera, np.array([0.0, 0.09]))
    assert share == pytest.approx(0.25 * large / (0.75 * small + 0.25 * large), abs=0.02)


def test_each_row_has_the_projection_of_its_own_time() -> None:
    roll = dg.RollingShutter("top", readout_time=0.2)
    camera = dg.Camera(projection=dg.keys([(-0.1, WIDE), (0.1, LONG)]), rolling_shutter=roll)
    mean, _ = middle_and_width(streak(camera.with_(shutter_time=1e-5)))
    times = -0.1 + 0.2 * (np.arange(150) + 0.5) / 150
    way, _ = places(camera, times)
    row = int(np.abs(way[:, 1] - np.arange(150)).argmin())
    np.testing.assert_allclose(mean, way[row], atol=1.0)
    still, _ = places(camera, np.zeros(1))
    assert (
        np.linalg.norm(still[0] - way[row]) > 3
    )  # which the lamp would be off, were it mid-frame's


def test_a_projection_between_two_keys_has_the_numbers_between() -> None:
    camera = dg.Camera(projection=dg.keys([(0.0, WIDE), (1.0, LONG)]))
    now = camera.frozen_at(0.25).projection
    assert now is not None
    assert now.focal == pytest.approx((167.5, 168.75))
    assert now.center == pytest.approx((0.75 * 99.5 + 0.25 * 110, 0.75 * 74.5 + 0.25 * 70))
    assert now.parameters == pytest.approx((-0.15, 0.04, 0.00025))
    assert camera.frozen_at(-1).projection is WIDE
    assert camera.frozen_at(2).projection is LONG


def test_what_changes_is_in_the_metadata() -> None:
    camera = dg.Camera(projection=dg.keys([(-0.1, WIDE), (0.1, LONG)]), **OPEN)
    session = dg.Session(lamp(), camera, resolution=SIZE)
    shown = session.metadata["camera"]
    facts = shown["motion"]["projection"]
    assert facts["open"]["focal_px"] == [150.0, 150.0]
    assert facts["close"]["parameters"] == pytest.approx([-0.3, 0.1, 1e-3])
    assert shown["projection"]["focal_px"] == pytest.approx([185.0, 187.5])


OTHER = dg.Projection("eucm", SIZE, (150.0, 150.0), None, (0.5, 1.0))
LARGE = dg.Projection("opencv", (400, 300), (150.0, 150.0))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (lambda: {"projection": dg.keys([(0, WIDE), (1, OTHER)])}, r"keys\[1\].*opencv.*eucm"),
        (lambda: {"projection": dg.keys([(0, WIDE), (1, LARGE)])}, r"200, 150.*400, 300"),
        (lambda: {"projection": dg.keys([(0, WIDE), (1, 3.0)])}, r"keys\[1\]"),
        (lambda: {"projection": dg.keys([(0, 1.0), (1, 3.0)])}, "wanted a Projection"),
        (lambda: {"projection": dg.keys([(0, WIDE), (1, LONG)], "twist")}, "linear, step"),
        (
            lambda: {"tilt": dg.keys([(-1, (-3.0, 0.0)), (1, (3.0, 0.0))])},
            "wanted either projection or tilt",
        ),
        (lambda: {"sensor_size": dg.keys([(-1, (8.0, 6.0)), (1, (9.0, 6.75))])}, "sensor_size"),
    ],
)
def test_what_cannot_change_so_is_refused(changes: Any, message: str) -> None:
    with pytest.raises(DaguerreError, match=message):
        streak(dg.Camera(**({"projection": WIDE} | changes()), **OPEN))
