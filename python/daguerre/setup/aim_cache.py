"""Cache of the set-up of exact lenses ("aims").

A folder keeps the results, one file per lens and setting, named by a hash of everything that they
depend on, including the build of this package: ``$XDG_CACHE_HOME/daguerre/aims`` (``~/.cache`` if
that is not set). ``DAGUERRE_CACHE`` names another folder, or is ``off``. Files are written
atomically; beyond 256 MB the least recently used are removed. If the folder cannot be written
or a file is damaged, the lens is set up anew.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import tempfile
from pathlib import Path

import daguerre._core as _core
from daguerre.files.limited_folder import drop_oldest

MAX_BYTES = 256 << 20


def folder() -> Path | None:
    """Folder that keeps aims; None: no cache."""
    choice = os.environ.get("DAGUERRE_CACHE", "")
    if choice.lower() == "off":
        return None
    if choice:
        return Path(choice) / "aims"
    home = os.environ.get("XDG_CACHE_HOME", "")
    try:
        # The convention: a relative path there is to be ignored.
        base = Path(home) if Path(home).is_absolute() else Path.home() / ".cache"
    except RuntimeError:  # no home
        return None
    return base / "daguerre" / "aims"


def identity(path: Path) -> str:
    """Text that differs between builds of the core: each may aim a lens differently."""
    with contextlib.suppress(OSError):
        facts = path.stat()
        return f"{path} {facts.st_size} {facts.st_mtime_ns}"
    return str(path)


BUILD = f"{_core.__version__} {identity(Path(_core.__file__))}"


def file_name(key: str) -> str:
    """Name of the file in which this build keeps the state of a key."""
    return hashlib.blake2b(f"{key} {BUILD}".encode(), digest_size=16).hexdigest() + ".aim"


def load(key: str) -> bytes | None:
    """Loads the bytes kept under a key, if any, and marks them as used."""
    place = folder()
    if place is None:
        return None
    path = place / file_name(key)
    try:
        state = path.read_bytes()
    except OSError:
        return None
    with contextlib.suppress(OSError):
        os.utime(path)
    return state


def store(key: str, state: bytes) -> None:
    """Stores bytes under a key, if possible."""
    place = folder()
    if place is None:
        return
    with contextlib.suppress(OSError):
        place.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=".new-", dir=place)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(state)
            Path(name).replace(place / file_name(key))
        except OSError:
            Path(name).unlink(missing_ok=True)
            raise
        drop_oldest(place, MAX_BYTES, _is_ours)


def _is_ours(name: str) -> bool:
    """Whether a file is of this cache, or was never finished."""
    return name.endswith(".aim") or name.startswith(".new-")


def exact_lens(
    prescription: _core.Prescription, settings: _core.ExactLensSettings
) -> _core.ExactLens:
    """Sets up a lens at one focus and f-stop; bit-identical with and without the cache.

    Args:
        prescription: The lens, with gaps set for zoom and focus.
        settings: Its stop and focus, and the film that it covers.

    Raises:
        CoreError: The lens has no such stop or focus.
    """
    key = _core.ExactLens.aim_key(prescription, settings)
    known = load(key)
    exact = _core.ExactLens(prescription, settings, known)
    state = exact.aim_state
    if state != known:
        store(key, state)
    return exact
