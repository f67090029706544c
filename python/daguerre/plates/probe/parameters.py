"""Parameters of a light probe: a row for each, which defines keyword, checks and flag."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypedDict

from daguerre import units
from daguerre.errors import UsageError
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table

BALLS, SUNS, RESPONSES = (
    ("mirror", "grey"),
    ("auto", "disc", "off"),
    ("auto", "recover", "srgb", "linear"),
)
PHOTOGRAPHS, BALL, SUN, MAP = "The photographs", "The ball", "The sun", "The map"


class ProbeKeywords(TypedDict, total=False):
    """Keywords of ``light_probe``."""

    ball: str
    ev: Sequence[float]
    response: str
    scale: float
    wb: Any
    circle: Sequence[float]
    fov: float
    reflectance: float | Sequence[float]
    ball_direction: float | Sequence[float]
    pitch: float
    sun: str
    sun_diameter: float
    illuminance: float
    grey: str | Path | Sequence[str | Path]
    grey_circle: Sequence[float]
    grey_direction: float
    rotate: float
    res: int


def _list(example: str) -> Callable[[str, str], tuple[float, ...]]:
    """Makes a parser of any number of values between commas."""
    return lambda flag, text: units.numbers(flag, text, text.count(",") + 1, example)


def _fov(flag: str, text: str) -> float:
    """Parses an angle, degrees, or ``far``, which is 0."""
    if text.strip().lower() == "far":
        return 0.0
    angle = units.angle_deg(flag, text)
    if not 0 < angle < 180:
        raise UsageError(f"{flag}: wanted an angle between 0 and 180 degrees, or far, got {text!r}")
    return angle


def _angles(flag: str, text: str) -> tuple[float, ...]:
    return tuple(units.angle_deg(flag, part) for part in text.split(","))


# fmt: off
LIGHT_PROBE = Table(
    Parameter(
        "ball", "Kind of ball in the photographs [none: a panorama]", kind="choice",
        choices=BALLS, wants="mirror or grey", flags=("--ball",), panel=BALL,
        in_python="Kind of ball in the photographs, ``mirror`` or ``grey``; None: a panorama.",
    ),
    Parameter(
        "ev", "Exposure of each photograph, EV, such as -4,-2,0", kind="value",
        parse=_list("-4,-2,0"), flags=("--ev",), metavar="EV,...", panel=PHOTOGRAPHS,
        default_words="from EXIF",
        in_python="Exposure of each photograph, EV; larger is brighter. None: from EXIF.",
    ),
    Parameter(
        "response", "Response curve of developed photographs; auto recovers it from brackets",
        default="auto", kind="choice", choices=RESPONSES,
        flags=("--response",), panel=PHOTOGRAPHS, tells_default=True,
        in_python="Response curve of developed photographs: ``recover`` (from brackets), ``srgb``, "
        "``linear``, or ``auto``: recover if exposures differ, else srgb.",
    ),
    Parameter(
        "scale", "Luminance of a value of 1 in the first photograph, cd/m2", above=0,
        flags=("--scale",), metavar="X", panel=PHOTOGRAPHS, default_words="from EXIF, else 1",
        in_python="Luminance of a value of 1 in the first photograph (at 0 EV with ``ev``), cd/m2; "
        "None: from EXIF, else 1.",
    ),
    Parameter(
        "wb", "White that becomes neutral in raw files", kind="value",
        parse=units.white, flags=("--wb",), metavar="K|X,Y", panel=PHOTOGRAPHS,
        default_words="as shot",
        in_python="White that becomes neutral in raw files: K, or (x, y); None: as shot.",
    ),
    Parameter(
        "circle", "Outline of the ball: centre and radius, px", kind="value",
        parse=lambda flag, text: units.numbers(flag, text, 3, "1024,768,400"),
        flags=("--circle",), metavar="X,Y,R", panel=BALL, default_words="detected",
        in_python="Outline of the ball, centre and radius, px; None: detected.",
    ),
    Parameter(
        "fov", "Horizontal field of view of the photographs, degrees, or far", kind="value",
        parse=_fov, flags=("--fov",), metavar="DEG|far", panel=BALL,
        default_words="from EXIF, else far",
        in_python="Horizontal field of view of the photographs, degrees; 0: the ball is seen from "
        "far away; None: from EXIF, else 0.",
    ),
    Parameter(
        "reflectance", "Reflectance of the ball, X or R,G,B [mirror: 1; grey: 0.18]", kind="value",
        parse=_list("0.6"), flags=("--reflectance",), metavar="X", panel=BALL,
        in_python="Reflectance of the ball, one number or RGB; None: 1 for a mirror ball, 0.18 for "
        "a grey one.",
    ),
    Parameter(
        "ball_direction", "Yaw of the camera, degrees; one for each side", kind="value",
        parse=_angles, flags=("--ball-direction",), metavar="DEG,...", panel=BALL,
        default_words="0: along -z",
        in_python="Yaw of the camera, degrees, about +y from -z toward -x; with several, "
        "photographs are split evenly between the sides. None: 0.",
    ),
    Parameter(
        "pitch", "Pitch of the camera, degrees; positive is up", "deg", 0.0, low=-90, high=90,
        flags=("--pitch",), metavar="DEG", panel=BALL, tells_default=True,
        in_python="Pitch of the camera, degrees; positive is up.",
    ),
    Parameter(
        "sun", "Search for the sun; disc also draws it as a uniform disc", default="auto",
        kind="choice", choices=SUNS, flags=("--sun",), panel=SUN, tells_default=True,
        in_python="Search for the sun. ``auto``: search, and draw it as a disc only if its light "
        "was solved for; ``disc``: search, and always draw a disc; ``off``: no search.",
    ),
    Parameter(
        "sun_diameter", "Angular diameter of the sun's disc, degrees", "deg",
        above=0, high=20, flags=("--sun-diameter",), metavar="DEG", panel=SUN,
        default_words="as measured; 0.533 if clipped",
        in_python="Angular diameter of the sun's disc, degrees; None: as measured, 0.533 if "
        "clipped.",
    ),
    Parameter(
        "illuminance", "Metered illuminance of the open ground, lux; restores clipped light",
        above=0, flags=("--illuminance",), metavar="LUX", panel=SUN,
        in_python="Metered illuminance of the open ground, lux; solves for a clipped sun, else "
        "scales the map.",
    ),
    Parameter(
        "grey", "Photograph of a grey ball that restores clipped light; repeatable", kind="value",
        parse=lambda flag, text: text, repeated=True, flags=("--grey",), metavar="PHOTO", panel=SUN,
        in_python="Photographs of a matt grey ball, to solve for a clipped sun.",
    ),
    Parameter(
        "grey_circle", "Outline of the ball in --grey: centre and radius, px", kind="value",
        parse=lambda flag, text: units.numbers(flag, text, 3, "1024,768,400"),
        flags=("--grey-circle",), metavar="X,Y,R", panel=SUN, default_words="detected",
        in_python="Outline of the ball in ``grey``, centre and radius, px; None: detected.",
    ),
    Parameter(
        "grey_direction", "Yaw of the camera for --grey, degrees", "deg",
        flags=("--grey-direction",), metavar="DEG", panel=SUN,
        default_words="the first --ball-direction",
        in_python="Yaw of the camera for ``grey``, degrees; None: the first ``ball_direction``.",
    ),
    Parameter(
        "rotate", "Rotation of the map about +y, like --env-rotation, degrees", "deg", 0.0,
        flags=("--rotate",), metavar="DEG", panel=MAP, tells_default=True,
        in_python="Rotation of the map about +y, degrees.",
    ),
    Parameter(
        "res", "Width of the map, px; its height is half of that", kind="whole", low=16, high=32768,
        wants="16 to 32768", flags=("--res",), metavar="W", panel=MAP,
        default_words="width of the source",
        in_python="Width of the map, px; its height is half of that. None: width of the source.",
    ),
)
# fmt: on
