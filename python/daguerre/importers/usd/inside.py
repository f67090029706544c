"""Tasks of the helper process that reads stages (``wall.py`` asks for them)."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from daguerre import memory
from daguerre.apart.serving import Owned
from daguerre.files import uses
from daguerre.scene.packed.gathered import Gathered
from daguerre.scene.packed.parts import parts_of

from .reader import read
from .stage import time_of_code
from .wall import FILE, PIXELS

Tell = Callable[[str], None]


def scene(request: Mapping[str, Any], tell: Tell) -> Owned:
    """Reads a stage and takes its scene apart; points over time stay in its files' memory."""
    with _beginning(request, tell):
        found = Gathered()
        read(request["path"], into=found, **request["options"])
        return Owned(parts_of(found), found.owner)


def seconds(request: Mapping[str, Any], tell: Tell) -> float:
    """Converts a time code of a stage to s."""
    with _beginning(request, tell):
        return time_of_code(request["path"], request["code"])


@contextlib.contextmanager
def _beginning(request: Mapping[str, Any], tell: Tell) -> Iterator[None]:
    """Takes over folder and memory limit of the parent process, and reports uses to it."""
    with contextlib.suppress(OSError):
        os.chdir(request["folder"])
    left = request["memory"]
    memory.set_limit(None if left is None else left + memory.own_bytes())

    def hear(use: str | int) -> None:
        text = f"{PIXELS}{use}" if isinstance(use, int) else f"{FILE}{Path(use).absolute()}"
        tell(text)

    with uses.heard_by(hear):
        yield
