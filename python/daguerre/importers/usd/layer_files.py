"""Checks files of layers before USD opens them: ordinary files with valid content."""

from __future__ import annotations

import mmap
from pathlib import Path

from daguerre.errors import InputError
from daguerre.files.reading import opened, size_of

from .crates import MAGIC, check_crate
from .packages import entries_of
from .text_layers import check_text

#: Most nested packages.
_DEEPEST = 4
_TEXTS = (".usda", ".usd", ".sdf")


def check_file(path: Path, file: str) -> bool:
    """Checks a layer, or all layers of a package.

    Args:
        path: File of the layer or package.
        file: File, for messages.

    Returns:
        Whether the layer may name files by expressions, or files inside of packages.

    Raises:
        InputError: The file is no ordinary file, is damaged, or is nested too deeply.
    """
    if size_of(path) == 0:
        return False
    with opened(path) as stream:
        whole = mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ)
    if path.suffix.lower() == ".usdz" or whole[:2] == b"PK":
        return _check_package(whole, file, 1)
    return _check_layer(path.name, memoryview(whole), file)


def _check_package(whole: mmap.mmap | memoryview, file: str, depth: int) -> bool:
    if depth > _DEEPEST:
        raise InputError(f"{file}: packages are nested too deeply: the limit is {_DEEPEST}")
    odd = False
    for entry in entries_of(whole, file):
        data = memoryview(whole)[entry.begin : entry.end]
        if entry.name.lower().endswith(".usdz"):
            odd |= _check_package(data, f"{file}[{entry.name}]", depth + 1)
        elif data[:8] == MAGIC or entry.name.lower().endswith(_TEXTS):
            odd |= _check_layer(entry.name, data, file)
    return odd


def _check_layer(name: str, data: memoryview, file: str) -> bool:
    if data[:8] == MAGIC:
        return check_crate(data, file)
    return check_text(bytes(data), file)
