"""Denoisers: Open Image Denoise from its package, or from a shared library of another program.

Source of the C interface: the documentation of Open Image Denoise 2, openimagedenoise.github.io.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError, UsageError

Image = NDArray[np.float32]

_CPU, _FLOAT3 = 1, 3
_BALANCED, _HIGH = 5, 6
#: Major version of the interface.
_MAJOR = 2
_HANDLE, _TEXT, _SIZE = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t
#: Result and arguments of the functions that are called.
_FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {
    "oidnNewDevice": (_HANDLE, [ctypes.c_int]),
    "oidnCommitDevice": (None, [_HANDLE]),
    "oidnReleaseDevice": (None, [_HANDLE]),
    "oidnGetDeviceInt": (ctypes.c_int, [_HANDLE, _TEXT]),
    "oidnGetDeviceError": (ctypes.c_int, [_HANDLE, ctypes.POINTER(_TEXT)]),
    "oidnNewFilter": (_HANDLE, [_HANDLE, _TEXT]),
    "oidnSetSharedFilterImage": (
        None, [_HANDLE, _TEXT, _HANDLE, ctypes.c_int, _SIZE, _SIZE, _SIZE, _SIZE, _SIZE],
    ),
    "oidnSetFilterBool": (None, [_HANDLE, _TEXT, ctypes.c_bool]),
    "oidnSetFilterInt": (None, [_HANDLE, _TEXT, ctypes.c_int]),
    "oidnCommitFilter": (None, [_HANDLE]),
    "oidnExecuteFilter": (None, [_HANDLE]),
    "oidnReleaseFilter": (None, [_HANDLE]),
}  # fmt: skip


@dataclass(frozen=True)
class Denoiser:
    """A denoiser.

    Attributes:
        name: Name and version.
        run: Filters ``color`` by clean ``albedo`` and ``normal``, or one of these alone; pictures
            are given by name, shape (H, W, 3).
    """

    name: str
    run: Callable[..., Image]


def of_library(path: Path) -> Denoiser:
    """Loads the denoiser from a shared library of Open Image Denoise 2.

    Raises:
        UsageError: It is none.
    """
    try:
        library = ctypes.CDLL(str(path))
        for name, (result, arguments) in _FUNCTIONS.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError) as error:
        raise UsageError(f"{path}: wanted Open Image Denoise {_MAJOR}, got {error}") from None
    device = library.oidnNewDevice(_CPU)
    library.oidnCommitDevice(device)
    number = library.oidnGetDeviceInt(device, b"version")
    library.oidnReleaseDevice(device)
    major, minor, patch = number // 10000, number // 100 % 100, number % 100
    if major != _MAJOR:
        raise UsageError(f"{path}: wanted Open Image Denoise {_MAJOR}, got version {major}")
    name = f"Open Image Denoise {major}.{minor}.{patch}"
    return Denoiser(name, lambda **images: _filtered(library, images))


def _filtered(library: ctypes.CDLL, images: dict[str, Image]) -> Image:
    """Filters the picture by clean guides, or filters a guide."""
    given = {name: np.ascontiguousarray(image, np.float32) for name, image in images.items()}
    made = np.empty_like(next(iter(given.values())))
    device = library.oidnNewDevice(_CPU)
    library.oidnCommitDevice(device)
    work = library.oidnNewFilter(device, b"RT")
    try:
        for name, image in (*given.items(), ("output", made)):
            height, width, _ = image.shape
            library.oidnSetSharedFilterImage(
                work, name.encode(), image.ctypes.data, _FLOAT3, width, height, 0, 0, 0
            )
        has_color = "color" in given
        library.oidnSetFilterInt(work, b"quality", _HIGH if has_color else _BALANCED)
        library.oidnSetFilterBool(work, b"hdr", has_color)
        library.oidnSetFilterBool(work, b"cleanAux", len(given) > 1)
        library.oidnCommitFilter(work)
        library.oidnExecuteFilter(work)
        text = _TEXT()
        if library.oidnGetDeviceError(device, ctypes.byref(text)):
            said = (text.value or b"").decode(errors="replace")
            raise InputError(f"denoise: Open Image Denoise failed: {said}")
    finally:
        library.oidnReleaseFilter(work)
        library.oidnReleaseDevice(device)
    return made
