"""Several cameras in one scene: stereo pairs, and rigs of robots and cars."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.camera.exposure_mode import is_automatic
from daguerre.checks import number, short
from daguerre.errors import InputError, UsageError
from daguerre.frame.frame import Frame
from daguerre.parameters.keywords import takes
from daguerre.scene.far import Place
from daguerre.scene.scene import Scene
from daguerre.setup.built_scene import BuiltScene
from daguerre.setup.pose import moved_right
from daguerre.setup.stereo import stereo_note
from daguerre.setup.straight import straight_focal_px

from .auto_exposure import Chosen, choose
from .keywords import RigKeywords, settings_of
from .parameters import TABLE
from .render import finish
from .session import Session
from .settings import RenderSettings


@takes(TABLE, RigKeywords)
@guarded(but=("cameras",))
def render_rig(
    scene: Scene,
    cameras: Mapping[str, Camera | str],
    *,
    resolution: tuple[int, int] | None = None,
    settings: RenderSettings | None = None,
    **keywords: Unpack[RigKeywords],
) -> dict[str, Frame]:
    """Renders a picture for each camera; the scene is built once.

    All cameras use the same random numbers. So each frame is bit-identical to ``render`` with that
    camera alone, unless it is some 1000 m from the first camera (:mod:`daguerre.setup.origin`), and
    cameras with similar views have similar noise. Cameras with the same automatic
    exposure mode share the exposure that a meter chooses for the first of them.

    Args:
        scene: The scene.
        cameras: Cameras by name, or names of the scene's cameras.
        resolution: Width and height of all pictures, px; default: each calibrated camera's own,
            else as in the settings.
        settings: How they are rendered; the keywords change it.
        {keywords}

    Returns:
        The frames, by name.
    """
    named: Any = cameras
    if not isinstance(named, Mapping) or not named:
        raise UsageError(f"cameras: wanted cameras by name, got {short(named)}")
    common = settings_of(settings, keywords)
    frames: dict[str, Frame] = {}
    built: BuiltScene | None = None
    origin: Place | None = None
    chosen: dict[str, Chosen] = {}
    for name, given in cameras.items():
        camera = given if isinstance(given, Camera) else scene.camera(given)
        own = camera.projection.size if camera.projection else common.film.resolution
        sized = common.with_(resolution=resolution or own)
        choice = None
        if is_automatic(camera.exposure):
            if camera.exposure not in chosen:
                chosen[camera.exposure], built = choose(scene, camera, sized, built)
            choice = chosen[camera.exposure]
            camera = choice.of(camera)
        session = Session(scene, camera, settings=sized, built=built, origin=origin)
        session.metering = {} if choice is None else choice.facts
        frames[name] = finish(session)
        built, origin = session.built, session.built.origin
    return frames


@guarded
def stereo_pair(camera: Camera, baseline: float) -> dict[str, Camera]:
    """Makes a stereo pair of parallel cameras, with the given camera midway between them.

    They move with it. A ``UserWarning`` says that the sides of a panorama or of a wide fisheye have
    no parallax.

    Args:
        camera: Camera that gives pose and all parameters.
        baseline: Distance between the two cameras, m.
    """
    number(baseline, "stereo_pair: baseline", above=0)
    if note := stereo_note(camera):
        warnings.warn(note, stacklevel=3)  # in the caller of the guarded function
    return {
        name: moved_right(camera, side * baseline)
        for name, side in (("left", -0.5), ("right", 0.5))
    }


def check_straight(metadata: dict[str, Any]) -> None:
    """Checks that a camera images straight lines as straight lines, as disparity needs.

    Raises:
        InputError: The camera has distortion.
    """
    straight_focal_px(metadata, "disparity")


@guarded
def disparity(frame: Frame, baseline: float) -> NDArray[np.float32]:
    """Returns the disparity of a stereo pair, px: x_left - x_right of the same point.

    For both pictures it is focal length x baseline / depth; 0 where there is no surface.

    Args:
        frame: Left or right frame, with ground truth (``gt_time``) by chief rays, from a pinhole, a
            thin lens or a rectilinear projection.
        baseline: Distance between the cameras of the pair, m.

    Returns:
        Disparity, px, shape (H, W).

    Raises:
        InputError: The frame has another kind of camera, or no ground truth by chief rays.
    """
    number(baseline, "disparity: baseline", above=0)
    focal = straight_focal_px(frame.metadata, "disparity")
    depth = frame.aovs.get("depth.Z")
    if depth is None or "gt_time" not in frame.metadata:
        raise InputError("disparity: wanted exact depth, got none; render with gt_time='mid'")
    if (lens := frame.metadata.get("gt_lens", "chief")) != "chief":
        raise InputError(f"disparity: wanted gt_lens='chief', got {lens!r}")
    apart = focal * baseline
    return np.where(depth > 0, apart / np.maximum(depth, 1e-30), 0).astype(np.float32)
