"""Parameters of a camera's pose: parts of its ``transform``."""

from __future__ import annotations

from functools import partial

from daguerre.parameters.parameter import Parameter

from . import typed

_Row = partial(Parameter, panel="Camera", default_words="the scene's")
_POINT = partial(_Row, unit="m", kind="numbers", count=3, wants="a point X,Y,Z, m", metavar="X,Y,Z")

PLACE = (
    _POINT(
        "place.position",
        "Position of the camera, m; it then stands still",
        flags=("--position",),
        parse=typed.point("0,1.6,4"),
    ),
    _POINT(
        "place.look_at",
        "Point in the middle of the picture, m; levels the camera",
        flags=("--look-at",),
        parse=typed.point("0,1,0"),
    ),
    _Row(
        "place.roll",
        "Roll of the camera about its view direction, degrees; 0 is level, positive clockwise as "
        "the photographer sees it",
        "deg",
        flags=("--roll",),
        metavar="DEG",
    ),
)
