"""Sharing of one picture among workers: how long tasks are, which answers are folded on the way."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import groupby, pairwise
from typing import TYPE_CHECKING, Any

from .pool import Submission, WorkerPool
from .task import SceneKey, Task

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
        pool: Workers.
        place: The picture among the values of the pool.
    """

    def __init__(self, session: Session, pool: WorkerPool, place: SceneKey) -> None:
        self.session, self.pool, self.place = session, pool, place
        self._take_s = self._add_s = self._task_s = 0.0  # of one answer, and of one task
        self._waited = 0.0

    @property
    def submissions(self) -> list[Submission]:
        """Tasks of this picture that were submitted, in the order of their begin."""
        return self.pool.submissions_of(self.place)

    def begin(self, begin: int, end: int, round: str) -> None:
        """Sends parts of a round to the workers."""
        self.pool.begin(Task(self.place.scene, self.place.view, begin, end, round))

    def room(self) -> int:
        """Number of tasks that may begin."""
        most = AHEAD * max(1, len(self.pool.workers.good))
        submissions = self.pool.submissions
        pending = sum(not one.done for one in submissions)
        return min(most - pending, FAN_IN * most - len(submissions))

    def size(self, left: float) -> float:
        """Samples of the next task, by the measured speed of workers; fewer toward the end."""
        if not self.pool.per_second:
            return 1.0
        share = left / max(1, len(self.pool.workers.good))
        least = min(LAST_WORTH * self.pool.answer_s * self.pool.per_second, share)
        length = min(max(TASK_S, WORTH * self.pool.answer_s), LONG_S)
        return max(1.0, min(length * self.pool.per_second, max(share / 2, least)))

    def take(self, first: int | None = None) -> tuple[Task, Sums] | None:
        """A task that is done and its sums, after waiting a little; None: no task is done.

        Args:
            first: First sample of the wanted answer; None: any.

        Raises:
            GivenUp: A task failed on several workers.
        """
        end = time.monotonic() + STEP_S
        while True:
            self.pool.look()
            self.pool.serve()
            ready = self._ready(self._folded(self._without_twins(self.submissions)), first)
            if ready is not None:
                began = time.process_time()  # another thread fetches the sums
                sums = self.pool.result(ready, self.session.key)
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
            self.pool.answer_s = packing + self._add_s
            self.pool.per_second = max(samples / seconds, 1e-3)

    def facts(self) -> dict[str, Any]:
        """Values for a ``Status``."""
        return {"workers": len(self.pool.workers.good), "drawn_again": self.pool.drawn_again}

    @property
    def group(self) -> int:
        """Number of tasks to fold into each answer, so that the client keeps up with workers."""
        if not self._task_s:
            return 1
        busy = self._add_s * len(self.pool.workers.good) / self._task_s
        return max(1, math.ceil(busy / ADDING))

    def _ready(self, submissions: list[Submission], first: int | None) -> Submission | None:
        """Submission with an answer that the client takes now."""
        group = self.group
        done = [submission for submission in submissions if submission.done]
        rest = group < FAN_IN or len(done) == len(submissions)  # no more folding
        for submission in done:
            fits = first is None or submission.task.begin == first
            if fits and (rest or submission.alone or submission.tasks >= group):
                return submission
        return None

    def _folded(self, submissions: list[Submission]) -> list[Submission]:
        """Has workers add adjacent answers, if there are too many for the client."""
        group = self.group
        if group < FAN_IN:
            return submissions
        small = [f for f in submissions if f.has_sums and not f.alone and f.tasks < group]
        least = FAN_IN if any(not f.done for f in submissions) else 2
        folded = False
        for row in _rows(small):
            while len(row) >= least:
                self.pool.fold(row[:FAN_IN])
                row, folded = row[FAN_IN:], True
        return self.submissions if folded else submissions

    def _without_twins(self, submissions: list[Submission]) -> list[Submission]:
        """Gives up tasks that were submitted a second time, once either submission is done."""
        late: list[Submission] = []
        for _, same in groupby(submissions, lambda one: (one.task.begin, one.task.end)):
            twins = list(same)
            done = next((one for one in twins if one.done), None) if len(twins) > 1 else None
            late += [one for one in twins if done is not None and one is not done]
        if not late:
            return submissions
        self.pool.drop(*late)
        return [one for one in submissions if one not in late]

    def _draw_late_ones_again(self) -> None:
        """Has idle workers draw late tasks a second time; gives up late folds."""
        if time.monotonic() - self._waited < STEP_S:
            return
        self._waited = time.monotonic()
        pending = [one for one in self.submissions if not one.done]
        for one in pending:
            if one.parts and self.pool.is_late(one):
                self.pool.unfold(one)
        submissions = [one for one in pending if not one.parts]
        held = self.pool.holders()
        idle = sum(not keys for keys in held.values())
        for one in sorted(submissions, key=lambda submission: submission.began):
            has_twin = sum(other.task == one.task for other in submissions) > 1
            if idle > 0 and not has_twin and self.pool.is_late(one):
                busy = {name for name, keys in held.items() if keys}
                self.pool.begin(one.task, one.failed_on, but=busy)
                idle -= 1


def _rows(submissions: list[Submission]) -> Iterator[list[Submission]]:
    """Submissions that follow each other without a gap."""
    if not submissions:
        return
    row = submissions[:1]
    for one, other in pairwise(submissions):
        if one.task.end != other.task.begin:
            yield row
            row = []
        row.append(other)
    yield row
