"""Textures of materials as pictures that other renderers can read.

Factors of a slot are multiplied into the pixels, as neither pbrt nor Mitsuba has a factor beside
each texture. An 8-bit texture without a factor keeps its bytes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color import srgb
from daguerre.files.notes import Notes
from daguerre.scene.materials import TextureSlot
from daguerre.scene.parts import Texture
from daguerre.scene.spectrum import Spectrum

from .spectra import rgb_of

Color = tuple[float, float, float]
Floats = NDArray[np.float32]
Transform = tuple[float, float, float, float, float, float]
IDENTITY: Transform = (1, 0, 0, 0, 1, 0)


@dataclass(frozen=True, eq=False)
class BakedPicture:
    """Pixels of one use of a texture, row 0 on top.

    Attributes:
        pixels: Shape (H, W, 1) or (H, W, 3), uint8 or float32.
        srgb: Whether the pixels are sRGB-encoded (8 bits).
        wrap: Behaviour beyond the edges, along u and v: repeat, mirror or clamp.
        nearest: Whether magnified texels have sharp edges.
        uv_set: Set of texture coordinates.
        transform: u' = a u + b v + c, v' = d u + e v + f, v down.
    """

    pixels: NDArray[Any]
    srgb: bool = False
    wrap: tuple[str, str] = ("repeat", "repeat")
    nearest: bool = False
    uv_set: int = 0
    transform: Transform = IDENTITY

    def mapped(self, change: Callable[[Floats], NDArray[Any]]) -> BakedPicture:
        """Returns a picture of changed linear values."""
        return replace(self, pixels=np.asarray(change(self.linear), np.float32), srgb=False)

    @property
    def linear(self) -> Floats:
        """Linear values, shape (H, W, 1 or 3)."""
        if self.pixels.dtype != np.uint8:
            return np.asarray(self.pixels, np.float32)
        plain = self.pixels.astype(np.float32) / 255
        return np.asarray(srgb.to_linear(plain) if self.srgb else plain, np.float32)

    @property
    def mean(self) -> Color:
        """Mean linear colour."""
        red, green, blue = np.broadcast_to(self.linear.mean(axis=(0, 1)), 3).tolist()
        return red, green, blue

    def without_mirrors(self, axes: tuple[bool, bool] = (True, True)) -> BakedPicture:
        """Returns a picture that repeats instead of mirroring: the mirror image is part of it."""
        pixels, wrap, rows = (
            self.pixels,
            list(self.wrap),
            np.array(self.transform, np.float64).reshape(2, 3),
        )
        for axis in (0, 1):
            if wrap[axis] == "mirror" and axes[axis]:
                pixels = np.concatenate([pixels, np.flip(pixels, 1 - axis)], axis=1 - axis)
                wrap[axis] = "repeat"
                rows[axis] *= 0.5
        made: Any = tuple(float(x) for x in rows.reshape(-1))
        return replace(self, pixels=pixels, wrap=(wrap[0], wrap[1]), transform=made)


Number = float | BakedPicture
Colored = Color | Spectrum | BakedPicture
BLACK: Color = (0.0, 0.0, 0.0)
WHITE: Color = (1.0, 1.0, 1.0)


class Baker:
    """Makes numbers and colours of a material, each constant or a picture."""

    def __init__(self, textures: list[Texture], notes: Notes) -> None:
        self._textures = textures
        self.notes = notes

    def color(self, slot: TextureSlot | None, factor: Color | Spectrum) -> Colored:
        """Colour of a slot, times a factor."""
        if slot is None:
            return factor
        if isinstance(factor, Spectrum):
            self.notes.add("spectrum beside a texture is written as a colour")
            factor = rgb_of(factor)
        texture = self._textures[slot.texture]
        rgb = _channels(texture, (0, 1, 2))
        made = _picture(texture, slot, rgb)
        if factor == WHITE:
            return made
        return made.mapped(lambda light: light * np.asarray(factor, np.float32))

    def number(self, slot: TextureSlot | None, factor: float, channel: int) -> Number:
        """One channel of a slot, times a factor; channels are R, G, B, A."""
        if slot is None:
            return factor
        texture = self._textures[slot.texture]
        plain = texture.pixels.dtype == np.uint8 and (not texture.srgb or channel == 3)
        made = _picture(texture, slot, _channels(texture, (channel,)), srgb=not plain)
        return made if factor == 1 else made.mapped(lambda light: light * np.float32(factor))

    def normals(self, slot: TextureSlot | None, scale: float) -> BakedPicture | None:
        """Normal map of a slot, with its scale in it; None: no normal map, or no effect."""
        if slot is None or scale == 0:
            return None
        texture = self._textures[slot.texture]
        made = _picture(texture, slot, _channels(texture, (0, 1, 2)), srgb=texture.srgb)
        if scale == 1 and not texture.srgb:
            return made
        stretch = np.array([scale, scale, 1], np.float32)

        def stretched(code: Floats) -> Floats:
            return np.asarray(_unit((2 * code - 1) * stretch) / 2 + 0.5, np.float32)

        return made.mapped(stretched)


def each(value: Number, change: Callable[[Any], Any]) -> Number:
    """Applies a function to a number or to each pixel."""
    return value.mapped(change) if isinstance(value, BakedPicture) else float(change(value))


def changed(color: Colored, change: Callable[[Any], Any]) -> Colored:
    """Applies a function to a colour, to each sample of a spectrum, or to each pixel."""
    if isinstance(color, BakedPicture):
        return color.mapped(change)
    if isinstance(color, Spectrum):
        return Spectrum(color.wavelengths_nm, tuple(change(np.array(color.values)).tolist()))
    red, green, blue = (float(change(c)) for c in color)
    return red, green, blue


def scaled(color: Colored, factor: float) -> Colored:
    """Multiplies a colour by a number; no channel exceeds 1, as no surface reflects more."""
    return changed(color, lambda light: np.minimum(light * factor, 1))


def _unit(vectors: Floats) -> Floats:
    length = np.linalg.norm(vectors, axis=2, keepdims=True)
    return np.asarray(vectors / np.maximum(length, 1e-6), np.float32)


def _channels(texture: Texture, wanted: tuple[int, ...]) -> NDArray[Any]:
    """Channels of a texture; grey serves as R, G and B, and a missing alpha is 1."""
    pixels = texture.pixels
    count = pixels.shape[2]
    opaque = np.ones_like(pixels[:, :, :1]) * (255 if pixels.dtype == np.uint8 else 1)
    planes = []
    for channel in wanted:
        if channel == 3:
            planes.append(pixels[:, :, count - 1 : count] if count in (2, 4) else opaque)
        else:
            at = channel if count >= 3 else 0
            planes.append(pixels[:, :, at : at + 1])
    return np.ascontiguousarray(np.concatenate(planes, axis=2))


def _picture(
    texture: Texture, slot: TextureSlot, pixels: NDArray[Any], *, srgb: bool = True
) -> BakedPicture:
    coded = texture.srgb and srgb and pixels.dtype == np.uint8
    nearest = texture.filter == "nearest"
    return BakedPicture(pixels, coded, texture.wrap, nearest, slot.uv_set, slot.transform)
