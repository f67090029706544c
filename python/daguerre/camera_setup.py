"""The wall between a photographer's camera and the core's: names and units become mm, m and rays.

All lengths in mm unless the name says otherwise. Distances of focus are m.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core

from . import lenses
from .camera import IDEAL, LIMITS, Camera
from .checks import number, numbers, short, whole
from .errors import InputError, UsageError, suggest
from .scene import Scene

DEFAULT_FOCAL_LENGTH = 50.0
DEFAULT_F_STOP = 5.6
MODELS = ("exact", "thin", "pinhole")
_VERTICES_AT_ONCE = 1 << 18
FITS = ("horizontal", "vertical", "auto", "fill")


@dataclass
class CameraSetup:
    """A camera that is ready to draw.

    Attributes:
        core: The core's camera.
        frame_size: What the picture covers of the film (mm).
        pinhole_focal_length: Film distance of the pinhole with the same framing, mm.
        notes: What was decided on the user's behalf, one sentence each.
        facts: Camera parameters as resolved; for metadata and hashes, JSON-able.
    """

    core: _core.Camera
    frame_size: tuple[float, float]
    pinhole_focal_length: float
    notes: list[str] = field(default_factory=list)
    facts: dict[str, Any] = field(default_factory=dict)


def frame_size(camera: Camera, resolution: tuple[int, int]) -> tuple[float, float]:
    """Width and height (mm) of the part of the film that a picture of this resolution covers."""
    width, height = numbers(camera.sensor_size, "camera: sensor_size", 2, "two positive mm")
    low, high = LIMITS["sensor_size"]
    if not (low <= min(width, height) and max(width, height) <= high):
        raise UsageError(
            f"camera: sensor_size: wanted {low:g} .. {high:g} mm, got {camera.sensor_size}"
        )
    columns, rows = resolution
    if camera.sensor_fit not in FITS:
        raise UsageError(
            f"camera: sensor_fit: wanted {', '.join(FITS)}, got {camera.sensor_fit!r}"
            f"{suggest(str(camera.sensor_fit), FITS)}"
        )
    scale = {  # mm per pixel
        "horizontal": width / columns,
        "vertical": height / rows,
        "auto": width / columns if columns >= rows else height / rows,
        "fill": min(width / columns, height / rows),
    }[camera.sensor_fit]
    return columns * scale, rows * scale


def set_up(
    scene: Scene, camera: Camera, resolution: tuple[int, int], core_scene: _core.Scene | None
) -> CameraSetup:
    """Resolves names, focus and f-stop of a camera.

    Args:
        scene: For ``focus_on``.
        camera: In a photographer's terms.
        resolution: Width and height, px.
        core_scene: For autofocus; None: autofocus gives infinity.

    Raises:
        UsageError: A parameter that is wrong, or that the chosen kind of lens cannot honour.
        InputError: The lens file cannot be used, the lens cannot focus or open so far, or the scene
            has no such node.
    """
    if not isinstance(camera, Camera):
        raise UsageError(f"camera: wanted a Camera, got {short(camera)}")
    lens, model = _lens_and_model(camera)
    size = frame_size(camera, resolution)
    _check(camera, model, prescription=lens is not None)
    world = rigid(camera.transform)
    setup = CameraSetup(core=cast("Any", None), frame_size=size, pinhole_focal_length=0)
    focus = Focus(scene, camera, resolution, size, world, core_scene, setup.notes)
    if lens is not None:
        _set_up_prescription(setup, camera, lens, model, world, focus)
    elif model == "pinhole":
        _set_up_pinhole(setup, camera, world)
    else:
        _set_up_thin(setup, camera, world, focus)
    setup.facts |= {
        "lens_model": model,
        "sensor_size_mm": list(camera.sensor_size),
        "frame_size_mm": list(size),
        "sensor_fit": camera.sensor_fit,
        "shift_mm": list(camera.shift),
        "world_from_camera": np.asarray(world).tolist(),
        "iso": camera.iso,
        "exposure_compensation": camera.exposure_compensation,
        "shutter_time_s": camera.shutter_time,
    }
    return setup


def _lens_and_model(camera: Camera) -> tuple[lenses.Lens | None, str]:
    model = camera.lens_model
    if model is not None and model not in MODELS:
        raise UsageError(
            f"camera: lens_model: wanted {', '.join(MODELS)}, got {model!r}"
            f"{suggest(str(model), MODELS)}"
        )
    if not isinstance(camera.lens, lenses.Lens | str | Path | None):
        raise UsageError(
            f"camera: lens: wanted a name, a file, a Lens or None, got {short(camera.lens)}"
        )
    if camera.lens is None or camera.lens in IDEAL:
        kind = str(camera.lens or "thin")
        if model == "exact":
            raise UsageError(
                "camera: lens_model exact: wanted the name or file of a lens, got none"
            )
        return None, model or kind
    lens = camera.lens if isinstance(camera.lens, lenses.Lens) else lenses.load(camera.lens)
    return lens, model or "exact"


def _check(camera: Camera, model: str, *, prescription: bool) -> None:
    """Values that no lens has, and values that this kind cannot honour."""
    for name in ("focal_length", "f_stop", "aperture_diameter", "iso"):
        value = getattr(camera, name)
        if value is not None:
            hint = name in ("f_stop", "aperture_diameter") and value == 0
            _positive(name, value, "; a pinhole is its own kind: lens='pinhole'" if hint else "")
    if camera.focus_distance is not None:
        _positive("focus_distance", camera.focus_distance, infinite=True)
    if camera.shutter_time is not None:
        number(camera.shutter_time, "camera: shutter_time", 0)
    number(camera.exposure_compensation, "camera: exposure_compensation")
    for shift in numbers(camera.shift, "camera: shift", 2, "two finite numbers (mm)"):
        number(shift, "camera: shift", *LIMITS["shift"])
    whole(camera.blades, "camera: blades", 0, 64, "0 (round) or 3 .. 64")
    number(camera.blade_rotation, "camera: blade_rotation")
    number(camera.blade_curvature, "camera: blade_curvature", -1)
    if camera.focus_at is not None:
        numbers(camera.focus_at, "camera: focus_at", 2, "a pixel (x, y)")
    if prescription and camera.focal_length is not None:
        raise UsageError(
            "camera: focal_length: a lens with a prescription has its own; "
            "wanted none with it, or an ideal lens (lens='thin' or 'pinhole')"
        )
    if (model != "thin" or prescription) and camera.aperture_diameter is not None:
        raise UsageError(f"camera: aperture_diameter: this {model} lens takes f_stop instead")
    if camera.aperture_diameter is not None and camera.f_stop is not None:
        raise UsageError("camera: wanted either f_stop or aperture_diameter, got both")
    if camera.focus_from not in ("pupil", "sensor"):
        raise UsageError(f"camera: focus_from: wanted pupil or sensor, got {camera.focus_from!r}")
    if camera.blades and camera.aperture_image is not None:
        raise UsageError("camera: wanted either blades or aperture_image, got both")
    if model == "exact" and camera.natural_vignetting:
        raise UsageError("camera: natural_vignetting: the exact lens has its own vignetting")


def _positive(name: str, value: Any, hint: str = "", *, infinite: bool = False) -> None:
    low, high = LIMITS.get(name, (0.0, math.inf))
    where = f"camera: {name}"
    try:
        number(value, where, above=0, infinite=infinite)
        number(value, where, low, high, infinite=infinite)
    except UsageError as error:
        raise UsageError(f"{error}{hint}") from None


def rigid(transform: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rotation and position of a transform: a camera has no scale.

    Raises:
        UsageError: The matrix is no 4x4 of finite numbers, or is singular.
    """
    try:
        matrix = np.asarray(transform, np.float64)
    except (TypeError, ValueError):
        raise UsageError(
            f"camera: transform: wanted a 4x4 matrix, got {short(transform)}"
        ) from None
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
        raise UsageError("camera: transform: wanted a finite 4x4 matrix")
    forward, up = -matrix[:3, 2], matrix[:3, 1]
    right = np.cross(forward, up)
    if not (np.linalg.norm(forward) > 0 and np.linalg.norm(right) > 0):
        raise UsageError(
            "camera: transform: wanted a view direction and an up vector, got a singular matrix"
        )
    z = -forward / np.linalg.norm(forward)
    x = right / np.linalg.norm(right)
    out = np.eye(4)
    out[:3, 0], out[:3, 1], out[:3, 2], out[:3, 3] = x, np.cross(z, x), z, matrix[:3, 3]
    return out


def iris_of(camera: Camera) -> _core.Iris:
    """The shape of the iris: round, blades, or a picture."""
    try:
        if camera.aperture_image is not None:
            picture = np.asarray(camera.aperture_image, np.float32)
            if picture.ndim != 2:
                raise UsageError(
                    f"camera: aperture_image: wanted shape (H, W), got {picture.shape}"
                )
            return _core.Iris.image(np.ascontiguousarray(picture))
        if camera.blades:
            return _core.Iris.polygon(camera.blades, camera.blade_rotation, camera.blade_curvature)
    except UsageError:
        raise
    except (TypeError, ValueError) as error:
        raise UsageError(f"camera: {error}") from None
    return _core.Iris()


@dataclass
class Focus:
    """Answers "how far is what shall be sharp": m from the entrance pupil along the axis."""

    scene: Scene
    camera: Camera
    resolution: tuple[int, int]
    frame: tuple[float, float]
    world: NDArray[np.float64]
    core_scene: _core.Scene | None
    notes: list[str]

    def distance(self, direction_of: Callable[[float, float], NDArray[np.float64]]) -> float:
        """The focus distance, m (may be infinite).

        Args:
            direction_of: Unit view direction in the camera's frame of a film point (mm, upright).
        """
        camera = self.camera
        if (
            camera.focus_at is None
            and camera.focus_on is None
            and camera.focus_distance is not None
        ):
            return camera.focus_distance
        if camera.focus_on is not None:
            return self._on_node(camera.focus_on)
        x, y = camera.focus_at or (self.resolution[0] / 2, self.resolution[1] / 2)
        if not (0 <= x <= self.resolution[0] and 0 <= y <= self.resolution[1]):
            raise UsageError(
                f"camera: focus_at: wanted a pixel within {self.resolution[0]} x "
                f"{self.resolution[1]}, got {x:g},{y:g}"
            )
        film_x = (x / self.resolution[0] - 0.5) * self.frame[0] + camera.shift[0]
        film_y = (0.5 - y / self.resolution[1]) * self.frame[1] + camera.shift[1]
        what = f"pixel {x:g},{y:g}" if camera.focus_at else "centre ray"
        return self._along(direction_of(film_x, film_y), what)

    def _along(self, direction: NDArray[np.float64], what: str) -> float:
        hit = None
        if self.core_scene is not None:
            origin = tuple(self.world[:3, 3])
            hit = self.core_scene.first_hit(origin, tuple(self.world[:3, :3] @ direction))
        if hit is None:
            self.notes.append(f"autofocus: {what} meets nothing; focus at infinity")
            return math.inf
        depth = float(hit[0]) * -float(direction[2])
        if not depth > 0:  # the camera stands in a surface
            self.notes.append(f"autofocus: {what} begins on a surface; focus at infinity")
            return math.inf
        self.notes.append(f"autofocus: {what} meets a surface {depth:.4g} m away")
        return depth

    def _on_node(self, name: str) -> float:
        """Depth of the visible surface in the middle of the node, else of its nearest vertex."""
        scene = self.scene
        if name not in scene.node_positions and name not in scene.nodes:
            known = set(scene.node_positions) | set(scene.nodes)
            raise InputError(f"camera: focus_on: no node named {name!r}{suggest(name, known)}")
        instances = scene.nodes.get(name, [])
        eye, axis = self.world[:3, 3], -self.world[:3, 2]
        if not instances:
            depth = float((scene.node_positions[name] - eye) @ axis)
            return self._in_front(name, depth, "is")
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        nearest, farthest = math.inf, -math.inf
        for points in _world_vertices(scene, instances):
            low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
            depths = (points - eye) @ axis
            nearest = min(nearest, float(np.where(depths > 0, depths, math.inf).min()))
            farthest = max(farthest, float(depths.max()))
        middle = (low + high) / 2 - eye
        if self.core_scene is not None and middle @ axis > 0:
            hit = self.core_scene.first_hit(tuple(eye), tuple(middle))
            if hit is not None and hit[1] in instances:
                depth = hit[0] * float(middle @ axis) / float(np.linalg.norm(middle))
                return self._in_front(name, depth, "has its visible middle")
        depth = nearest if nearest < math.inf else farthest
        return self._in_front(name, depth, "has its nearest vertex")

    def _in_front(self, name: str, depth: float, verb: str) -> float:
        if not depth > 0:
            raise InputError(
                f"camera: focus_on: node {name!r} lies behind the camera ({depth:.4g} m)"
            )
        self.notes.append(f"focus: node {name!r} {verb} {depth:.4g} m away")
        return depth


def _world_vertices(scene: Scene, instances: list[int]) -> Iterator[NDArray[np.float64]]:
    """Vertices of instances, shape (N, 3), m: in pieces, as a forest has more than fit."""
    by_mesh: dict[int, list[int]] = {}
    for i in instances:
        by_mesh.setdefault(scene.instances[i].mesh, []).append(i)
    for mesh, users in by_mesh.items():
        points = scene.meshes[mesh].positions.astype(np.float64)
        at_once = max(1, _VERTICES_AT_ONCE // max(1, len(points)))
        for start in range(0, len(users), at_once):
            piece = np.array([scene.instances[i].transform for i in users[start : start + at_once]])
            world = points @ piece[:, :3, :3].swapaxes(1, 2) + piece[:, None, :3, 3]
            if world.size:
                yield world.reshape(-1, 3)


def ideal_direction(film_distance: float) -> Callable[[float, float], NDArray[np.float64]]:
    """View direction of a film point through the centre of an ideal lens."""

    def direction(x: float, y: float) -> NDArray[np.float64]:
        d = np.array([x, y, -film_distance])
        return np.asarray(d / np.linalg.norm(d))

    return direction


def _set_up_pinhole(setup: CameraSetup, camera: Camera, world: NDArray[np.float64]) -> None:
    f = camera.focal_length or DEFAULT_FOCAL_LENGTH
    setup.core = _core.Camera.pinhole(world, f, camera.natural_vignetting)
    setup.pinhole_focal_length = f
    setup.facts |= {"lens": "pinhole", "focal_length_mm": f}


def _set_up_thin(
    setup: CameraSetup, camera: Camera, world: NDArray[np.float64], focus: Focus
) -> None:
    f = camera.focal_length or DEFAULT_FOCAL_LENGTH
    diameter = camera.aperture_diameter or f / (camera.f_stop or DEFAULT_F_STOP)
    distance = focus.distance(ideal_direction(f))
    if camera.focus_from == "sensor" and camera.focus_distance is not None:
        distance = _from_pupil(distance, f)
    film = f
    if camera.focus_breathing:
        if not distance * 1e3 > f:
            raise InputError(
                f"camera: focus_distance: a {f:g} mm lens wanted more than {f * 1e-3:g} m, "
                f"got {distance:g} m"
            )
        film = f if math.isinf(distance) else f * distance * 1e3 / (distance * 1e3 - f)
    setup.core = _core.Camera.thin(
        world, film, diameter / 2, distance, iris_of(camera), camera.natural_vignetting
    )
    setup.pinhole_focal_length = film
    setup.facts |= {
        "lens": "thin",
        "focal_length_mm": f,
        "f_stop": f / diameter,
        "aperture_diameter_mm": diameter,
        "focus_distance_m": distance,
        "focus_breathing": camera.focus_breathing,
        **_iris_facts(camera),
    }


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


def _iris_facts(camera: Camera) -> dict[str, Any]:
    if camera.aperture_image is not None:
        image = np.ascontiguousarray(camera.aperture_image, np.float32)
        return {"aperture_image_sha256": hashlib.sha256(image.tobytes()).hexdigest()}
    return {
        "blades": camera.blades,
        "blade_rotation_deg": camera.blade_rotation,
        "blade_curvature": camera.blade_curvature,
    }


def _set_up_prescription(
    setup: CameraSetup,
    camera: Camera,
    lens: lenses.Lens,
    model: str,
    world: NDArray[np.float64],
    focus: Focus,
) -> None:
    """A real lens: traced exactly, or replaced by the ideal lens of the same framing and blur."""
    order = lens.first_order()
    f_stop = camera.f_stop or max(DEFAULT_F_STOP, order.f_number)
    from_sensor = camera.focus_from == "sensor" and camera.focus_distance is not None
    direction = ideal_direction(order.efl)
    if camera.focus_at is not None and model == "exact":
        far = _exact_lens(lens, camera, setup.frame_size, f_stop, math.inf, False)

        def direction(x: float, y: float) -> NDArray[np.float64]:
            return np.array(far.chief_direction(x, y))

    distance = focus.distance(direction)
    exact = _exact_lens(lens, camera, setup.frame_size, f_stop, distance, from_sensor)
    if from_sensor:  # the film's place is known now, and with it the way to the pupil
        distance -= (exact.film_z_mm - order.entrance_pupil.z) * 1e-3
    film = framing_distance(order, exact.film_distance_mm, distance)
    if model == "exact":
        setup.core = _core.Camera.exact(world, exact)
    elif model == "thin":
        radius = order.efl / f_stop / 2
        setup.core = _core.Camera.thin(
            world, film, radius, distance, iris_of(camera), camera.natural_vignetting
        )
    else:
        setup.core = _core.Camera.pinhole(world, film, camera.natural_vignetting)
    setup.pinhole_focal_length = film
    setup.facts |= {
        "lens": lens.name,
        "lens_sha256": _hash_lens(lens),
        "coating": lens.coating,
        "focal_length_mm": lens.nominal.efl_mm or order.efl,
        "effective_focal_length_mm": order.efl,
        "f_stop": f_stop,
        "focus_distance_m": distance,
        "entrance_pupil_offset_mm": exact.film_z_mm - order.entrance_pupil.z,
        "h0": exact.h0,
        "transmittance": exact.transmittance,
        **_iris_facts(camera),
    }


def framing_distance(
    order: lenses.FirstOrder, film_distance: float, focus_distance_m: float
) -> float:
    """Film distance (mm) of the pinhole, at the entrance pupil, with the framing of a real lens.

    A chief ray of slope t crosses the plane of focus at height t s_pupil and the film at
    t s_pupil s' / s, with s and s' measured from the principal points.
    """
    if math.isinf(focus_distance_m):
        return order.efl
    from_pupil = focus_distance_m * 1e3
    from_principal = from_pupil + order.front_principal_point - order.entrance_pupil.z
    return film_distance * from_pupil / from_principal


def _exact_lens(
    lens: lenses.Lens,
    camera: Camera,
    frame: tuple[float, float],
    f_stop: float,
    distance: float,
    from_sensor: bool,
) -> _core.ExactLens:
    half = [abs(s) + size / 2 for s, size in zip(camera.shift, frame, strict=True)]
    # The reconstruction filter reaches over the frame's edge.
    half_diagonal = 1.02 * math.hypot(*half)
    try:
        return _core.ExactLens(
            lens.prescription, f_stop, iris_of(camera), distance, from_sensor, half_diagonal
        )
    except ValueError as error:
        raise InputError(f"{lens.source}: {error}") from None


def _hash_lens(lens: lenses.Lens) -> str:
    text = json.dumps(lens.data, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()
