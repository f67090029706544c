"""Flags of the viewfinder's server.

Annotations must be real objects here (see ``groups.py``), so no ``annotations`` future.
"""

from dataclasses import dataclass
from typing import Annotated

from .groups import option

PORT = 8321


@dataclass(frozen=True)
class ServerFlags:
    """Address of the viewfinder, its token and proxies."""

    host: Annotated[
        str, option("--host", metavar="ADDRESS", help="Address to listen on [127.0.0.1].")
    ] = "127.0.0.1"
    port: Annotated[
        int, option("--port", metavar="N", help=f"Port; the next free one from here [{PORT}].")
    ] = PORT
    token: Annotated[
        str | None,
        option("--token", metavar="TEXT", help="Token of the page [a new random one]."),
    ] = None
    proxy: Annotated[
        list[str] | None,
        option(
            "--proxy",
            metavar="URL",
            help="Address of a proxy that leads here, such as https://hub.example; repeatable.",
        ),
    ] = None
    no_browser: Annotated[
        bool, option("--no-browser", help="Print the page's address, and open no browser.")
    ] = False
