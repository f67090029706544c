"""Parameters of the shutter. Limits are far beyond any real shutter, to catch mistakes."""

from __future__ import annotations

from functools import partial

from daguerre.parameters.parameter import Parameter

from . import typed

_ANGLE = 180.0
_Row = partial(Parameter, panel="Shutter")

SHUTTER_ROWS = (
    _Row(
        "shutter_time",
        "Exposure time, s, such as 1/48, 20ms or 4s; 0 freezes motion",
        "s",
        low=0,
        high=1e6,
        flags=("--shutter",),
        metavar="S",
        default_words="the scene's, else from {shutter_angle}",
        in_python="Time for which each point of the film is exposed, s; 0 freezes motion. "
        "Default: from ``shutter_angle``.",
        explained=("motion.md#the-shutter",),
        rivals="shutter",
        movable=True,
    ),
    _Row(
        "shutter_angle",
        "Exposure time as a shutter angle, degrees; 360 is a whole frame",
        "deg",
        low=0,
        high=360e6,
        flags=("--shutter-angle",),
        metavar="DEG",
        default_words=f"the scene's, else {_ANGLE:g}",
        more="It equals 360 x {fps} x {shutter_time}",
        in_python="Exposure time as a shutter angle, degrees; 360 is a whole frame; default: "
        f"{_ANGLE:g}. It equals 360 x ``fps`` x ``shutter_time``.",
        usual=_ANGLE,
        rivals="shutter",
        movable=True,
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
        more="Shutter angles, shutter offsets and sequences use it",
    ),
    _Row(
        "shutter_offset",
        "Time at which the shutter opens, in frames from --time",
        "frames",
        low=-1e9,
        high=1e9,
        flags=("--shutter-offset",),
        metavar="FRAMES",
        parse=typed.number("frames such as -0.25"),
        default_words="exposure centred on --time",
        in_python="Time at which the shutter opens, in frames from the scene's time; default: the "
        "exposure is centred on that time.",
        movable=True,
    ),
    _Row(
        "shutter_type",
        "Shutter type",
        kind="choice",
        choices=("box", "leaf", "focal_plane", "rotary", "electronic"),
        flags=("--shutter-type",),
        parse=typed.shutter_type,
        default_words="box; electronic with {rolling_shutter}",
    ),
    _Row(
        "shutter_curve",
        "Opening of the shutter over time: a box, a trapezoid of efficiency E, or a file with a "
        "table of time and opening",
        kind="value",
        flags=("--shutter-curve",),
        metavar="box|trapezoid:E|FILE",
        parse=typed.shutter_curve,
        in_python='Opening of the shutter over time: box, ("trapezoid", efficiency) or points '
        "(fraction of the time, opening); for a leaf shutter, the radius of the iris.",
    ),
    _Row(
        "rolling_shutter",
        "Rolling shutter: the side that it starts from (top, bottom, left or right), and its "
        "read-out time (top,16.6ms) or time per line (top,15us/line)",
        "s",
        kind="value",
        flags=("--rolling",),
        metavar="SIDE,S",
        parse=typed.rolling_shutter,
        in_python="Rolling shutter, which exposes lines of pixels in turn; default: by the "
        "shutter type.",
    ),
)
