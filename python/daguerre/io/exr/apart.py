"""Unpacks pictures of other compressions in a separate process.

Libraries that decode PIZ, PXR24, B44, DWA, HTJ2K and RLE have crashed on damaged files. Here only
another process crashes: :mod:`daguerre.io.exr.transcode` writes plain pixels into a temporary file,
which is then read with the same checks as any other file.
"""

from __future__ import annotations

import importlib.util
import signal
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from daguerre.errors import InputError

from . import transcode
from .layout import COMPRESSIONS, Layout

#: Time limit: seconds for any picture, and bytes per second in addition.
PATIENCE, PACE = 8.0, 50e6


def plain_copy(layout: Layout, folder: TemporaryDirectory[str]) -> Path:
    """Writes the first part of a file into a folder, with plain pixels.

    Raises:
        InputError: The file cannot be decoded, or the process failed, crashed or took too long.
    """
    kind = COMPRESSIONS[layout.compression][0]
    if layout.index != 0:
        raise InputError(
            f"{layout.path}: part {layout.index}: wanted pixels that are plain or deflated (NONE, "
            f"ZIPS, ZIP), got {kind}"
        )
    target = Path(folder.name) / "plain.exr"
    library = importlib.util.find_spec("OpenImageIO")
    assert library is not None
    assert library.origin is not None
    words = (
        sys.executable, "-I", "-S", transcode.__file__, str(layout.path.absolute()), str(target),
        str(Path(library.origin).parent), str(layout.size),
    )  # fmt: skip
    try:
        done = subprocess.run(
            words,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            timeout=PATIENCE + layout.size / PACE,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise InputError(
            f"{layout.path}: cannot be decoded: {kind} pixels took longer than "
            f"{error.timeout:.0f} s"
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(f"{layout.path}: cannot be decoded: no second process: {error}") from error
    if done.returncode:
        reason = _reason(done.returncode, done.stderr.decode("utf-8", "replace"), str(layout.path))
        raise InputError(f"{layout.path}: cannot be decoded: damaged {kind} pixels: {reason}")
    return target


def _reason(code: int, text: str, path: str) -> str:
    """One line of the process's output, or the signal that ended it."""
    if code < 0:
        try:
            return f"the decoder ended by {signal.Signals(-code).name}"
        except ValueError:
            return f"the decoder ended by signal {-code}"
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    line = (lines[0] if code == 1 and "Traceback" not in text else lines[-1]) if lines else ""
    return "".join(c for c in line.replace(path, "").strip() if c.isprintable())[:200] or "unknown"
