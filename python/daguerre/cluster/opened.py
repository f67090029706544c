"""Opens a cluster for a render, and leaves none of its tasks behind."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, nullcontext

from daguerre.checks import short
from daguerre.errors import UsageError
from daguerre.rendering.schedule import WorkOf

from .address import WANTED, connected
from .pool import WorkerPool
from .work import work_of
from .workers import Tell, is_client


@contextmanager
def opened(
    cluster: object, *, insecure: bool = False, mixed: bool = False, tell: Tell = lambda text: None
) -> Iterator[WorkerPool]:
    """Opens a cluster and waits for its first worker.

    Args:
        cluster: A ``distributed.Client``, or an address as for ``--cluster``.
        insecure: Whether a scheduler on another machine may be reached without TLS.
        mixed: Whether workers of another build may draw.
        tell: Called with a sentence when a worker is lost or a task fails.

    Raises:
        UsageError: The address is none.
        InputError: The cluster cannot be reached, or has no worker that may draw.
    """
    if not isinstance(cluster, str) and not is_client(cluster):
        raise UsageError(f"cluster: wanted a distributed.Client or {WANTED}, got {short(cluster)}")
    reached = (
        connected(cluster, insecure=insecure) if isinstance(cluster, str) else nullcontext(cluster)
    )
    with reached as client:
        pool = WorkerPool(client, mixed=mixed, tell=tell)
        pool.workers.wait()
        try:
            yield pool
        finally:
            pool.close()


@contextmanager
def work_on(cluster: object) -> Iterator[WorkOf]:
    """Opens a cluster for one picture; see :func:`opened`."""
    with opened(cluster) as pool:
        yield work_of(pool)
