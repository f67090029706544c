"""The wall between a photographer's camera and the core's: names and units become mm, m and rays.

All lengths in mm unless the name says otherwise. Distances of focus are m.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre import lenses
from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.exposure import exposure_facts, exposure_notes, lens_h0
from daguerre.camera.overscan import NONE, Overscan
from daguerre.camera.parameters import CAMERA
from daguerre.camera.parameters.needs import TRACED
from daguerre.camera.projection import Projection, check_resolution
from daguerre.checks import short
from daguerre.errors import InputError, UsageError
from daguerre.scene.scene import Scene

from . import lens as camera_prescription
from . import tilt
from .checks import check, lens_and_model
from .film import frame_size
from .focus import Focus, ideal_direction
from .iris import iris_facts, iris_of
from .lens_motion import LensMotion
from .pose import motion_facts
from .pose import pose as pose_over

DEFAULT_FOCAL_LENGTH: float = CAMERA["focal_length"].usual


@dataclass
class CameraSetup:
    """A camera that is ready to draw.

    Attributes:
        core: The core's camera.
        frame_size: Size of the picture on the film, mm.
        pinhole_focal_length: Film distance of the pinhole with the same framing, mm.
        notes: Decisions made on the user's behalf, one sentence each.
        facts: Camera parameters as resolved; for metadata and hashes, JSON-able.
    """

    core: _core.Camera
    frame_size: tuple[float, float]
    pinhole_focal_length: float
    notes: list[str] = field(default_factory=list)
    facts: dict[str, Any] = field(default_factory=dict)


def set_up(
    scene: Scene,
    camera: Camera,
    resolution: tuple[int, int],
    core_scene: _core.Scene | None,
    overscan: Overscan = NONE,
) -> CameraSetup:
    """Resolves names, focus and f-stop of a camera.

    Args:
        scene: For ``focus_on``.
        camera: In a photographer's terms.
        resolution: Width and height, px.
        core_scene: For autofocus; None: autofocus gives infinity.
        overscan: Pixels beside the frame that are drawn, too.

    Raises:
        UsageError: A parameter that is wrong, or that the chosen kind of lens cannot honour.
        InputError: The lens file cannot be used, the lens cannot focus or open so far, or the scene
            has no such node.
    """
    if not isinstance(camera, Camera):
        raise UsageError(f"camera: wanted a Camera, got {short(camera)}")
    lens, model = lens_and_model(camera)
    begin, end = shutter.interval(camera, scene.time, resolution)
    pose = pose_over(camera, begin, end)
    world = pose.at(0.5)
    facts = motion_facts(camera, begin, end)
    moving = camera  # what is said of a camera is said of mid-shutter
    camera = moving.at(0.5 * (begin + end))
    size = frame_size(camera, resolution)
    if camera.projection is not None:
        check_resolution(camera.projection, resolution)
        size = (camera.sensor_size[0], camera.sensor_size[0] * resolution[1] / resolution[0])
    check(camera, model, prescription=lens is not None)
    setup = CameraSetup(core=cast("Any", None), frame_size=size, pinhole_focal_length=0)
    focus = Focus(scene, camera, resolution, size, world, core_scene, setup.notes)
    film = _film_size(size, resolution, overscan)
    _set_up_lens(setup, camera, lens, model, pose, focus, film)

    traced = []  # models of the states of a lens that changes

    def lens_of(now: Camera) -> _core.Camera:
        """Makes the lens of another moment, whose focus distance is known."""
        like = setup.facts.get("lens_model", model)  # what stands in for it at mid-shutter
        now = now if like == model else now.with_(lens_model=like)
        check(now, like, prescription=lens is not None)
        made = CameraSetup(core=cast("Any", None), frame_size=size, pinhole_focal_length=0)
        known = Focus(scene, now, resolution, size, world, None, [])
        _set_up_lens(made, now, lens, like, pose, known, film)
        traced.append(made.facts.get("lens_model", like))
        return made.core

    if any(camera.tilt) and model != "pinhole":
        setup.notes.append(tilt.note(camera.tilt, setup.facts["focal_length_mm"]))
    changing = set(facts.get("motion", {})) - {"transform"}
    if changing:
        parts = setup.facts.get("focus_distance_m"), setup.facts.get("f_stop")
        behind = 1e-3 * setup.facts.get("entrance_pupil_offset_mm", 0.0) / tilt.cosine(camera.tilt)
        lens_motion = LensMotion(moving, changing, begin, end, *parts, behind, lens_of)
        states = model in (*TRACED, "thick")  # as opposed to ideal lenses, which blend
        efl = setup.facts["effective_focal_length_mm"] if states else None
        note = lens_motion.apply(setup.core, efl, size, size[0] / resolution[0])
        setup.notes += [note] if note else []
        if "polynomial" in traced and "exact" in traced:
            setup.notes.append(
                f"{traced.count('exact')} of the {len(traced)} states of the lens are not fitted "
                "well enough: the exact lens draws them"
            )
    setup.facts["h0"] = lens_h0(camera, setup.facts, setup.pinhole_focal_length)
    setup.notes += exposure_notes(camera, setup.facts, shutter.shutter_time(camera))
    setup.facts = (
        {"lens_model": model}
        | setup.facts
        | {
            "sensor_size_mm": list(camera.sensor_size),
            "frame_size_mm": list(size),
            "sensor_fit": camera.sensor_fit,
            "shift_mm": list(camera.shift),
            "tilt_deg": list(camera.tilt),
            "world_from_camera": np.asarray(world).tolist(),
            "iso": camera.iso,
            "exposure_compensation": camera.exposure_compensation,
            **exposure_facts(camera),
            "shutter": shutter.facts(camera, resolution),
            **facts,
        }
    )
    return setup


def _film_size(
    size: tuple[float, float], resolution: tuple[int, int], overscan: Overscan
) -> tuple[float, float]:
    """Width and height (mm) of the film around the frame's middle that has all that is drawn."""
    across, along = (
        pixels * mm / count
        for pixels, mm, count in zip(
            (max(overscan.left, overscan.right), max(overscan.top, overscan.bottom)),
            size, resolution, strict=True,
        )
    )  # fmt: skip
    return size[0] + 2 * across, size[1] + 2 * along


def _set_up_lens(
    setup: CameraSetup,
    camera: Camera,
    lens: lenses.Lens | None,
    model: str,
    pose: _core.Motion,
    focus: Focus,
    film: tuple[float, float],
) -> None:
    if lens is not None:
        real = camera_prescription.set_up(camera, lens, model, film, pose, focus)
        setup.core, setup.pinhole_focal_length = real.core, real.pinhole_focal_length
        setup.facts |= real.facts
    elif camera.projection is not None:
        _set_up_projection(setup, camera, camera.projection, pose, focus)
    elif model == "pinhole":
        _set_up_pinhole(setup, camera, pose)
    else:
        _set_up_thin(setup, camera, pose, focus)


def _set_up_projection(
    setup: CameraSetup, camera: Camera, projection: Projection, pose: _core.Motion, focus: Focus
) -> None:
    film = projection.film(setup.frame_size[0])
    focal = math.sqrt(film["focal_mm"][0] * film["focal_mm"][1])
    radius = 0.0 if camera.f_stop is None else focal / camera.f_stop / 2

    def direction(x: float, y: float) -> NDArray[np.float64]:
        (fx, fy), (cx, cy) = film["focal_mm"], film["principal_mm"]
        seen = projection.core.unproject(np.array([[(x - cx) / fx, (cy - y) / fy]]))[0]
        if not np.isfinite(seen).all():
            raise UsageError("camera: focus_at: the projection sees nothing there")
        return np.asarray(seen * (1, -1, -1))

    if projection.is_wide:  # what is sharp lies on a sphere
        focus.sharp_at = lambda point: float(np.linalg.norm(point))
    distance = focus.distance(direction) if radius > 0 else math.inf
    setup.core = _core.Camera.projection(
        pose,
        projection.core,
        film["focal_mm"],
        film["principal_mm"],
        radius,
        distance,
        iris_of(camera),
    )
    setup.pinhole_focal_length = focal
    setup.facts |= {
        "lens": "projection",
        "focal_length_mm": focal,
        "projection": projection.facts(),
    }
    if radius > 0:
        setup.facts |= {
            "f_stop": camera.f_stop,
            "aperture_diameter_mm": 2 * radius,
            "focus_distance_m": distance,
            **iris_facts(camera),
        }


def _set_up_pinhole(setup: CameraSetup, camera: Camera, pose: _core.Motion) -> None:
    f = camera.focal_length or DEFAULT_FOCAL_LENGTH
    setup.core = _core.Camera.pinhole(pose, f, camera.natural_vignetting)
    setup.pinhole_focal_length = f
    setup.facts |= {"lens": "pinhole", "focal_length_mm": f}


def _set_up_thin(setup: CameraSetup, camera: Camera, pose: _core.Motion, focus: Focus) -> None:
    f = camera.focal_length or DEFAULT_FOCAL_LENGTH
    f_stop = camera.f_stop or camera.t_stop  # without glass they are the same
    diameter = camera.aperture_diameter or f / (f_stop or camera_prescription.DEFAULT_F_STOP)
    if any(camera.tilt):
        focus.sharp_at = _sharp_when_tilted(camera, f)
    distance = focus.settled(lambda s: ideal_direction(_film_distance(camera, f, s)))
    if camera.focus_from == "sensor" and camera.focus_distance is not None:
        distance = _from_pupil(distance, f)
    film = _film_distance(camera, f, distance)
    setup.core = _core.Camera.thin(
        pose, film, diameter / 2, distance, iris_of(camera), camera.natural_vignetting, camera.tilt
    )
    setup.pinhole_focal_length = film
    setup.facts |= {
        "lens": "thin",
        "focal_length_mm": f,
        "f_stop": f / diameter,
        "aperture_diameter_mm": diameter,
        "focus_distance_m": distance,
        "focus_breathing": camera.focus_breathing,
        **iris_facts(camera),
    }


def _film_distance(camera: Camera, f: float, distance: float) -> float:
    """Along the camera's axis, mm: that of the pinhole with the same framing."""
    if not camera.focus_breathing:
        return f
    if not distance * 1e3 > f:
        raise InputError(
            f"camera: focus_distance: a {f:g} mm lens wanted more than {f * 1e-3:g} m, "
            f"got {distance:g} m"
        )
    film = f if math.isinf(distance) else f * distance * 1e3 / (distance * 1e3 - f)
    return film * tilt.cosine(camera.tilt)  # where the lens's axis meets it


def _sharp_when_tilted(camera: Camera, f: float) -> Callable[[NDArray[np.float64]], float]:
    if camera.focus_breathing:
        return lambda point: tilt.focus_on(tilt.Imaging.thin(f), camera.tilt, point)
    return lambda point: tilt.focus_still(f, camera.tilt, point)


def _from_pupil(total_m: float, f: float) -> float:
    """Object distance (m) of a thin lens at a given distance from object to film.

    Source: Kolb 1995, section 3.2: s + s' = T and s s' = f T.
    """
    if math.isinf(total_m):
        return total_m
    total = total_m * 1e3
    if total < 4 * f:
        raise InputError(
            f"camera: focus_distance from the sensor: a {f:g} mm lens wanted at least "
            f"{4e-3 * f:g} m, got {total_m:g} m"
        )
    image = (total - math.sqrt(total * (total - 4 * f))) / 2
    return (total - image) * 1e-3
