"""How far the fakes are: depth of field and motion blur of the darkroom against rendered ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import daguerre as dg
from tests.support.scene.motion_scenes import TIME, card, move

SIZE = (150, 100)
OPTIONS = {"resolution": SIZE, "spp": 64, "filter": "box", "light_paths": "off"}


def relative_error(image: NDArray[np.float32], truth: dg.Frame) -> float:
    """Mean square error over the square of the truth, less the noise of the truth."""
    error = (image - truth.rgb) ** 2 - truth.variance
    return float((error / (truth.rgb**2 + 0.01)).mean())


def cards(*transforms: object) -> dg.Scene:
    """Glowing cards, the last one so large that it fills the frame."""
    scene = dg.Scene(time=TIME)
    for transform, size in zip(transforms, (0.22, 0.5, 6.0), strict=True):
        card(scene, transform, size=size)
    return scene


def test_depth_of_field_is_near_the_rendered_one_before_and_behind_the_focus() -> None:
    scene = cards(move(-0.25, 0.1, -1.3), move(0.35, -0.1, -2), move(0, 0, -6))
    lens = {"focal_length": 50, "f_stop": 0.35, "blades": 5}
    camera = dg.Camera(**lens, focus_distance=2.0, shutter_time=0)
    sharp = dg.render(scene, camera.with_(lens="pinhole"), gt_time="mid", aovs=True, **OPTIONS)
    truth = dg.render(scene, camera, **OPTIONS)
    fake = dg.post.depth_of_field(
        sharp.rgb, sharp.aovs["depth.Z"], **lens, focus=2, sensor=(36, 24)
    )
    before, after = relative_error(sharp.rgb, truth), relative_error(fake, truth)
    assert after < 0.1 * before


def test_motion_blur_is_near_the_rendered_one() -> None:
    def along(x: float, y: float, z: float, way: float) -> dg.Keys:
        return dg.keys([(TIME + t, move(x + 24 * t * way, y, z)) for t in (-1, 1)])

    scene = cards(along(-0.35, 0.1, -1.3, 0.2), move(0.4, -0.1, -2), along(0, 0, -6, -0.5))
    camera = dg.Camera(lens="pinhole", focal_length=35, shutter_angle=180)
    still = dg.render(
        scene, camera.with_(shutter_angle=0), gt_time="mid", motion=True, aovs=True, **OPTIONS
    )
    truth = dg.render(scene, camera, **OPTIONS)
    fake = dg.post.motion_blur(still.rgb, still.motion, still.aovs["depth.Z"])
    blind = dg.post.motion_blur(still.rgb, still.motion)
    before, after = relative_error(still.rgb, truth), relative_error(fake, truth)
    assert np.nanmax(np.abs(still.motion)) > 15
    assert after < 0.1 * before
    assert after < relative_error(blind, truth) < before
