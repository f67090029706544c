"""Opens pictures by one plug-in of OpenImageIO alone, and reads their pixels in this process."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

from .size import check_size

_ALL_READERS = "try_all_readers"


class _OnePlugin:
    """Context, for any thread, in which OpenImageIO tries the plug-in of the suffix alone.

    Otherwise OpenImageIO offers a file that this plug-in refuses to all other plug-ins. The setting
    belongs to the process, so it is restored afterwards.
    """

    def __init__(self) -> None:
        self._lock, self._inside, self._before = threading.Lock(), 0, 1
        if hasattr(os, "register_at_fork"):
            os.register_at_fork(after_in_child=self._renew)

    def _renew(self) -> None:
        """Forgets threads that the parent had at a fork."""
        self._lock, self._inside = threading.Lock(), 0

    @contextmanager
    def only(self) -> Iterator[None]:
        import OpenImageIO as oiio

        with self._lock:
            if self._inside == 0:
                self._before = oiio.get_int_attribute(_ALL_READERS, 1)
                oiio.attribute(_ALL_READERS, 0)
            self._inside += 1
        try:
            yield
        finally:
            with self._lock:
                self._inside -= 1
                if self._inside == 0:
                    oiio.attribute(_ALL_READERS, self._before)


_one_plugin = _OnePlugin()


def read(name: str, where: str, limit: int, *, floats: bool = False) -> tuple[NDArray[Any], Any]:
    """Reads the first picture of a file.

    Args:
        name: File; its suffix chooses the plug-in.
        where: Place of the picture, for messages.
        limit: Most bytes of its pixels.
        floats: Return float32: integers scaled to 0 .. 1, premultiplied by alpha; otherwise the
            type of the file, with straight alpha.

    Returns:
        Pixels, shape (H, W, C), and OpenImageIO's ``ImageSpec``.

    Raises:
        InputError: The file cannot be decoded, or is too large.
    """
    import OpenImageIO as oiio  # takes 30 MB, which scenes without pictures save

    try:
        name.encode()
    except UnicodeEncodeError:
        raise InputError(f"{where}: cannot be decoded: wanted a name in UTF-8") from None
    config = oiio.ImageSpec()
    config.attribute("oiio:UnassociatedAlpha", int(not floats))
    with _one_plugin.only():
        source = oiio.ImageInput.open(name, config)
        if source is None:
            raise InputError(f"{where}: cannot be decoded: {reason(oiio.geterror(), name)}")
    try:
        spec = source.spec()
        format = oiio.TypeDesc(oiio.FLOAT) if floats else spec.format
        check_size(spec.width, spec.height, spec.nchannels, format.basesize(), where, limit)
        pixels = source.read_image(0, 0, 0, spec.nchannels, format)
        error = source.geterror()
    finally:
        source.close()
    if pixels is None or (error and "extraneous bytes" not in error):
        raise InputError(f"{where}: cannot be decoded: {reason(error, name)}")
    return np.asarray(pixels).reshape(spec.height, spec.width, spec.nchannels), spec


def reason(error: str, name: str) -> str:
    """One line of an error of OpenImageIO, without the path."""
    line = error.strip().splitlines()[0] if error.strip() else "no reason given"
    return line.replace(f'("{name}")', "").replace(name, Path(name).name).strip()[:200]
