"""Unpacks bufferViews of EXT_meshopt_compression and KHR_meshopt_compression.

C++ unpacks the bitstreams (``core/codec``), as no package has wheels for all three modes; the
filters here are arithmetic on whole arrays. Both extensions accept both versions of the streams,
which have the version in their header.
Source: the README of KHR_meshopt_compression, schema and appendix B.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.errors import InputError, core_errors
from daguerre.files.json_item import Item, short

NAMES = ("KHR_meshopt_compression", "EXT_meshopt_compression")


def packed(item: Item) -> Item | None:
    """Extension object of a bufferView or buffer; None: not compressed."""
    return next((found for name in NAMES if (found := item.extension(name)) is not None), None)


def placeholders(root: Item) -> set[int]:
    """Buffers that are never read, as all their bufferViews are compressed."""
    buffers = root.list_of("buffers")
    stood_on: set[int] = set()
    read: set[int] = set()
    for view in root.list_of("bufferViews"):
        extension = packed(view)
        buffer = view.need("buffer").index(len(buffers), "buffers")
        (read if extension is None else stood_on).add(buffer)
        if extension is not None:
            read.add(extension.need("buffer").index(len(buffers), "buffers"))
    return stood_on - read


def check(view: Item, extension: Item) -> tuple[str, str, int, int]:
    """Checks mode, filter, count and stride against the schema, and returns them."""
    mode = extension.need("mode").choice(("ATTRIBUTES", "TRIANGLES", "INDICES"))
    filter_item = extension.get("filter")
    filter_name = "NONE" if filter_item is None else filter_item.choice(("NONE", *_FILTERS))
    stride_item, count_item = extension.need("byteStride"), extension.need("count")
    stride, count = stride_item.integer(1, 256), count_item.integer(1)
    strides = (2, 4) if mode != "ATTRIBUTES" else _STRIDES.get(filter_name, range(4, 257, 4))
    if stride not in strides:
        wanted = ", ".join(map(str, strides)) if len(strides) < 3 else "a multiple of 4"
        stride_item.fail(f"does not fit mode and filter: wanted {wanted}, got {stride}")
    if mode != "ATTRIBUTES" and filter_name != "NONE" and filter_item is not None:
        filter_item.fail(f"no filter is allowed with mode {mode}, got {filter_name}")
    if mode == "TRIANGLES" and count % 3:
        count_item.fail(f"wanted a multiple of 3, got {short(count)}")
    length = view.need("byteLength")
    if length.integer(1) != count * stride:
        length.fail(f"wanted count x byteStride = {short(count * stride)}, got {length.value}")
    return mode, filter_name, count, stride


def unpack(data: memoryview, view: Item, extension: Item) -> memoryview:
    """Unpacks the bytes of a bufferView.

    Args:
        data: Packed bytes.
        view: The bufferView.
        extension: Extension object of the bufferView.

    Raises:
        InputError: The stream is damaged, or does not fit its count and stride.
    """
    mode, filter_name, count, stride = check(view, extension)
    with core_errors(InputError, f"{view.file}: {extension.path}"):
        raw = _core.unpack_meshopt(np.frombuffer(data, np.uint8), mode, count, stride)
    if filter_name != "NONE":
        with np.errstate(all="ignore"):  # unspecified results may be any number
            raw = _FILTERS[filter_name](raw, stride)
    return np.ascontiguousarray(raw).data.cast("B")


# Filters: bytes in, an array of the same size out ------------------------------------------------


def _round(values: NDArray[np.float32], dtype: type) -> NDArray[Any]:
    """Rounds to the nearest integer, halves away from zero."""
    rounded: NDArray[Any] = np.trunc(values + np.copysign(np.float32(0.5), values)).astype(dtype)
    return rounded


def _octahedral(raw: NDArray[np.uint8], stride: int) -> NDArray[Any]:
    dtype = np.int8 if stride == 4 else np.int16
    packed_values = raw.view(dtype).reshape(-1, 4)
    x, y, scale = packed_values[:, :3].astype(np.float32).T
    x, y = x / scale, y / scale
    z = 1 - np.abs(x) - np.abs(y)
    fold = np.minimum(z, np.float32(0))
    unit = np.stack([x - np.copysign(fold, x), y - np.copysign(fold, y), z], axis=1)
    unit *= np.float32(np.iinfo(dtype).max) / np.linalg.norm(unit, axis=1, keepdims=True)
    out = packed_values.copy()
    out[:, :3] = _round(unit, dtype)
    return out


def _quaternion(raw: NDArray[np.uint8], stride: int) -> NDArray[Any]:
    values = raw.view("<i2").reshape(-1, 4)
    scale = (values[:, 3] | 3).astype(np.float32)
    three = values[:, :3].astype(np.float32) / (scale[:, None] * np.float32(np.sqrt(2)))
    largest = np.sqrt(np.maximum(0, 1 - np.square(three).sum(axis=1)))
    turned = _round(np.concatenate([largest[:, None], three], axis=1) * np.float32(32767), np.int16)
    # Element k of `turned` belongs to component (largest + k) % 4.
    places = (np.arange(4) - (values[:, 3:] & 3)) % 4
    out: NDArray[np.int16] = np.take_along_axis(turned, places, axis=1)
    return out


def _exponential(raw: NDArray[np.uint8], stride: int) -> NDArray[Any]:
    values = raw.view("<i4")
    floats: NDArray[Any] = np.ldexp(((values << 8) >> 8).astype(np.float32), values >> 24)
    return floats


def _color(raw: NDArray[np.uint8], stride: int) -> NDArray[Any]:
    unsigned, signed = (np.uint8, np.int8) if stride == 4 else (np.uint16, np.int16)
    y, alpha = (raw.view(unsigned).reshape(-1, 4)[:, k].astype(np.int32) for k in (0, 3))
    co, cg = (raw.view(signed).reshape(-1, 4)[:, k].astype(np.int32) for k in (1, 2))
    # The highest bit of alpha sets the precision: 1 in all bits up to and including it.
    ones = np.left_shift(1, np.frexp(alpha.astype(np.float32))[1]) - 1
    alpha &= ones >> 1
    alpha = (alpha << 1) | (alpha & 1)
    rgba = np.stack([y + co - cg, y + cg, y - co - cg, alpha], axis=1).astype(np.float32)
    limit = np.float32(np.iinfo(unsigned).max)
    return _round(np.clip(rgba * (limit / ones.astype(np.float32))[:, None], 0, limit), unsigned)


_FILTERS: dict[str, Callable[[NDArray[np.uint8], int], NDArray[Any]]] = {
    "OCTAHEDRAL": _octahedral,
    "QUATERNION": _quaternion,
    "EXPONENTIAL": _exponential,
    "COLOR": _color,
}
_STRIDES = {"OCTAHEDRAL": (4, 8), "QUATERNION": (8,), "COLOR": (4, 8)}
