"""Watches the files of a scene, and lets pages know that the server lives."""

from __future__ import annotations

import asyncio
import itertools
from collections.abc import Callable, Mapping
from pathlib import Path

from daguerre.files.recorded import Stamp, changed

from .clients import Client, Clients

#: Time between two looks at the scene's files, s.
_LOOK_S = 2.5
#: Looks from one sign of life to the next: browsers show pages no pings of the protocol.
_LOOKS = 4


class Watch:
    """Watches the files of a scene.

    Args:
        files: Returns the files that were read, with their stamps then.
        clients: Pages that hear of changes.
    """

    def __init__(self, files: Callable[[], Mapping[str, Stamp]], clients: Clients) -> None:
        self._files, self._clients = files, clients
        self._told: list[str] = []

    async def run(self) -> None:
        """Tells the pages when files change, and at times that the server lives."""
        for look in itertools.count(1):
            await asyncio.sleep(_LOOK_S)
            files = self._files()
            names = await asyncio.to_thread(changed, files)
            if files is self._files() and names != self._told:  # not loaded again meanwhile
                self._told = names
                await self._clients.tell(self._message())
            if look % _LOOKS == 0:
                await self._clients.tell({"ping": look})

    async def welcome(self, client: Client) -> None:
        """Tells a page the changes so far."""
        await client.tell(self._message())

    async def begin(self) -> None:
        """Tells the pages that all files are read anew."""
        self._told = []
        await self._clients.tell(self._message())

    def _message(self) -> dict[str, list[str]]:
        return {"changed": sorted({Path(name).name for name in self._told})}
