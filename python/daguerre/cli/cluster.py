"""``daguerre scheduler`` and ``daguerre worker``: Dask's own, with settings that suit renders."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from daguerre.checks import is_loopback, whole
from daguerre.errors import UsageError

from . import console
from .flags.groups import option

PORT = 8786
_CA = option("--ca", metavar="FILE", help="Certificate of the authority that all trust, .pem.")
_CERT = option("--cert", metavar="FILE", help="Certificate of this machine, .pem.")
_KEY = option("--key", metavar="FILE", help="Its key, .pem.")
_INSECURE = option("--insecure-cluster", help="Do without TLS on other machines.")


def scheduler(
    host: Annotated[
        str, option("--host", metavar="ADDRESS", help="Address to listen on [127.0.0.1].")
    ] = "127.0.0.1",
    port: Annotated[int, option("--port", metavar="N", help=f"Port [{PORT}].")] = PORT,
    ca: Annotated[Path | None, _CA] = None,
    cert: Annotated[Path | None, _CERT] = None,
    key: Annotated[Path | None, _KEY] = None,
    insecure_cluster: Annotated[bool, _INSECURE] = False,
) -> int:
    """Starts the scheduler of a cluster, to which workers and renders connect.

    Whoever reaches it can run code on all workers, so it listens on this machine alone, or by TLS.
    """
    from daguerre.cluster.certificates import Certificates
    from daguerre.cluster.servers import run_scheduler

    files = Certificates.of({"ca": ca, "cert": cert, "key": key}, "--ca, --cert and --key")
    if not (files or insecure_cluster or is_loopback(host)):
        raise UsageError(
            f"--host {host}: other machines can reach this address, and anyone who can reach "
            "a scheduler can run code on its workers; give --ca, --cert and --key, or "
            "--insecure-cluster to do without"
        )
    run_scheduler(host, whole(port, "--port", 0, 65535), files)
    return 0


def worker(
    address: Annotated[
        str,
        typer.Argument(metavar="ADDRESS", help="Scheduler, tcp://HOST:PORT or tls://HOST:PORT."),
    ],
    threads: Annotated[
        int, option("--threads", metavar="N", help="Number of threads; 0 uses all cores [0].")
    ] = 0,
    memory: Annotated[
        str, option("--memory", metavar="8GB", help="Memory limit [the machine's memory].")
    ] = "auto",
    ca: Annotated[Path | None, _CA] = None,
    cert: Annotated[Path | None, _CERT] = None,
    key: Annotated[Path | None, _KEY] = None,
    insecure_cluster: Annotated[bool, _INSECURE] = False,
) -> int:
    """Starts a worker: one process that draws for the renders of a cluster."""
    from daguerre.cluster.address import check_address
    from daguerre.cluster.certificates import Certificates
    from daguerre.cluster.servers import run_worker

    files = Certificates.of({"ca": ca, "cert": cert, "key": key}, "--ca, --cert and --key")
    host = check_address(address, insecure=insecure_cluster, flag="ADDRESS")
    run_worker(
        address,
        threads=whole(threads, "--threads", 0, 1 << 16),
        memory=memory,
        host="127.0.0.1" if is_loopback(host) else None,
        certificates=files,
        tell=console.warn,
    )
    return 0
