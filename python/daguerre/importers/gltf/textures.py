"""Reads textures of glTF: the image of each, its sampler and its coordinates.

Source: glTF 2.0 specification, chapters 3.8 and 5.26; KHR_texture_transform.
"""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass

from daguerre.files import extras
from daguerre.files.json_item import Item
from daguerre.files.notes import Notes, Silence
from daguerre.files.value import Value
from daguerre.scene.materials import TextureSlot

_WRAP = {10497: "repeat", 33071: "clamp", 33648: "mirror"}
_MAG = {9728: "nearest", 9729: "linear"}
#: Extensions that name another image of a texture; the first that can be decoded is used.
_COMPRESSED = ("KHR_texture_basisu", "EXT_texture_webp")
_MIN = {
    9728: "nearest",
    9729: "linear",
    9984: "nearest_mipmap_nearest",
    9985: "linear_mipmap_nearest",
    9986: "nearest_mipmap_linear",
    9987: "linear_mipmap_linear",
}


@dataclass(frozen=True)
class Sampler:
    """Wrapping and filters of a texture, with the names of ``Scene.add_texture``."""

    wrap: tuple[str, str] = ("repeat", "repeat")
    filter: str = "linear"
    min_filter: str = "linear_mipmap_linear"


@dataclass(frozen=True)
class Plan:
    """A texture of the scene: an image with a sampler."""

    image: int
    srgb: bool
    sampler: Sampler


class Textures(Value):
    """Turns ``textureInfo`` objects into slots, and plans the textures of the scene.

    Args:
        root: The JSON object of the file.
        same: Index of the first image with the same file or bufferView, for each image.
        missing: Names of files that do not exist, by image.
        notes: Receives notes on unsupported content.

    Attributes:
        plans: The scene's textures and their indices.
    """

    def __init__(self, root: Item, same: list[int], missing: dict[int, str], notes: Notes) -> None:
        self._notes = notes
        self._textures = root.list_of("textures")
        self._samplers = [_sampler(item) for item in root.list_of("samplers")]
        self._same = same
        self._missing = missing
        self._images: dict[int, int | None] = {}
        self._settled = False
        self.plans: dict[Plan, int] = {}

    def silenced(self) -> Textures:
        """Returns a copy for materials that are read again, without notes and with the same images.

        The images are kept as packages for images may be missing in another process.
        """
        other = copy.copy(self)
        other._settled = True
        other._notes = Silence()
        return other

    def slot(self, owner: Item | None, key: str, *, srgb: bool) -> TextureSlot | None:
        """Reads the texture in member ``key`` of a material; None: no texture."""
        info = None if owner is None else owner.get(key)
        if info is None:
            return None
        index = info.need("index").index(len(self._textures), "textures")
        texture = self._textures[index]
        if not (self._settled and index in self._images):
            self._images[index] = self._image_of(texture)
        image = self._images[index]
        sampler = texture.get("sampler")
        seen_through = Sampler()
        if sampler is not None:
            seen_through = self._samplers[sampler.index(len(self._samplers), "samplers")]
        if image is None:
            self._notes.add("a texture without an image of a supported format is left out")
            return None
        if image in self._missing:
            missing = "a texture whose file is missing is left out"
            self._notes.add(missing, name=self._missing[image])
            return None
        uv_set, transform = _coordinates(info)
        if uv_set > 1:
            self._notes.add("a texture on texture coordinates other than sets 0 and 1 is left out")
            return None
        plan = Plan(self._same[image], srgb, seen_through)
        return TextureSlot(self.plans.setdefault(plan, len(self.plans)), uv_set, transform)

    def _image_of(self, texture: Item) -> int | None:
        """Image of a texture: the compressed image if it exists and can be decoded."""
        plain = texture.get("source")
        for name in _COMPRESSED:
            extension = texture.extension(name)
            if extension is None:
                continue
            package = extras.missing_for(name)
            if not package:
                return self._checked(extension.need("source"))
            done = "is left out" if plain is None else "is replaced by its fallback image"
            self._notes.add(f"a texture {done}: {name} {extras.lack(package)}")
        return None if plain is None else self._checked(plain)

    def _checked(self, source: Item) -> int:
        return source.index(len(self._same), "images")


def _sampler(item: Item) -> Sampler:
    wraps = []
    for key in ("wrapS", "wrapT"):
        member = item.get(key)
        wraps.append("repeat" if member is None else _WRAP[member.choice(_WRAP)])
    magnify, minify = item.get("magFilter"), item.get("minFilter")
    return Sampler(
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
