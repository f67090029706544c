"""Decodes an untrusted picture into a plain file, in a process apart.

The program, :mod:`daguerre.pictures.decoder_program`, may crash, loop, or take too much memory:
each ends in one error. It has the rights of this process, and limits its resources.
"""

from __future__ import annotations

import importlib.util
import math
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from daguerre.errors import InputError

from . import decoder_program


@dataclass(frozen=True)
class Wanted:
    """A plain picture that is wanted.

    Attributes:
        form: ``tiff``, or ``openexr`` for an EXR.
        target: File that it becomes.
        most: Most bytes of its pixels.
        seconds: Time that it may take.
        straight: Whether alpha is straight; otherwise colours are premultiplied.
    """

    form: Literal["tiff", "openexr"]
    target: Path
    most: int
    seconds: float
    straight: bool = False


def run(source: str | Path, wanted: Wanted, where: str, what: str) -> str:
    """Decodes a picture.

    Args:
        source: File of the picture.
        wanted: The plain picture.
        where: Place of the file, for messages.
        what: Name of the content, such as "PIZ pixels", for messages.

    Returns:
        Standard output of the decoder.

    Raises:
        InputError: The decoder failed, crashed or took too long.
    """
    path = str(Path(source).absolute())
    numbers = (wanted.most, math.ceil(wanted.seconds), int(wanted.straight))
    words = (wanted.form, path, str(wanted.target), _package(), *map(str, numbers))
    try:
        done = subprocess.run(
            (sys.executable, "-I", "-S", decoder_program.__file__, *words),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=wanted.seconds,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise InputError(
            f"{where}: cannot be decoded: {what} took longer than {wanted.seconds:.0f} s"
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(f"{where}: cannot be decoded: no second process: {error}") from error
    if done.returncode:
        reason = _reason(done.returncode, done.stderr.decode("utf-8", "replace"), path)
        raise InputError(f"{where}: cannot be decoded: damaged {what}: {reason}")
    return done.stdout.decode("utf-8", "replace")


def _package() -> str:
    """Folder of OpenImageIO: the decoder, without site packages, gets it as an argument."""
    library = importlib.util.find_spec("OpenImageIO")
    assert library is not None
    assert library.origin is not None
    return str(Path(library.origin).parent)


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
