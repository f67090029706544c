"""Reads cameras of Blender in a photographer's terms.

Lens and sensor of Blender are in mm, whatever the scene's unit; distances are in its units. The
properties of Daguerre's own panel take precedence (``camera_panel.py``).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.camera import Camera
from daguerre.camera.exposure_mode import METERS, chosen_by
from daguerre.camera.ideal import IDEAL
from daguerre.camera.projection import Projection
from daguerre.errors import InputError, UsageError
from daguerre.files.notes import Notes
from daguerre.scene.transforms import without_scale
from daguerre.sensors import load

from .camera_panel import BLENDER, CameraPanel
from .film import Film, film_of
from .frames import metres_per_unit
from .panoramas import panorama_of
from .shutters import shutter_of

if TYPE_CHECKING:
    import bpy

Matrix = NDArray[np.float64]


def camera_of(
    thing: bpy.types.Object,
    render: bpy.types.RenderSettings,
    matrix: Matrix,
    notes: Notes,
    *,
    shift_x: float | None = None,
) -> Camera:
    """Makes a camera.

    Args:
        thing: Evaluated camera object.
        render: Render settings of its scene, which give resolution, unit and shutter.
        matrix: World from camera, y-up, m for each unit of Blender, shape (4, 4).
        notes: Receives notes on unsupported content.
        shift_x: Shift of one eye of a stereo pair, as ``RenderEngine.camera_shift_x`` has it, and
            ``matrix`` then is its place; default: the camera's own.

    Raises:
        InputError: A camera that no lens can be, or a value that is wrong; the message names it.
    """
    where = f"camera {thing.name!r}"
    placed = without_scale(np.asarray(matrix, np.float64))
    if placed is None:
        raise InputError(f"{where}: scale: wanted a scale above 0, got 0")
    data, panel = thing.data, CameraPanel(thing.data)
    metres = metres_per_unit(render.id_data)
    film = film_of(data, render, shift_x)
    lens = _lens_of(data, panel, where)
    _check_type(data.type, lens, where)
    values = _optics(data, film, lens, panel, where, notes) | _body(panel)
    if "pinhole" not in (lens, values.get("lens_model")):
        values |= _iris(data, values, panel, metres, notes) | _focus(thing, panel, metres)
    values |= shutter_of(render, panel, notes)
    for name in chosen_by(values.get("exposure", "")):  # the panel hides them
        values.pop(name, None)
    values["near_clip"] = max(float(data.clip_start), 0.0) * metres
    try:
        return Camera(placed, **values)
    except UsageError as error:
        raise InputError(f"{where}: {str(error).removeprefix('camera: ')}") from None


def film_reach_mm(data: bpy.types.Camera, render: bpy.types.RenderSettings) -> float:
    """Largest distance of a camera's film from the axis of its lens, mm."""
    film = film_of(data, render)
    size = _body(CameraPanel(data)).get("sensor_size", film.size)
    return math.hypot(*(abs(s) + side / 2 for s, side in zip(film.shift, size, strict=True)))


def _check_type(kind: str, lens: str, where: str) -> None:
    """Refuses kinds of cameras that no lens can be; a camera shader gives way to a real lens."""
    if kind in ("PERSP", "PANO") or (kind == "CUSTOM" and lens not in IDEAL):
        return
    raise InputError(f"{where}: type: wanted PERSP or PANO, got {kind}")


def _lens_of(data: bpy.types.Camera, panel: CameraPanel, where: str) -> str:
    """Name or file of the lens; without one of the panel, Blender's own switch of blur decides."""
    lens = panel.named("lens", BLENDER)
    if lens is None:
        return "thin" if data.dof.use_dof else "pinhole"
    if lens != "file":
        return lens
    name = panel.chosen("lens_file")
    if not name:
        raise InputError(f"{where}: lens_file: wanted a lens file, got none")
    import bpy

    return str(bpy.path.abspath(name))


def _optics(
    data: bpy.types.Camera, film: Film, lens: str, panel: CameraPanel, where: str, notes: Notes
) -> dict[str, Any]:
    """Lens or projection, and the film."""
    found: dict[str, Any] = {"sensor_size": film.size}
    if lens not in IDEAL:
        return found | _glass(data, film, lens, panel, notes)
    found["natural_vignetting"] = False  # Cycles has none
    if data.type == "PANO":
        return found | {"projection": panorama_of(data, film, where, notes)}
    if not film.square:
        return found | {"projection": _stretched(float(data.lens), film)}
    found |= {"lens": lens, "focal_length": float(data.lens)}
    return found | _movements(film, panel if lens == "thin" else None)


def _glass(
    data: bpy.types.Camera, film: Film, lens: str, panel: CameraPanel, notes: Notes
) -> dict[str, Any]:
    """Values of a lens with a prescription, which has its own focal length."""
    found: dict[str, Any] = {"lens": lens}
    model = panel.named("lens_model", "auto")
    if model is not None:
        found["lens_model"] = model
    if zoom := panel.chosen("zoom"):
        found["zoom"] = float(zoom)
    if panel.chosen("dispersion") is False:
        found["dispersion"] = False
    if data.type == "PANO":
        notes.add("a lens with a prescription replaces the panoramic projection")
    if not film.square:
        notes.add("pixels behind a lens with a prescription are drawn square")
    return found | _movements(film, None if model == "pinhole" else panel)


def _stretched(focal: float, film: Film) -> Projection:
    """A pinhole with pixels that are not square; ``focal`` in mm."""
    across, down = (side / count for side, count in zip(film.size, film.resolution, strict=True))
    (columns, rows), (right, up) = film.resolution, film.shift
    principal = ((columns - 1) / 2 - right / across, (rows - 1) / 2 + up / down)
    return Projection("rectilinear", film.resolution, (focal / across, focal / down), principal)


def _movements(film: Film, panel: CameraPanel | None) -> dict[str, Any]:
    """Shift of the film and tilt of the lens, where they are not 0."""
    found: dict[str, Any] = {"shift": film.shift} if any(film.shift) else {}
    if panel is not None:
        tilt = tuple(float(panel.chosen(name) or 0.0) for name in ("tilt_x", "tilt_y"))
        found |= {"tilt": tilt} if any(tilt) else {}
    return found


def _body(panel: CameraPanel) -> dict[str, Any]:
    """Sensor and exposure of the panel."""
    found: dict[str, Any] = {}
    if (sensor := panel.named("sensor", "blender")) is not None:
        found |= {"sensor": sensor, "sensor_size": load(sensor).size}
    if (mode := panel.named("exposure_mode")) is not None:
        found |= {"exposure": mode, "meter": panel.value("meter") or METERS[0]}
    for name, field in (("iso", "iso"), ("ev", "exposure_compensation")):
        if (value := panel.chosen(name)) is not None:
            found[field] = float(value)
    return found


def _iris(
    data: bpy.types.Camera, values: dict[str, Any], panel: CameraPanel, metres: float, notes: Notes
) -> dict[str, Any]:
    """Stop and blades."""
    dof, found = data.dof, {}
    asked = panel.chosen("t_stop" if panel.chosen("use_t_stop") else "f_stop")
    if asked is not None:
        found["t_stop" if panel.chosen("use_t_stop") else "f_stop"] = float(asked)
    elif dof.use_dof:
        found["f_stop"] = float(dof.aperture_fstop)
        if abs(metres - 1) > 1e-6:
            notes.add("depth of field is that of the real lens, in mm, whatever the scene's unit")
    if "projection" in values and "f_stop" in found and data.type == "PERSP":
        across, down = values["projection"].focal  # the iris belongs to their mean
        width = values["sensor_size"][0] / values["projection"].size[0]
        found["f_stop"] *= (across + down) / 2 * width / data.lens
    if abs(dof.aperture_ratio - 1) > 1e-6 and dof.use_dof:
        notes.add("the ratio of an anamorphic iris is left out: the iris stays round")
    return found | _blades(dof, panel)


def _blades(dof: bpy.types.CameraDOFSettings, panel: CameraPanel) -> dict[str, Any]:
    """Blades of the iris.

    The polygon of Blender is turned by half a side, and lies within the circle of the f-stop; that
    of Daguerre has the area of the circle.
    """
    count, turn = panel.chosen("blades"), panel.chosen("blade_rotation")
    bend = panel.chosen("blade_curvature")
    own = int(dof.aperture_blades) if dof.use_dof else 0
    blades = own if count is None else int(count)
    if blades < 3:
        return {}
    own_turn = math.degrees(dof.aperture_rotation) + 180 / blades
    degrees = own_turn if turn is None else float(turn)
    return {"blades": blades, "blade_rotation": degrees, "blade_curvature": float(bend or 0.0)}


def _focus(thing: bpy.types.Object, panel: CameraPanel, metres: float) -> dict[str, Any]:
    """Distance along the camera's axis; none for autofocus."""
    if panel.named("focus_mode", "blender") is not None:
        return {}
    dof = thing.data.dof
    if dof.focus_object is None:
        return {"focus_distance": float(dof.focus_distance) * metres}
    camera, target = np.array(thing.matrix_world), _place(dof)
    axis = -camera[:3, 2] / np.linalg.norm(camera[:3, 2])
    return {"focus_distance": abs(float(axis @ (target - camera[:3, 3]))) * metres}


def _place(dof: bpy.types.CameraDOFSettings) -> Matrix:
    """Point of the object to focus on, or of one of its bones, in Blender's world."""
    target, bone = dof.focus_object, None
    if dof.focus_subtarget and target.pose is not None:
        bone = target.pose.bones.get(dof.focus_subtarget)
    world = np.array(target.matrix_world)
    local = np.append(np.array(bone.head if bone is not None else (0.0, 0.0, 0.0)), 1.0)
    return np.asarray((world @ local)[:3], np.float64)
