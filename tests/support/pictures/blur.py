"""A blurred frame against the mean of still ones, and what a still one is.

A still frame is the same world at one moment, as plain values: nothing of it moves, and its shutter
stays frozen. So none of the machinery of motion has a part in it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre as dg
from daguerre.scene.motion import SceneMotion
from tests.support.pictures.statistical import differences

Pictures = NDArray[np.float64]
#: Weight of a still frame at a moment (s) in each pixel, broadcast to (H, W); its mean over the
#: moments from ``begin`` to ``end`` is what a shutter lets through.
Window = Callable[[float], Any]

#: Chance that one case fails though all is right, by pixels, by blocks and by the mean.
ALPHA = 1e-4


@dataclass(frozen=True)
class Case:
    """A world that moves while the shutter is open.

    Attributes:
        scene: At the time of the frame, with its motion.
        camera: With its shutter.
        interval: When light is let in, s.
        still: Scene and camera of one moment, as plain values.
        window: Weight of the still frame of one moment.
        options: Options of ``dg.render``.
    """

    scene: dg.Scene
    camera: dg.Camera
    interval: tuple[float, float]
    still: Callable[[float], tuple[dg.Scene, dg.Camera]]
    window: Window = lambda t: 1.0
    options: dict[str, Any] = field(default_factory=dict)

    @property
    def settings(self) -> dict[str, Any]:
        """Options of ``dg.render``: small and in equal boxes, unless the case says otherwise."""
        return {"resolution": (24, 16), "filter": "box", "max_depth": 4} | self.options


def case(
    scene: dg.Scene,
    camera: dg.Camera,
    shutter_time: float,
    window: Window = lambda t: 1.0,
    **options: Any,
) -> Case:
    """A shutter that opens and closes at once around the time of the scene.

    Args:
        scene: With its motion.
        camera: Any.
        shutter_time: s.
        window: Weight of moments, see :class:`Case`.
        **options: Options of ``dg.render``.
    """

    def still(t: float) -> tuple[dg.Scene, dg.Camera]:
        return without_motion(scene.at(t)), camera.frozen_at(t).with_(shutter_time=0.0)

    half = 0.5 * shutter_time
    interval = scene.time - half, scene.time + half
    opened = camera.with_(shutter_time=shutter_time)
    return Case(scene, opened, interval, still, window, options)


def without_motion(scene: dg.Scene) -> dg.Scene:
    """The moment that a scene shows, as plain values."""
    return replace(scene, motion=SceneMotion())


def blurred(case: Case, batches: int, spp: int, seed: int = 1) -> Pictures:
    """Independent frames with the shutter open, (batches, H, W, 3)."""
    return _frames(case.scene, case.camera, case, batches, spp, seed)


def frozen(case: Case, batches: int, spp: int, seed: int = 3) -> Pictures:
    """The same with the shutter open for no time: what a renderer without blur shows."""
    begin, end = case.interval
    scene, camera = case.still(0.5 * (begin + end))
    return _frames(scene, camera, case, batches, spp, seed)


def mean_of_stills(case: Case, batches: int, moments: int, spp: int, seed: int = 2) -> Pictures:
    """Means of still frames at random moments, one in each of so many equal parts of the interval.

    The moments make the mean unbiased; so do few of them. Shape (batches, H, W, 3).
    """
    random = np.random.default_rng(seed)
    begin, end = case.interval
    settings = {"light_paths": "off"} | case.settings  # a trial of `auto` takes as long as a still
    out = []
    for batch in range(batches):
        total: Any = 0.0
        for i in range(moments):
            t = begin + (i + random.random()) / moments * (end - begin)
            scene, camera = case.still(t)
            number = (seed << 32) + batch * moments + i
            frame = dg.render(scene, camera, spp=spp, seed=number, **settings)
            weight = np.broadcast_to(case.window(t), frame.rgb.shape[:2])[..., None]
            total = total + weight * frame.rgb.astype(np.float64)
        out.append(total / moments)
    return np.array(out)


def disagreement(a: Pictures, b: Pictures) -> list[str]:
    """Differences in the mean; empty: none."""
    return differences(a, b, alpha=ALPHA)


def _frames(
    scene: dg.Scene, camera: dg.Camera, case: Case, batches: int, spp: int, seed: int
) -> Pictures:
    return np.array(
        [
            dg.render(scene, camera, spp=spp, seed=(seed << 32) + i, **case.settings).rgb
            for i in range(batches)
        ],
        np.float64,
    )
