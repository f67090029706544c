"""Reads ``Film``: size, brightness and white.

pbrt-v4 multiplies a picture by time x ISO / 100, pbrt-v3 by the film's ``scale``.

Source: pbrt-v4's user's guide ("Film"), ``PixelSensor::Create``: imaging ratio = time x ISO / 100,
for each of its sensors.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .ledger import Ledger
from .state import Entity

_V4, _V3 = (1280, 720), (640, 480)
#: Parameters that only concern the file that pbrt writes.
_OF_FILE = ("filename", "savefp16", "maxcomponentvalue", "maxsampleluminance")


@dataclass(frozen=True)
class FilmSize:
    """Size of a film.

    Attributes:
        resolution: Width and height, px.
        millimetres: Width and height, mm.
        gain: Factor on the picture; in pbrt-v4 without the exposure time.
        white: White balance, K; None: the light's.
    """

    resolution: tuple[int, int]
    millimetres: tuple[float, float]
    gain: float = 1.0
    white: float | None = None

    @property
    def aspect(self) -> float:
        """Width over height."""
        return self.resolution[0] / self.resolution[1]


def film_of(entity: Entity | None, version: int, ledger: Ledger) -> FilmSize:
    """Reads the film of a scene; default: pbrt's default film.

    Raises:
        InputError: A parameter is wrong.
    """
    usual = _V4 if version == 4 else _V3
    if entity is None:
        return FilmSize(usual, _millimetres(usual, 35.0))
    parameters = entity.parameters
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
    if version == 4:
        gain, white = number("iso", 100.0, 1e-3, 1e9) / 100, _white(entity, ledger)
    else:
        gain, white = _scale(entity, ledger), None
    if entity.kind not in ("rgb", "image", "gbuffer", "spectral"):
        ledger.notes.add(f"a Film of kind {entity.kind[:40]!r} is read as 'rgb'")
    ledger.use(entity.place)
    ledger.tell_unread(parameters, entity.place, entity.kind)
    return FilmSize(resolution, _millimetres(resolution, diagonal), gain, white)


def _scale(entity: Entity, ledger: Ledger) -> float:
    """Factor of pbrt-v3's film; 0, which makes a black picture, is left out."""
    scale = entity.parameters.number("scale", 1.0, 0.0)
    if scale:
        return scale
    ledger.notes.add("a scale of 0 of the film is left out")
    return 1.0


def _white(entity: Entity, ledger: Ledger) -> float | None:
    white = entity.parameters.number("whitebalance", 0.0, 0.0, 25000.0)
    sensor = entity.parameters.text("sensor", "cie1931")
    if sensor != "cie1931":
        ledger.notes.add(f"the sensor {sensor[:40]!r} of the film is left out: colors are CIE 1931")
    if 0 < white < 1000:
        ledger.notes.add("a white balance below 1000 K is left out")
    return white if white >= 1000 else None


def _millimetres(resolution: tuple[int, int], diagonal: float) -> tuple[float, float]:
    width, height = resolution
    side = diagonal / math.hypot(width, height)
    return width * side, height * side
