"""Compares the film position of an imported file with a camera's, which is at the focus."""

from __future__ import annotations

import math

from daguerre.lenses.focus import image_z, path_of
from daguerre.lenses.lens import Lens

#: Films this near to the focus, as a share of the focal length, were moved for a sharper picture.
_NEAR = 0.005


def film_notes(lens: Lens) -> list[str]:
    """Returns a note on the file's film and object, as a camera puts them where its focus is."""
    behind = lens.surfaces[-1].thickness
    if not behind or path_of(lens) is not None:
        return []
    order, first = lens.first_order(), lens.configurations[0]
    back = f"{behind:.4g} mm behind the last surface"
    if first.object_distance_mm is not None:
        return [
            f"the file has its object {first.object_distance_mm:.4g} mm before the lens and its "
            f"image {back}: the focus distance of the camera replaces both"
        ]
    focus = image_z(lens, -math.inf)
    if abs(lens.image_z - focus) <= _NEAR * abs(order.efl):
        return [f"the file has its image {back}: the focus distance of the camera places the film"]
    at = focus - float(lens.vertices[-1])
    return [f"the file has its image {back}: the film is at the focus instead, {at:.4g} mm"]
