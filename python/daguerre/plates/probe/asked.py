"""Parameters of a light probe, checked, and notes."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import number, numbers, shown
from daguerre.errors import UsageError
from daguerre.files.notes import Notes

from .brackets import Reading
from .latlong import FloatArray


@dataclass(frozen=True)
class Asked:
    """Parameters of the table ``LIGHT_PROBE``, converted for use."""

    photographs: list[Path]
    ball: str | None
    ev: tuple[float, ...] | None
    circle: tuple[float, float, float] | None
    fov: float | None
    reflectance: FloatArray
    yaws: tuple[float, ...]
    pitch: float
    sun: str
    sun_diameter: float | None
    illuminance: float | None
    grey: list[Path]
    grey_circle: tuple[float, float, float] | None
    grey_yaw: float
    rotate: float
    res: int | None
    reading: Reading
    notes: Notes = field(default_factory=Notes)

    @classmethod
    def of(cls, photographs: object, given: dict[str, Any]) -> Asked:
        """Checks and converts parameters, beyond the checks of the table.

        Raises:
            UsageError: A parameter is wrong; the message has its name.
        """
        paths, greys = _paths(photographs), _paths([] if given["grey"] is None else given["grey"])
        if not paths:
            raise UsageError("light_probe: photographs: wanted at least one, got none")
        ball = given["ball"]
        yaws = _several(given["ball_direction"], "ball_direction") or (0.0,)
        _refuse_idle(ball, given)
        if len(paths) % len(yaws):
            raise UsageError(
                f"--ball-direction: wanted the same number of photographs for each of {len(yaws)} "
                f"sides, got {len(paths)} in all"
            )
        notes = Notes()
        reading = Reading(given["wb"], given["response"], given["scale"], notes)
        return cls(
            photographs=paths, ball=ball, ev=_several(given["ev"], "ev"),
            circle=_circle(given["circle"], "circle"), fov=_fov(given["fov"]),
            reflectance=_reflectance(given["reflectance"], ball), yaws=yaws,
            pitch=given["pitch"], sun=given["sun"], sun_diameter=given["sun_diameter"],
            illuminance=given["illuminance"], grey=greys,
            grey_circle=_circle(given["grey_circle"], "grey_circle"),
            grey_yaw=yaws[0] if given["grey_direction"] is None else given["grey_direction"],
            rotate=given["rotate"], res=given["res"], reading=reading, notes=notes,
        )  # fmt: skip

    @property
    def sides(self) -> list[tuple[float, list[Path]]]:
        """Photographs of each side of the ball, with the yaw of the camera."""
        each = len(self.photographs) // len(self.yaws)
        return [
            (yaw, self.photographs[i * each : (i + 1) * each]) for i, yaw in enumerate(self.yaws)
        ]

    def ev_of(self, side: int) -> tuple[float, ...] | None:
        """Exposures of the photographs of a side, EV; the list has one side's or all sides'."""
        if self.ev is None or len(self.ev) != len(self.photographs):
            return self.ev
        each = len(self.ev) // len(self.yaws)
        return self.ev[side * each : (side + 1) * each]


def _paths(given: Any) -> list[Path]:
    if isinstance(given, str | Path):
        return [Path(given)]
    try:
        return [Path(one) for one in given]
    except TypeError:
        raise UsageError(f"light_probe: wanted photographs, got {shown(given)}") from None


def _several(given: Any, name: str) -> tuple[float, ...] | None:
    """One number or several; None stays None."""
    if given is None:
        return None
    if isinstance(given, int | float) and not isinstance(given, bool):
        given = (given,)
    wanted = "numbers" if name == "ev" else "one number or several"
    return numbers(given, f"light_probe: {name}", len(given), wanted)


def _circle(given: object, name: str) -> tuple[float, float, float] | None:
    if given is None:
        return None
    x, y, radius = numbers(given, f"light_probe: {name}", 3, "x, y and radius in px")
    number(radius, f"light_probe: {name}: radius", 4)
    return x, y, radius


def _fov(given: object) -> float | None:
    return None if given is None else number(given, "light_probe: fov", 0, 179)


def _reflectance(given: object, ball: str | None) -> NDArray[np.float64]:
    if given is None:
        given = 0.18 if ball == "grey" else 1.0
    found = _several(given, "reflectance") or ()
    if len(found) not in (1, 3) or not all(0 < v <= 1 for v in found):
        raise UsageError(
            f"light_probe: reflectance: wanted one or three numbers above 0, at most 1; got {given}"
        )
    return np.broadcast_to(np.array(found), 3)


def _refuse_idle(ball: str | None, given: dict[str, Any]) -> None:
    """Raises an error for parameters without effect."""
    flags = ("circle", "reflectance", "ball_direction", "pitch")
    idle = [n for n in flags if given[n] is not None and not (n == "pitch" and given[n] == 0)]
    if ball is None and idle:
        raise UsageError(f"--{idle[0].replace('_', '-')} needs --ball mirror or --ball grey")
    if given["grey"] and (given["illuminance"] or ball == "grey"):
        other = "--ball grey" if ball == "grey" else "--illuminance"
        raise UsageError(f"--grey and {other}: wanted one of them, got both")
    if not given["grey"]:
        for name in ("grey_circle", "grey_direction"):
            if given[name] is not None:
                raise UsageError(f"--{name.replace('_', '-')} needs --grey")
    if ball == "grey" and np.size(given["ball_direction"]) > 1:
        raise UsageError("--ball-direction: wanted one value for a grey ball, got several")
