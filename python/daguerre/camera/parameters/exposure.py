"""Parameters of brightness: exposure, white balance, vignetting."""

from __future__ import annotations

from functools import partial

from daguerre import units
from daguerre.camera.exposure_mode import METERS, MODES, meter_of, mode_of
from daguerre.parameters.parameter import Parameter

from . import needs

#: F-stop that exposes a pinhole, which has no aperture: the sunny 16 rule, two stops wider.
_PINHOLE = 8.0
EXPOSURE_PANEL = "Exposure"
_Row = partial(Parameter, panel=EXPOSURE_PANEL)

EXPOSURE = (
    _Row(
        "exposure",
        "Exposure mode: light (1 is white), manual (ISO, time and f-stop count), or a meter sets "
        "the ISO (auto), the time (A), the f-stop (S) or both (P)",
        default="light",
        kind="text",
        flags=("--exposure",),
        metavar="|".join(MODES),
        parse=mode_of,
        tells_default=True,
        in_python="Exposure mode: ``light`` (1 is white), ``manual`` (ISO, time and f-stop "
        "count), or a meter sets the ISO (``auto``), the time (``A``), the f-stop (``S``) or both "
        "(``P``); default: light. No parameter of exposure changes the linear picture.",
        explained=("exposure.md",),
    ),
    _Row(
        "meter",
        "Metering pattern: centre, spot, matrix or highlight; spot:X,Y and spot:NODE read the spot "
        "at a pixel or a node",
        default="centre",
        kind="text",
        flags=("--meter",),
        metavar=f"{'|'.join(METERS)}|spot:X,Y|spot:NODE",
        parse=meter_of,
        tells_default=True,
        explained=("exposure.md",),
    ),
    _Row(
        "iso",
        "ISO speed of developed pictures; in the exposure mode light it sets the noise alone",
        default=100.0,
        above=0,
        flags=("--iso",),
        metavar="N",
        tells_default=True,
        movable=True,
    ),
    _Row(
        "exposure_compensation",
        "Exposure compensation, EV; in every mode",
        "EV",
        0.0,
        low=-64,
        high=64,
        flags=("--ev",),
        metavar="EV",
        tells_default=True,
        movable=True,
    ),
    _Row(
        "exposure_time",
        "Exposure time that sets brightness, s; motion blur keeps {shutter_time}",
        "s",
        above=0,
        flags=("--exposure-time",),
        metavar="S",
        default_words="{shutter_time}",
        explained=("exposure.md",),
        movable=True,
    ),
    _Row(
        "exposure_f_stop",
        "F-stop that sets brightness; depth of field keeps {f_stop}",
        above=0,
        flags=("--exposure-f-stop",),
        metavar="N",
        parse=units.f_number,
        usual=_PINHOLE,
        default_words=f"{{f_stop}}; for a pinhole {_PINHOLE:g}",
        explained=("exposure.md",),
        movable=True,
    ),
    _Row(
        "responsivity",
        "Factor that scales the exposure",
        default=1.0,
        above=0,
        flags=("--responsivity",),
        metavar="X",
        tells_default=True,
        movable=True,
    ),
    _Row(
        "white_balance",
        "White balance for development: kelvins such as 5600, or a chromaticity x,y",
        "K or x,y",
        kind="value",
        flags=("--wb",),
        metavar="K|X,Y",
        parse=units.white,
        in_python="White for development: colour temperature, K, or chromaticity (x, y).",
    ),
    _Row(
        "natural_vignetting",
        "Thin lens and pinhole: darken by cos^4 of the field angle",
        default=False,
        kind="flag",
        flags=("--natural-vignetting/--no-natural-vignetting",),
        needs=(needs.LENS_ITSELF, needs.EVEN),
    ),
)
