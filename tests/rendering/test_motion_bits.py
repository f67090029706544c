"""Motion keeps the promises on bits: threads, sample ranges, and times far from zero."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.scene.motion import SceneMotion
from tests.support.scene import motion_scenes
from tests.support.scene.motion_scenes import ball, card, floor, move, pinhole, sky, turn

SMALL: dict[str, Any] = {"resolution": (24, 16), "max_depth": 4}


def busy(time: float, shutter: float) -> tuple[dg.Scene, dg.Camera]:
    """Everything moves, as long as the shutter is open."""

    def across(a: Any, b: Any, **how: Any) -> dg.Keys:
        return dg.keys([(time - shutter, a), (time + shutter, b)], **how)

    scene = sky(across(0.5, 1.5), across(0.0, 40.0), time)
    floor(scene)
    card(scene, across(move(-0.9, 0, -3), move(0.9, 0.3, -3) @ turn(170)))
    spins = dg.spin((0, 0, 1), 1.5 / shutter, (0.2, 0, 0), move(0, 0.4, -3), time)
    card(scene, spins, size=0.2)
    paint = dg.Diffuse(across((0.9, 0.1, 0.1), (0.1, 0.1, 0.9)))
    ball(scene, paint, across(move(0.5, -0.4, -2), move(0.3, 0, -2)), 0.3)
    scene.add_light(dg.PointLight(across((6.0, 4.0, 2.0), (0.0, 1.0, 2.0))), move(-1, 1, -2))
    swings = across(move(-1, 0.5, -2), move(1, 0.5, -2))
    scene.add_light(dg.SphereLight((9, 9, 9), across(0.05, 0.2)), swings)
    camera = pinhole(
        lens="thin",
        shutter_time=shutter,
        f_stop=1.4,
        focus_distance=across(2.0, 4.0),
        transform=across(turn(-3), turn(3)),
        rolling_shutter=dg.RollingShutter("top", readout_time=0.3 * shutter),
    )
    return scene, camera


def picture(scene: dg.Scene, camera: dg.Camera, *ranges: tuple[int, int], **options: Any) -> Any:
    session = dg.Session(scene, camera, **(SMALL | options))
    for begin, end in ranges:
        session.draw(begin, end)
    return session.frame().rgb


@pytest.mark.parametrize("threads", [2, 3])
def test_threads(threads):
    scene, camera = busy(0.0, 0.5)
    one = picture(scene, camera, (0, 16), threads=1)
    assert np.array_equal(one, picture(scene, camera, (0, 16), threads=threads))


def test_ranges_of_samples_add():
    scene, camera = busy(0.0, 0.5)
    whole = picture(scene, camera, (0, 32))
    assert np.array_equal(whole, picture(scene, camera, (16, 32), (0, 16)))


@pytest.mark.parametrize("time", [1e5, -3e4])
def test_long_times_lose_nothing(time):
    """1/4000 s after a day is as good as at the start: times in a scene are fractions of it."""
    now, later = busy(0.0, 1 / 4000), busy(time, 1 / 4000)
    a, b = picture(*now, (0, 64)), picture(*later, (0, 64))
    # times of 1e5 s end 1.5e-11 s apart, 6e-8 of the exposure: hardly a ray falls elsewhere
    assert (np.abs(a - b) > 1e-3 * (a + b)).mean() < 0.1
    assert np.abs(a - b).mean() < 1e-3 * a.mean()


def test_a_motion_beyond_the_exposure_changes_no_bit():
    """Things that rest while the shutter is open cost nothing, and the picture is the same."""
    case = motion_scenes.translation()
    scene = case.scene
    late = case.scene.time + 1
    keys = dg.keys([(late, scene.instances[0].transform), (late + 1, move())])
    scene.motion.instances[0] = keys
    still = dg.Scene(**(vars(scene) | {"motion": SceneMotion()}))
    assert np.array_equal(picture(scene, case.camera, (0, 8)), picture(still, case.camera, (0, 8)))


def test_a_frozen_shutter_is_a_still_frame():
    """Bit for bit: with no time to move in, there is no trace of motion left."""
    scene, camera = busy(0.25, 0.5)
    still = dg.Scene(**(vars(scene.at(0.3)) | {"motion": SceneMotion()}))
    frozen = {"shutter_time": 0.0, "rolling_shutter": None}
    a = picture(scene.at(0.3), camera.with_(**frozen), (0, 16))
    b = picture(still, camera.frozen_at(0.3).with_(**frozen), (0, 16))
    assert np.array_equal(a, b)


def test_a_crop_of_a_rolling_frame_is_that_part_of_it():
    """Lines have the times that they have in the whole frame."""
    scene, camera = busy(0.0, 0.5)
    # Other filters reach over the edge of a crop; of its own accord a crop has fewer light paths.
    box: dict[str, Any] = {"filter": "box", "light_paths": (200, 0)}
    whole = picture(scene, camera, (0, 8), **box)
    assert np.array_equal(
        whole[9:15, 4:20], picture(scene, camera, (0, 8), crop=(4, 9, 20, 15), **box)
    )


def test_adaptive_rounds_keep_the_mean_of_what_moves():
    scene, camera = busy(0.0, 0.5)
    adaptive = dg.render(scene, camera, noise=0.02, spp=2048, **SMALL).rgb
    even = dg.render(scene, camera, spp=1024, seed=7, **SMALL).rgb
    assert np.sqrt(np.mean((adaptive - even) ** 2 / (even**2 + 0.01))) < 0.04
    assert adaptive.mean() == pytest.approx(even.mean(), rel=0.01)
