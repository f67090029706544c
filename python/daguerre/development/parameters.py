"""Parameters of development: a row for each, which defines keyword, checks and flag."""

from __future__ import annotations

from typing import Any, TypedDict

from daguerre.camera.exposure_mode import METERS, RETAKEN, meter_of, retaken_mode
from daguerre.camera.parameters import typed
from daguerre.color.spaces import COLOR_SPACES
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table

HIGHLIGHTS = ("clip", "blend", "reconstruct")
SENSOR, LOOK, FILE = "The sensor (of IN.exr)", "The picture", "The file"


class RecipeKeywords(TypedDict, total=False):
    """Keywords of ``develop``."""

    wb: Any
    look: str
    ev: float
    exposure: str | None
    meter: str
    colour_space: str
    sharpen: float
    grain: float
    highlights: str
    demosaic: str
    colour_noise: int
    seed: int


# fmt: off
DEVELOP = Table(
    Parameter(
        "seed", "Seed of noise and grain", default=0, kind="whole",
        flags=("--seed",), metavar="N", panel=SENSOR, tells_default=True,
        in_python="Seed of the grain.",
    ),
    Parameter(
        "ev", "Exposure compensation, EV, on top of the file's; in every mode",
        "EV", 0.0, low=-64, high=64,
        parse=typed.number("an exposure in EV such as -0.5"),
        flags=("--ev",), metavar="EV", panel=LOOK,
        in_python="Exposure compensation, EV, on top of the frame's.",
    ),
    Parameter(
        "exposure",
        "Exposure mode: light (1 is white), manual (ISO, time and stop set the brightness) or auto "
        "(a meter sets the ISO)",
        kind="text", flags=("--exposure",), metavar="|".join(RETAKEN), parse=retaken_mode,
        panel=LOOK, default_words="the file's, else manual",
        in_python="Exposure mode of a frame: ``light`` (1 is white), ``manual`` (ISO, time and "
        "stop set the brightness) or ``auto`` (a meter sets the ISO). None: the frame's, else "
        "``manual``.",
    ),
    Parameter(
        "meter", "Metering pattern of auto", default="centre", kind="text",
        flags=("--meter",), metavar=f"{'|'.join(METERS)}|spot:X,Y", parse=meter_of, panel=LOOK,
        tells_default=True,
        in_python="Metering pattern of ``auto``: ``centre``, ``spot``, ``matrix`` or "
        "``highlight``; ``spot:X,Y`` reads the spot at a pixel.",
    ),
    Parameter(
        "wb", "White that becomes neutral", kind="value",
        flags=("--wb",), metavar="as-shot|auto|K|X,Y", panel=LOOK, default_words="as-shot",
        in_python='White that becomes neutral: "as-shot" (None), "auto", a colour temperature, K, '
        "or a chromaticity (x, y).",
    ),
    Parameter(
        "look", "Tone curve [neutral]; OCIO: extra `color`", default="neutral", kind="text",
        flags=("--look",), metavar="neutral|standard|film|filmic|ocio:VIEW", panel=LOOK,
        in_python="Tone curve. ``neutral``: linear up to white; ``standard``, ``film``, "
        "``filmic``: curves with toe and shoulder; ``ocio:VIEW``: a view of OpenColorIO's ACES "
        "configuration (extra ``color``).",
    ),
    Parameter(
        "highlights", "Treatment of saturated channels", default="clip", kind="choice",
        choices=HIGHLIGHTS, wants=f"one of {', '.join(HIGHLIGHTS)}",
        flags=("--highlights",), panel=LOOK, tells_default=True,
        in_python="Treatment of saturated channels. ``clip``: to white; ``blend``: highlights keep "
        "differences and lose colour; ``reconstruct``: from the other channels.",
    ),
    Parameter(
        "sharpen", "Strength of an unsharp mask", default=0.0, low=0, high=10,
        flags=("--sharpen",), metavar="X", panel=LOOK, tells_default=True,
        in_python="Strength of an unsharp mask; 0: none, 0.5: about that of a camera.",
    ),
    Parameter(
        "grain", "Diameter of film grains, um", "um", 0.0, low=0, high=1000,
        parse=typed.number("a diameter in um such as 2"),
        flags=("--grain",), metavar="UM", panel=LOOK, tells_default=True,
        in_python="Diameter of film grains, um; 0: none. Needs ``sensorOverallDimensions`` in the "
        "metadata, or a raw picture.",
    ),
    Parameter(
        "demosaic", "Demosaicing method, also by LibRaw's names", default="good", kind="text",
        flags=("--demosaic",), metavar="best|good|fast", panel=LOOK, tells_default=True,
        in_python="Demosaicing method: ``best``, ``good``, ``fast``, or LibRaw's name of one.",
    ),
    Parameter(
        "colour_noise", "Passes of a median filter over color differences, for raw pictures",
        default=0, kind="whole", low=0, high=20,
        flags=("--colour-noise",), metavar="N", panel=LOOK, tells_default=True,
        in_python="Passes of a median filter over colour differences, against colour noise at "
        "high ISO; 0: none, 2 to 5 are usual. Only for raw pictures with colours.",
    ),
    Parameter(
        "colour_space", "Color space of the file; the linear ones need .exr", default="srgb",
        kind="choice", choices=tuple(COLOR_SPACES), wants=f"one of {', '.join(COLOR_SPACES)}",
        flags=("--colorspace",), panel=FILE, tells_default=True,
        in_python="Colour space of the picture: ``srgb``, ``p3`` or ``rec2020`` for displays; "
        "``lin_rec709``, ``acescg``, ``aces``, ``xyz`` or a raw picture's ``camera`` for "
        "scene-linear light in an ``.exr``, which is neither clipped nor toned.",
    ),
)
# fmt: on
