"""Flags of the shutter, for every command that looks through a camera.

Annotations must be real objects here (see ``flags.py``), so no ``annotations`` future.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from daguerre import units as q

from .groups import Text, option

_SHUTTER = "Shutter"


@dataclass(frozen=True)
class ShutterFlags:
    """When the film is exposed; what is not given stays as the file says, else 180 degrees."""

    shutter: Annotated[
        Text,
        option(
            "--shutter",
            metavar="S",
            help="Exposure time, s: 1/48, 20ms, 4s; 0 freezes.",
            panel=_SHUTTER,
        ),
    ] = None
    shutter_angle: Annotated[
        Text,
        option(
            "--shutter-angle",
            metavar="DEG",
            help="Exposure time in degrees of a frame.",
            panel=_SHUTTER,
        ),
    ] = None
    fps: Annotated[
        Text,
        option(
            "--fps", metavar="N", help="Frames per second, such as 24000/1001 [24].", panel=_SHUTTER
        ),
    ] = None
    shutter_offset: Annotated[
        Text,
        option(
            "--shutter-offset",
            metavar="FRAMES",
            help="Time of opening, in frames from --time [exposure centred on --time].",
            panel=_SHUTTER,
        ),
    ] = None
    shutter_type: Annotated[
        Text,
        option(
            "--shutter-type",
            metavar="box|leaf|focal_plane|rotary|electronic",
            help="Kind of shutter [box; electronic with --rolling].",
            panel=_SHUTTER,
        ),
    ] = None
    shutter_curve: Annotated[
        Text,
        option(
            "--shutter-curve",
            metavar="box|trapezoid:E|FILE",
            help="Opening over time: box, efficiency E, or a table of time and opening.",
            panel=_SHUTTER,
        ),
    ] = None
    rolling: Annotated[
        Text,
        option(
            "--rolling",
            metavar="SIDE,S",
            help="Lines exposed in turn from top, bottom, left or right: top,16.6ms for all of "
            "them, top,15us/line for each.",
            panel=_SHUTTER,
        ),
    ] = None

    def changes(self) -> dict[str, Any]:
        """The parameters of ``Camera.with_`` that were given."""
        from daguerre.errors import UsageError

        if self.shutter is not None and self.shutter_angle is not None:
            raise UsageError("--shutter and --shutter-angle: wanted one of them, got both")
        out: dict[str, Any] = {}
        if self.shutter is not None:
            out["shutter_time"] = q.time_s("--shutter", self.shutter)
        if self.shutter_angle is not None:
            out["shutter_angle"] = q.angle_deg("--shutter-angle", self.shutter_angle)
        if self.fps is not None:
            out["fps"] = q.plain_number("--fps", self.fps, "a number such as 24 or 24000/1001")
        if self.shutter_offset is not None:
            out["shutter_offset"] = q.plain_number(
                "--shutter-offset", self.shutter_offset, "frames such as -0.25"
            )
        if self.shutter_type is not None:
            out["shutter_type"] = self.shutter_type.replace("-", "_")
        if self.shutter_curve is not None:
            out["shutter_curve"] = _curve(self.shutter_curve)
        if self.rolling is not None:
            out["rolling_shutter"] = _rolling(self.rolling)
        return out


def _curve(text: str) -> Any:
    if text == "box":
        return text
    kind, _, efficiency = text.partition(":")
    if kind == "trapezoid":
        wanted = "trapezoid:E with an efficiency E of 0.5 .. 1, such as trapezoid:0.8"
        return "trapezoid", q.plain_number("--shutter-curve", efficiency, wanted)
    from daguerre.camera.shutter_curve import read_curve

    return read_curve(Path(text))


def _rolling(text: str) -> Any:
    from daguerre.camera.rolling_shutter import RollingShutter
    from daguerre.errors import UsageError

    side, comma, time = text.partition(",")
    if not comma:
        raise UsageError(
            "--rolling: wanted a side and a time such as top,16.6ms (read-out) or top,15us/line; "
            f"got {text!r}"
        )
    per_line = time.removesuffix("/line")
    if per_line != time:
        return RollingShutter(side.strip(), line_time=q.time_s("--rolling", per_line))
    return RollingShutter(side.strip(), readout_time=q.time_s("--rolling", time))
