"""Media of a scene in the core's form."""

from __future__ import annotations

from typing import Any

import daguerre._core as _core
from daguerre.checks import as_readonly
from daguerre.errors import InputError
from daguerre.scene.lights import DirectionalLight
from daguerre.scene.materials import Boundary
from daguerre.scene.media import Medium
from daguerre.scene.scene import Scene
from daguerre.scene.spectrum import Spectrum

ENDLESS = (
    "endless fog absorbs all light of the environment and of directional lights; put "
    "the fog inside a mesh of dg.Boundary to let this light in"
)


def add_media(builder: _core.SceneBuilder, scene: Scene, notes: list[str]) -> None:
    """Adds the media of materials and of the world, each once.

    Args:
        builder: Scene of the core, with all materials.
        scene: The scene.
        notes: List that gets a sentence if fog keeps out light.

    Raises:
        InputError: The scene has both media and catchers.
    """
    if scene.has_media and scene.has_catchers:
        raise InputError(
            "catchers cannot be used in a scene with media: remove the catchers or the media"
        )
    known: list[Medium] = []

    def index(medium: Medium | None) -> int:
        if medium is None:
            return -1
        for i, one in enumerate(known):
            if one is medium:
                return i
        known.append(medium)
        return _add_medium(builder, medium)

    for i, material in enumerate(scene.materials):
        invisible = isinstance(material.kind, Boundary)
        media = (material.interior, material.exterior)
        if invisible or media != (None, None):
            builder.set_media(i, index(media[0]), index(media[1]), invisible)
    if scene.fog is not None:
        builder.set_fog(index(scene.fog))
        if scene.fog.density is None and _has_light_from_infinity(scene):
            notes.append(ENDLESS)


def _has_light_from_infinity(scene: Scene) -> bool:
    suns = any(isinstance(light, DirectionalLight) for light, _ in scene.lights)
    return suns or scene.environment is not None


def _add_medium(builder: _core.SceneBuilder, medium: Medium) -> int:
    grid = medium.density
    density = None if grid is None else (as_readonly(grid.values), as_readonly(grid.transform))
    added = builder.add_medium(
        _core_color(medium.absorption),
        _core_color(medium.scattering),
        _core_color(medium.emission),
        list(medium.lobes),
        density,
    )
    return int(added)


def _core_color(value: object) -> Any:
    """A triple, or wavelengths and values."""
    return (value.wavelengths_nm, value.values) if isinstance(value, Spectrum) else value
