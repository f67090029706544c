"""Server: the page's files, and a WebSocket for each page that has the token."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import socket
from collections.abc import Callable
from dataclasses import dataclass
from http import HTTPStatus
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from daguerre.errors import UsageError
from daguerre.lenses.index import names

from .access import HEADERS, Access
from .bundle import PAGE, bundled
from .hub import Hub
from .lens_list import photograph_path
from .messages import MAX_BYTES

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Request, Response

KINDS = {
    ".html": "text/html; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".svg": "image/svg+xml",
    ".webp": "image/webp",
}
SOCKET = "/live"
#: Seconds within which a page sends its token.
PATIENCE_S = 5.0
#: Seconds that a page has to answer when the server ends; a page that hangs never answers.
GOODBYE_S = 1.0
#: Pages at once.
MOST_CLIENTS = 16
#: Connections at once, including connections that have not sent a token yet.
MOST_LINES = 64
#: Ports to try after a port that is in use.
TRIES = 20


@dataclass
class Server:
    """A viewfinder's server.

    Attributes:
        access: Allowed hosts, origins and the token.
        hub: State that the pages share.
    """

    access: Access
    hub: Hub
    clients: int = 0
    lines: int = 0

    def answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """Answers a request with a file of the page; None: a WebSocket."""
        path = urlsplit(request.path).path
        if not self.access.allows_host(request.headers.get_all("Host")):
            return _plain(connection, HTTPStatus.MISDIRECTED_REQUEST, "wrong Host")
        if path == SOCKET:
            if not self.access.allows_origin(request.headers.get_all("Origin")):
                return _plain(connection, HTTPStatus.FORBIDDEN, "wrong Origin")
            if self.lines >= MOST_LINES:
                return _plain(connection, HTTPStatus.SERVICE_UNAVAILABLE, "too many connections")
            return None
        # Before version 17, websockets itself refuses all but GET.
        if getattr(request, "method", "GET") not in ("GET", "HEAD"):
            return _plain(connection, HTTPStatus.METHOD_NOT_ALLOWED, "wanted GET")
        body = _body("/index.html" if path == "/" else path)
        if body is None:
            return _plain(connection, HTTPStatus.NOT_FOUND, "no such file")
        return _file(connection, path, body)

    async def talk(self, connection: ServerConnection) -> None:
        """Serves a WebSocket until it closes."""
        self.lines += 1
        try:
            if await self._has_token(connection):
                await self._serve(connection)
        finally:
            self.lines -= 1

    async def _has_token(self, connection: ServerConnection) -> bool:
        try:
            first = await asyncio.wait_for(connection.recv(), PATIENCE_S)
        except TimeoutError:
            await connection.close(4408, "no token")
            return False
        if isinstance(first, str) and self.access.allows_token(first):
            if self.clients < MOST_CLIENTS:
                return True
            await connection.close(4429, "too many pages")
            return False
        await connection.close(4401, "wrong token")
        return False

    async def _serve(self, connection: ServerConnection) -> None:
        self.clients += 1
        from websockets.exceptions import ConnectionClosed

        client = self.hub.join(_Line(connection))
        try:
            await self.hub.welcome(client)
            with contextlib.suppress(ConnectionClosed):  # without a word: a page that is stuck
                async for message in connection:
                    await self.hub.hear(client, message)
        finally:
            self.clients -= 1
            await self.hub.leave(client)


class _Line:
    """Connection of the hub to a page; a closed connection drops messages."""

    def __init__(self, connection: ServerConnection) -> None:
        self._connection = connection

    async def send(self, message: str | bytes) -> None:
        from websockets.exceptions import ConnectionClosed

        with contextlib.suppress(ConnectionClosed):
            await self._connection.send(message)


def _read_files() -> dict[str, bytes]:
    """Files of the page by path, read once: no request reaches the disk."""
    files = {
        f"/{path.relative_to(PAGE).as_posix()}": path.read_bytes()
        for path in sorted(PAGE.rglob("*"))
        if path.suffix in KINDS and path.suffix != ".js"
    }
    return {**files, "/start.js": bundled("start").encode()}


FILES = _read_files()
#: Photographs of the lenses by path: only these are ever read, one when it is asked for.
PHOTOGRAPHS = {f"/photographs/{name}.webp": photograph_path(name) for name in names()}


def _body(path: str) -> bytes | None:
    """Bytes of a file of the page, or of a photograph; None: there is none."""
    photograph = PHOTOGRAPHS.get(path)
    if photograph is None:
        return FILES.get(path)
    return photograph.read_bytes() if photograph.is_file() else None


def _plain(connection: ServerConnection, status: HTTPStatus, text: str) -> Response:
    return _with_headers(connection.respond(status, f"{text}\n"))


def _file(connection: ServerConnection, path: str, body: bytes) -> Response:
    answer = connection.respond(HTTPStatus.OK, "")
    answer.body = body
    del answer.headers["Content-Type"], answer.headers["Content-Length"]
    answer.headers["Content-Type"] = KINDS[Path(path).suffix or ".html"]
    answer.headers["Content-Length"] = str(len(body))
    return _with_headers(answer)


def _with_headers(answer: Response) -> Response:
    for name, value in HEADERS.items():
        answer.headers[name] = value
    return answer


def free_socket(host: str, port: int) -> socket.socket:
    """Opens a listening socket at a port, or at the next free port.

    Raises:
        UsageError: None of the next ports is free, or the host is not of this machine.
    """
    if not 0 <= port < 1 << 16:
        raise UsageError(f"--port: wanted a number of 0 to 65535, got {port}")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    for each in range(port, min(port + TRIES, 1 << 16) if port else 1):
        try:
            sock = socket.create_server((host, each), family=family, backlog=128)
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                raise UsageError(f"--host {host}: {error.strerror or error}") from None
            continue
        # Connections inherit it. Without it, a picture waits until the page acknowledges the
        # message before, which takes up to 40 ms; asyncio sets it only where a socket names TCP.
        sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return sock
    raise UsageError(f"--port {port}: no port from {port} to {port + TRIES - 1} is free")


async def serve(
    sock: socket.socket,
    access: Access,
    hub_of: Callable[[asyncio.AbstractEventLoop], Hub],
    **more: Any,
) -> None:
    """Serves until it is cancelled."""
    from websockets.asyncio.server import serve as listen

    server = Server(access, hub_of(asyncio.get_running_loop()))
    try:
        async with listen(
            server.talk,
            sock=sock,
            process_request=server.answer,
            compression=None,
            max_size=MAX_BYTES,
            max_queue=8,
            open_timeout=PATIENCE_S,
            close_timeout=GOODBYE_S,
            server_header=None,
            **more,
        ):
            try:
                await asyncio.Event().wait()
            finally:
                await _stop_accepting(sock)
    finally:
        server.hub.close()


async def _stop_accepting(sock: socket.socket) -> None:
    """Accepts no more connections, and lets those just accepted reach their handlers.

    asyncio closes a server without them: their sockets would stay open.
    """
    asyncio.get_running_loop().remove_reader(sock)
    for _ in ("transport", "handler"):  # each is made in a turn of the loop of its own
        await asyncio.sleep(0)
