"""Parameters of a camera: one row each, from which flags, checks and pages are made.

The order of the rows is the order in help texts and pages.
"""

from __future__ import annotations

import math

from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table

from .body import FULL_FRAME, GHOSTS, PARTS, SENSOR, STANDING
from .exposure import EXPOSURE
from .iris import IRIS
from .lens import CHOICE, LENS
from .opening import FOCUS, STOP
from .place import PLACE
from .shutter import SHUTTER_ROWS

__all__ = [
    "CAMERA",
    "CAMERA_FLAGS",
    "FULL_FRAME",
    "LIGHT",
    "LIMITS",
    "MOVABLE",
    "OPTICS",
    "SHUTTER",
]

_PLACE = Parameter(
    "transform",
    "World from camera, shape (4, 4), m; the camera looks along its -z, +y is up",
    "m",
    kind="value",
    movable=True,
)
_MOTION = Parameter("motion", "Parameters that change over time, by name", kind="value")

#: Rows of the fields of a ``Camera``: lens and body, brightness, shutter, and all.
OPTICS = Table(_PLACE, LENS, STOP, FOCUS, IRIS, GHOSTS, SENSOR, STANDING, _MOTION)
LIGHT = Table(EXPOSURE)
SHUTTER = Table(SHUTTER_ROWS)
CAMERA = Table(OPTICS, LIGHT, SHUTTER)
#: Rows of the flags of a camera; a name such as ``scatter.barrel`` is a part of a field.
CAMERA_FLAGS = Table(
    CHOICE, PLACE, LENS, STOP, FOCUS, IRIS, GHOSTS, PARTS, SENSOR, STANDING, EXPOSURE
)

#: Names of those that may change over time: optics while the shutter is open, brightness and
#: shutter from one picture to the next.
MOVABLE = tuple(row.name for row in CAMERA if row.movable)
#: Smallest and largest values, far beyond any real camera: values outside are mistakes, and would
#: overflow single precision.
LIMITS = {row.name: (row.low, row.high) for row in CAMERA if math.isfinite(row.low)}
