"""Who is let in: addresses by equality, and the token."""

from __future__ import annotations

import pytest

from daguerre.checks import is_loopback
from daguerre.viewfinder.access import Access, new_token

ACCESS = Access.at("127.0.0.1", 8321, "secret")


@pytest.mark.parametrize("host", ["127.0.0.1:8321", "localhost:8321"])
def test_our_own_names_are_known(host: str) -> None:
    assert ACCESS.allows_host([host])
    assert ACCESS.allows_origin([f"http://{host}"])


@pytest.mark.parametrize(
    "hosts",
    [
        [],
        ["evil.example:8321"],
        ["127.0.0.1"],
        ["127.0.0.1:80"],
        ["127.0.0.1:8321.evil.example"],
        ["evil.127.0.0.1:8321"],
        ["127.0.0.1:8321", "127.0.0.1:8321"],
        ["127.0.0.1:8321", "evil.example"],
        ["LOCALHOST:8321\n"],
        ["0.0.0.0:8321"],
        ["[::1]:8321"],
    ],
)
def test_other_hosts_are_not(hosts: list[str]) -> None:
    assert not ACCESS.allows_host(hosts)


@pytest.mark.parametrize(
    "origin",
    [
        "null",
        "http://evil.example",
        "https://127.0.0.1:8321",
        "http://127.0.0.1:8321/",
        "http://127.0.0.1:83210",
        "http://127.0.0.1:8321.evil.example",
        "http://localhost",
        "file://",
        "",
    ],
)
def test_other_origins_are_not(origin: str) -> None:
    assert not ACCESS.allows_origin([origin])


def test_a_proxy_adds_its_origin() -> None:
    access = Access.at("127.0.0.1", 8321, "secret", ["https://hub.example"])
    assert access.allows_origin(["https://hub.example"])
    assert access.allows_host(["hub.example"])
    assert not access.allows_origin(["https://hub.example.evil"])


@pytest.mark.parametrize("token", ["", "secre", "secret ", "Secret", "secret\0", "geheim", "ü"])
def test_another_token_opens_nothing(token: str) -> None:
    assert not ACCESS.allows_token(token)
    assert ACCESS.allows_token("secret")


def test_tokens_have_256_bits_and_differ() -> None:
    tokens = {new_token() for _ in range(100)}
    assert len(tokens) == 100
    assert all(len(token) >= 43 for token in tokens)


@pytest.mark.parametrize(
    ("host", "local"),
    [
        ("127.0.0.1", True),
        ("127.1.2.3", True),
        ("::1", True),
        ("localhost", True),
        ("0.0.0.0", False),
        ("192.168.1.2", False),
        ("example.org", False),
        ("::", False),
    ],
)
def test_loopback_is_known(host: str, local: bool) -> None:
    assert is_loopback(host) is local
