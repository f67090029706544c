"""A viewfinder's server in a thread, and pages that talk to it, for tests."""

from __future__ import annotations

import asyncio
import contextlib
import json
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from daguerre.viewfinder.access import Access
from daguerre.viewfinder.clients import Client
from daguerre.viewfinder.dials import Dials
from daguerre.viewfinder.hub import Hub
from daguerre.viewfinder.server import free_socket, serve
from daguerre.viewfinder.stage import Stage

TOKEN = "test-token"
WORDS = ["scene.glb", "-o", "out.exr"]


@dataclass
class Live:
    """A server that runs: its port, its hub and its event loop."""

    port: int
    hub: Hub
    loop: asyncio.AbstractEventLoop

    @property
    def host(self) -> str:
        """Host and port."""
        return f"127.0.0.1:{self.port}"

    def turn(self, changes: Mapping[str, str | None]) -> None:
        """Turns dials as the page that turns does."""
        client = Client(_Nowhere(), turns=True)
        work = self.hub.hear(client, json.dumps({"turn": changes}))
        asyncio.run_coroutine_threadsafe(work, self.loop).result(30)


class _Nowhere:
    """Line of a page that turns; all that it is sent is that it was heard."""

    async def send(self, message: str | bytes) -> None:
        assert json.loads(message) == {"heard": True}, message


@contextlib.contextmanager
def live(
    stage: Stage,
    dials: Dials | None = None,
    words: Sequence[str] = WORDS,
    also: Sequence[str] = (),
    said: str = "",
) -> Iterator[Live]:
    """Runs a server while the context lasts.

    Args:
        stage: Scene, camera and settings.
        dials: Dials of the command line.
        words: Its other words.
        also: Other addresses that it lets in.
        said: Text that pages show until something is turned.
    """
    sock = free_socket("127.0.0.1", 0)
    port = sock.getsockname()[1]
    started, hubs = threading.Event(), []
    loop = asyncio.new_event_loop()

    def hub_of(running: asyncio.AbstractEventLoop) -> Hub:
        hubs.append(Hub(stage, dials or Dials(), words, running, said=said))
        started.set()
        return hubs[0]

    task = None

    def run() -> None:
        nonlocal task
        asyncio.set_event_loop(loop)
        task = loop.create_task(serve(sock, Access.at("127.0.0.1", port, TOKEN, also), hub_of))
        with contextlib.suppress(asyncio.CancelledError):
            loop.run_until_complete(task)
        loop.run_until_complete(loop.shutdown_default_executor())
        loop.close()

    thread = threading.Thread(target=run)
    thread.start()
    assert started.wait(30)
    try:
        yield Live(port, hubs[0], loop)
    finally:
        assert task is not None
        loop.call_soon_threadsafe(task.cancel)
        thread.join(30)
        assert not thread.is_alive()


@dataclass
class Page:
    """A page that is connected, as a browser would be."""

    socket: Any
    role: str = ""
    open: dict[str, Any] = field(default_factory=dict)
    state: dict[str, Any] = field(default_factory=dict)
    refused: list[str] = field(default_factory=list)
    changed: list[str] = field(default_factory=list)
    heard: int = 0
    drawn: int = -1
    values: list[Any] = field(default_factory=list)
    heads: list[dict[str, Any]] = field(default_factory=list)
    bytes: bytes = b""
    acknowledges: bool = True

    def send(self, **message: Any) -> None:
        """Sends a message."""
        self.socket.send(json.dumps(message))

    def step(self, timeout: float = 30) -> None:
        """Takes the next message."""
        found = self.socket.recv(timeout)
        if isinstance(found, bytes):
            length = int.from_bytes(found[:4], "little")
            self.heads.append(json.loads(found[4 : 4 + length]))
            self.bytes = found[4 + length :]
            if self.acknowledges:
                self.send(got=self.heads[-1]["picture"])
            return
        message = json.loads(found)
        self.role = message.get("role", self.role)
        self.open = message.get("open", self.open)
        self.state = message.get("state", self.state)
        self.heard += "heard" in message
        self.drawn = message.get("drawn", self.drawn)
        self.changed = message.get("changed", self.changed)
        if "refused" in message:
            self.refused.append(message["refused"])
        if "value" in message:
            self.values.append(message["value"])

    def until_rest(self, turn: int, timeout: float = 60) -> dict[str, Any]:
        """Head of the picture at rest of a turn."""
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            if self.heads and self.heads[-1]["rests"] and self.heads[-1]["turn"] == turn:
                return self.heads[-1]
            self.step(max(0.1, end - time.monotonic()))
        raise AssertionError(f"no picture at rest of turn {turn}")


@contextlib.contextmanager
def page(server: Live, token: str = TOKEN, **more: Any) -> Iterator[Page]:
    """Opens a page."""
    from websockets.sync.client import connect

    with connect(f"ws://{server.host}/live", **more) as socket:
        socket.send(token)
        yield Page(socket)
