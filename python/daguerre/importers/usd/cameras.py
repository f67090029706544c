"""Reads cameras of USD in a photographer's units: UsdGeomCamera, NVIDIA's attributes, and ours.

Camera lengths (focal length, apertures, offsets) are tenths of a scene unit, ``focusDistance`` is
in scene units. An ``fStop`` of 0 is a pinhole, a ``focusDistance`` of 0 is unset. Values that are
not authored keep Daguerre's defaults. ``daguerre:*`` takes precedence over the rest.

Source: OpenUSD, UsdGeomCamera; GfCamera for the direction of offsets.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd

from daguerre.camera.camera import Camera
from daguerre.camera.exposure import check_exposure
from daguerre.camera.ideal import IDEAL
from daguerre.camera.parameters import CAMERA
from daguerre.camera.shutter import check as check_shutter
from daguerre.errors import InputError, UsageError
from daguerre.files.notes import Notes
from daguerre.motion.values import Dynamic, Keys, is_dynamic, keys

from .checked import Checked
from .daguerre_attributes import read_ours
from .exposure import never_opens, read_exposure, read_shutter, unsplit
from .omni import read_distortion
from .rolling import OMNI, read_rolling
from .stage_facts import StageFacts
from .values import path_text

#: F-stop of keys with an f-stop of 0, a pinhole, among keys of a camera with a lens: no blur.
_SHARP = 1e9
_FOCUSED = ("focus_at", "focus_on")
_STOPPED = ("t_stop", "aperture_diameter")


def read_camera(
    prim: Usd.Prim, transform: NDArray[np.float64] | Dynamic, stage: StageFacts, notes: Notes
) -> Camera | None:
    """Reads a camera.

    Args:
        prim: Prim of type Camera.
        transform: World from camera, rigid, m, shape (4, 4), or over time.
        stage: Facts of its stage.
        notes: Notes of the reader.

    Returns:
        The camera; None, with a note, if no lens takes its picture.

    Raises:
        InputError: A value is wrong; the message names the attribute.
    """
    read = Checked(prim, stage, notes)
    if read.text("projection") == "orthographic":
        notes.add("an orthographic camera is left out: no lens makes parallel rays")
        return None
    if never_opens(read):
        notes.add("a camera with a shutter that closes before it opens is left out")
        return None
    ours = read_ours(read)
    values = _film(read) | _opening(read) | read_exposure(read, ours.get("exposure"))
    values |= read_shutter(read) | read_rolling(read, OMNI) | _near_clip(read)
    if ours.get("lens") in (None, *IDEAL):
        values = _projected(values, read_distortion(read))
    values = _completed(values, ours, notes)
    _doubt(values, notes)
    _unread(read)
    return _made(transform, values, read, named=ours.get("exposure") == "manual")


def _made(transform: Any, values: dict[str, Any], read: Checked, *, named: bool) -> Camera:
    """Makes the camera, and checks that its values go together.

    Args:
        transform: World from camera, constant or over time.
        values: Other parameters of the camera.
        read: Attributes of the camera, for messages.
        named: Whether an attribute of ours names the mode ``manual``.
    """
    try:
        made = Camera(transform=transform, **values)
        made = unsplit(made) if named else made
        check_shutter(made)
        check_exposure(made)
        CAMERA.refuse_rivals(_given(made), "camera")
    except UsageError as error:
        place = f"{read.stage.file}: {path_text(read.prim.GetPath())}"
        raise InputError(f"{place}: {str(error).removeprefix('camera: ')}") from None
    return made


def _given(made: Camera) -> set[str]:
    return {row.name for row in CAMERA if getattr(made, row.name) is not None}


def _film(read: Checked) -> dict[str, Any]:
    """Focal length, sensor and shift, mm."""
    width = _length(read, "horizontalAperture", "sensor_size")
    height = _length(read, "verticalAperture", "sensor_size")
    found = {
        "focal_length": _length(read, "focalLength", "focal_length"),
        "sensor_size": (width, height),
    }
    sideways, upward = (
        _length(read, name, "shift")
        for name in ("horizontalApertureOffset", "verticalApertureOffset")
    )
    moved = is_dynamic(sideways) or is_dynamic(upward) or sideways or upward
    return found | ({"shift": (sideways, upward)} if moved else {})


def _length(read: Checked, name: str, field: str) -> Any:
    """Camera length, mm, over time, within the limits of a parameter."""
    scale = read.stage.millimetres
    return read.within(name, field, read.moving(name, lambda value: value * scale))


def _opening(read: Checked) -> dict[str, Any]:
    """Parameters of stop and focus, without values that are not authored."""
    found: dict[str, Any] = {}
    if read.is_authored("fStop"):
        found |= _stop(read)
    if read.is_authored("focusDistance"):
        focus = read.moving("focusDistance", lambda value: value * read.stage.metres)
        focus = _without_unset(focus)
        if focus is not None:
            found["focus_distance"] = read.within("focusDistance", "focus_distance", focus)
    return found


def _stop(read: Checked) -> dict[str, Any]:
    stop = read.moving("fStop", lambda value: value)
    values = stop.values if isinstance(stop, Keys) else (stop,)
    if not any(values):
        return {"lens": "pinhole"}
    if not all(values):
        read.notes.add("an f-stop of 0 in an animation is read as a pinhole")
        stop = keys(
            zip(stop.times, (value or _SHARP for value in values), strict=True), stop.interpolation
        )
    return {"f_stop": read.within("fStop", "f_stop", stop)}


def _without_unset(focus: object) -> Any:
    """Focus distance without the moments at which it is unset; None: never set."""
    if not isinstance(focus, Keys):
        return focus or None
    pairs = [
        (t, value) for t, value in zip(focus.times.tolist(), focus.values, strict=True) if value
    ]
    return keys(pairs, focus.interpolation) if pairs else None


def _projected(values: dict[str, Any], projection: object) -> dict[str, Any]:
    """Values with a calibrated projection in the place of the lens and the film's height."""
    if projection is None:
        return values
    left = {
        name: value
        for name, value in values.items()
        if name not in ("lens", "focal_length", "shift")
    }
    width = values["sensor_size"][0]
    columns, rows = _start(projection).size
    height = _scaled(width, rows / columns)
    return left | {"projection": projection, "sensor_size": (width, height)}


def _scaled(value: float | Keys, factor: float) -> float | Keys:
    if not isinstance(value, Keys):
        return value * factor
    pairs = zip(value.times.tolist(), (v * factor for v in value.values), strict=True)
    return keys(pairs, value.interpolation)


def _completed(values: dict[str, Any], ours: dict[str, Any], notes: Notes) -> dict[str, Any]:
    """Merges values with ours; drops values that ours replace."""
    gone: set[str] = set()
    if ours.get("lens") not in (None, *IDEAL):  # a prescription sets the focal length
        gone |= {"focal_length"}
    if any(name in ours for name in _STOPPED):
        gone |= {"f_stop"}
    if any(name in ours for name in _FOCUSED):
        gone |= {"focus_distance"}
    if "shutter_angle" in ours:
        gone |= {"shutter_time"}
    if "projection" in ours:
        values = _projected(values, ours["projection"])
    values, ours = _pitched(values, ours, notes)
    made = {name: value for name, value in values.items() if name not in gone} | ours
    return {name: value for name, value in made.items() if value is not None}


def _pitched(
    values: dict[str, Any], ours: dict[str, Any], notes: Notes
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Values with the size of a calibrated sensor, by its pixel pitch, and ours without that."""
    left = {name: value for name, value in ours.items() if name != "pixel_pitch"}
    pitch, projection = ours.get("pixel_pitch"), _start(values.get("projection"))
    if pitch is None:
        return values, left
    if projection is None:
        notes.add("the pixel pitch of a camera without lens distortion is not read")
        return values, left
    size = tuple(side * pitch * 1e-3 for side in projection.size)
    return values | {"sensor_size": size}, left


def _start(value: object) -> Any:
    """First value over time."""
    return value.values[0] if isinstance(value, Keys) else value


def _doubt(values: dict[str, Any], notes: Notes) -> None:
    """Notes an implausible length: the stage probably states a wrong unit."""
    focal, width = _start(values.get("focal_length")), _start(values["sensor_size"][0])
    said = ""
    if focal is not None and not 1 <= focal <= 2000:
        said = f"a lens of {_shown(focal)}"
    elif not 0.5 <= width <= 200:
        said = f"a sensor {_shown(width)} wide"
    if said:
        notes.add(
            f"this file says {said}; metersPerUnit is probably wrong: --camera-units mm reads it "
            "in millimetres"
        )


def _shown(mm: float) -> str:
    return f"{mm / 1e3:.4g} m" if mm >= 1000 else f"{mm:.4g} mm"


def _unread(read: Checked) -> None:
    """Notes attributes of a camera that are not drawn."""
    if read.now("clippingPlanes"):
        read.notes.add("clipping planes of a camera are left out")
    role = read.text("stereoRole")
    if role not in (None, "mono"):
        read.notes.add(f"stereoRole {role} of a camera is ignored: the camera stays at its prim")


def _near_clip(read: Checked) -> dict[str, Any]:
    """Near clipping plane, if authored; the far plane is left out, as lenses have no far limit."""
    if not read.is_authored("clippingRange"):
        return {}
    near, far = read.numbers("clippingRange", 2) or (0.0, 1.0)
    if near >= far:
        read.notes.add("a clipping range whose far plane is not beyond its near one is left out")
        return {}
    distance = max(near, 0.0) * read.stage.metres
    return {"near_clip": read.within("clippingRange", "near_clip", distance)}
