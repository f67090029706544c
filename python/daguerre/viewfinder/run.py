"""Run: opens the server, prints the page's address, and serves until it is stopped."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from daguerre.checks import is_loopback
from daguerre.errors import UsageError

from .access import Access, check_origin, new_token
from .browser import opened
from .dials import Dials
from .hub import Hub
from .server import free_socket, serve
from .stage import Stage

INTERRUPTED = 0  # a viewfinder ends by Ctrl-C alone


@dataclass(frozen=True)
class Listening:
    """Address of the server.

    Attributes:
        host: Address to listen on.
        port: Port; if it is in use, the next free port.
        token: Token of the page; None: a new random token.
        browser: Whether to open a browser.
        proxies: Addresses of proxies that lead here, such as ``https://hub.example``.
    """

    host: str = "127.0.0.1"
    port: int = 8321
    token: str | None = None
    browser: bool = True
    proxies: tuple[str, ...] = ()


def run(
    stage: Stage,
    dials: Dials,
    words: Sequence[str],
    where: Listening,
    say: Callable[[str], None],
    said: str = "",
) -> int:
    """Serves a viewfinder until Ctrl-C.

    Args:
        stage: Scene, camera and settings.
        dials: Dials of the command line.
        words: Its other words.
        where: Address of the server.
        say: Prints a line.
        said: Text that pages show until something is turned.

    Raises:
        UsageError: The address cannot be used.
    """
    if not is_loopback(where.host):
        if where.token is None:
            raise UsageError(
                f"--host {where.host} needs --token: other machines can reach this address"
            )
        say(
            f"warning: anyone who can reach {where.host} and has the token can see the "
            "picture and control the camera"
        )
    for proxy in where.proxies:
        check_origin(proxy)
    sock = free_socket(where.host, where.port)
    port = sock.getsockname()[1]
    if port != where.port and where.port:
        say(f"port {where.port} is in use; using {port}")
    token = where.token or new_token()
    host = f"[{where.host}]" if ":" in where.host else where.host
    url = f"http://{host}:{port}/#{token}"
    say(url)
    access = Access.at(where.host, port, token, where.proxies)
    page = opened(url, say) if where.browser else contextlib.nullcontext()
    with contextlib.suppress(KeyboardInterrupt), page:
        asyncio.run(serve(sock, access, lambda loop: Hub(stage, dials, words, loop, said=said)))
    return INTERRUPTED
