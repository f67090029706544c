"""Watches the file of a scene, and lets pages know that the server lives."""

from __future__ import annotations

import asyncio
import itertools
from pathlib import Path

from .clients import Clients

#: Time between two looks at the scene's file, s.
_LOOK_S = 2.5
#: Looks from one sign of life to the next: browsers show pages no pings of the protocol.
_LOOKS = 4


async def watch(path: Path | None, clients: Clients) -> None:
    """Tells the pages when the file changes, and at times that the server lives."""
    known = _stamp(path)
    for look in itertools.count(1):
        await asyncio.sleep(_LOOK_S)
        now = _stamp(path)
        if now not in (known, None):
            known = now
            await clients.tell({"changed": "" if path is None else path.name})
        if look % _LOOKS == 0:
            await clients.tell({"ping": look})


def _stamp(path: Path | None) -> tuple[int, int] | None:
    """Time and size of a file; None: there is none."""
    try:
        facts = None if path is None else path.stat()
    except OSError:
        return None
    return None if facts is None else (facts.st_mtime_ns, facts.st_size)
