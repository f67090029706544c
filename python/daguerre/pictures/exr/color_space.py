"""Colour spaces of frames in OpenEXR files: converted channels, and attributes of the space.

Light is converted: R, G, B and the layers ``flare``, ``catcher`` and ``albedo``. ``catcher_ratio``
is converted like light on white, which is exact for grey plates. All other channels are no
colours of primaries, ``variance`` among them, and keep their numbers.

With ACES primaries, a file of nothing but R, G, B and A is an ACES image container (SMPTE
ST 2065-4): half floats, not compressed, without variance and sample counts.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color.encodings import encoding_of_space, rec709_from, through
from daguerre.color.spaces import COLOR_SPACES, LINEAR, WORKING

from .layout import NONE

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

Float = NDArray[np.float32]
#: Layers of light, by their names in files; a frame's own picture is R, G, B.
LIGHT, RATIO = ("flare", "catcher", "albedo"), "catcher_ratio"
ACES = "aces"
#: Largest half float.
_MOST_HALF = 65504.0


def space_of(metadata: Mapping[str, Any]) -> str:
    """Name of the space in which a frame is written."""
    name = metadata.get("colorspace")
    return name if name in LINEAR else WORKING


def space_attributes(name: str) -> dict[str, Any]:
    """Attributes of a file of linear light in a space of ``spaces.COLOR_SPACES``."""
    space = COLOR_SPACES[name]
    return {
        "chromaticities": (*itertools.chain(*space.primaries), *space.white),
        "colorInteropID": space.interop,
    }


class Converter:
    """Converts channels of frames from and to linear Rec.709; ``name``: a linear space."""

    def __init__(self, name: str) -> None:
        """Finds the matrices of a space."""
        self._light = np.array(rec709_from(encoding_of_space(name)))
        self._white = np.linalg.inv(self._light).sum(axis=1)

    def written(self, layer: str, plane: Float) -> Float:
        """A layer in the space; ``layer``: ``RGB``, or its name."""
        made = through(plane, np.linalg.inv(self._light))
        return made / self._white.astype(np.float32) if layer == RATIO else made

    def read(self, layer: str, plane: Float) -> Float:
        """A layer in linear Rec.709."""
        scaled = plane * self._white.astype(np.float32) if layer == RATIO else plane
        return through(scaled, self._light)


def in_space(planes: dict[str, Any], name: str) -> dict[str, Any]:
    """Channels by name, (H, W) or (H, W, 3), with light in a space instead of linear Rec.709."""
    if name == WORKING:
        return planes
    made, convert = dict(planes), Converter(name)
    for layer in ("RGB", *LIGHT, RATIO):
        if layer in planes:
            made[layer] = convert.written(layer, planes[layer])
        elif names := _split(layer, planes):
            light = convert.written(layer, np.stack([planes[name] for name in names], axis=2))
            made |= {name: light[:, :, i] for i, name in enumerate(names)}
    return made


def in_rec709(planes: dict[str, Any], convert: Any) -> None:
    """Converts the layers of light of a file, (H, W) each, in place.

    Args:
        planes: Channels by name.
        convert: Function of a layer's name and its light, (H, W, 3).
    """
    for layer in (*LIGHT, RATIO):
        if names := _split(layer, planes):
            light = convert(layer, np.stack([planes[name] for name in names], axis=2))
            planes.update({name: light[:, :, i] for i, name in enumerate(names)})


def _split(layer: str, planes: Mapping[str, Any]) -> list[str]:
    names = [f"{layer}.{color}" for color in "RGB"]
    return names if all(name in planes for name in names) else []


def beside_color(frame: Frame) -> list[str]:
    """Groups of channels that an ACES image container cannot hold, and that somebody asked for."""
    found = {name.partition(".")[0] for name in frame.aovs}
    found |= {f"crypto_{name}" for name in frame.cryptomatte}
    parts = ("flare", "catcher", "catcher_channels", "channels", "bands")
    found |= {name for name in parts if getattr(frame, name) is not None}
    return sorted(found)


def is_container(frame: Frame) -> bool:
    """Whether a frame becomes an ACES image container."""
    return space_of(frame.metadata) == ACES and not beside_color(frame)


def container_planes(planes: Mapping[str, Any]) -> dict[str, Any]:
    """Channels of a container: R, G, B and A in half floats; larger values are clamped."""
    return {
        name: np.clip(planes[name], -_MOST_HALF, _MOST_HALF).astype(np.float16)
        for name in ("RGB", "A")
        if name in planes
    }


def container_attributes() -> dict[str, Any]:
    """Attributes that ST 2065-4 adds; the neutral of ACES is always the same."""
    return {
        "acesImageContainerFlag": 1,
        "adoptedNeutral": np.array(COLOR_SPACES[ACES].white, np.float32),
        "compression": NONE,
    }
