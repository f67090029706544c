"""Setting of a lens: f-stop, focus and zoom in one record."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass
from typing import Literal, get_args

from daguerre.argument_checks import guarded
from daguerre.checks import short
from daguerre.errors import UsageError

By = Literal["paraxial", "best"]
MeasuredFrom = Literal["pupil", "sensor"]


@guarded
@dataclass(frozen=True)
class LensSetting:
    """Setting of a lens, as on its rings.

    The record checks only types and choices. Ranges depend on the lens and are checked when the
    setting is applied; the error then has the lens's file, its range and a code.

    Attributes:
        f_stop: F-stop as engraved, for infinity focus; None: wide open.
        focus_m: Distance in focus, m; may be infinite.
        zoom_mm: Focal length of a zoom, mm; None: the current focal length.
        focus_by: ``paraxial``: the paraxial image; ``best``: the smallest RMS spot on the axis.
        focus_from: Start of the distance: ``pupil``, the centre of the entrance pupil, or
            ``sensor``.

    Raises:
        UsageError: Unknown ``focus_by`` or ``focus_from``, or a value that is not a number.
    """

    f_stop: float | None = None
    focus_m: float = math.inf
    zoom_mm: float | None = None
    focus_by: By = "paraxial"
    focus_from: MeasuredFrom = "pupil"

    def __post_init__(self) -> None:
        _check_choice("focus_by", self.focus_by, get_args(By))
        _check_choice("focus_from", self.focus_from, get_args(MeasuredFrom))
        _check_number("focus_m", self.focus_m)
        for name, value in (("f_stop", self.f_stop), ("zoom_mm", self.zoom_mm)):
            if value is not None:
                _check_number(name, value)

    @property
    def from_sensor(self) -> bool:
        """Whether the distance starts at the sensor."""
        return self.focus_from == "sensor"


def _check_choice(name: str, given: object, known: tuple[str, ...]) -> None:
    if not isinstance(given, str) or given not in known:
        raise UsageError(f"lens setting: {name}: wanted {' or '.join(known)}, got {short(given)}")


def _check_number(name: str, given: object) -> None:
    if isinstance(given, bool) or not isinstance(given, numbers.Real):
        raise UsageError(f"lens setting: {name}: wanted a number, got {short(given)}")
