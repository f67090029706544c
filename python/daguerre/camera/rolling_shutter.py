"""Rolling shutters: scan order and time per line."""

from __future__ import annotations

from dataclasses import dataclass

from daguerre.argument_checks import guarded

#: ``"box"``, ``("trapezoid", efficiency)`` or points (fraction of the time, opening)
ShutterCurve = str | tuple[str, float] | list[tuple[float, float]]


@guarded
@dataclass(frozen=True)
class RollingShutter:
    """Rolling shutter: lines of pixels are exposed in sequence.

    Attributes:
        scan_order: Side of the upright picture that is exposed first: top, bottom, left or right.
        line_time: Time from one line to the next, s; give this or ``readout_time``.
        readout_time: Time for all lines, s: number of lines x ``line_time``.
    """

    scan_order: str = "top"
    line_time: float | None = None
    readout_time: float | None = None
