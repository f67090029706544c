"""Parameters of the shutter. Limits are far beyond any: what lies outside is a mistake."""

from __future__ import annotations

from functools import partial

from daguerre.parameters.parameter import Parameter

from . import typed

_ANGLE = 180.0
_Row = partial(Parameter, panel="Shutter")

SHUTTER_ROWS = (
    _Row(
        "shutter_time",
        "Exposure time, s: 1/48, 20ms, 4s; 0 freezes",
        "s",
        low=0,
        high=1e6,
        flags=("--shutter",),
        metavar="S",
        more="Without it the file's, else that of {shutter_angle}",
        in_python="Time for which a point of the film is exposed, s; 0 freezes. Default: "
        "``shutter_angle``.",
        explained=("motion.md#the-shutter",),
        rivals="shutter",
    ),
    _Row(
        "shutter_angle",
        "Exposure time in degrees of a frame",
        "deg",
        low=0,
        high=360e6,
        flags=("--shutter-angle",),
        metavar="DEG",
        more="It is 360 {fps} {shutter_time}. Without either the file's, else "
        f"{_ANGLE:g} degrees",
        usual=_ANGLE,
        rivals="shutter",
    ),
    _Row(
        "fps",
        "Frames per second, such as 24000/1001",
        "1/s",
        24.0,
        low=1e-6,
        high=1e9,
        flags=("--fps",),
        metavar="N",
        parse=typed.number("a number such as 24 or 24000/1001"),
        tells_default=True,
        more="Angles, offsets and sequences count by it",
    ),
    _Row(
        "shutter_offset",
        "Time of opening, in frames from --time",
        "frames",
        low=-1e9,
        high=1e9,
        flags=("--shutter-offset",),
        metavar="FRAMES",
        parse=typed.number("frames such as -0.25"),
        default_words="exposure centred on --time",
        in_python="Time at which the shutter opens, in frames from the scene's time; default: the "
        "exposure is centred on that time.",
    ),
    _Row(
        "shutter_type",
        "Kind of shutter",
        kind="choice",
        choices=("box", "leaf", "focal_plane", "rotary", "electronic"),
        flags=("--shutter-type",),
        parse=typed.shutter_type,
        default_words="box; electronic with {rolling_shutter}",
    ),
    _Row(
        "shutter_curve",
        "Opening over time: box, efficiency E, or a table of time and opening",
        kind="value",
        flags=("--shutter-curve",),
        metavar="box|trapezoid:E|FILE",
        parse=typed.shutter_curve,
        in_python='Opening over the time: box, ("trapezoid", efficiency) or points (fraction of '
        "the time, opening); for a leaf the radius of the iris.",
    ),
    _Row(
        "rolling_shutter",
        "Lines exposed in turn from top, bottom, left or right: top,16.6ms for all of them, "
        "top,15us/line for each",
        "s",
        kind="value",
        flags=("--rolling",),
        metavar="SIDE,S",
        parse=typed.rolling_shutter,
        in_python="Lines of pixels exposed in turn; default: that of the type.",
    ),
)
