"""A tilted lens: what it is focused on is sharp, and what is sharp is a plane (Scheimpflug)."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre.setup import tilt
from daguerre.setup.camera import set_up
from tests.camera.test_lens_models import LENS, Array, meeting, rays
from tests.support.scene import scenes

ALL = [(0.0, 0.0), (9.0, 6.0), (-12.0, 4.0), (3.0, -10.0), (0.0, 8.0)]
KINDS = {
    "thin": dg.Camera(focal_length=50.0, f_stop=2.0),
    "breathing": dg.Camera(focal_length=50.0, f_stop=2.0, focus_breathing=True),
    "thin stand-in": dg.Camera(lens=LENS, lens_model="thin", f_stop=2.8),
    "thick": dg.Camera(lens=LENS, lens_model="thick", f_stop=2.8),
}


EXACT = dg.Camera(lens=LENS, f_stop=11.0, focus_distance=2.0)
NEAR = [(0.0, 0.0), (1.5, 1.0), (-1.5, 1.0), (1.0, -2.0), (-1.0, -1.5)]


def sharp_points(camera: dg.Camera, film: list[tuple[float, float]] = ALL) -> Array:
    o, d, w = rays(camera, film)
    return np.array([meeting(*one) for one in zip(o, d, w, strict=True)])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("angles", [(6.0, 0.0), (0.0, -8.0), (5.0, 4.0)])
def test_what_is_sharp_is_a_plane_through_the_focus(kind: str, angles: tuple[float, float]) -> None:
    camera = KINDS[kind].with_(focus_distance=2.0, tilt=angles)
    points = sharp_points(camera)
    middle = points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(points - middle)
    assert sizes[2] < 2e-4 * sizes[1]  # flat
    axis = -tilt.turn(angles)[:, 2]
    assert (2.0 * axis - middle) @ axes[2] == pytest.approx(0, abs=2e-3)


@pytest.mark.parametrize("angles", [(2.0, 0.0), (1.5, -2.0)])
def test_near_the_axis_an_exact_lens_is_sharp_where_a_thick_one_is(
    angles: tuple[float, float],
) -> None:
    """Only the difference of their focus is left, which tilt does not change."""
    exact = EXACT.with_(tilt=angles)
    error = sharp_points(exact, NEAR) - sharp_points(exact.with_(lens_model="thick"), NEAR)
    straight = sharp_points(EXACT, NEAR) - sharp_points(EXACT.with_(lens_model="thick"), NEAR)
    slant = sharp_points(exact, NEAR)[:, 2]
    assert np.ptp(slant) > 0.1
    np.testing.assert_allclose(error, straight, atol=0.25 * np.ptp(slant))


def test_the_axis_of_an_exact_lens_is_sharp_at_its_focus() -> None:
    for angles in ((6.0, 0.0), (4.0, -5.0)):
        axis = -tilt.turn(angles)[:, 2]
        exact = EXACT.with_(tilt=angles)
        core = set_up(dg.Scene(), exact, (36, 24), None).core
        film = np.asarray(core.chief_rays().film_points((2.0 * axis)[None]))[0]
        point = sharp_points(exact, [(float(film[0]), float(film[1]))])[0]
        np.testing.assert_allclose(point, 2.0 * axis, atol=0.04)
        np.testing.assert_allclose(point / point[2], axis / axis[2], atol=1e-3)


def test_the_sharp_plane_of_a_thin_lens_meets_film_and_lens_in_one_line() -> None:
    camera = KINDS["thin"].with_(focus_distance=2.0, tilt=(6.0, 0.0))
    points = sharp_points(camera, [(0.0, -9.0), (0.0, 0.0), (0.0, 9.0)])
    slope = (points[2, 2] - points[0, 2]) / (points[2, 1] - points[0, 1])
    # Lens: z = y tan(tilt); film: z = 50 mm.
    hinge = 0.05 / np.tan(np.radians(6.0))
    assert points[0, 2] + slope * (hinge - points[0, 1]) == pytest.approx(0.05, abs=2e-3)


@pytest.mark.parametrize("kind", KINDS)
def test_autofocus_makes_the_point_sharp(kind: str) -> None:
    """A pixel's surface is sharp there, wherever the lens's axis points."""
    camera = KINDS[kind].with_(tilt=(5.0, 3.0))
    film = (7.0, -5.0)
    core = set_up(dg.Scene(), camera.with_(focus_distance=2.0), (36, 24), None).core
    _, direction = core.chief_rays().rays(np.array([film]))
    point = 1.7 * np.asarray(direction)[0]
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh(*scenes.quad(1.0)), dg.Material(), scenes.at(*point))
    session = dg.Session(
        scene, camera.with_(focus_at=(18 + film[0], 12 - film[1])), resolution=(36, 24)
    )
    focused = camera.with_(focus_distance=session.metadata["camera"]["focus_distance_m"])
    assert sharp_points(focused, [film])[0, 2] == pytest.approx(point[2], rel=2e-3)


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_straight_ahead_stays_in_the_middle(kind: str) -> None:
    camera = KINDS[kind].with_(focus_distance=2.0, tilt=(8.0, -3.0))
    point = sharp_points(camera, [(0.0, 0.0)])[0]
    np.testing.assert_allclose(point[:2] / point[2], 0, atol=1e-5)


def test_tilt_is_nothing_to_a_pinhole() -> None:
    straight = dg.Camera(lens="pinhole", focal_length=35.0)
    for a, b in zip(
        rays(straight, ALL, 4), rays(straight.with_(tilt=(9.0, 2.0)), ALL, 4), strict=True
    ):
        assert (a == b).all()


@pytest.mark.parametrize("kind", ["thin", "thick", "exact"])
def test_the_lens_axis_is_as_bright_as_without_tilt(kind: str) -> None:
    camera = (KINDS | {"exact": EXACT})[kind]
    camera = camera.with_(focus_distance=4.0, tilt=(10.0, 0.0), shift=(0.0, 8.8))
    frame = dg.render(scenes.furnace(), camera, resolution=(12, 8), spp=64, filter="box")
    light = np.asarray(frame.xyz)[..., 1]
    assert light[3:5, 5:7].mean() == pytest.approx(1, abs=0.03)


@pytest.mark.parametrize("kind", ["thin", "thick"])
def test_tilt_over_time_is_each_lens_in_turn(kind: str) -> None:
    swing = dg.keys([(0.0, (0.0, 0.0)), (1.0, (8.0, 0.0))])
    camera = KINDS[kind].with_(focus_distance=2.0, shutter_time=1.0, shutter_offset=0.0, fps=1.0)
    setup = set_up(dg.Scene(), camera.with_(tilt=swing), (36, 24), None)
    assert setup.changes["tilt"].close == [8.0, 0.0]


@pytest.mark.parametrize("kind", ["thick", "exact"])
def test_metadata_say_how_far_the_film_is_along_the_axis_of_the_camera(kind: str) -> None:
    camera = (KINDS | {"exact": EXACT})[kind].with_(focus_distance=4.0)
    on_axis = set_up(dg.Scene(), camera, (36, 24), None).lens.entrance_pupil_offset_mm
    angles = (7.0, -4.0)
    turned = set_up(dg.Scene(), camera.with_(tilt=angles), (36, 24), None).lens
    expected = (tilt.turn(angles) @ [0, 0, on_axis])[2]
    assert turned.entrance_pupil_offset_mm == pytest.approx(expected)
