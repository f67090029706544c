"""Decodes images of glTF in parallel, each once, however many materials use it.

Source: glTF 2.0 specification, chapter 3.8.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre import memory
from daguerre.checks import freeze_in_place
from daguerre.color import srgb as srgb_curve
from daguerre.errors import asked_by
from daguerre.files.budget import Budget
from daguerre.files.json_item import Item, clean
from daguerre.files.reading import read_bytes
from daguerre.files.uris import data_bytes, is_data
from daguerre.scene.scene import Scene

from .accessors import Accessors
from .file import Document
from .textures import Plan

#: Limit of all decoded images of a file, as a few kB of JSON could name any number of them; at most
#: that share of free memory, as mipmaps take a third more, and the picture needs some.
_MAX_TOTAL_BYTES = 8 << 30
_SHARE = 0.6


class Images:
    """The images of a file.

    Args:
        document: The file.
        accessors: Accessors, for images inside of bufferViews.

    Attributes:
        same: Index of the first image with the same file or bufferView, for each image.
        missing: Names of files that do not exist, by image.
    """

    def __init__(self, document: Document, accessors: Accessors) -> None:
        self._document = document
        self._accessors = accessors
        self._images = document.root.list_of("images")
        self.missing: dict[int, str] = {}
        self._paths = [self._path(item) for item in self._images]
        first: dict[object, int] = {}
        self.same = [first.setdefault(self._source(i), i) for i in range(len(self._images))]

    def decode(self, plans: Iterable[Plan], scene: Scene) -> None:
        """Decodes planned images and adds them to the scene, which must have no textures yet."""
        wanted = sorted({plan.image for plan in plans})
        budget = _budget()

        def load(index: int) -> NDArray[Any]:
            from daguerre.pictures import (
                images,  # slow to import, and unused by scenes without pictures
            )

            pixels = images.decode(self._bytes(index), self._where(index))
            budget.spend(pixels.nbytes, self._images[index])
            return pixels

        if not wanted:
            return
        from concurrent.futures import ThreadPoolExecutor

        import OpenImageIO  # noqa: F401 (the import costs more in a thread)

        # OpenImageIO releases the interpreter's lock while it decodes.
        with ThreadPoolExecutor(min(8, os.cpu_count() or 1)) as pool:
            futures = [pool.submit(load, index) for index in wanted]
            try:
                decoded = {i: f.result() for i, f in zip(wanted, futures, strict=True)}
            finally:
                for future in futures:
                    future.cancel()
        for plan in plans:
            pixels, srgb = decoded[plan.image], plan.srgb
            if srgb and pixels.dtype != np.uint8:  # only 8-bit textures are decoded on lookup
                pixels, srgb = _linear(pixels), False
            scene.add_texture(
                freeze_in_place(pixels),
                srgb=srgb,
                wrap=plan.sampler.wrap,
                filter=plan.sampler.filter,
                min_filter=plan.sampler.min_filter,
                name=self._name(plan.image),
            )

    def _path(self, item: Item) -> Path | None:
        """Path of an image that is a file; unused images are checked, too."""
        uri, view = item.get("uri"), item.get("bufferView")
        if (uri is None) == (view is None):
            item.fail("wanted either a uri or a bufferView, got " + ("both" if uri else "neither"))
        if view is not None:
            self._accessors.view_bytes(view)
            return None
        assert uri is not None
        if is_data(uri):
            return None
        path = self._document.folder.find(uri)
        if path is None:
            self.missing[int(item.key)] = uri.text()
        return path

    def _source(self, index: int) -> object:
        view = self._images[index].get("bufferView")
        if view is not None:
            return ("bufferView", view.integer())
        return self._paths[index] or ("data", index)

    def _bytes(self, index: int) -> bytes | memoryview:
        item, path = self._images[index], self._paths[index]
        if path is not None:
            from daguerre.pictures.reading.source import MAX_FILE

            with asked_by(item.need("uri").where):
                return read_bytes(path, MAX_FILE)
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


def _linear(pixels: NDArray[np.float32]) -> NDArray[np.float32]:
    """Decodes colour channels from sRGB; alpha, if there are 2 or 4 channels, is unchanged."""
    colors = pixels.shape[2] - (pixels.shape[2] in (2, 4))
    linear = srgb_curve.to_linear(pixels[:, :, :colors])
    return np.concatenate([linear, pixels[:, :, colors:]], axis=2)


def _budget() -> Budget:
    """Budget of bytes of decoded images."""
    free = memory.left_bytes()
    if free is None or _SHARE * free >= _MAX_TOTAL_BYTES:
        return Budget(_MAX_TOTAL_BYTES, "bytes of decoded images")
    what = f"bytes of decoded images ({_SHARE:.0%} of the {memory.shown(free)} that are free)"
    return Budget(int(_SHARE * free), what)
