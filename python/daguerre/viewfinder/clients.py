"""Pages that are connected: one turns the dials, the others watch."""

from __future__ import annotations

import asyncio
import json
from dataclasses import dataclass
from typing import Any, Protocol

from .sheet import Sheet


class Line(Protocol):
    """Connection to a page."""

    async def send(self, message: str | bytes) -> None:
        """Sends a message."""


@dataclass(eq=False)
class Client:
    """A connected page.

    Attributes:
        line: Connection to the page.
        turns: Whether the page may turn the dials.
        busy: Number of the picture that is on its way; None: none.
        sent: Number of the newest picture that was sent.
    """

    line: Line
    turns: bool
    busy: int | None = None
    sent: int = 0

    async def tell(self, message: dict[str, Any]) -> None:
        """Sends the page a message."""
        await self.line.send(json.dumps(message))

    async def offer(self, sheet: Sheet | None) -> None:
        """Sends the page a picture, unless it has this picture or another is on its way."""
        if sheet is None or self.busy is not None or self.sent == sheet.number:
            return
        self.busy = self.sent = sheet.number
        await self.line.send(sheet.bytes)


class Clients(list[Client]):
    """All pages, in the order of their connection."""

    def join(self, line: Line) -> Client:
        """Adds a page; the first page may turn the dials."""
        client = Client(line, not any(other.turns for other in self))
        self.append(client)
        return client

    async def leave(self, client: Client) -> None:
        """Forgets a page; if it turned the dials, the next page does."""
        self.remove(client)
        if client.turns and self:
            self[0].turns = True
            await self[0].tell({"role": "turns"})

    async def tell(self, message: dict[str, Any], heard: Client | None = None) -> None:
        """Sends all pages a message; for the page ``heard``, it is the answer to a request."""
        answer = message | {"heard": True}
        await asyncio.gather(
            *(client.tell(answer if client is heard else message) for client in self)
        )
