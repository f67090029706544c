"""Runs a program that decodes a stranger's picture, in a process apart.

The program may crash, loop, or take too much memory: each ends in one error. It gets the rights of
this process; limits of memory and files are its own (:mod:`daguerre.io.exr.transcode`,
:mod:`daguerre.io.pictures.program`).
"""

from __future__ import annotations

import importlib.util
import signal
import subprocess
import sys
from pathlib import Path

from daguerre.errors import InputError


def package() -> str:
    """Folder of OpenImageIO, which a program without site packages must be told."""
    library = importlib.util.find_spec("OpenImageIO")
    assert library is not None
    assert library.origin is not None
    return str(Path(library.origin).parent)


def run(words: tuple[str, ...], where: str, what: str, seconds: float) -> str:
    """Runs a program to its end.

    Args:
        words: Path of the program, and its arguments: the file to decode first.
        where: Place of the file, for messages.
        what: Name of what it holds, such as "PIZ pixels".
        seconds: Time that it may take.

    Returns:
        Its standard output.

    Raises:
        InputError: It failed, crashed or took too long.
    """
    try:
        done = subprocess.run(
            (sys.executable, "-I", "-S", *words),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=seconds,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise InputError(
            f"{where}: cannot be decoded: {what} took longer than {seconds:.0f} s"
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(f"{where}: cannot be decoded: no second process: {error}") from error
    if done.returncode:
        reason = _reason(done.returncode, done.stderr.decode("utf-8", "replace"), words[1])
        raise InputError(f"{where}: cannot be decoded: damaged {what}: {reason}")
    return done.stdout.decode("utf-8", "replace")


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
