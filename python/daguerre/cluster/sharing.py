"""Sharing of one picture among workers: how long tasks are, which answers are folded on the way."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import groupby, pairwise
from typing import TYPE_CHECKING, Any

from .crew import Crew, Flight
from .task import Place, Task

if TYPE_CHECKING:
    from daguerre.rendering.session import Session

    from .answers import Sums

#: Tasks queued at each worker beside the task that it draws.
AHEAD = 2
#: Length of a task once the workers' speed is known, and longest task if answers take long, s.
TASK_S, LONG_S = 15.0, 240.0
#: Least ratio of the time of a task to the time for its answer; and the ratio toward the end.
WORTH, LAST_WORTH = 40.0, 10.0
#: Time that a step waits for results, s.
STEP_S = 0.5
#: Answers that a worker adds at once.
FAN_IN = 4
#: Share of its time that the client may spend adding answers; beyond, workers add some first.
ADDING = 0.5


class Sharing:
    """Tasks of one picture, and how fast they are drawn.

    Args:
        session: Session of the picture.
        crew: Workers.
        place: The picture among the values of the crew.
    """

    def __init__(self, session: Session, crew: Crew, place: Place) -> None:
        self.session, self.crew, self.place = session, crew, place
        self._take_s = self._add_s = self._task_s = 0.0  # of one answer, and of one task
        self._waited = 0.0

    @property
    def flights(self) -> list[Flight]:
        """Tasks of this picture that are under way or have landed, in the order of their begin."""
        return self.crew.flights_of(self.place)

    def begin(self, begin: int, end: int, round: str) -> None:
        """Sends parts of a round to the workers."""
        self.crew.begin(Task(self.place.scene, self.place.view, begin, end, round))

    def room(self) -> int:
        """Number of tasks that may begin."""
        most = AHEAD * max(1, len(self.crew.workers.good))
        flights = self.crew.flights
        pending = sum(not one.landed for one in flights)
        return min(most - pending, FAN_IN * most - len(flights))

    def size(self, left: float) -> float:
        """Samples of the next task, by the measured speed of workers; fewer toward the end."""
        if not self.crew.per_second:
            return 1.0
        share = left / max(1, len(self.crew.workers.good))
        least = min(LAST_WORTH * self.crew.answer_s * self.crew.per_second, share)
        length = min(max(TASK_S, WORTH * self.crew.answer_s), LONG_S)
        return max(1.0, min(length * self.crew.per_second, max(share / 2, least)))

    def take(self, first: int | None = None) -> tuple[Task, Sums] | None:
        """A task that has landed and its sums, after waiting a little; None: none.

        Args:
            first: First sample of the wanted answer; None: any.

        Raises:
            GivenUp: A task failed on several workers.
        """
        end = time.monotonic() + STEP_S
        while True:
            self.crew.look()
            self.crew.serve()
            ready = self._ready(self._folded(self._without_twins(self.flights)), first)
            if ready is not None:
                began = time.process_time()  # another thread fetches the sums
                sums = self.crew.result(ready, self.session.key)
                if sums is not None:
                    self._take_s = time.process_time() - began
                    return ready.task, sums
            elif time.monotonic() > end:
                return None
            else:
                self._draw_late_ones_again()
                time.sleep(0.02)

    @contextmanager
    def adding(self, samples: float, sums: Sums) -> Iterator[None]:
        """Context in which sums are added; measures the time of that, and the workers' speed."""
        began = time.process_time()
        yield
        self._add_s = self._take_s + time.process_time() - began
        self.session.counters.rays += int(sums.fact("rays"))
        seconds, tasks = sums.fact("seconds"), max(sums.fact("tasks"), 1.0)
        if seconds > 0:
            self._task_s = seconds / tasks
            packing = sums.fact("pack_s") / tasks
            self.crew.answer_s = packing + self._add_s
            self.crew.per_second = max(samples / seconds, 1e-3)

    def facts(self) -> dict[str, Any]:
        """Values for a ``Status``."""
        return {"workers": len(self.crew.workers.good), "drawn_again": self.crew.drawn_again}

    @property
    def group(self) -> int:
        """Number of tasks to fold into each answer, so that the client keeps up with workers."""
        if not self._task_s:
            return 1
        busy = self._add_s * len(self.crew.workers.good) / self._task_s
        return max(1, math.ceil(busy / ADDING))

    def _ready(self, flights: list[Flight], first: int | None) -> Flight | None:
        """Flight whose answer the client takes now."""
        group = self.group
        landed = [flight for flight in flights if flight.landed]
        rest = group < FAN_IN or len(landed) == len(flights)  # no more folding
        for flight in landed:
            fits = first is None or flight.task.begin == first
            if fits and (rest or flight.alone or flight.tasks >= group):
                return flight
        return None

    def _folded(self, flights: list[Flight]) -> list[Flight]:
        """Has workers add adjacent answers, if there are too many for the client."""
        group = self.group
        if group < FAN_IN:
            return flights
        small = [f for f in flights if f.has_sums and not f.alone and f.tasks < group]
        least = FAN_IN if any(not f.landed for f in flights) else 2
        folded = False
        for row in _rows(small):
            while len(row) >= least:
                self.crew.fold(row[:FAN_IN])
                row, folded = row[FAN_IN:], True
        return self.flights if folded else flights

    def _without_twins(self, flights: list[Flight]) -> list[Flight]:
        """Gives up tasks that were drawn a second time, once one of the two has landed."""
        late: list[Flight] = []
        for _, same in groupby(flights, lambda one: (one.task.begin, one.task.end)):
            twins = list(same)
            landed = next((one for one in twins if one.landed), None) if len(twins) > 1 else None
            late += [one for one in twins if landed is not None and one is not landed]
        if not late:
            return flights
        self.crew.drop(*late)
        return [one for one in flights if one not in late]

    def _draw_late_ones_again(self) -> None:
        """Has idle workers draw late tasks a second time; gives up late folds."""
        if time.monotonic() - self._waited < STEP_S:
            return
        self._waited = time.monotonic()
        pending = [one for one in self.flights if not one.landed]
        for one in pending:
            if one.parts and self.crew.is_late(one):
                self.crew.unfold(one)
        flights = [one for one in pending if not one.parts]
        held = self.crew.holders()
        idle = sum(not keys for keys in held.values())
        for one in sorted(flights, key=lambda flight: flight.began):
            has_twin = sum(other.task == one.task for other in flights) > 1
            if idle > 0 and not has_twin and self.crew.is_late(one):
                busy = {name for name, keys in held.items() if keys}
                self.crew.begin(one.task, one.failed_on, but=busy)
                idle -= 1


def _rows(flights: list[Flight]) -> Iterator[list[Flight]]:
    """Flights that follow each other without a gap."""
    if not flights:
        return
    row = flights[:1]
    for one, other in pairwise(flights):
        if one.task.end != other.task.begin:
            yield row
            row = []
        row.append(other)
    yield row
