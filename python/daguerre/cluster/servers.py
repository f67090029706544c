"""Scheduler and worker of a cluster, each as long as this process: Dask's own."""

from __future__ import annotations

import asyncio
import signal
from collections.abc import Awaitable, Callable, Coroutine
from contextlib import suppress
from typing import Any

from daguerre.errors import InputError, UsageError
from daguerre.files import extras
from daguerre.files.json_item import short

from .address import reason_of
from .certificates import Certificates
from .workers import Tell

#: Port of Dask's own page, on the scheduler's machine alone; it needs the package bokeh.
PAGE = 8787
#: Time to reach the scheduler, s.
_REACH_S = 30


def run_scheduler(host: str, port: int, certificates: Certificates | None) -> None:
    """Runs a scheduler until a signal ends it.

    Raises:
        InputError: It cannot listen there.
    """
    extras.need("distributed", "cluster")
    from distributed import Scheduler

    async def serve(stop: asyncio.Event) -> None:
        try:
            server = await Scheduler(
                host=host,
                port=port,
                dashboard=True,
                dashboard_address=f"127.0.0.1:{PAGE}",
                security=_security(certificates),
                protocol=None if certificates is None else "tls",
            )
        except (OSError, ValueError, RuntimeError) as error:
            reason = reason_of(error.__cause__ or error)
            raise InputError(f"scheduler: cannot listen on {host}:{port}: {reason}") from None
        async with server:
            await _first(server.finished, stop.wait)

    _run(serve)


def run_worker(
    address: str,
    *,
    threads: int,
    memory: str,
    host: str | None,
    certificates: Certificates | None,
    tell: Tell,
) -> None:
    """Runs a worker until a signal ends it; if the scheduler goes away, waits for it.

    Args:
        address: Address of the scheduler.
        threads: Number of threads; 0: all cores.
        memory: Memory limit, such as "8GB"; "auto": the machine's memory.
        host: Address to listen on; None: the address that the scheduler sees.
        certificates: For TLS.
        tell: Called with a sentence when the scheduler is lost.

    Raises:
        UsageError: The memory limit is no size.
        InputError: The scheduler cannot be reached.
    """
    extras.need("distributed", "cluster")
    from dask.system import CPU_COUNT
    from distributed import Nanny

    limit = _bytes(memory)

    async def serve(stop: asyncio.Event) -> None:
        was_there = False
        while not stop.is_set():
            try:
                async with Nanny(
                    address,
                    nthreads=threads or CPU_COUNT,
                    memory_limit=limit,
                    host=host,
                    death_timeout=_REACH_S,
                    security=_security(certificates),
                    dashboard=False,
                    dashboard_address="127.0.0.1:0",
                ) as nanny:
                    was_there = True
                    await _first(nanny.finished, stop.wait)
            except (OSError, ValueError, RuntimeError) as error:
                if not was_there:
                    raise InputError(
                        f"worker: cannot reach {address} within {_REACH_S} s: {reason_of(error)}"
                    ) from None
            if not stop.is_set():
                tell(f"worker: {address}: lost the scheduler; waiting for it to come back")
                await asyncio.sleep(1.0)

    _run(serve)


def _run(serve: Callable[[asyncio.Event], Coroutine[Any, Any, None]]) -> None:
    """Runs a server; sets its event when a signal asks this process to end."""

    async def main() -> None:
        stop = asyncio.Event()
        for one in (signal.SIGINT, signal.SIGTERM):
            with suppress(NotImplementedError):  # Windows
                asyncio.get_running_loop().add_signal_handler(one, stop.set)
        await serve(stop)

    with suppress(KeyboardInterrupt):
        asyncio.run(main())


async def _first(*waits: Callable[[], Awaitable[Any]]) -> None:
    """Waits until the first of several awaitables is done."""
    tasks = [asyncio.ensure_future(wait()) for wait in waits]
    await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    for one in tasks:
        one.cancel()


def _security(certificates: Certificates | None) -> Any:
    """Certificates for Dask; None: the certificates of Dask's configuration."""
    return None if certificates is None else certificates.security()


def _bytes(text: str) -> int | str:
    from dask.utils import parse_bytes

    try:
        return text if text == "auto" else int(parse_bytes(text))
    except ValueError:
        raise UsageError(
            f"--memory: wanted a size such as 8GB, or auto, got {short(text)}"
        ) from None
