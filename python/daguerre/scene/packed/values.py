"""Values that a packed scene may name, each made and checked by its own constructor."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from daguerre.camera.camera import Camera
from daguerre.camera.ideal import IDEAL
from daguerre.camera.lens_scatter import LensScatter
from daguerre.camera.projection import Projection
from daguerre.camera.rolling_shutter import RollingShutter
from daguerre.checks import short
from daguerre.errors import InputError, suggest
from daguerre.files.value import MADE_BY
from daguerre.lenses import library, search
from daguerre.motion.values import Composite, Keys, Spin, is_dynamic, keys, spin
from daguerre.scene.light_profile import LightProfile, ProfileCone, ProfileFocus, ProfileTable
from daguerre.scene.lights import DirectionalLight, PointLight, SphereLight, SpotLight
from daguerre.scene.materials import (
    Boundary,
    Coated,
    Conductor,
    Dielectric,
    Diffuse,
    Gltf,
    Material,
    Mix,
    Spectrum,
    TextureSlot,
)
from daguerre.scene.media import DensityGrid, Medium
from daguerre.scene.parts import Environment
from daguerre.sensors import names as sensor_names

from . import moving

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def make(name: object, state: Mapping[str, Any]) -> Any:
    """Makes a value from the name of its class and its attributes; makes texts printable.

    Raises:
        ValueError: A scene holds no values of this class.
        InputError: An attribute is wrong.
    """
    return make_verbatim(name, {key: _safe(part) for key, part in state.items()})


def make_verbatim(name: object, state: Mapping[str, Any]) -> Any:
    """Makes a value like :func:`make`, with its texts as they are."""
    given = {key: part for key, part in state.items() if key != MADE_BY}
    if isinstance(name, str) and name in moving.NAMES:
        return moving.make(name, given)
    maker = _MAKERS.get(name) if isinstance(name, str) else None
    if maker is None:
        raise ValueError(f"unknown kind of value {short(name)}")
    return maker(**given)


def printable(text: str) -> str:
    """A text without control characters, which a terminal might obey, and halves of others."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)


def _safe(part: object) -> Any:
    if isinstance(part, tuple):
        return tuple(map(_safe, part))
    return printable(part) if isinstance(part, str) else part


def _keys(
    times: ArrayLike, values: Iterable[Any], interpolation: str, pivot: ArrayLike | None = None
) -> Keys:
    pairs = zip(np.asarray(times).tolist(), values, strict=True)
    return keys(pairs, interpolation, pivot)


def _camera(**given: Any) -> Camera:
    """A camera; for safety a file may name a lens or a sensor of the library, but no file."""
    _listed(
        "lens", given.get("lens"), (*IDEAL, *library.names()), partial(search.suggest, others=IDEAL)
    )
    _listed(
        "sensor",
        given.get("sensor"),
        sensor_names(),
        partial(suggest, known=sensor_names(), few=True),
    )
    motion = given.get("motion", {})
    if not isinstance(motion, Mapping) or not all(map(is_dynamic, motion.values())):
        raise InputError("camera: motion: values must change over time")
    if given.get("sensor_size") is None:
        given.pop("sensor_size", None)  # was not given
    return Camera(**given)


def _listed(what: str, name: object, names: Collection[str], near: Callable[[str], str]) -> None:
    if name is not None and not (isinstance(name, str) and name in names):
        raise InputError(
            f"camera: {what}: refused: wanted the name of a {what} in the library, got "
            f"{short(name)}{near(str(name))}"
        )


_PLAIN: tuple[type[Any], ...] = (
    *(Boundary, Coated, Conductor, Dielectric, Diffuse, Gltf, Mix),
    *(Material, Spectrum, TextureSlot),
    *(DensityGrid, Medium),
    *(DirectionalLight, PointLight, SphereLight, SpotLight, Environment),
    *(LightProfile, ProfileCone, ProfileFocus, ProfileTable),
    *(Composite, LensScatter, Projection, RollingShutter),
)
_OTHERS: dict[type[Any], Callable[..., Any]] = {Camera: _camera, Keys: _keys, Spin: spin}
_MAKERS: dict[str, Callable[..., Any]] = {
    f"{kind.__module__}:{kind.__qualname__}": maker
    for kind, maker in ({kind: kind for kind in _PLAIN} | _OTHERS).items()
}
#: Classes that a packed scene may hold.
KINDS = (*_PLAIN, *_OTHERS)
