"""Solids around a camera: water, glass and other meshes that refract light."""

from __future__ import annotations

from typing import NamedTuple

from .prepare import Prepared

#: Share of directions in which the mesh of a solid must be closed for the camera to be inside.
_INSIDE = 0.5


class Around(NamedTuple):
    """Solids around the camera at some time of the exposure.

    Attributes:
        names: Their names.
        notes: A sentence for each solid with a mesh that is not closed.
    """

    names: list[str]
    notes: list[str]


def solids_around(prepared: Prepared) -> Around:
    """Finds the solids around the camera of a picture."""
    found = _found(prepared)
    notes = [
        f"the camera is inside {name}, a mesh that is not closed: {share:.0%} of its directions "
        "leave it through a back face"
        for name, share in found.items()
        if share < 0.99
    ]
    return Around([name for name, share in found.items() if share > _INSIDE], notes)


def _found(prepared: Prepared) -> dict[str, float]:
    """Largest share of directions that leave each solid through its inside, by its name."""
    begin, end = prepared.interval
    moves = prepared.scene.motion or "transform" in prepared.camera.motion
    found: dict[str, float] = {}
    for moment in (0.0, 0.5, 1.0) if moves else (0.5,):
        camera = prepared.camera.frozen_at((1 - moment) * begin + moment * end)
        x, y, z = camera.transform[:3, 3].tolist()
        for instance, share in prepared.core_scene.surroundings((x, y, z), moment):
            own = prepared.scene.instances[instance]
            name = repr(own.name or instance)
            found[name] = max(found.get(name, 0.0), share)
    return found
