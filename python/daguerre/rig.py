"""Several cameras that see one scene: stereo pairs, and rigs of robots and cars."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .built_scene import BuiltScene
from .camera import Camera
from .camera_pose import moved_right
from .checks import number, short
from .errors import UsageError
from .frame import Frame
from .scene import Scene
from .session import Session, finish


def render_rig(
    scene: Scene,
    cameras: Mapping[str, Camera | str],
    *,
    spp: int | None = None,
    noise: float | None = None,
    resolution: tuple[int, int] | None = None,
    **options: Any,
) -> dict[str, Frame]:
    """Renders a picture by each camera; the scene is built once.

    All cameras draw the same random numbers, so each frame has the bits of ``render`` with that
    camera alone, and the noise of two cameras that see nearly the same is nearly the same.

    Args:
        scene: What is seen.
        cameras: By name; or names of the scene's cameras.
        spp: As of :func:`render`.
        noise: As of :func:`render`.
        resolution: Of all pictures, px; None: each calibrated camera's own, else 960 x 540.
        **options: As of :class:`Session`.

    Returns:
        The frames, by name.
    """
    named: Any = cameras
    if not isinstance(named, Mapping) or not named:
        raise UsageError(f"cameras: wanted cameras by name, got {short(named)}")
    frames: dict[str, Frame] = {}
    built: BuiltScene | None = None
    for name, given in cameras.items():
        camera = given if isinstance(given, Camera) else scene.camera(given)
        size = resolution or (camera.projection.size if camera.projection else (960, 540))
        session = Session(scene, camera, resolution=size, built=built, **options)
        frames[name] = finish(session, spp, noise)
        built = session.built
    return frames


def stereo_pair(camera: Camera, baseline: float) -> dict[str, Camera]:
    """Two cameras side by side, in whose middle the given one stands; they look in parallel.

    Where it moves, they move with it.

    Args:
        camera: It gives all else.
        baseline: Between them, m.
    """
    number(baseline, "stereo_pair: baseline", above=0)
    return {
        name: moved_right(camera, side * baseline)
        for name, side in (("left", -0.5), ("right", 0.5))
    }
