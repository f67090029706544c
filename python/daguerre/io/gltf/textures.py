"""Images and textures of glTF: planned while materials are read, then decoded side by side.

An image is decoded once, whoever uses it. Source: glTF 2.0 specification, chapters 3.8 and 5.26.
"""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import given_up
from daguerre.color import srgb
from daguerre.files import extras
from daguerre.files.budget import Budget
from daguerre.files.json_item import Item, clean
from daguerre.files.notes import Notes
from daguerre.files.uris import data_bytes, is_data
from daguerre.io import images
from daguerre.scene.materials import TextureSlot
from daguerre.scene.scene import Scene

from .accessors import Accessors
from .file import Document

_WRAP = {10497: "repeat", 33071: "clamp", 33648: "mirror"}
_MAG = {9728: "nearest", 9729: "linear"}
#: Extensions that name another image of a texture; the first that can be decoded is taken.
_COMPRESSED = ("KHR_texture_basisu", "EXT_texture_webp")
_MIN = {
    9728: "nearest",
    9729: "linear",
    9984: "nearest_mipmap_nearest",
    9985: "linear_mipmap_nearest",
    9986: "nearest_mipmap_linear",
    9987: "linear_mipmap_linear",
}
#: All images of a file together, decoded; a few kB of JSON could ask for any number of them.
_MAX_TOTAL_BYTES = 8 << 30


@dataclass(frozen=True)
class _Sampler:
    wrap: tuple[str, str] = ("repeat", "repeat")
    filter: str = "linear"
    min_filter: str = "linear_mipmap_linear"


@dataclass(frozen=True)
class _Plan:
    """One texture of the scene: an image as seen through a sampler."""

    image: int
    srgb: bool
    sampler: _Sampler


class Textures:
    """Turns ``textureInfo`` objects into slots; ``decode`` then fills the scene.

    Args:
        document: The file.
        accessors: Accessors, for images inside of bufferViews.
        notes: Gets what was not understood.
    """

    def __init__(self, document: Document, accessors: Accessors, notes: Notes) -> None:
        root = document.root
        self._document = document
        self._accessors = accessors
        self._notes = notes
        self._textures = root.list_of("textures")
        self._samplers = [_sampler(item) for item in root.list_of("samplers")]
        self._images = root.list_of("images")
        self._paths = [self._path(item) for item in self._images]
        # The first image with the same file or bufferView stands for all of them.
        first: dict[object, int] = {}
        self._same = [first.setdefault(self._source(i), i) for i in range(len(self._images))]
        self._plans: dict[_Plan, int] = {}

    def slot(self, owner: Item | None, key: str, *, srgb: bool) -> TextureSlot | None:
        """The use of a texture by member ``key`` of a material, or None."""
        info = None if owner is None else owner.get(key)
        if info is None:
            return None
        texture = self._textures[info.need("index").index(len(self._textures), "textures")]
        source = self._image_of(texture)
        sampler = texture.get("sampler")
        seen_through = _Sampler()
        if sampler is not None:
            seen_through = self._samplers[sampler.index(len(self._samplers), "samplers")]
        if source is None:
            self._notes.add("a texture without an image that is understood is left out")
            return None
        image = source.index(len(self._images), "images")
        uv_set, transform = _coordinates(info)
        if uv_set > 1:
            self._notes.add("a texture that asks for texture coordinates beyond set 1 is left out")
            return None
        plan = _Plan(self._same[image], srgb, seen_through)
        return TextureSlot(self._plans.setdefault(plan, len(self._plans)), uv_set, transform)

    def _image_of(self, texture: Item) -> Item | None:
        """The image of a texture: a compressed one where the file has it and it can be decoded."""
        plain = texture.get("source")
        for name in _COMPRESSED:
            extension = texture.extension(name)
            if extension is None:
                continue
            package = extras.missing(name)
            if not package:
                return extension.need("source")
            self._notes.add(
                f"{name} needs {package} ({extras.HINT}): a texture "
                + ("is left out" if plain is None else "is shown by the plain image beside it")
            )
        return plain

    def decode(self, scene: Scene) -> None:
        """Decodes what the slots need and adds it to the scene, which has no textures yet."""
        wanted = sorted({plan.image for plan in self._plans})
        budget = Budget(_MAX_TOTAL_BYTES, "bytes of decoded images")

        def load(index: int) -> NDArray[Any]:
            pixels = images.decode(self._bytes(index), self._where(index))
            budget.spend(pixels.nbytes, self._images[index])
            return pixels

        # OpenImageIO releases the interpreter's lock while it decodes.
        with ThreadPoolExecutor(min(8, os.cpu_count() or 1)) as pool:
            futures = [pool.submit(load, index) for index in wanted]
            try:
                decoded = {i: f.result() for i, f in zip(wanted, futures, strict=True)}
            finally:
                for future in futures:
                    future.cancel()
        for plan in self._plans:
            pixels, srgb = decoded[plan.image], plan.srgb
            if srgb and pixels.dtype != np.uint8:  # only 8-bit textures are decoded on lookup
                pixels, srgb = _linear(pixels), False
            scene.add_texture(
                given_up(pixels),
                srgb=srgb,
                wrap=plan.sampler.wrap,
                filter=plan.sampler.filter,
                min_filter=plan.sampler.min_filter,
                name=self._name(plan.image),
            )

    def _path(self, item: Item) -> Path | None:
        """Where an image lies if it is a file; checks also those that no material uses."""
        uri, view = item.get("uri"), item.get("bufferView")
        if (uri is None) == (view is None):
            item.fail("wanted either a uri or a bufferView, got " + ("both" if uri else "neither"))
        if view is not None:
            self._accessors.view_bytes(view)
            return None
        assert uri is not None
        return None if is_data(uri) else self._document.folder.resolve(uri)

    def _source(self, index: int) -> object:
        view = self._images[index].get("bufferView")
        if view is not None:
            return ("bufferView", view.integer())
        return self._paths[index] or ("data", index)

    def _bytes(self, index: int) -> bytes | memoryview:
        item, path = self._images[index], self._paths[index]
        if path is not None:
            try:
                return path.read_bytes()
            except OSError as error:
                item.need("uri").fail(f"cannot be read: {error.strerror}")
        uri = item.get("uri")
        if uri is not None:
            return data_bytes(uri)
        return self._accessors.view_bytes(item.need("bufferView"))

    def _name(self, index: int) -> str:
        path = self._paths[index]
        return self._images[index].name() or (clean(path.name) if path else f"image{index}")

    def _where(self, index: int) -> str:
        item, path = self._images[index], self._paths[index]
        name = item.name() or (path.name if path else "")
        return f"{item.file}: {item.path}" + (f" ({clean(name)[:60]!r})" if name else "")


def _sampler(item: Item) -> _Sampler:
    wraps = []
    for key in ("wrapS", "wrapT"):
        member = item.get(key)
        wraps.append("repeat" if member is None else _WRAP[member.choice(_WRAP)])
    magnify, minify = item.get("magFilter"), item.get("minFilter")
    return _Sampler(
        (wraps[0], wraps[1]),
        "linear" if magnify is None else _MAG[magnify.choice(_MAG)],
        "linear_mipmap_linear" if minify is None else _MIN[minify.choice(_MIN)],
    )


def _coordinates(info: Item) -> tuple[int, tuple[float, float, float, float, float, float]]:
    """Set and transform of a textureInfo; KHR_texture_transform: uv' = T R S uv."""
    chosen = info.get("texCoord")
    transform = info.extension("KHR_texture_transform")
    if transform is None:
        return (0 if chosen is None else chosen.integer(0)), (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
    offset = transform.numbers_of("offset", (0.0, 0.0))
    scale = transform.numbers_of("scale", (1.0, 1.0))
    angle = transform.number_of("rotation", 0.0)
    override = transform.get("texCoord")
    chosen = chosen if override is None else override
    # Counter-clockwise with v down, hence the minus sign in the second row.
    c, s = math.cos(angle), math.sin(angle)
    matrix = (
        c * scale[0],
        s * scale[1],
        offset[0],
        -s * scale[0],
        c * scale[1],
        offset[1],
    )
    return (0 if chosen is None else chosen.integer(0)), matrix


def _linear(pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    """Colour channels undone from sRGB; the alpha of 2 or 4 channels stays."""
    colors = pixels.shape[2] - (pixels.shape[2] in (2, 4))
    linear = srgb.to_linear(pixels[:, :, :colors])
    return np.concatenate([linear, pixels[:, :, colors:]], axis=2)
