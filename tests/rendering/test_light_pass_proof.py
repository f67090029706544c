"""Light sent to the film and camera rays find one picture: alone, together, and by any plan.

Through every kind of camera; emitters of every kind are in ``test_light_pass_emitters.py``, and how
pictures are compared in ``light_proof.py``.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from tests.support.pictures.light_proof import (
    CLOSE,
    SMALL,
    Case,
    ball,
    by_chance,
    check,
    glass,
    lamp,
    pictures,
    thin,
    wall,
)
from tests.support.pictures.statistical import differences
from tests.support.scene import scenes


def lamps(x: float = 0.0, y: float = 0.0, spread: float = 1.0) -> dg.Scene:
    """Lamps before, in and behind the plane of focus, about one direction, over a wall."""
    scene = dg.Scene()
    wall(scene)
    for dx, dy, z, radius, color in (
        (-0.05, 0.02, -0.7, 0.002, (60, 30, 10)),  # nearer than the focus
        (0.03, 0.03, -CLOSE, 0.004, (30, 40, 60)),
        (0.04, -0.03, -2.4, 0.008, (400, 250, 120)),
        (-0.02, -0.035, -3.2, 0.010, (300, 300, 500)),
    ):
        at = ((x + spread * dx) * -z, (y + spread * dy) * -z, z)
        lamp(scene, at, radius, color)
    # One that is no ball: two triangles that shine to the front
    points, faces = scenes.quad(0.01)
    glow = dg.Material(dg.Diffuse((0, 0, 0)), emission=(20, 90, 60))
    at = ((x - 0.03 * spread) * 2.0, (y + 0.045 * spread) * 2.0, -2.0)
    scene.add_instance(scene.add_mesh(points, faces), glow, scenes.at(*at))
    ball(scene, dg.Conductor((0.9, 0.8, 0.6), 0.25), ((x + 0.01) * CLOSE, y * CLOSE, -CLOSE), 0.02)
    return scene


def star() -> NDArray[np.float32]:
    """An iris of four points, grey between them."""
    y, x = np.mgrid[-1:1:33j, -1:1:33j]
    return np.asarray(
        np.where(np.abs(x) ** 0.6 + np.abs(y) ** 0.6 < 1, 1, 0.2 * (np.hypot(x, y) < 0.95)),
        np.float32,
    )


def moving_lamp() -> dg.Scene:
    """A lamp that crosses the frame while lines are read out one after the other."""
    scene = dg.Scene(time=0.0)
    wall(scene)
    path = dg.keys([(-0.05, scenes.at(-0.08, -0.04, -1.6)), (0.05, scenes.at(0.08, 0.05, -2.2))])
    scene.add_light(dg.SphereLight((30, 20, 9), 0.02), path)
    lamp(scene, (0.05, 0.06, -2.4), 0.02, (120, 160, 200))
    return scene


def rolling() -> dg.Camera:
    roll = dg.RollingShutter("top", readout_time=0.04)
    return thin(shutter_time=0.02, rolling_shutter=roll)


def hot_sky() -> dg.Scene:
    """A picture of the sky with a few hot texels, 1.6 px wide here, over a ground."""
    scene = dg.Scene()
    sky = np.full((512, 1024, 3), 0.02, np.float32)
    for row, column, color in (
        (250, 508, (1, 0.8, 0.5)),
        (252, 515, (0.5, 0.7, 1)),
        (251, 517, (1, 1, 1)),
        (246, 512, (1, 0.4, 0.2)),
    ):
        sky[row, column] = np.multiply(color, 400)
    scene.set_environment(sky)
    points, faces = scenes.quad(3)
    tilt = np.array([[1, 0, 0, 0], [0, 0, 1, -0.12], [0, -1, 0, -2], [0, 0, 0, 1.0]])
    ground = dg.Material(dg.Diffuse((0.5, 0.5, 0.4)))
    scene.add_instance(scene.add_mesh(points, faces), ground, tilt)
    ball(scene, dg.Conductor((0.9, 0.9, 0.9), 0.2), (0.03, -0.03, -CLOSE), 0.05)
    return scene


def caustic() -> dg.Scene:
    """A lamp behind a ball of smooth glass, and what the glass throws on a floor: only camera rays
    find the lamp through the glass, only light paths find what it throws easily."""
    scene = dg.Scene()
    points, faces = scenes.quad(2)
    tilt = np.array([[1, 0, 0, 0], [0, 0, 1, -0.1], [0, -1, 0, -2], [0, 0, 0, 1.0]])
    floor = dg.Material(dg.Diffuse((0.6, 0.6, 0.6)))
    scene.add_instance(scene.add_mesh(points, faces), floor, tilt)
    ball(scene, dg.Dielectric(1.5), (0.0, -0.02, -1.3), 0.06, 24)
    lamp(scene, (0.03, 0.25, -1.7), 0.05, (250, 200, 150))
    return scene


CORNER = {"resolution": (192, 128), "crop": (4, 2, 52, 34)}
#: Direction (x / -z) of the middle of that crop for 50 mm on 36 x 24 mm
AT_CORNER = (-0.25, 0.17)

FAST = {
    "thin": Case(lamps, thin()),
    "exact": Case(lamps, glass(), plan=(2000.0, 0.0), spp=(96, 24, 24)),
    "moving lamp, rolling shutter": Case(moving_lamp, rolling(), brightest=60),
}
SLOW = {
    "pinhole": Case(lamps, dg.Camera(lens="pinhole", focal_length=50, sensor_size=SMALL)),
    "thick": Case(lamps, glass(lens_model="thick")),
    "exact, more of it": Case(lamps, glass(), spp=(1024, 256, 256)),
    "cat's eyes": Case(
        lambda: lamps(*AT_CORNER),
        glass(sensor_size=(36.0, 24.0)),
        plan=(20000.0, 0.0),
        spp=(1024, 64, 64),
        options=CORNER,
    ),
    "image iris, thin": Case(lamps, thin(aperture_image=star()), spp=(512, 128, 128)),
    "image iris, exact": Case(lamps, glass(aperture_image=star()), spp=(512, 128, 128)),
    "blades": Case(lamps, glass(f_stop=2.8, blades=6), spp=(512, 128, 128)),
    "anamorphic": Case(
        lamps, glass("schneider-anamorphic-60mm", 2.9, sensor_size=(6.2, 4.1)), spp=(512, 128, 128)
    ),
    "tilted": Case(lamps, glass(tilt=(3.0, 2.0)), spp=(512, 128, 128)),
    "moving lamp, exact": Case(
        moving_lamp,
        glass(shutter_time=0.02, rolling_shutter=dg.RollingShutter("left", readout_time=0.03)),
        spp=(512, 128, 128),
    ),
    "leaf shutter": Case(
        moving_lamp, thin(shutter_time=0.02, shutter_type="leaf", shutter_curve=("trapezoid", 0.6))
    ),
    "hot sky": Case(hot_sky, thin(), brightest=400, spp=(1024, 256, 256)),
    "hot sky, exact": Case(hot_sky, glass(), brightest=400, spp=(1024, 256, 256)),
}


@pytest.mark.parametrize("name", FAST)
def test_camera_light_and_both_find_one_picture(name: str) -> None:
    check(FAST[name])


@pytest.mark.slow
@pytest.mark.parametrize("name", SLOW)
def test_so_they_do_through_every_camera(name: str) -> None:
    check(SLOW[name])


def test_no_figure_depends_on_the_plan() -> None:
    case = FAST["thin"]
    plans = [(20000.0, 0.0), (200.0, 50.0), (2000.0, 2000.0)]
    every = [pictures(case, "both", plan, 100 * i) for i, plan in enumerate(plans)]
    assert [differences(one, every[0]) for one in every[1:]] == [[], []]


@pytest.mark.slow
@pytest.mark.parametrize("camera", [thin(), glass()], ids=["thin", "exact"])
def test_with_bounces_camera_and_both_find_one_picture(camera: dg.Camera) -> None:
    """Light alone meets what is dark or shiny too rarely for a test pixel by pixel."""
    case = Case(lamps, camera, plan=(3000.0, 4000.0), spp=(512, 128, 128))
    camera_alone, both = pictures(case, "camera"), pictures(case, "both")
    assert differences(both, by_chance(case, camera_alone)) == []


@pytest.mark.slow
@pytest.mark.parametrize("camera", [thin(), glass()], ids=["thin", "exact"])
def test_behind_smooth_glass_both_find_what_the_camera_finds(camera: dg.Camera) -> None:
    case = Case(
        caustic, camera, plan=(0.0, 20000.0), spp=(2048, 256, 256), options={"max_depth": 6}
    )
    camera, both = pictures(case, "camera"), pictures(case, "both")
    assert differences(both, by_chance(case, camera)) == []


def test_light_paths_take_the_noise_from_lamps_out_of_focus() -> None:
    """At equal samples, discs of small lamps are many times cleaner: the point of light paths."""

    def small() -> dg.Scene:
        scene = dg.Scene()
        for x in (-0.05, 0.0, 0.05):
            lamp(scene, (3 * x, 0.02, -3.0), 0.001, (300, 200, 100))
        return scene

    case = Case(small, thin(), spp=(64, 64, 64))
    noise = [pictures(case, name).var(axis=0, ddof=1).mean() for name in ("camera", "both")]
    assert noise[1] * 30 < noise[0]
    assert math.isfinite(noise[0])
