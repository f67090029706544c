"""Distance of a finished picture from the meter, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.camera.exposure_mode import split_pattern
from daguerre.errors import DaguerreError
from daguerre.exposure.meter_words import distance
from daguerre.exposure.metering import stops_over

from .meter_picture import metered_point

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

    from .session import Session


def metered_part(
    session: Session, size: tuple[int, int] | None = None
) -> tuple[str, tuple[float, float] | None]:
    """Metering pattern of a picture, and the point that it looks at, px; None: the middle.

    Args:
        session: Session that drew it.
        size: Size of the picture that ``spot:X,Y`` refers to, px; None: the session's picture.

    Raises:
        DaguerreError: The spot is not in the picture.
    """
    pattern = session.metering.get("metering") or session.camera.meter
    return split_pattern(pattern)[0], metered_point(session.prepared, pattern, size)


def exposure_in_words(session: Session, frame: Frame) -> str:
    """Exposure mode of a picture and its distance from the meter, in words.

    Args:
        session: Session that drew it.
        frame: The picture.
    """
    mode = str(frame.metadata.get("exposure") or "")
    if not mode:
        return ""
    try:
        stops = stops_over(frame, *metered_part(session))
    except DaguerreError:  # such as a spot out of view, or a frozen shutter
        return mode
    whole = session.crop == (0, 0, session.width, session.height)
    return distance(mode, stops, "" if whole else " in this crop")
