"""Values that go to workers, each once: scenes, views, and rounds of adaptive sampling."""

from __future__ import annotations

import time
from collections import Counter
from typing import Any

from daguerre.files.packing import hash_of, large_of, pack

from . import task as on_worker


class Values:
    """Packed values by their hash, for workers that ask for them."""

    def __init__(self) -> None:
        self._kept: dict[str, Any] = {}  # bytes or arrays, by their hash
        self._uses: Counter[str] = Counter()
        self._names: dict[int, tuple[Any, str]] = {}  # hashes of arrays, which stay alive here
        self._sent: dict[tuple[str, str], float] = {}  # when, by worker and hash

    def keep(self, value: object) -> str:
        """Keeps a value until :meth:`forget`; returns its hash."""
        packed = pack(value, self._name)
        name = hash_of(packed.data)
        self._kept |= {name: packed.data, **packed.large}
        self._uses.update((name, *packed.large))
        return name

    def forget(self, name: str) -> None:
        """Gives up a value; its arrays stay while another value has them."""
        for one in (name, *large_of(self._kept[name])):
            self._uses[one] -= 1
            if not self._uses[one]:
                del self._uses[one]
                self._names.pop(id(self._kept.pop(one)), None)

    def send(self, client: Any, worker: str, names: list[str], since: float) -> str:
        """Sends values to a worker that asked for them; returns why it cannot keep them.

        Args:
            client: ``distributed.Client``.
            worker: Address of the worker.
            names: Hashes of the values.
            since: When the task began that needs them, by ``time.monotonic``, s. Values sent later
                have arrived: tasks that wait at the same worker ask for the same values.

        Raises:
            OSError: The worker, or the scheduler, is gone.
        """
        for name in names:
            if self._sent.get((worker, name), 0.0) <= since:
                data = bytes(self._kept[name])
                found = client.run(
                    on_worker.keep, name, data, workers=[worker], on_error="return"
                ).get(worker, "")
                if isinstance(found, Exception):
                    raise ConnectionError(str(found))
                if found:
                    return str(found)
                self._sent[worker, name] = time.monotonic()
        return ""

    def _name(self, array: Any) -> str:
        """Hash of an array; computed once for a read-only array."""
        if array.flags.writeable:
            return hash_of(array)
        known = self._names.get(id(array))
        if known is None:
            known = self._names[id(array)] = array, hash_of(array)
        return known[1]
