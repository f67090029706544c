"""Reads stages behind a wall: USD runs in a helper process, which answers with a packed scene.

USD crashes, loops or fills the memory on some damaged files; each of these raises one
``InputError`` here. This process does not import USD to read. A fault may hand the helper over to a
stranger, so its answer is rebuilt with checks, like a scene in a stranger's file.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from daguerre import memory
from daguerre.apart.helper import Answer, Helper, NoHelperError
from daguerre.apart.limits import Limits
from daguerre.errors import InputError
from daguerre.files.in_use import note_read
from daguerre.scene.packed.rebuild import rebuilding, rebuilt
from daguerre.scene.packed.values import make_verbatim
from daguerre.scene.scene import Scene

_TASKS = "daguerre.importers.usd.inside"
#: Prefixes of the helper's texts: a file that it reads, and the bytes of a decoded picture.
FILE, PIXELS = "file ", "pixels "
#: Limits for a stage of at most ``_SMALL`` bytes.
_SECONDS, _MEMORY, _SMALL = 10.0, 1.5e9, 1e6
#: More of both for each byte of files beyond that, and for each byte of decoded pictures.
_SECONDS_PER_BYTE, _MEMORY_PER_BYTE = 1e-6, 200.0
_SECONDS_PER_PIXEL, _MEMORY_PER_PIXEL = 4e-8, 2.0
#: Most bytes of decoded pictures that count, as of ``shading.images``.
_MOST_PIXELS = 8 << 30
#: Least memory of a helper, bytes, and its largest share of the memory left.
_LEAST, _SHARE = 3e8, 0.9
_helper = Helper()


def read(
    path: str | os.PathLike[str],
    *,
    time: float = 0.0,
    variant: str | Sequence[str] = (),
    allow_dirs: Iterable[str | os.PathLike[str]] = (),
    purpose: Sequence[str] = ("render",),
    camera_units: float | None = None,
    moments: tuple[float, float] | None = None,
    in_process: bool = False,
) -> Scene:
    """Reads a stage: .usd, .usda, .usdc or .usdz.

    Args:
        path: The file.
        time: Scene time, s: time codes over the stage's time codes per second.
        variant: Selections of variants, each as ``/prim:set=name``.
        allow_dirs: Further folders from which it may read layers and images.
        purpose: Purposes of prims to draw, besides ``default``.
        camera_units: Length of a unit of focal lengths and apertures, mm; default: a tenth of a
            scene unit.
        moments: Begin and end of the time that will be drawn, s; default: any may be.
        in_process: Whether USD may run in this process, which a damaged file can then end.

    Returns:
        The scene; ``warnings`` has notes on unsupported content.

    Raises:
        InputError: The file cannot be read or is invalid, or no helper process can start.
    """
    folders = (allow_dirs,) if isinstance(allow_dirs, str | os.PathLike) else tuple(allow_dirs)
    options: dict[str, Any] = {
        "time": time,
        "variant": variant if isinstance(variant, str) else tuple(variant),
        "allow_dirs": tuple(map(os.fspath, folders)),
        "purpose": tuple(purpose),
        "camera_units": camera_units,
        "moments": moments,
    }
    if in_process:
        from . import reader

        return reader.read(path, **options)
    found = _scene(_ask("scene", path, {"options": options}))
    found.path = Path(path)
    return found


def time_of_code(path: str | os.PathLike[str], code: float, *, in_process: bool = False) -> float:
    """Converts a time code of a stage to s.

    Args:
        path: The file.
        code: Time code.
        in_process: Whether USD may run in this process; see :func:`read`.

    Raises:
        InputError: The file cannot be read, or states no valid rate.
    """
    if in_process:
        from . import stage

        return stage.time_of_code(path, code)
    found = _ask("seconds", path, {"code": float(code)}).value()
    if not isinstance(found, float):
        raise InputError(f"{path}: cannot read: the helper process sent no time")
    return found


class _Uses:
    """Limits that grow with the files that a stage reads.

    Only existing files count, each once: the helper reports names, but no sizes.
    """

    def __init__(self) -> None:
        self._files: dict[tuple[int, int], int] = {}
        self._pixels = 0
        self._left = memory.left_bytes()

    def heard(self, text: str) -> Limits:
        """Limits with another file or picture."""
        if text.startswith(PIXELS):
            count = text.removeprefix(PIXELS)
            more = int(count) if count.isdecimal() and len(count) < 20 else 0
            self._pixels = min(self._pixels + more, _MOST_PIXELS)
        elif text.startswith(FILE):
            self._open(text.removeprefix(FILE))
        return self.limits

    def _open(self, name: str) -> None:
        note_read([name])
        try:
            facts = Path(name).stat()
        except (OSError, ValueError):
            return
        self._files[facts.st_dev, facts.st_ino] = facts.st_size

    @property
    def limits(self) -> Limits:
        """The limits now."""
        more = max(sum(self._files.values()) - _SMALL, 0.0)
        seconds = _SECONDS + _SECONDS_PER_BYTE * more + _SECONDS_PER_PIXEL * self._pixels
        most = _MEMORY + _MEMORY_PER_BYTE * more + _MEMORY_PER_PIXEL * self._pixels
        if self._left is not None:
            most = min(most, max(_SHARE * self._left, _LEAST))
        return Limits(seconds, int(most))


def _ask(task: str, path: str | os.PathLike[str], request: Mapping[str, Any]) -> Answer:
    """Runs a task of ``inside.py``."""
    uses = _Uses()
    given = {
        "path": os.fspath(path),
        "folder": _folder(),
        "memory": memory.left_bytes(),
        **request,
    }
    try:
        return _helper.answer(
            f"{_TASKS}:{task}", given, uses.limits, where=str(path), heard=uses.heard
        )
    except NoHelperError as error:
        raise NoHelperError(
            f"{error}; --usd-in-process reads a stage that you trust without one"
        ) from None


def _folder() -> str:
    try:
        return str(Path.cwd())
    except OSError:  # it is gone
        return "/"


def _scene(answer: Answer) -> Scene:
    """Rebuilds a scene from the helper's answer."""
    with rebuilding(f"{answer.where}: cannot read"):
        return rebuilt(answer.value(make_verbatim), answer.size, verbatim=True)
