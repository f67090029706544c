"""Addresses of clusters: ``local``, a scheduler, or a file with a scheduler's address."""

from __future__ import annotations

import contextlib
import logging
import multiprocessing
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from daguerre.checks import is_loopback
from daguerre.errors import InputError, UsageError
from daguerre.files import extras
from daguerre.files.json_item import short

from .certificates import Certificates

#: Time to reach a scheduler, s.
TIMEOUT_S = 10
WANTED = "local, local:N, tcp://HOST:PORT, tls://HOST:PORT or FILE.yaml"
_MAX_BYTES = 1 << 20
_KEYS = ("address", "ca", "cert", "key")
_NO_GUARD = (
    "cluster: local workers run this script again as they start, up to the call that wants them; "
    'put it under `if __name__ == "__main__":`'
)


@contextlib.contextmanager
def connected(text: str, *, insecure: bool = False) -> Iterator[Any]:
    """Opens a cluster for as long as the context lasts.

    Args:
        text: :data:`WANTED`. ``local`` starts workers on this machine: N, or else 2.
        insecure: Whether a scheduler on another machine may be reached without TLS.

    Yields:
        Its ``distributed.Client``.

    Raises:
        UsageError: The text is none of these, or wants TLS.
        InputError: The cluster cannot be reached.
    """
    extras.need("distributed", "cluster")
    local = re.fullmatch(r"local(?::(\d+))?", text)
    if local:
        with _local(int(local[1] or 2)) as client:
            yield client
        return
    address, files = _read(Path(text)) if text.endswith((".yaml", ".yml")) else (text, None)
    check_address(address, insecure=insecure)
    with _client(address, None if files is None else files.security()) as client:
        yield client


def check_address(address: str, *, insecure: bool, flag: str = "--cluster") -> str:
    """Checks the address of a scheduler, and returns its host.

    Raises:
        UsageError: It is not an address, or names another machine without TLS.
    """
    try:
        parts = urlsplit(address)
        fits = parts.scheme in ("tcp", "tls") and parts.hostname and parts.port
    except ValueError:
        fits = False
    if not fits:
        wanted = WANTED if flag == "--cluster" else "tcp://HOST:PORT or tls://HOST:PORT"
        raise UsageError(f"{flag}: wanted {wanted}, got {short(address)}")
    host = parts.hostname or ""
    if parts.scheme == "tcp" and not insecure and not is_loopback(host):
        raise UsageError(
            f"{flag} {address}: wanted tls:// for another machine, as anyone who can reach a "
            "scheduler can run code on its workers; --insecure-cluster allows tcp://"
        )
    return host


@contextlib.contextmanager
def _local(count: int) -> Iterator[Any]:
    from dask.system import CPU_COUNT
    from distributed import Client, LocalCluster

    if not 1 <= count <= 1024:
        raise UsageError(f"--cluster: wanted local:N with 1 to 1024 workers, got {count}")
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        raise SystemExit(_NO_GUARD)  # a process of LocalCluster that runs the script again
    threads = max(1, CPU_COUNT // count)
    try:
        cluster = LocalCluster(
            n_workers=count,
            threads_per_worker=threads,
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            silence_logs=logging.CRITICAL,
        )
    except RuntimeError as error:
        raise InputError(f"cluster: local workers did not start: {reason_of(error)}") from None
    with cluster, Client(cluster) as client:
        yield client


@contextlib.contextmanager
def _client(address: str, security: object) -> Iterator[Any]:
    from distributed import Client

    try:
        client = Client(address, timeout=TIMEOUT_S, security=security)
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            f"cluster: cannot reach {address} within {TIMEOUT_S} s: {reason_of(error)}"
        ) from None
    with client:
        yield client


def reason_of(error: BaseException) -> str:
    """First line of an error."""
    return str(error).splitlines()[0] if str(error) else type(error).__name__


def _read(path: Path) -> tuple[str, Certificates | None]:
    """Address and certificates of a file; paths in it are relative to it."""
    from daguerre.files import yaml_text
    from daguerre.files.reading import read_bytes

    found = yaml_text.parse(read_bytes(path, _MAX_BYTES), str(path)).value
    if not isinstance(found, dict) or "address" not in found or found.keys() - set(_KEYS):
        raise InputError(
            f"{path}: wanted address, and optionally ca, cert and key, got {short(found)}"
        )
    files = {name: path.parent / str(found[name]) for name in _KEYS[1:] if name in found}
    return str(found["address"]), Certificates.of(files, f"{path}: ca, cert and key")
