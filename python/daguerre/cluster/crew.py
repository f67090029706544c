"""Crew: workers that draw for a client, and the tasks that are under way."""

from __future__ import annotations

import time
from asyncio import CancelledError
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from math import inf
from typing import TYPE_CHECKING, Any

from daguerre.errors import InputError, MismatchError

from . import task as on_worker
from .answers import Answer, Failed, Needs, Sums, answer_of
from .task import Place, Task
from .values import Values
from .workers import PATIENCE_S, Tell, Workers

if TYPE_CHECKING:
    from daguerre.rendering.light_paths import Plan

#: Workers on which a task may fail before it is given up.
TRIES = 3
#: A task that takes so many times as long as it should is late, unless it takes less than LATE_S.
LATE, LATE_S = 3.0, 0.5
#: Time of one try to reach a scheduler that went away, s.
_RETRY_S = 5


@dataclass(eq=False)
class Flight:
    """A task that was sent to the workers.

    Attributes:
        task: The task.
        future: Dask's future of the answer.
        parts: Flights with answers that this task adds; empty: the task draws.
        failed_on: Workers on which the task failed.
        only: Workers that may draw the task; empty: all.
        alone: Whether the client must take the answer itself, unfolded.
        home: Preferred worker; empty: any.
        answer: The answer, once it is fetched.
        began: Time at which the task was sent, by ``time.monotonic``, s.
    """

    task: Task
    future: Any
    parts: tuple[Flight, ...] = ()
    failed_on: tuple[str, ...] = ()
    only: frozenset[str] = frozenset()
    alone: bool = False
    home: str = ""
    answer: Answer | None = None
    began: float = field(default_factory=time.monotonic)

    @property
    def landed(self) -> bool:
        """Whether the task ended: with an answer, an error, or lost."""
        return str(self.future.status) != "pending"

    @property
    def has_sums(self) -> bool:
        """Whether the answer has sums; see ``task.draw``."""
        return str(self.future.status) == "finished" and self.future.type is memoryview

    @property
    def has_words(self) -> bool:
        """Whether the answer is a message without sums."""
        return str(self.future.status) == "finished" and self.future.type is not memoryview

    @property
    def tasks(self) -> int:
        """Number of drawing tasks in the answer."""
        return sum(part.tasks for part in self.parts) or 1


class GivenUp(InputError):
    """A task failed on so many workers that it is given up.

    Attributes:
        task: The task.
    """

    def __init__(self, task: Task, workers: Iterable[str], reason: str) -> None:
        super().__init__(f"cluster: {task.words} failed on {', '.join(workers)}: {reason}")
        self.task = task


class Crew:
    """Workers of a Dask cluster that draw tasks.

    Args:
        client: ``distributed.Client``.
        mixed: Whether workers of another build may draw.
        tell: Called with a sentence when a worker is lost or a task fails.

    Attributes:
        flights: Tasks under way.
        drawn_again: Number of tasks that began anew.
        per_second: Samples of all pixels that a worker drew last, 1/s; 0: not known yet.
        answer_s: Time that the last answer took to be packed, fetched and added, s.
    """

    def __init__(self, client: Any, *, mixed: bool = False, tell: Tell = lambda text: None) -> None:
        self.client, self.mixed, self._tell = client, mixed, tell
        self._given = client
        self._address, self._security = client.scheduler.address, client.security
        self.workers = Workers(client, mixed=mixed, tell=tell)
        self.values = Values()
        self.flights: list[Flight] = []
        self.drawn_again = 0
        self.per_second = self.answer_s = 0.0

    def look(self) -> None:
        """Looks after workers and scheduler; both may come and go.

        Raises:
            InputError: They did not come back.
        """
        try:
            self.workers.look()
        except (OSError, RuntimeError) as error:  # TimeoutError and CommClosedError are OSErrors
            self._wait_for_scheduler(error)
        good = self.workers.good
        for flight in [one for one in self.flights if one.only and not one.only & good]:
            if not flight.landed:  # all that might draw it are gone
                self.drop(flight)
                self.begin(flight.task, flight.failed_on)

    def serve(self) -> None:
        """Sends values to workers that ask for them, for whatever picture.

        Raises:
            GivenUp: Several workers cannot keep them.
        """
        for flight in [one for one in self.flights if one.has_words and one.answer is None]:
            flight.answer = self._answer(flight)
            if isinstance(flight.answer, Needs):
                self.flights.remove(flight)
                self._provide(flight, flight.answer)

    def begin(
        self,
        task: Task,
        failed_on: Iterable[str] = (),
        but: Iterable[str] = (),
        home: str = "",
    ) -> Flight:
        """Sends a task to the workers, preferably to its home and not where it failed."""
        good, avoided = self.workers.good, {*failed_on, *but}
        free = avoided.isdisjoint(good) and self.workers.all_are_good
        only = frozenset() if free else frozenset(good - avoided or good)
        home = home if free and home in good else ""
        future = self._submit(only, on_worker.draw, task.to_text(), home=home)
        flight = Flight(task, future, failed_on=tuple(failed_on), only=only, home=home)
        self.flights.append(flight)
        return flight

    def fold(self, flights: Sequence[Flight]) -> Flight:
        """Has a worker add the answers of flights with adjacent samples."""
        task = replace(flights[0].task, end=flights[-1].task.end)
        only = frozenset() if self.workers.all_are_good else frozenset(self.workers.good)
        future = self._submit(only, on_worker.fold, task.to_text(), *(f.future for f in flights))
        for one in flights:
            self.flights.remove(one)
        flight = Flight(task, future, parts=tuple(flights), only=only)
        self.flights.append(flight)
        return flight

    def result(self, flight: Flight, key: dict[str, str]) -> Sums | None:
        """Returns the sums of a flight that has landed; None: others take its place.

        Args:
            flight: The flight.
            key: Key of its picture.

        Raises:
            GivenUp: Its task failed on several workers.
        """
        self.flights.remove(flight)
        answer = self._answer(flight)
        if isinstance(answer, Sums):
            answer = self._checked(answer, key)
        if isinstance(answer, Sums):
            return answer
        if flight.parts:
            self._take_apart(flight)
        elif answer is None:
            self._again(flight)
        elif isinstance(answer, Needs):
            self._provide(flight, answer)
        else:
            self._failed(flight, answer)
        return None

    def piloted(self, flight: Flight) -> Plan | None:
        """Result of the worker's pilot render, from a flight that landed; None: not known."""
        flight.answer = self._answer(flight)
        return flight.answer.piloted if isinstance(flight.answer, Sums) else None

    def is_late(self, flight: Flight) -> bool:
        """Whether a task takes much longer than the speed of the workers predicts."""
        should = (flight.task.end - flight.task.begin) / self.per_second if self.per_second else inf
        return time.monotonic() - flight.began > max(LATE * should, LATE_S)

    def drop(self, *flights: Flight) -> None:
        """Gives up tasks."""
        self.client.cancel([flight.future for flight in flights], force=True)
        self.flights = [one for one in self.flights if one not in flights]

    def unfold(self, flight: Flight) -> None:
        """Gives up a fold; the client takes the answers of its parts."""
        self.drop(flight)
        self._take_apart(flight)

    def drop_all(self) -> None:
        """Gives up all tasks."""
        self.drop(*self.flights)

    def close(self) -> None:
        """Gives up all tasks, and a connection that it opened itself."""
        with suppress(OSError, RuntimeError):  # the cluster may be gone
            self.drop_all()
            if self.client is not self._given:
                self.client.close()

    def flights_of(self, place: Place) -> list[Flight]:
        """Flights of a picture, in the order of their begin."""
        own = [f for f in self.flights if (f.task.scene, f.task.view) == (place.scene, place.view)]
        return sorted(own, key=lambda one: one.task.begin)

    def holders(self) -> dict[str, set[str]]:
        """Keys of the tasks that each worker draws or queues; empty: not known."""
        try:
            found = self.client.processing()
        except (OSError, RuntimeError):  # the scheduler is gone; look() waits for it
            return {}
        held = {str(name): set(map(str, keys)) for name, keys in found.items()}
        return {name: held.get(name, set()) for name in self.workers.good}

    def _submit(
        self, only: Iterable[str], function: Callable[..., Any], *given: Any, home: str = ""
    ) -> Any:
        """Future of a function that runs on a worker of a list (empty: any), best at home."""
        where = sorted(only) or ([home] if home else None)
        loose = bool(home) and not only
        while True:
            try:
                return self.client.submit(
                    function, *given,
                    pure=False, retries=0, workers=where, allow_other_workers=loose,
                )  # fmt: skip
            except Exception as error:
                if self.client.status == "running":
                    raise
                self._wait_for_scheduler(error)

    def _answer(self, flight: Flight) -> Answer | None:
        """Answer of a flight; None: the scheduler lost it."""
        if flight.answer is not None or flight.future.status in ("cancelled", "lost"):
            return flight.answer
        try:
            direct = self.workers.all_are_reached
            return answer_of(self.client.gather(flight.future, direct=direct))
        except InputError as error:
            return Failed("a worker", str(error))
        except CancelledError:
            return None
        except Exception as error:  # whatever Dask raises: a killed worker, no memory
            if flight.future.status in ("cancelled", "lost"):
                return None
            worker = getattr(error, "last_worker", None)  # KilledWorker
            return Failed(str(worker.address) if worker else "a worker", str(error))

    def _checked(self, sums: Sums, key: dict[str, str]) -> Sums | Failed:
        """Sums of the picture of a key; a worker that draws others is refused."""
        try:
            sums.check_key(key, mixed=self.mixed)
        except MismatchError as error:
            self.workers.refuse(sums.worker, str(error))
            return Failed(sums.worker, str(error))
        return sums

    def _provide(self, flight: Flight, needs: Needs) -> None:
        """Sends values to the worker that asked for them, and the task anew."""
        try:
            reason = self.values.send(self.client, needs.worker, needs.names, flight.began)
        except (OSError, RuntimeError):  # the worker is gone, or the scheduler: look() waits for it
            self._again(flight)
            return
        if reason:  # its disk is full
            self.workers.refuse(needs.worker, reason)
            self._failed(flight, Failed(needs.worker, reason))
        else:
            self.begin(flight.task, flight.failed_on, home=flight.home)

    def _take_apart(self, fold: Flight) -> None:
        for part in fold.parts:
            part.alone = True
        self.flights.extend(fold.parts)

    def _failed(self, flight: Flight, failed: Failed) -> None:
        failed_on, task = (*flight.failed_on, failed.worker), flight.task
        if len(failed_on) >= TRIES or self.workers.good <= set(failed_on):
            raise GivenUp(task, failed_on, failed.reason)
        self._tell(f"cluster: {failed.worker}: {failed.reason}; its task is drawn again elsewhere")
        self._again(flight, failed_on)

    def _again(self, flight: Flight, failed_on: tuple[str, ...] | None = None) -> None:
        self.drawn_again += 1
        again = flight.failed_on if failed_on is None else failed_on
        self.begin(flight.task, again, home=flight.home)

    def _wait_for_scheduler(self, error: Exception) -> None:
        """Waits for a scheduler that went away to come back, as on a restart.

        Raises:
            InputError: It did not.
        """
        self._tell(f"cluster: {self._address}: lost the scheduler; waiting for it to come back")
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            try:
                if self.client.status == "closed":
                    from distributed import Client

                    self.client = Client(self._address, timeout=_RETRY_S, security=self._security)
                self.client.nthreads()
            except (OSError, RuntimeError, ValueError) as again:
                error = again
                time.sleep(0.5)
            else:
                self.workers = Workers(self.client, mixed=self.mixed, tell=self._tell)
                return
        raise InputError(
            f"cluster: {self._address}: lost the scheduler, and it did not come back within "
            f"{PATIENCE_S:g} s: {error}"
        )
