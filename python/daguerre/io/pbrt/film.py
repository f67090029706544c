"""Reads ``Film``: size, exposure and white.

pbrt shows a radiance of 1 as 1 at ISO 100 and 1 s; it has no f-stop (but in its realistic camera).
Here 10 / ISO lux s become 0.18 of white (ISO 12232), so a camera whose brightness is that of
f/1.19 shows the same: 0.18 / 10 x pi / (4 N^2) = 1 / 100.

Source: pbrt-v4's user's guide ("Film"), ``PixelSensor::Create``: imaging ratio = time x ISO / 100.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .ledger import Ledger
from .state import Made

#: F-stop whose brightness is that of pbrt.
PBRT_F_STOP = math.sqrt(0.45 * math.pi)
#: Factor on the exposure of a lens with an f-stop in pbrt: its film has the illuminance itself.
PBRT_RESPONSIVITY = 1 / 1.8
_V4, _V3 = (1280, 720), (640, 480)
#: Parameters that only concern the file that pbrt writes.
_OF_FILE = ("filename", "savefp16", "maxcomponentvalue", "maxsampleluminance")


@dataclass(frozen=True)
class FilmSize:
    """Size of a film.

    Attributes:
        resolution: Width and height, px.
        millimetres: Width and height, mm.
        exposure: Parameters of ``Camera``.
    """

    resolution: tuple[int, int]
    millimetres: tuple[float, float]
    exposure: dict[str, Any]

    @property
    def aspect(self) -> float:
        """Width over height."""
        return self.resolution[0] / self.resolution[1]


def film_of(made: Made | None, version: int, ledger: Ledger) -> FilmSize:
    """Reads the film of a scene; without one it is pbrt's.

    Raises:
        InputError: A parameter is wrong.
    """
    usual = _V4 if version == 4 else _V3
    if made is None:
        return _sized(usual, 35.0, {})
    parameters = made.parameters
    integer, number = parameters.integer, parameters.number
    resolution = (
        integer("xresolution", usual[0], 1, 1 << 16),
        integer("yresolution", usual[1], 1, 1 << 16),
    )
    diagonal = number("diagonal", 35.0, 1e-2, 1e5)
    for name in _OF_FILE:
        parameters.find(name)
    for name, plain in (("cropwindow", [0, 1, 0, 1]), ("pixelbounds", None)):
        values = parameters.numbers(name)
        if values is not None and values.tolist() != plain:
            ledger.notes.add(f"{name!r} of the film is left out: the whole picture is drawn")
    exposure: dict[str, Any] = {}
    if version == 3:
        scale = number("scale", 1.0, 0.0)
        exposure = {"responsivity": scale} if scale not in (0.0, 1.0) else {}
    else:
        exposure = _exposure(made, ledger)
    if made.kind not in ("rgb", "image", "gbuffer", "spectral"):
        ledger.notes.add(f"a Film of kind {made.kind[:40]!r} is read as 'rgb'")
    ledger.use(made.place)
    ledger.tell_unread(parameters, made.place, made.kind)
    return _sized(resolution, diagonal, exposure)


def _exposure(made: Made, ledger: Ledger) -> dict[str, Any]:
    number = made.parameters.number
    exposure: dict[str, Any] = {}
    iso = number("iso", 100.0, 1e-3, 1e9)
    if iso != 100:
        exposure["iso"] = iso
    white = number("whitebalance", 0.0, 0.0, 25000.0)
    sensor = made.parameters.text("sensor", "cie1931")
    if sensor != "cie1931":
        ledger.notes.add(f"the sensor {sensor[:40]!r} of the film is left out: colors are CIE 1931")
    if white >= 1000:
        exposure["white_balance"] = white
    elif white > 0:
        ledger.notes.add("a white balance below 1000 K is left out")
    return exposure


def _sized(resolution: tuple[int, int], diagonal: float, exposure: dict[str, Any]) -> FilmSize:
    width, height = resolution
    side = diagonal / math.hypot(width, height)
    return FilmSize(resolution, (width * side, height * side), exposure)
