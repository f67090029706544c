"""Blocks that cross between processes as sealed files in memory instead of through a socket.

A sealed file can neither change nor shrink, so its sender can do nothing to the process that maps
it.
"""

from __future__ import annotations

import ctypes
import fcntl
import itertools
import mmap
import os
from collections.abc import Sequence
from functools import cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import SealedBytes
from daguerre.files.packing import padded

#: Whether this system has such files; Linux has.
HAS_FILES = hasattr(os, "memfd_create")
_SEALS = fcntl.F_SEAL_SHRINK | fcntl.F_SEAL_GROW | fcntl.F_SEAL_WRITE if HAS_FILES else 0


def copied(blocks: Sequence[memoryview]) -> int | None:
    """Copies blocks into a sealed file, aligned as in a packed value.

    Returns:
        The open file; None: this system has no sealed files.
    """
    if not HAS_FILES:
        return None
    try:
        file = os.memfd_create("daguerre", os.MFD_CLOEXEC | os.MFD_ALLOW_SEALING)
    except OSError:
        return None
    try:
        for block in blocks:
            left = block
            while left:
                left = left[os.write(file, left) :]
            os.write(file, bytes(padded(len(block)) - len(block)))
        fcntl.fcntl(file, fcntl.F_ADD_SEALS, _SEALS)
    except OSError:
        os.close(file)
        return None
    return file


def mapped(files: list[int], sizes: Sequence[int]) -> list[NDArray[np.uint8]]:
    """Maps the bytes of blocks, read-only. The file can be closed then.

    Args:
        files: Open files that came with the blocks; valid: a single file.
        sizes: Numbers of bytes; not all are 0.

    Raises:
        OSError: The file cannot be mapped, or is of another kind.
        ValueError: There is not one sealed file of this size.
    """
    if len(files) != 1 or not HAS_FILES:
        raise ValueError(f"wanted 1 file, got {len(files)}")
    begins = list(itertools.accumulate(map(padded, sizes), initial=0))
    size = begins.pop()
    seals = fcntl.fcntl(files[0], fcntl.F_GET_SEALS)
    found = os.fstat(files[0]).st_size
    if seals & _SEALS != _SEALS or found != size:
        raise ValueError(f"wanted a sealed file of {size} bytes, got {found} bytes")
    system = _system()
    address = system.mmap(None, size, mmap.PROT_READ, mmap.MAP_PRIVATE, files[0], 0)
    if address == ctypes.c_void_p(-1).value:
        code = ctypes.get_errno()
        raise OSError(code, os.strerror(code))
    held = np.asarray(SealedBytes(address, size, partial(system.munmap, address, size)))
    return [held[begin : begin + size] for begin, size in zip(begins, sizes, strict=True)]


@cache
def _system() -> Any:
    """The C library: ``mmap.mmap`` would keep the file open for as long as its bytes."""
    system = ctypes.CDLL(None, use_errno=True)
    system.mmap.restype = ctypes.c_void_p
    numbers = (ctypes.c_int, ctypes.c_int, ctypes.c_int, ctypes.c_long)
    system.mmap.argtypes = (ctypes.c_void_p, ctypes.c_size_t, *numbers)
    system.munmap.argtypes = (ctypes.c_void_p, ctypes.c_size_t)
    return system
