"""Parameters of a lens alone, and its calibration: the camera's, where they say the same of it."""

from __future__ import annotations

import math
from dataclasses import replace

from daguerre import units
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM
from daguerre.parameters.parameter import REQUIRED, Parameter
from daguerre.parameters.table import Table

from . import CAMERA

ZOOM = replace(CAMERA["zoom"], meaning="Focal length to set a zoom lens to, mm", panel=None)
FOCUS = replace(
    CAMERA["focus_distance"],
    meaning="Focus distance from the entrance pupil, m, or inf",
    default_words="inf",
    panel=None,
)
F_STOP = replace(
    CAMERA["f_stop"],
    meaning="F-stop, as engraved on the lens",
    default_words="wide open",
    flags=("--f-stop",),
    panel=None,
)


def focus_by(meaning: str, first: str) -> Parameter:
    """``--focus-by`` with this meaning and default."""
    row = CAMERA["focus_by"]
    choices = tuple(sorted(row.choices, key=lambda choice: choice != first))
    return replace(row, meaning=meaning, choices=choices, default=first, panel=None)


# fmt: off
MODEL = Parameter(
    "model", "Projection model to fit: opencv, fisheye, double_sphere, ...; all compares them",
    default="opencv", kind="text", flags=("--model",), metavar="MODEL|all", tells_default=True,
)
TERMS = Parameter(
    "terms", "Number of parameters to fit", kind="whole",
    flags=("--terms",), metavar="N", default_words="opencv: 5, or 4 for Kalibr; others: all",
    in_python="Number of parameters of the model to fit, from the first; None: 5 for "
    "``opencv``, all for other models.",
)
#: How a lens that is calibrated sees a picture. ``LensSetting`` checks how it is set.
SEEN = Table(
    replace(
        FOCUS, default=math.inf, kind="value", parse=units.distance_m,
        in_python="Focus distance from the entrance pupil, m; may be infinite.",
    ),
    replace(
        F_STOP, kind="value",
        in_python="F-stop; None: wide open. It affects where the film stands.",
    ),
    replace(
        ZOOM, name="focal_length", kind="value", parse=units.length_mm,
        in_python="Focal length to set a zoom lens to, mm.",
    ),
    replace(
        focus_by("Focus criterion: rays near the axis, or smallest spot on the axis", "paraxial"),
        kind="value", metavar="paraxial|best",
        in_python="Focus criterion, paraxial or best; see ``Camera``.",
    ),
    replace(
        CAMERA["sensor_size"], meaning="Size of the sensor, mm", kind="value",
        flags=("--sensor",), metavar="WxH|" + "|".join(units.SENSORS), panel=None,
        parse=units.sensor_mm, tells_default=False, default_words="36x24",
        in_python="Size of the sensor, mm. The picture spans its width; pixels are square.",
    ),
    Parameter(
        "resolution", "Size of the picture, px", "px", REQUIRED, "value",
        flags=("--res",), metavar="WxH", default_words="1920x1280",
        parse=lambda flag, text: units.resolution(flag, text, (1920, 1280)),
    ),
    replace(
        CAMERA["shift"], wants="right and up, mm", panel=None, default_words="0,0",
        in_python="Shift of the sensor, mm; see ``Camera``.",
    ),
    Parameter(
        "wavelength_nm", "Wavelength, nm", default=DESIGN_WAVELENGTH_NM,
        low=300, high=2500,  # beyond, formulas of glasses are no glasses
        flags=("--wavelength",), metavar="NM", default_words=str(units.TYPED_D_LINE_NM),
        in_python="Wavelength, nm.",
    ),
)
CALIBRATE = Table(SEEN, TERMS)
# fmt: on
