"""Cameras: ``perspective`` and ``thinlens``, in a photographer's terms.

A sensor of Mitsuba has a field of view and no size. Ours gets the diagonal of a full frame,
so that its focal length is the 35 mm equivalent that Mitsuba's ``focal_length`` means.

Source: Mitsuba 3, documentation of the sensors; its cameras look along +z, with +x to the left.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.parameters import OPTICS
from daguerre.errors import InputError, UsageError
from daguerre.files.notes import Notes

from .node import Node
from .settings import Settings
from .transforms import TURN, rigid

#: Diagonal of a frame of 36 mm x 24 mm.
DIAGONAL_MM = math.hypot(36, 24)
PERSPECTIVE = ("perspective", "thinlens")
_AXES = ("x", "y", "diagonal", "smaller", "larger")


def read_camera(node: Node, world: NDArray[np.float64], settings: Settings, notes: Notes) -> Camera:
    """Reads a sensor.

    Args:
        node: The sensor.
        world: Scene from world, which scales to metres and may mirror, shape (4, 4).
        settings: Settings with the shape of its film.
        notes: Receives notes.

    Raises:
        InputError: A value is wrong; the message names file, line and element.
    """
    width, height = settings.resolution
    aspect = width / height
    size = sensor_size(aspect)
    half = math.tan(field_of_view(node, aspect) / 2)
    values: dict[str, Any] = {
        "sensor_size": size,
        "focal_length": size[0] / 2 / half,
        "lens": "pinhole" if node.plugin == "perspective" else "thin",
    }
    metres = float(world[1, 1])
    values |= _shift(node, size) | _clip(node, metres) | _shutter(node)
    if node.plugin == "thinlens":
        values |= _lens(node, metres)
    node.skip("focus_distance")
    pose = rigid(world @ node.transform(), node, notes)
    try:
        camera = Camera(transform=pose @ TURN, **values)
        OPTICS.check(camera, "camera")
        shutter.check(camera)
        return camera
    except (UsageError, InputError) as error:
        node.fail(str(error).removeprefix("camera: "))


def sensor_size(aspect: float) -> tuple[float, float]:
    """Width and height of a sensor with the diagonal of a full frame, mm."""
    height = DIAGONAL_MM / math.hypot(aspect, 1)
    return aspect * height, height


def field_of_view(node: Node, aspect: float) -> float:
    """Horizontal field of view, radians.

    Raises:
        InputError: The angle is not within 0 and 180 degrees.
    """
    if not node.has("fov"):
        text = node.text("focal_length", "50mm").strip().removesuffix("mm")
        try:
            focal = float(text)
        except ValueError:
            focal = 0.0
        if not 0 < focal < 1e6:
            node.fail(f"focal_length: wanted a length such as 50mm, got {text[:40]!r}")
        half = DIAGONAL_MM / 2 / focal
        axis = "diagonal"
    else:
        if node.has("focal_length"):
            node.fail("set either fov or focal_length, not both")
        fov = node.number("fov", 0.0)
        if not 0 < fov < 180:
            node.fail(f"fov: wanted an angle between 0 and 180 degrees, got {fov:g}")
        half = math.tan(math.radians(fov) / 2)
        axis = node.choice("fov_axis", "x", _AXES)
    if axis in ("smaller", "larger"):
        axis = "y" if (aspect > 1) == (axis == "smaller") else "x"
    if axis == "y":
        half *= aspect
    if axis == "diagonal":
        half *= aspect / math.hypot(aspect, 1)
    return 2 * math.atan(half)


def _shift(node: Node, size: tuple[float, float]) -> dict[str, Any]:
    """Shift of the film by the offset of the principal point, a share of its size."""
    x = node.number("principal_point_offset_x", 0.0)
    y = node.number("principal_point_offset_y", 0.0)
    return {"shift": (x * size[0], -y * size[1])} if x or y else {}


def _clip(node: Node, metres: float) -> dict[str, Any]:
    near = node.number("near_clip", 1e-2, above=0)
    return {"near_clip": near * metres} if node.has("near_clip") else {}


def _shutter(node: Node) -> dict[str, Any]:
    """Shutter from its times, s; Mitsuba has no other unit of time."""
    if not node.has("shutter_open") and not node.has("shutter_close"):
        return {}
    begin, end = node.number("shutter_open", 0.0), node.number("shutter_close", 0.0)
    if end < begin:
        node.fail(f"the shutter must close after it opens at {begin:g}, got {end:g}")
    fps = 24.0
    return {"shutter_time": end - begin, "shutter_offset": begin * fps, "fps": fps}


def _lens(node: Node, metres: float) -> dict[str, Any]:
    """Aperture and focus of a thin lens, which is at its far clip unless it says otherwise."""
    if not node.has("aperture_radius"):
        node.fail("the property 'aperture_radius' is missing")
    radius = node.number("aperture_radius", 0.0, above=0)
    focus = node.number("focus_distance", node.number("far_clip", 1e4, above=0), above=0)
    return {"aperture_diameter": 2000 * radius * metres, "focus_distance": focus * metres}
