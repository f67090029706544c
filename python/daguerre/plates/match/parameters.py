"""Parameters of a match: what a photograph does not say, or says wrongly."""

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
    """A camera's parameter, where the photograph's own is the default."""
    return replace(
        CAMERA[name],
        meaning=meaning,
        default=None,
        usual=None,
        tells_default=False,
        default_words="the photo's",
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
        "Lens of the library or a lens file; `thin`: an ideal one",
        metavar="NAME|FILE|thin",
    ),
    _row("focal_length", "Focal length, mm; of a zoom where it stands", flags=("--focal-length",)),
    _row("f_stop", "F-number of the shot"),
    replace(
        _row("focus_distance", "Focus distance of the shot, m, or inf"),
        default_words="the photo's, else autofocus",
    ),
    _row("shutter_time", "Exposure time of the shot, s: 1/125, 20ms"),
    _row("iso", "ISO of the shot"),
    _row(
        "sensor",
        "Sensor of the library or a file, or the size of the camera's, mm",
        metavar="NAME|FILE|WxH|ff|apsc",
    ),
    _row("white_balance", "White that the photo was developed for, K or x,y"),
    Parameter(
        "look",
        "Tone curve of a developed photo",
        kind="text",
        flags=("--look",),
        metavar="NAME",
        panel="Camera",
        default_words="standard",
        in_python=DEVELOP["look"].in_python,
    ),
)
