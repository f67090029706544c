"""Switches: light that a lens adds to the picture, ghosts, stars and scatter."""

from __future__ import annotations

from collections.abc import Collection

from daguerre.camera.ideal import WITH_IRIS
from daguerre.camera.parameters.needs import GHOSTS, SCATTER, TRACED
from daguerre.rendering.parameters import DEFAULT
from daguerre.rendering.settings import RenderSettings

#: Settings that add such light, and the lens models that support each.
SWITCHES = {
    "flare": GHOSTS.kinds,
    "diffraction": (*TRACED, "thick", *WITH_IRIS),
    "scatter": SCATTER.kinds,
}
#: Settings that need one of these switches to be on.
COMPANIONS = {
    "flare_order": ("flare",),
    "flare_highlights": ("flare", "scatter"),
    "diffraction_bands": ("diffraction",),
    "diffraction_zones": ("diffraction",),
}


def is_on(name: str, value: object) -> bool:
    """Whether a value of a setting switches it on."""
    return value not in (DEFAULT[name], "0", 0.0, None)


def on_in(settings: RenderSettings) -> list[str]:
    """Switches that are on."""
    return [name for name in SWITCHES if is_on(name, getattr(settings.light, name))]


def possible(model: str) -> list[str]:
    """Switches that a model of a lens can turn on."""
    return [name for name, models in SWITCHES.items() if model in models]


def stranded(lit: Collection[str]) -> list[str]:
    """Companions that these switches leave without any that they need."""
    return [name for name, needed in COMPANIONS.items() if not {*needed} & {*lit}]


def without(settings: RenderSettings, off: Collection[str]) -> RenderSettings:
    """Returns the settings with switches off, and without the settings that need them."""
    names = [*off, *stranded({*on_in(settings)} - {*off})]
    return settings.with_(**{name: DEFAULT[name] for name in names if name in DEFAULT})


def suited(settings: RenderSettings, model: str) -> RenderSettings:
    """Returns the settings without the light that a model of a lens cannot add."""
    return without(settings, SWITCHES.keys() - possible(model))
