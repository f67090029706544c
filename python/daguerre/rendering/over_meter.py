"""Distance of a finished picture from the meter, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.errors import DaguerreError
from daguerre.exposure.metering import stops_over

from .meter_picture import kind_of, metered_point

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

    from .session import Session


def exposure_in_words(session: Session, frame: Frame) -> str:
    """Exposure mode of a picture and its distance from the meter, in words.

    Args:
        session: Session that drew it.
        frame: The picture.
    """
    mode = frame.metadata.get("exposure")
    if mode is None:
        return ""
    pattern = session.metering.get("metering") or session.camera.meter
    try:
        point = metered_point(session.prepared, pattern)
        stops = stops_over(frame, kind_of(pattern), point)
    except DaguerreError:  # such as a spot out of view, or a frozen shutter
        return str(mode)
    if stops is None:
        return f"{mode}, nothing to meter"
    if abs(stops) < 0.05:
        return f"{mode}, as metered"
    part = "" if session.crop == (0, 0, session.width, session.height) else " in this crop"
    return f"{mode}, {abs(stops):.1f} EV {'over' if stops > 0 else 'under'} the meter{part}"
