"""Pictures of a stage: each is found, decoded and added once, however many materials use it.

Names are paths of files, ``package.usdz[name]`` inside a package, or ``name.<UDIM>.ext``.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from daguerre import memory
from daguerre.checks import freeze_in_place
from daguerre.errors import InputError
from daguerre.files import uses
from daguerre.files.notes import Notes
from daguerre.files.reading import is_input
from daguerre.pictures.stated_colors import PLAIN, Colors
from daguerre.scene.scene import Scene

from . import udim
from .channels import IDENTITY, Six
from .picture import DecodedPicture
from .picture_bytes import UnknownFormat, bytes_of, decoded, member, opened_package

#: Finds the file of an asset path: ``resolve(place, path)``. The file need not exist; a path that
#: leaves the folders that a stage may read is an ``InputError`` at ``place``.
Resolve = Callable[[str, str], Path]
#: Limit of all decoded pictures of a stage; at most that share of free memory.
_MAX_TOTAL_BYTES = 8 << 30
_SHARE = 0.6
_PACKAGED = re.compile(r"(?P<package>[^\[\]]*)\[(?P<name>[^\[\]]+)\]\Z")
#: Most pictures that are decoded before anything asks for them.
_MOST_BEGUN = 64
_UNKNOWN = "a texture in an unknown format shows its fallback value"
_MISSING = "a texture whose file is missing shows its fallback value"


class Textures:
    """Textures of a scene: each is added once, however many materials use it."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._textures: dict[Any, int] = {}
        self._kept: list[Any] = []  # arrays with ids in use as keys

    def texture(
        self,
        pixels: NDArray[Any],
        *,
        srgb: bool,
        wrap: tuple[str, str],
        filter: str,
        min_filter: str = "linear_mipmap_linear",
        name: str,
        key: object = None,
    ) -> int:
        """Adds pixels to the scene once; ``key`` identifies them, by default their ``id``."""
        known = (id(pixels) if key is None else key, srgb, wrap, filter, min_filter)
        if known not in self._textures:
            self._kept.append(pixels)
            self._textures[known] = self._scene.add_texture(
                freeze_in_place(pixels),
                srgb=srgb,
                wrap=wrap,
                filter=filter,
                min_filter=min_filter,
                name=name,
            )
        return self._textures[known]

    def known(
        self, key: object, srgb: bool, wrap: tuple[str, str], filter: str, min_filter: str
    ) -> int | None:
        """Index of a texture that was added with this key."""
        return self._textures.get((key, srgb, wrap, filter, min_filter))

    def keep(self, value: object) -> None:
        """Keeps an array alive, so that its identity stays a key."""
        self._kept.append(value)


class Images(Textures):
    """The pictures of a stage.

    Args:
        scene: Receives textures.
        resolve: Finds the files of asset paths; see ``Resolve``.
        notes: Receives notes on missing files.
    """

    def __init__(self, scene: Scene, resolve: Resolve, notes: Notes) -> None:
        super().__init__(scene)
        self.resolve = resolve
        self._notes = notes
        self._pictures: dict[str, DecodedPicture | None] = {}
        self._lit: dict[str, DecodedPicture] = {}
        self._unknown: set[str] = set()
        self._left = _most_bytes()
        self._begun: dict[str, Future[DecodedPicture | None]] = {}
        self._pool = ThreadPoolExecutor(min(8, os.cpu_count() or 1))

    def picture(self, place: str, path: str, *, is_data: bool = False) -> DecodedPicture | None:
        """Decodes the picture of an asset path.

        Args:
            place: Place that names the picture, for messages.
            path: The asset path.
            is_data: Whether the numbers are no colours, or the scene states their colour space:
                they are not converted. Else they are converted if the file states primaries.

        Returns:
            The picture; None, and a note: there is no such file, or its format is unknown.

        Raises:
            InputError: The path leaves the stage's folders, or the picture is damaged.
        """
        if path not in self._pictures:
            try:
                self._pictures[path] = self._counted(place, self._found(place, path))
            except UnknownFormat:
                self._pictures[path] = None
                self._unknown.add(path)
        found = self._pictures[path]
        if found is None:
            self._notes.add(_UNKNOWN if path in self._unknown else _MISSING, name=path)
            return None
        return found if is_data else self._light(place, path, found)

    def _light(self, place: str, path: str, found: DecodedPicture) -> DecodedPicture:
        """The picture with its colours converted, once, and notes."""
        if path not in self._lit:
            self._lit[path] = found
            if found.pixels.shape[2] > 2:
                found.colors.tell(self._notes, found.name)
            if not found.is_light:
                self._lit[path] = found.light()
                self._counted(place, self._lit[path])
        return self._lit[path]

    def _found(self, place: str, path: str) -> DecodedPicture | None:
        begun = self._begun.pop(path, None)
        if begun is not None:
            return begun.result()
        return self._tiles(place, path) if udim.MARK in path else self._one(place, path)

    def prefetch(self, places: Mapping[str, str]) -> None:
        """Begins to decode the pictures of asset paths; ``places`` name each, for messages.

        A fault of a picture is an error of the later call of ``picture``. ``close`` ends running
        decodes.
        """
        for path, place in places.items():
            if len(self._begun) >= _MOST_BEGUN:
                return
            if path not in self._pictures and path not in self._begun and udim.MARK not in path:
                # OpenImageIO releases the interpreter's lock while it decodes.
                self._begun[path] = self._pool.submit(self._one, place, path)

    def close(self) -> None:
        """Ends the threads that decode pictures."""
        self._pool.shutdown(cancel_futures=True)

    def add(
        self,
        place: str,
        path: str,
        *,
        srgb: bool,
        wrap: tuple[str, str] = ("repeat", "repeat"),
        filter: str = "linear",
    ) -> int | None:
        """Adds the picture of an asset path to the scene; None, and a note: it is missing.

        Raises:
            InputError: The path or the picture is wrong; see ``picture``.
        """
        found = self.picture(place, path)
        if found is None:
            return None
        return self.texture(found.pixels, srgb=srgb, wrap=wrap, filter=filter, name=found.name)

    def _one(self, place: str, path: str) -> DecodedPicture | None:
        packaged = _PACKAGED.match(path)
        package = packaged["package"] if packaged else path
        file = self.resolve(place, package)
        if not is_input(file):
            return None
        where = f"{place}: {path}"
        if packaged is None:
            return _decoded(bytes_of(file, where), file.name, where)
        with opened_package(file, where) as archive:
            if packaged["name"] not in archive.namelist():
                return None
            data = member(archive, packaged["name"], where)
        return _decoded(data, packaged["name"].rsplit("/", 1)[-1], where)

    def _tiles(self, place: str, path: str) -> DecodedPicture | None:
        """Stitches the tiles of a UDIM pattern."""
        packaged = _PACKAGED.match(path)
        if packaged:
            file = self.resolve(place, packaged["package"])
            if not is_input(file):
                return None
            with opened_package(file, place) as archive:
                found = udim.tile_numbers(archive.namelist(), packaged["name"])
            paths = {n: f"{packaged['package']}[{name}]" for n, name in found.items()}
        else:
            folder, _, pattern = path.replace("\\", "/").rpartition("/")
            if udim.MARK in folder:
                return None
            inside = self.resolve(place, path).parent
            names = _names(inside)
            found = udim.tile_numbers(names, pattern)
            paths = {n: f"{folder}/{name}" if folder else name for n, name in found.items()}
        tiles = {n: one for n, name in paths.items() if (one := self._one(place, name))}
        if not tiles:
            return None
        colors = next(iter(tiles.values())).colors
        if any(tile.colors != colors for tile in tiles.values()):
            tiles, colors = self._alike(tiles), PLAIN
        pixels, grid, halved = udim.stitched({n: tile.pixels for n, tile in tiles.items()})
        if halved:
            self._notes.add("UDIM tiles are halved in size, because together they are too large")
        name = path.rsplit("/", 1)[-1]
        return _picture(pixels, colors, name, grid.transform)

    def _alike(self, tiles: dict[int, DecodedPicture]) -> dict[int, DecodedPicture]:
        """Tiles in linear Rec.709, for files that state different primaries."""
        for tile in tiles.values():
            tile.colors.tell(self._notes, tile.name)
        return {n: tile if tile.is_light else tile.light() for n, tile in tiles.items()}

    def _counted(self, place: str, picture: DecodedPicture | None) -> DecodedPicture | None:
        """Charges a picture to the limit of all."""
        self._left -= 0 if picture is None else picture.pixels.nbytes
        if self._left < 0:
            most = memory.shown(_most_bytes())
            raise InputError(f"{place}: decoded pictures are too large: the limit is {most}")
        return picture


def _decoded(data: bytes, name: str, where: str) -> DecodedPicture:
    pixels, colors = decoded(data, name, where)
    return _picture(pixels, colors, name)


def _picture(
    pixels: NDArray[Any], colors: Colors, name: str, transform: Six | None = None
) -> DecodedPicture:
    freeze_in_place(pixels)
    uses.decoded(pixels.nbytes)
    return DecodedPicture(pixels, name, transform or IDENTITY, transform is not None, colors)


def _names(folder: Path) -> list[str]:
    try:
        return [file.name for file in folder.iterdir()]
    except (OSError, ValueError):  # no folder; no name of a folder
        return []


def _most_bytes() -> int:
    """Most bytes of decoded pictures."""
    free = memory.left_bytes()
    return _MAX_TOTAL_BYTES if free is None else min(_MAX_TOTAL_BYTES, int(_SHARE * free))
