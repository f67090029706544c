"""Solids around a camera: water, glass and other meshes that refract light."""

from __future__ import annotations

from .prepare import Prepared

#: Share of directions in which the mesh of a solid must be closed for the camera to be inside.
_INSIDE = 0.5


def solids_around(prepared: Prepared) -> list[str]:
    """Names of the solids around the camera at some time of the exposure."""
    return [name for name, share in _found(prepared).items() if share > _INSIDE]


def open_solids(prepared: Prepared) -> list[str]:
    """A sentence for each solid around the camera with a mesh that is not closed."""
    return [
        f"the camera is inside {name}, a mesh that is not closed: {share:.0%} of its directions "
        "leave it through a back face"
        for name, share in _found(prepared).items()
        if share < 0.99
    ]


def _found(prepared: Prepared) -> dict[str, float]:
    """Largest share of directions that leave each solid through its inside, by its name."""
    begin, end = prepared.interval
    found: dict[str, float] = {}
    for moment in (0.0, 0.5, 1.0):
        camera = prepared.camera.frozen_at((1 - moment) * begin + moment * end)
        x, y, z = camera.transform[:3, 3].tolist()
        for instance, share in prepared.core_scene.surroundings((x, y, z), moment):
            own = prepared.scene.instances[instance]
            name = repr(own.name or instance)
            found[name] = max(found.get(name, 0.0), share)
    return found
