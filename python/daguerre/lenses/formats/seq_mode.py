"""Chooses between radii and curvatures in a CODE V sequence that does not say RDM.

Programs that read such files differ. The image of the right reading lies on the file's own film.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from daguerre.lenses.errors import LensError
from daguerre.lenses.focus import image_z
from daguerre.lenses.json_lens import lens_of

#: A lens file's value, and notes.
Read = tuple[dict[str, Any], list[str]]


def fitting(radii: Callable[[], Read], curvatures: Callable[[], Read], where: str) -> Read:
    """Returns the reading with the paraxial image nearest to the file's film, with a note.

    Without a film in the file, the numbers are radii.

    Args:
        radii: Builds the lens, with the first numbers of its surfaces as radii.
        curvatures: Builds it with the same numbers as curvatures.
        where: Name of the file.

    Raises:
        LensError: Neither makes a lens; the error of radii.
    """
    found: dict[str, tuple[float, Read]] = {}
    errors: list[LensError] = []
    for word, read in (("radii", radii), ("curvatures", curvatures)):
        try:
            made = read()
            found[word] = _miss(made[0], where), made
        except LensError as error:
            errors.append(error)
    if not found:
        raise errors[0]
    word = min(found, key=lambda name: found[name][0])
    miss, (data, notes) = found[word]
    if errors:
        reason = "the other reading makes no lens"
    elif not data["surfaces"][-1]["thickness"]:
        reason = "the file has no image distance to choose by"
    else:
        (other,) = (name for name in found if name != word)
        reason = (
            f"the image is {miss:.4g} mm from the file's film, with {other} {found[other][0]:.4g}"
        )
    return data, [f"no RDM: the numbers of surfaces are read as {word}, as {reason}", *notes]


def _miss(data: dict[str, Any], where: str) -> float:
    """Distance of the paraxial image from the file's film, mm."""
    lens = lens_of(data, where)
    distance = lens.configurations[0].object_distance_mm
    return abs(image_z(lens, -math.inf if distance is None else -distance) - lens.image_z)
