"""Textures of the scene from channels: factors stay factors, files stay as they are if they can."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from daguerre.scene.materials import TextureSlot

from .bake import Baker
from .channels import Channel, Mapping, Plane, Six, Texel, VertexColor

if TYPE_CHECKING:
    from .images import Textures

_BEYOND_TWO = "a texture that needs a third set of texture coordinates is replaced by its mean"
_ONLY_BASE = "colours of vertices are supported in the colour and opacity of a material only"


@dataclass(frozen=True)
class Packed:
    """Factors of channels, and the texture that they are multiplied with."""

    factors: tuple[float, ...]
    slot: TextureSlot | None = None


class Packer:
    """Makes textures.

    Args:
        images: Receives the textures.
        baker: Computes pictures, and has the notes.
        uv_sets: Primvars of texture coordinates, by number of their set.
    """

    def __init__(self, images: Textures, baker: Baker, uv_sets: Sequence[str]) -> None:
        self._images = images
        self._baker = baker
        self._uv_sets = uv_sets

    def packed(
        self,
        channels: Sequence[Channel],
        *,
        places: Sequence[int] | None = None,
        most: float = 1.0,
        by_vertices: bool = False,
    ) -> Packed:
        """Factors and texture of channels.

        Args:
            channels: Numbers, pictures or vertex colours.
            places: Channel of the texture for each; default: 0, 1, 2, ...
            most: Largest factor that the material takes.
            by_vertices: Whether the renderer multiplies the channels with colours of vertices.
        """
        if not by_vertices and any(isinstance(channel, VertexColor) for channel in channels):
            self._baker.notes.add(_ONLY_BASE)
        plain = [self._within_sets(self._without_vertices(channel)) for channel in channels]
        plain = list(self._baker.together(plain))
        pictures = [channel for channel in plain if isinstance(channel, Texel)]
        if not pictures:
            return Packed(
                tuple(min(max(float(c), 0.0), most) for c in plain if isinstance(c, float))
            )
        mapping = pictures[0].mapping
        same = [picture.plane.pixels.shape for picture in pictures if picture.mapping == mapping]
        size = max(height for height, _ in same), max(width for _, width in same)
        alike = [self._baker.resampled(channel, mapping, size) for channel in plain]
        factors, planes = zip(*(self._factored(picture, most) for picture in alike), strict=True)
        if all(plane is None for plane in planes):
            return Packed(factors)
        return Packed(factors, self._slot(planes, places or range(len(planes)), mapping))

    def _without_vertices(self, channel: Channel) -> Channel:
        """Colours of vertices multiply in the renderer, so that only their factor is left."""
        return channel.scale if isinstance(channel, VertexColor) else channel

    def _within_sets(self, channel: Channel) -> Channel:
        if not isinstance(channel, Texel) or channel.mapping.primvar in self._uv_sets[:2]:
            return channel
        self._baker.notes.add(_BEYOND_TWO)
        return channel.mean()

    def _factored(self, channel: Channel, most: float) -> tuple[float, Plane | None]:
        """Factor of a channel, and its plane; a picture that is no product is computed."""
        if not isinstance(channel, Texel):
            number = float(channel) if isinstance(channel, float) else 0.0
            return min(max(number, 0.0), most), None
        pixels = channel.plane.pixels
        is_light = pixels.dtype == np.uint8 or float(pixels.min()) >= 0.0
        if is_light and channel.bias == 0.0 and 0.0 <= channel.scale <= most:
            return channel.scale, channel.plane
        unit = 1.0 if most == 1.0 else np.inf
        made = self._baker.combined(lambda v: np.clip(v, 0, unit), channel)
        return (1.0, made.plane) if isinstance(made, Texel) else (float(_float(made)), None)

    def _slot(
        self, planes: Sequence[Plane | None], places: Sequence[int], mapping: Mapping
    ) -> TextureSlot:
        by_place: list[Plane | None] = [None] * (max(places) + 1)
        for plane, place in zip(planes, places, strict=True):
            by_place[place] = plane
        if len(by_place) == 2:  # two channels would be grey and opacity
            by_place.append(None)
        texture = self._texture(by_place, mapping)
        uv_set = list(self._uv_sets).index(mapping.primvar)
        return TextureSlot(texture, uv_set, top_down(mapping.transform))

    def _texture(self, planes: Sequence[Plane | None], mapping: Mapping) -> int:
        """Texture of planes; None: filled with 1."""
        encoded = _common_curve(planes)
        key = (tuple(None if plane is None else plane.key for plane in planes), encoded)
        found = self._images.known(
            key, bool(encoded), mapping.wrap, mapping.filter, mapping.min_filter
        )
        if found is not None:
            return found
        first = next(plane for plane in planes if plane is not None)
        for plane in planes:
            if plane is not None:
                self._images.keep(plane.pixels if plane.source is None else plane.source)
        pixels = _as_in_file(planes) if encoded is not None else None
        if pixels is None:
            pixels = _stacked(planes, bytes_=encoded is not None)
        return self._images.texture(
            pixels,
            srgb=bool(encoded),
            wrap=mapping.wrap,
            filter=mapping.filter,
            min_filter=mapping.min_filter,
            name=first.name,
            key=key,
        )


def top_down(transform: Six) -> Six:
    """Converts a transform of coordinates from the bottom left to coordinates from the top left."""
    a, b, c, d, e, f = transform
    return a, 0.0 - b, b + c, 0.0 - d, e, 1.0 - e - f


def _float(channel: Channel) -> float:
    return channel if isinstance(channel, float) else 0.0


def _common_curve(planes: Sequence[Plane | None]) -> bool | None:
    """Whether bytes of all colours are in sRGB, or none; None: they must become floats."""
    given = [(i, plane) for i, plane in enumerate(planes) if plane is not None]
    if any(plane.pixels.dtype != np.uint8 for _, plane in given):
        return None
    curves = {plane.srgb for i, plane in given if i < 3}
    if len(curves) > 1 or any(plane.srgb for i, plane in given if i == 3):
        return None
    return curves.pop() if curves else False


def _as_in_file(planes: Sequence[Plane | None]) -> Any:
    """Pixels of the file, if the planes are all its channels in order, or its only grey."""
    sources = {id(plane.source) if plane is not None else 0 for plane in planes}
    first = planes[0]
    if len(sources) > 1 or first is None or first.source is None:
        return None
    count = first.source.shape[2]
    index = [plane.index for plane in planes if plane is not None]
    if index == list(range(count)) and count > 2:
        return first.source
    return first.source if count == 1 and len(index) == 3 else None


def _stacked(planes: Sequence[Plane | None], *, bytes_: bool) -> Any:
    size = next(plane.pixels.shape for plane in planes if plane is not None)
    pixels = np.empty((*size, len(planes)), np.uint8 if bytes_ else np.float32)
    for i, plane in enumerate(planes):
        if plane is None:
            pixels[:, :, i] = 255 if bytes_ else 1
        else:
            pixels[:, :, i] = plane.pixels if bytes_ else plane.linear()
    return pixels
