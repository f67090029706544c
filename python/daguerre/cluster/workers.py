"""Workers of a cluster: who is there, and who may draw."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Iterable
from typing import Any

from daguerre.errors import InputError
from daguerre.rendering.identity import build

from . import task as on_worker

#: Time between two looks at the workers, s.
LOOK_S = 0.5
#: Time to wait for a worker while there is none, s.
PATIENCE_S = 60.0
#: Time in which a worker accepts a connection of the client, s.
REACH_S = 2.0

Tell = Callable[[str], None]


def is_client(value: object) -> bool:
    """Whether a value can be a client of Dask; its class is none."""
    return hasattr(value, "submit") and not isinstance(value, type)


class Workers:
    """Workers of a Dask cluster that may draw.

    Args:
        client: ``distributed.Client``.
        mixed: Whether workers of another build may draw.
        tell: Called with a sentence when a worker is lost or refused.
    """

    def __init__(self, client: Any, *, mixed: bool, tell: Tell) -> None:
        self._client, self._mixed, self._tell = client, mixed, tell
        self._refused: dict[str, str] = {}
        self._there: set[str] = set()
        self._reached: set[str] = set()
        self._looked, self._alone_since = -LOOK_S, time.monotonic()

    @property
    def good(self) -> set[str]:
        """Addresses of workers that may draw, at the last look."""
        return self._there - self._refused.keys()

    @property
    def all_are_good(self) -> bool:
        """Whether any worker may draw."""
        return not self._refused

    @property
    def all_are_reached(self) -> bool:
        """Whether the client fetches answers from the workers, not through the scheduler."""
        return self.good <= self._reached

    def look(self) -> None:
        """Looks who is there, now and then.

        Raises:
            InputError: For a long time none was there that may draw.
        """
        if time.monotonic() - self._looked < LOOK_S:
            return
        now = set(self._client.nthreads())
        for gone in sorted(self._there - now - self._refused.keys()):
            self._tell(f"cluster: {gone} is gone; its tasks are drawn again elsewhere")
        self._judge(now - self._there)
        self._there, self._looked = now, time.monotonic()
        if now - self._refused.keys():
            self._alone_since = self._looked
        elif self._looked - self._alone_since > PATIENCE_S:
            raise InputError(self._alone())

    def wait(self) -> None:
        """Waits for a first worker.

        Raises:
            InputError: None came in time.
        """
        self.look()
        while not self.good:
            if self._there:
                raise InputError(self._alone())
            time.sleep(LOOK_S / 5)
            self.look()

    def refuse(self, worker: str, reason: str) -> None:
        """Keeps a worker from drawing."""
        if worker not in self._refused:
            self._refused[worker] = reason
            self._tell(f"cluster: {worker}: {reason}; this worker is not used")

    def _alone(self) -> str:
        address = self._client.scheduler.address
        if self._there:
            first = sorted(self._there)[0]
            return f"cluster: {address}: no worker can draw: {first}: {self._refused[first]}"
        return (
            f"cluster: {address}: wanted a worker within {PATIENCE_S:g} s, got none; "
            "`daguerre worker` starts one"
        )

    def _judge(self, new: Iterable[str]) -> None:
        """Refuses workers without Daguerre, and of another build."""
        wanted, new = build(), sorted(new)
        if not new:
            return
        found = self._client.run(on_worker.worker_build, workers=new, on_error="return")
        for worker, got in found.items():
            if isinstance(got, ImportError | AttributeError):
                self.refuse(worker, f"it has no daguerre of this version ({got})")
            elif isinstance(got, str) and got != wanted and not self._mixed:
                self.refuse(worker, f"build: wanted the same as the client's, {wanted}, got {got}")
        self._reached |= reached(self._client, new)


def reached(client: Any, workers: Iterable[str]) -> set[str]:
    """Workers that accept a connection of the client; others are behind their scheduler."""
    from distributed.comm.core import connect

    async def reach(address: str) -> str | None:
        try:
            found = await connect(address, timeout=REACH_S, **client.connection_args)
        except OSError:
            return None
        await found.close()
        return address

    async def reach_all() -> list[str | None]:
        return await asyncio.gather(*map(reach, workers))

    return {address for address in client.sync(reach_all) if address is not None}
