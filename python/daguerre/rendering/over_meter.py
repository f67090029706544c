"""Distance of a finished picture from the meter, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from daguerre.camera.exposure_mode import split_pattern
from daguerre.errors import DaguerreError
from daguerre.exposure.meter_words import distance
from daguerre.exposure.metering import stops_over

from .meter_picture import metered_point

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

    from .session import Session


class MeteredPart(NamedTuple):
    """Part of a picture that a meter looks at.

    Attributes:
        pattern: Metering pattern.
        at: Point that it looks at, px; None: the middle.
    """

    pattern: str
    at: tuple[float, float] | None


def metered_part(session: Session, size: tuple[int, int] | None = None) -> MeteredPart:
    """Returns the part of a picture that its meter looks at.

    Args:
        session: Session that drew it.
        size: Size of the picture that ``spot:X,Y`` refers to, px; None: the session's picture.

    Raises:
        DaguerreError: The spot is not in the picture.
    """
    pattern = session.metering.get("metering") or session.camera.meter
    at = metered_point(session.prepared, pattern, size)
    return MeteredPart(split_pattern(pattern)[0], at)


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
        part = metered_part(session)
        stops = stops_over(frame, part.pattern, part.at)
    except DaguerreError:  # such as a spot out of view, or a frozen shutter
        return mode
    whole = session.crop == (0, 0, session.width, session.height)
    return distance(mode, stops, "" if whole else " in this crop")
