"""Set-up of a camera: converts a photographer's parameters to the core's camera.

Lengths are in mm unless the name says otherwise. Focus distances are in m.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import daguerre._core as _core
from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.exposure import check_exposure
from daguerre.camera.ideal import WITHOUT_IRIS
from daguerre.camera.overscan import NONE, Overscan
from daguerre.camera.projection import check_resolution
from daguerre.camera.settled import settled
from daguerre.checks import as_readonly, short
from daguerre.errors import UsageError
from daguerre.scene.far import origin_near
from daguerre.scene.scene import Scene

from . import ideal, tilt
from .checks import check, lens_and_model
from .film import frame_size
from .focus import Focus
from .framing import Framing
from .near_clip import set_near_clip
from .pose import changes
from .pose import pose as pose_over
from .resolved import ResolvedCamera, ResolvedLens

if TYPE_CHECKING:
    from daguerre.lenses import Lens


def set_up(
    scene: Scene,
    camera: Camera,
    resolution: tuple[int, int],
    core_scene: _core.Scene | None,
    overscan: Overscan = NONE,
) -> ResolvedCamera:
    """Resolves names, focus and f-stop of a camera.

    Args:
        scene: For ``focus_on``.
        camera: Camera to set up.
        resolution: Width and height of the picture, px.
        core_scene: Scene for autofocus; None: autofocus gives infinity.
        overscan: Extra pixels to draw around the frame.

    Raises:
        UsageError: A parameter is wrong, or the lens model does not support it.
        InputError: The lens file cannot be used, the lens has no such focus or stop, or the scene
            has no such node.
    """
    if not isinstance(camera, Camera):
        raise UsageError(f"camera: wanted a Camera, got {short(camera)}")
    camera = settled(camera, scene.time)
    prescription, model = lens_and_model(camera)
    begin, end = shutter.interval(camera, scene.time, resolution)
    pose = pose_over(camera, begin, end)
    world_from_camera = pose.at(0.5)
    origin = origin_near(world_from_camera[:3, 3]) if core_scene is None else core_scene.origin
    changing = changes(camera, begin, end)
    frozen = camera.frozen_at(0.5 * (begin + end))  # facts of a camera are those at mid-exposure
    size = _picture_size(frozen, resolution)
    check(frozen, model, prescription=prescription is not None)
    focus = Focus(scene, frozen, resolution, size, world_from_camera, core_scene)
    framing = Framing(
        frozen, pose.relative_to(origin), focus, _film_size(size, resolution, overscan)
    )
    lens = _set_up_lens(framing, prescription, model)
    notes = [*lens.notes]
    if any(frozen.tilt) and model not in WITHOUT_IRIS:
        notes.append(tilt.note(frozen.tilt, lens.focal_length_mm))

    def lens_of(moment: Camera) -> ResolvedLens:
        """Makes the lens at another moment, with a known focus distance."""
        drawn_model = lens.model  # the model that draws, which may replace a polynomial
        moment = moment if drawn_model == model else moment.with_(lens_model=drawn_model)
        check(moment, drawn_model, prescription=prescription is not None)
        known = replace(focus, camera=moment, core_scene=None)
        return _set_up_lens(replace(framing, camera=moment, focus=known), prescription, drawn_model)

    if lens_changes := set(changing) - {"transform"}:
        from .lens_motion import LensMotion

        motion = LensMotion(camera, lens_changes, begin, end, lens, lens_of)
        notes += motion.apply(size, framing.pitch_mm)
    set_near_clip(lens.core, frozen, size)
    return ResolvedCamera(
        camera=frozen,
        lens=lens,
        resolution=resolution,
        interval_s=(begin, end),
        world_from_camera=as_readonly(np.asarray(world_from_camera, np.float64)),
        origin=origin,
        frame_size_mm=size,
        shift_mm=frozen.shift,
        changes=changing,
        light_notes=tuple(notes),
    )


def with_brightness_of(setup: ResolvedCamera, camera: Camera) -> ResolvedCamera:
    """Returns the set-up of a camera that differs in its exposure alone.

    Args:
        setup: Set-up of the first camera.
        camera: The second camera, settled.

    Raises:
        UsageError: The exposure of the second camera is wrong.
    """
    begin, end = setup.interval_s
    frozen = camera.frozen_at(0.5 * (begin + end))
    check_exposure(frozen)
    return replace(setup, camera=frozen)


def _picture_size(camera: Camera, resolution: tuple[int, int]) -> tuple[float, float]:
    """Width and height (mm) of the picture on the film."""
    size = frame_size(camera, resolution)
    if camera.projection is None:
        return size
    check_resolution(camera.projection, resolution)
    width = camera.sensor_size[0]
    return width, width * resolution[1] / resolution[0]


def _film_size(
    size: tuple[float, float], resolution: tuple[int, int], overscan: Overscan
) -> tuple[float, float]:
    """Width and height (mm) of the film, centred on the frame, that includes the overscan."""
    across, along = (
        pixels * mm / count
        for pixels, mm, count in zip(
            (max(overscan.left, overscan.right), max(overscan.top, overscan.bottom)),
            size, resolution, strict=True,
        )
    )  # fmt: skip
    return size[0] + 2 * across, size[1] + 2 * along


def _set_up_lens(framing: Framing, prescription: Lens | None, model: str) -> ResolvedLens:
    if prescription is None:
        return ideal.set_up(framing, model)
    from . import lens

    return lens.set_up(framing, prescription, model)
