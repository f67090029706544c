"""Rolling shutters: scan order and time per line."""

from __future__ import annotations

from dataclasses import dataclass

from daguerre.doors import guarded

#: ``"box"``, ``("trapezoid", efficiency)`` or points (fraction of the time, opening)
ShutterCurve = str | tuple[str, float] | list[tuple[float, float]]


@guarded
@dataclass(frozen=True)
class RollingShutter:
    """Lines of pixels that are exposed one after the other.

    Attributes:
        scan_order: Side of the upright picture that comes first: top, bottom, left or right.
        line_time: From one line to the next, s; or
        readout_time: for all of them, s: lines x line_time.
    """

    scan_order: str = "top"
    line_time: float | None = None
    readout_time: float | None = None
