"""Reads accessors of glTF as numpy arrays: strided, normalised, quantised, sparse, or zeros.

Every count is checked against the bytes of the file before memory is allocated.
Source: glTF 2.0 specification, chapter 3.6.2; KHR_mesh_quantization.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from daguerre.files.budget import Budget
from daguerre.files.json_item import Item, short

from . import meshopt as gltf_meshopt

_COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
# Limit of an accessor without bytes, which is zeros, in elements x components.
_MAX_ZEROS = 1 << 26
#: Limit of all compressed bufferViews of a file together, unpacked.
_MAX_UNPACKED_BYTES = 8 << 30


class Kind(NamedTuple):
    """Kind of an accessor.

    Attributes:
        type: Type, such as ``VEC3``.
        component_type: Component type, such as 5126 (float).
        normalized: Whether integers are normalised.
    """

    type: str
    component_type: int
    normalized: bool


class _View:
    """A bufferView; compressed views are unpacked at the first read.

    Args:
        item: The bufferView.
        buffers: Bytes of all buffers.
        budget: Budget of unpacked bytes.
    """

    def __init__(self, item: Item, buffers: list[memoryview], budget: Budget) -> None:
        self.item = item
        self.packed = gltf_meshopt.packed(item)
        self._budget = budget
        self._data = _slice(item if self.packed is None else self.packed, buffers)
        stride = item.get("byteStride")
        self.stride = None if stride is None else stride.integer(1, 252)
        if self.packed is not None:
            gltf_meshopt.check(item, self.packed)

    @property
    def data(self) -> memoryview:
        """Unpacked bytes."""
        if self.packed is not None:
            self._budget.spend(self.item.need("byteLength").integer(), self.item)
            self._data = gltf_meshopt.unpack(self._data, self.item, self.packed)
            self.packed = None
        return self._data


class Accessors:
    """All accessors of a file; arrays are read on demand and kept.

    Args:
        root: The JSON object of the file.
        buffers: Bytes of the file's buffers.
    """

    def __init__(self, root: Item, buffers: list[memoryview]) -> None:
        budget = Budget(_MAX_UNPACKED_BYTES, "bytes of unpacked bufferViews")
        self._views = [_View(item, buffers, budget) for item in root.list_of("bufferViews")]
        self._items = root.list_of("accessors")
        self._arrays: dict[int, NDArray[Any]] = {}
        self._sources: dict[int, object] = {}

    def index(self, use: Item) -> int:
        """Checked index of the accessor that ``use`` names."""
        return use.index(len(self._items), "accessors")

    def view_bytes(self, use: Item) -> memoryview:
        """Bytes of the bufferView that ``use`` names."""
        return self._views[use.index(len(self._views), "bufferViews")].data

    def kind(self, use: Item) -> Kind:
        """Kind of the accessor that ``use`` names."""
        item = self._items[self.index(use)]
        normalized = item.get("normalized")
        return Kind(
            item.need("type").choice(_WIDTHS),
            item.need("componentType").choice(_COMPONENTS),
            normalized is not None and normalized.flag(),
        )

    def floats(self, use: Item, types: tuple[str, ...], what: str = "element") -> NDArray[Any]:
        """Reads finite numbers; normalised integers are mapped to [0, 1] or [-1, 1].

        Args:
            use: The JSON value that names the accessor.
            types: Allowed types, such as ``("VEC3",)``.
            what: Name of an element in messages.

        Returns:
            float32, shape (count, components).
        """
        kind, _, normalized = self.kind(use)
        if kind not in types:
            use.fail(f"wrong accessor type: wanted {' or '.join(types)}, got {kind}")
        return _decoded(self._raw(self.index(use)), normalized, use, what)

    def changes(
        self, use: Item, types: tuple[str, ...], what: str
    ) -> tuple[NDArray[np.int64] | slice, NDArray[np.float32]]:
        """Reads like ``floats``, but only elements that may differ from 0, with their indices.

        Returns:
            Indices of the elements, and their numbers (indices, components).
        """
        item = self._items[self.index(use)]
        if item.get("bufferView") is not None:
            return slice(None), self.floats(use, types, what)
        kind, component, normalized = self.kind(use)
        if kind not in types:
            use.fail(f"wrong accessor type: wanted {' or '.join(types)}, got {kind}")
        sparse = item.get("sparse")
        if sparse is None:
            return slice(0), np.zeros((0, _WIDTHS[kind]), np.float32)
        places, values = self._sparse(
            sparse, np.dtype(_COMPONENTS[component]), _WIDTHS[kind], self.count(use)
        )
        return places, _decoded(values, normalized, use, what)

    def count(self, use: Item) -> int:
        """Number of elements of the accessor that ``use`` names."""
        return self._items[self.index(use)].need("count").integer(1)

    def joints(self, use: Item) -> NDArray[Any]:
        """Reads four unsigned integers per element, shape (count, 4), in the type of the file."""
        kind, component, normalized = self.kind(use)
        if kind != "VEC4" or component not in (5121, 5123) or normalized:
            use.fail(
                "wrong accessor type: wanted VEC4 of component type 5121 or 5123, not normalized, "
                f"got {kind} of {component}{', normalized' if normalized else ''}"
            )
        return self._raw(self.index(use))

    def integers(self, use: Item) -> NDArray[np.uint32]:
        """Reads unsigned integers, shape (count,)."""
        kind, component, _ = self.kind(use)
        if kind != "SCALAR" or component not in (5121, 5123, 5125):
            use.fail(
                "wrong accessor type: wanted SCALAR of component type 5121, 5123 or 5125, "
                f"got {kind} of {component}"
            )
        return np.array(self._raw(self.index(use))[:, 0], np.uint32)

    def has_bytes(self, use: Item) -> bool:
        """Whether an accessor has a bufferView or sparse elements."""
        item = self._items[self.index(use)]
        return item.get("bufferView") is not None or item.get("sparse") is not None

    def supplied(self, use: Item, source: object) -> bool:
        """Whether ``source`` supplied the array of the accessor."""
        return self._sources.get(self.index(use)) == source

    def check_size(self, uses: list[Item], limit: int) -> None:
        """Checks that accessors need at most ``limit`` bytes together."""
        total = 0
        for use in uses:
            kind, component, _ = self.kind(use)
            total += self.count(use) * _WIDTHS[kind] * np.dtype(_COMPONENTS[component]).itemsize
            if total > limit:
                use.fail(f"too large: wanted at most {limit >> 30} GiB, got {short(total)} bytes")

    def supply(
        self, use: Item, array: NDArray[Any], source: object, *, any_count: bool = False
    ) -> None:
        """Sets the array of an accessor, (count, components), unpacked from ``source``.

        Raises:
            InputError: The array does not fit the accessor, or another source supplied an array.
        """
        index = self.index(use)
        if self._sources.setdefault(index, source) != source:
            use.fail("an accessor of compressed data can belong to only one primitive")
        kind, component, _ = self.kind(use)
        dtype, count = np.dtype(_COMPONENTS[component]), self.count(use)
        wanted = (len(array) if any_count else count, _WIDTHS[kind])
        if array.shape != wanted:
            use.fail(f"wrong shape of the unpacked data: wanted {wanted}, got {array.shape}")
        cast = array.astype(dtype)
        if array.dtype != dtype and (cast != array).any():
            use.fail(f"the unpacked data do not fit component type {component}")
        self._arrays[index] = cast

    def _raw(self, index: int) -> NDArray[Any]:
        if index not in self._arrays:
            self._arrays[index] = self._read(self._items[index])
        return self._arrays[index]

    def _read(self, item: Item) -> NDArray[Any]:
        dtype = np.dtype(_COMPONENTS[item.need("componentType").choice(_COMPONENTS)])
        width = _WIDTHS[item.need("type").choice(_WIDTHS)]
        count = item.need("count").integer(1)
        view = item.get("bufferView")
        sparse = item.get("sparse")
        if view is None:
            if count * width > _MAX_ZEROS:
                item.need("count").fail(
                    f"too large without a bufferView: wanted at most {_MAX_ZEROS // width}, "
                    f"got {short(count)}"
                )
            array: NDArray[Any] = np.zeros((count, width), dtype)
        else:
            array = self._strided(view, item, dtype, width, count)
        if sparse is not None:
            array = array.copy()
            places, values = self._sparse(sparse, dtype, width, count)
            array[places] = values
        return array

    def _strided(
        self, view_use: Item, item: Item, dtype: np.dtype[Any], width: int, count: int
    ) -> NDArray[Any]:
        view = self._views[view_use.index(len(self._views), "bufferViews")]
        offset_item = item.get("byteOffset")
        offset = 0 if offset_item is None else offset_item.integer(0)
        element = dtype.itemsize * width
        stride = view.stride or element
        if stride < element:
            Item(stride, "byteStride", view.item).fail(
                f"too small for {item.path}: wanted at least {element}, got {stride}"
            )
        end = offset + stride * (count - 1) + element
        if end > len(view.data):
            item.fail(
                f"beyond its bufferView ({view.item.path}): wanted at most {len(view.data)} bytes, "
                f"got {short(end)} (count {short(count)}, byteOffset {short(offset)}, "
                f"stride {stride})"
            )
        return np.ndarray(
            (count, width), dtype, view.data, offset=offset, strides=(stride, dtype.itemsize)
        )

    def _sparse(
        self, sparse: Item, dtype: np.dtype[Any], width: int, length: int
    ) -> tuple[NDArray[np.int64], NDArray[Any]]:
        """Reads sparse elements and their indices, which must increase (chapter 3.6.2.3)."""
        count = sparse.need("count").integer(1, length)
        places_item, values_item = sparse.need("indices"), sparse.need("values")
        component = places_item.need("componentType").choice((5121, 5123, 5125))
        places = self._strided(
            places_item.need("bufferView"), places_item, np.dtype(_COMPONENTS[component]), 1, count
        )[:, 0].astype(np.int64)
        if (np.diff(places) <= 0).any():
            places_item.fail("indices must increase")
        if places[-1] >= length:
            places_item.fail(f"index out of range: wanted 0 .. {length - 1}, got {places[-1]}")
        values_view = values_item.need("bufferView")
        return places, self._strided(values_view, values_item, dtype, width, count)


def _decoded(array: NDArray[Any], normalized: bool, use: Item, what: str) -> NDArray[np.float32]:
    """Converts to finite float32; normalised integers are mapped to [0, 1] or [-1, 1]."""
    if array.dtype.kind == "f":
        bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
        if bad.size:
            use.fail(
                f"{what} {bad[0]}: wanted finite numbers, got {array[bad[0]].tolist()} "
                f"({bad.size} such elements)"
            )
    values = np.array(array, np.float32)
    if normalized and array.dtype.kind != "f":
        values /= np.float32(np.iinfo(array.dtype).max)
        np.maximum(values, -1, out=values)
    return values


def _slice(item: Item, buffers: list[memoryview]) -> memoryview:
    """Bytes of a buffer that a bufferView, or its compressed form, refers to."""
    buffer = buffers[item.need("buffer").index(len(buffers), "buffers")]
    offset_item = item.get("byteOffset")
    offset = 0 if offset_item is None else offset_item.integer(0)
    length = item.need("byteLength").integer(0)  # none of 0 bytes may be read
    if offset + length > len(buffer):
        item.fail(
            f"beyond its buffer ({len(buffer)} bytes): wanted byteOffset + byteLength at most "
            f"{len(buffer)}, got {short(offset)} + {short(length)}"
        )
    return buffer[offset : offset + length]
