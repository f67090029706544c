"""Parameters of ``match_plate``, which replace missing or wrong metadata of the photograph."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, TypedDict

from daguerre.camera.parameters import CAMERA
from daguerre.development.parameters import DEVELOP
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table


class MatchKeywords(TypedDict, total=False):
    """Keywords of ``match_plate``."""

    lens: Any
    focal_length: float
    f_stop: float
    focus_distance: float
    shutter_time: float
    iso: float
    sensor: Any
    white_balance: Any
    look: str


def _row(name: str, meaning: str, **changes: Any) -> Parameter:
    """Makes a row from a camera's parameter; its default is the photograph's value."""
    return replace(
        CAMERA[name],
        meaning=meaning,
        default=None,
        usual=None,
        tells_default=False,
        default_words="from the photo",
        more="",
        in_python="",
        explained=(),
        needs=(),
        rivals="",
        **changes,
    )


MATCH = Table(
    _row(
        "lens",
        "Lens of the library or a lens file; `thin`: an ideal lens",
        metavar="LENS|thin",
    ),
    _row("focal_length", "Focal length of the photo, mm", flags=("--focal-length",)),
    _row("f_stop", "F-number of the photo"),
    replace(
        _row("focus_distance", "Focus distance of the photo, m, or inf"),
        default_words="from the photo, else autofocus",
    ),
    _row("shutter_time", "Exposure time of the photo, s: 1/125, 20ms"),
    _row("iso", "ISO of the photo"),
    _row(
        "sensor",
        "Sensor of the library, a sensor file, or the sensor's size, mm",
        metavar="SENSOR|WxH|ff|apsc",
    ),
    _row("white_balance", "White balance of the developed photo, K or x,y"),
    Parameter(
        "look",
        "Tone curve of a developed photo",
        kind="text",
        flags=("--look",),
        metavar="LOOK",
        panel="Camera",
        default_words="standard",
        in_python=DEVELOP["look"].in_python,
    ),
)
