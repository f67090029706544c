"""Access control: allowed hosts, origins and tokens, and the page's content security policy.

A page of another origin can send requests to this machine, and a host name that its owner points
here ("DNS rebinding") makes them look local. So Host and Origin must equal addresses that the
server listens on, and a WebSocket must first send the token, which only the printed URL has.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from urllib.parse import urlsplit

from daguerre.checks import is_loopback
from daguerre.errors import UsageError

#: Headers of every answer. The page has scripts, styles and pictures of its own alone.
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' blob: data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'self'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}
_TOKEN_BYTES = 32


def new_token() -> str:
    """Makes a token of 256 random bits."""
    return secrets.token_urlsafe(_TOKEN_BYTES)


def check_origin(text: str) -> None:
    """Checks the address of a proxy: scheme, host and perhaps port, as browsers send them.

    Raises:
        UsageError: It has another form.
    """
    parts = urlsplit(text)
    if parts.scheme not in ("http", "https") or text != f"{parts.scheme}://{parts.netloc}":
        raise UsageError(f"--proxy: wanted http(s)://HOST or with :PORT, got {text!r}")


@dataclass(frozen=True)
class Access:
    """Allowed hosts, origins and the token of a server.

    Attributes:
        token: Text that a WebSocket sends first.
        hosts: Allowed values of Host, such as ``127.0.0.1:8321``.
        origins: Allowed values of Origin, such as ``http://127.0.0.1:8321``.
    """

    token: str
    hosts: frozenset[str]
    origins: frozenset[str]

    @classmethod
    def at(cls, host: str, port: int, token: str, more: Sequence[str] = ()) -> Access:
        """Makes the access control of a server.

        Args:
            host: Address that the server listens on.
            port: Port of the server.
            token: The token.
            more: Further names of the server, as in a proxy's ``https://HOST:PORT``.
        """
        names = {host, "localhost"} if is_loopback(host) else {host}
        shown = {f"[{name}]" if ":" in name else name for name in names}
        hosts = {f"{name}:{port}" for name in shown}
        origins = {f"http://{one}" for one in hosts} | set(more)
        hosts |= {one.partition("://")[2] for one in more}
        return cls(token, frozenset(hosts), frozenset(origins))

    def allows_host(self, hosts: Sequence[str]) -> bool:
        """Whether a request has a single Host, an allowed value."""
        return len(hosts) == 1 and hosts[0] in self.hosts

    def allows_origin(self, origins: Sequence[str]) -> bool:
        """Whether a WebSocket comes from our own page, or from a program without a browser."""
        return not origins or (len(origins) == 1 and origins[0] in self.origins)

    def allows_token(self, token: str) -> bool:
        """Whether the token is right, in a time that does not depend on its value."""
        return hmac.compare_digest(token.encode(), self.token.encode())
