"""Pictures of Blender: packed, of files, generated, and UDIM tiles.

Source: Blender Python API 5.0, ``bpy.types.Image``: numbers of 8 bits are as in the file, floats
are light in the working space.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre import memory
from daguerre.blender.pictures import raw_pixels
from daguerre.checks import freeze_in_place
from daguerre.errors import InputError
from daguerre.files.notes import Notes, Silence
from daguerre.scene.scene import Scene
from daguerre.shading import udim
from daguerre.shading.images import Textures
from daguerre.shading.picture import DecodedPicture
from daguerre.shading.picture_bytes import bytes_of, decoded

if TYPE_CHECKING:
    import bpy


#: Limit of all pictures of a scene, as decoded; at most that share of free memory.
MAX_BYTES, _SHARE = 8 << 30, 0.6
#: Colour spaces by their names in Blender, as the reader of graphs names them.
_SPACES = {
    "sRGB": "srgb_texture",
    "Non-Color": "raw",
    "Linear Rec.709": "lin_rec709",
    "scene_linear": "lin_rec709",
    "Linear Rec.2020": "lin_rec2020",
    "Linear DCI-P3 D65": "lin_p3d65",
    "Display P3": "srgb_displayp3",
    "Rec.1886": "g24_rec709",
    "Rec.2020": "g24_rec2020",
    "ACEScg": "acescg",
    "ACES2065-1": "aces2065_1",
}
#: Kinds of images without pixels that are read here.
_UNREAD = {"SEQUENCE": "an image sequence", "MOVIE": "a movie", "VIEWER": "a viewer's image"}


def space_of(image: bpy.types.Image) -> str:
    """Name of an image's colour space."""
    name = str(image.colorspace_settings.name)
    return _SPACES.get(name, name)


def _is_open(image: bpy.types.Image) -> bool:
    """Whether Blender names only linear colours, so that the file's primaries count.

    Blender converts pictures itself, but tiles are read from their files.
    """
    return space_of(image) == "lin_rec709"


def alpha_of(image: bpy.types.Image) -> str:
    """Alpha mode of an image; alpha of data is a channel without meaning."""
    if image.colorspace_settings.is_data and image.alpha_mode != "NONE":
        return "CHANNEL_PACKED"
    return str(image.alpha_mode)


class Pictures(Textures):
    """The images of a Blender file, and the textures that are made of them.

    Args:
        scene: Receives textures.
        notes: Receives notes on images that cannot be read.
        limit: Most bytes of all pictures; None: 8 GiB, or a share of free memory.
    """

    def __init__(self, scene: Scene, notes: Notes, limit: int | None = None) -> None:
        super().__init__(scene)
        self._notes = notes
        self._pictures: dict[str, DecodedPicture | None] = {}
        free = memory.left_bytes()
        most = MAX_BYTES if free is None else min(MAX_BYTES, int(_SHARE * free))
        self._limit = most if limit is None else limit
        self._left = self._limit

    @contextmanager
    def silent(self) -> Iterator[None]:
        """Adds no notes for a while."""
        notes, self._notes = self._notes, Silence()
        try:
            yield
        finally:
            self._notes = notes

    def picture(self, place: str, path: str, *, is_data: bool = False) -> DecodedPicture | None:
        """Pixels of an image by its full name; None, and a note: it has none.

        Raises:
            InputError: A tile is damaged, or all pictures are too large; it names the node.
        """
        if path not in self._pictures:
            self._pictures[path] = self._read(place, path)
        if self._pictures[path] is None:
            self._notes.add("an image without pixels is magenta")
        return self._pictures[path]

    def _read(self, place: str, path: str) -> DecodedPicture | None:
        import bpy

        image = next((one for one in bpy.data.images if one.name_full == path), None)
        if image is None:
            return None
        if image.source in _UNREAD:
            self._notes.add(f"{_UNREAD[image.source]} as a texture is not supported")
            return None
        if image.source == "TILED":
            return self._tiled(place, image)
        width, height = (int(n) for n in image.size)
        self._charge(place, width * height * int(image.channels) * 4)
        pixels = _pixels(image)
        if pixels is None:
            return None
        return DecodedPicture(freeze_in_place(pixels), str(image.name))

    def _tiled(self, place: str, image: bpy.types.Image) -> DecodedPicture | None:
        tiles = {}
        for number, name, data in _tiles(place, image):
            tiles[number], colors = decoded(data, name, f"{place}: {name}")
            if _is_open(image) and tiles[number].shape[2] > 2 and not colors.is_plain:
                tile = tiles[number].astype(np.float32)
                tile[:, :, :3] = colors.light(tile[:, :, :3])
                colors.tell(self._notes, name)
                tiles[number] = tile
            self._charge(place, tiles[number].nbytes)
        if not tiles:
            return None
        pixels, grid, halved = udim.stitched(tiles)
        if halved:
            self._notes.add("UDIM tiles are halved, as all of them are too large")
        freeze_in_place(pixels)
        return DecodedPicture(pixels, str(image.name), grid.transform, tiled=True)

    def _charge(self, place: str, size: int) -> None:
        self._left -= size
        if self._left < 0:
            most = memory.shown(self._limit)
            raise InputError(f"{place}: wanted at most {most} of decoded pictures, got more")


def _pixels(image: bpy.types.Image) -> NDArray[Any] | None:
    """Pixels (H, W, C) with row 0 on top; None: the image cannot be loaded.

    Colours of floats are divided by their opacity, which Blender has multiplied them with.
    """
    pixels = raw_pixels(image)
    if pixels is None:
        return None
    if not image.is_float:  # in place, as pictures are large
        np.rint(np.multiply(np.clip(pixels, 0, 1, out=pixels), 255, out=pixels), out=pixels)
    opaque = 1 if image.is_float else 255
    if pixels.shape[2] == 4 and pixels[:, :, 3].min() >= opaque:
        pixels = pixels[:, :, :3]
    if not image.is_float:
        return np.ascontiguousarray(pixels.astype(np.uint8))
    pixels = np.nan_to_num(pixels, nan=0.0, posinf=0.0, neginf=0.0)
    if pixels.shape[2] == 4 and alpha_of(image) in ("STRAIGHT", "PREMUL"):
        alpha = pixels[:, :, 3:]
        pixels[:, :, :3] /= np.where(alpha > 0, alpha, 1)
    return np.ascontiguousarray(pixels)


def _tiles(place: str, image: bpy.types.Image) -> Iterator[tuple[int, str, bytes]]:
    """Numbers, names and bytes of UDIM tiles; those without a file are left out."""
    import bpy

    packed = {Path(str(one.filepath)).name: one for one in image.packed_files}
    pattern = bpy.path.abspath(str(image.filepath), library=image.library)
    for tile in image.tiles:
        number = int(tile.number)
        if not udim.FIRST <= number <= udim.LAST:
            continue
        file = Path(pattern.replace(udim.MARK, str(number)))
        inside = packed.get(file.name)
        if inside is not None:
            yield number, file.name, bytes(inside.data)
        elif file.is_file():
            yield number, file.name, bytes_of(file, f"{place}: {file.name}")
