"""Work of a picture that a cluster draws: the same samples as on one machine, in many places."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple
from typing import TYPE_CHECKING, Any

from daguerre.errors import InputError
from daguerre.rendering import adaptive, rounds
from daguerre.rendering.ranges import join_ranges, show_ranges
from daguerre.rendering.schedule import Range, Rounds, Work, WorkOf

from .pool import TRIES, GivenUp, WorkerPool
from .sharing import Sharing
from .spread import Spread
from .task import Task

if TYPE_CHECKING:
    from daguerre.rendering.adaptive import Round
    from daguerre.rendering.job import Job
    from daguerre.rendering.passes import Pass
    from daguerre.rendering.rounds import Judge
    from daguerre.rendering.session import Session

    from .answers import Sums

#: Samples of a step in which nothing arrives: more than none, which would be the end.
_NOTHING = 1e-9


class ClusterRange(Range):
    """Samples [begin, end) of every pixel, drawn by a cluster."""

    def __init__(
        self,
        session: Session,
        wanted: tuple[int, int],
        pool: WorkerPool,
        spread: Spread | None = None,
    ) -> None:
        super().__init__(session, wanted)
        self._spread = spread or Spread(pool)
        self._sharing = Sharing(session, pool, self._spread.open(session))
        self._arrived: tuple[Task, Sums] | None = None
        self._drew = False
        self._given_up: dict[tuple[int, int], GivenUp] = {}

    def prepare(self, limit: float) -> float:
        """Keeps workers busy, and waits a little for a result; its samples, or 0 at the end."""
        missing = self._missing()
        if not missing:
            return 0.0
        free = self._fill()
        if not free and not self._sharing.submissions:  # all else is complete
            raise self._failure()
        try:
            self._arrived = self._sharing.take()
        except GivenUp as error:
            if (error.task.scene, error.task.view) != astuple(self._sharing.place):
                raise  # of a picture to come
            self._give_up(error)
            self._arrived = None
        if self._arrived is None:
            return _NOTHING
        task = self._arrived[0]
        return float(task.end - task.begin)

    def draw(self, progress: Callable[[float], bool]) -> bool:
        """Adds the sums that arrived."""
        if self._arrived is not None:
            (task, sums), self._arrived = self._arrived, None
            with self._sharing.adding(task.end - task.begin, sums):
                self.session.add(sums.parts, [(task.begin, task.end)])
            self._drew = True
        return True

    def facts(self) -> dict[str, Any]:
        """Workers, and tasks drawn again."""
        return self._sharing.facts()

    def _give_up(self, error: GivenUp) -> None:
        self._given_up[error.task.begin, error.task.end] = error
        if len(self._given_up) >= TRIES and not self._drew:
            raise self._failure()  # nothing but failures: the rest would be more of them

    def _failure(self) -> InputError:
        """Raises a single error for all tasks that were given up."""
        first = next(iter(self._given_up.values()))
        if len(self._given_up) == 1:
            return first
        ranges = show_ranges(join_ranges(self._given_up))
        return InputError(f"{first}; in all, samples {ranges} were not drawn")

    def _fill(self) -> bool:
        """Begins tasks while there is room; False: nothing is left to begin."""
        known = [*self.session.ranges, *self._given_up]
        return self._spread.fill(self._sharing, self.wanted, known)


class ClusterParts:
    """Parts of a session's round up to ``until``, drawn by a cluster.

    They are added in their order, so that a checkpoint can say how far it got.
    """

    def __init__(self, session: Session, until: int, pool: WorkerPool) -> None:
        self.session, self.until = session, until
        self._sharing = Sharing(session, pool, Spread(pool).open(session))
        self._arrived: tuple[Task, Sums] | None = None
        self._plan: tuple[Any, str] | None = None
        self._begun = 0

    def check(self, saved: Pass) -> None:
        """Accepts all checkpoints."""

    def prepare(self, limit: float) -> float:
        """Keeps workers busy, and waits a little for the next parts; samples, or 0 at the end."""
        if self._round.drawn >= self.until:
            return 0.0
        self._fill()
        self._arrived = self._sharing.take(self._round.drawn)
        return _NOTHING if self._arrived is None else self._samples(self._arrived[0])

    def draw(self, progress: Callable[[float], bool]) -> bool:
        """Adds the parts that arrived."""
        if self._arrived is not None:
            (task, sums), self._arrived = self._arrived, None
            with self._sharing.adding(self._samples(task), sums):
                self.session.add(sums.parts, until=task.end)
        return True

    def done(self) -> float:
        """Parts drawn."""
        return self._round.drawn

    def total(self) -> float:
        """Parts wanted."""
        return self.until

    def facts(self) -> dict[str, Any]:
        """Workers, and tasks drawn again."""
        return self._sharing.facts()

    @property
    def _round(self) -> Round:
        assert self.session.round is not None
        return self.session.round

    def _samples(self, task: Task) -> float:
        """Mean samples per pixel of parts of the round."""
        return float(self._round.count.mean()) * (task.end - task.begin) / adaptive.PARTS

    def _fill(self) -> None:
        sharing, now = self._sharing, self._round
        if self._plan is None or self._plan[0] is not now.count:
            if self._plan is not None:
                sharing.pool.values.forget(self._plan[1])
            self._plan = now.count, sharing.pool.values.keep((now.begin, now.count))
            self._begun = now.drawn
        part = float(now.count.mean()) / adaptive.PARTS
        while self._begun < self.until and sharing.room() > 0:
            left = self.until - self._begun
            parts = max(1, min(int(sharing.size(left * part) / part), left))
            sharing.begin(self._begun, self._begun + parts, self._plan[1])
            self._begun += parts


class ClusterRounds(Rounds):
    """Adaptive sampling with rounds planned here and drawn by a cluster."""

    def __init__(
        self, session: Session, noise: float, ceiling: int, judge: Judge | None, pool: WorkerPool
    ) -> None:
        super().__init__(session, noise, ceiling, judge)
        self._parts = ClusterParts(session, adaptive.PARTS, pool)

    def prepare(self, limit: float) -> float:
        """Plans a round, keeps workers busy, and waits a little for its next parts."""
        if not rounds.plan_round(self.session, self.noise, self.ceiling, self.judge):
            return 0.0
        return self._parts.prepare(limit)

    def draw(self, progress: Callable[[float], bool]) -> bool:
        """Adds the parts that arrived."""
        return self._parts.draw(progress)

    def facts(self) -> dict[str, Any]:
        """Noise, workers, and tasks drawn again."""
        return super().facts() | self._parts.facts()


def work_of(pool: WorkerPool, job: Job | None = None) -> WorkOf:
    """Makes ``daguerre.rendering.schedule.work_of`` for a cluster.

    Args:
        pool: Workers.
        job: Job of the pictures; None: each picture alone.
    """
    spread = Spread(pool, job)
    if job is not None:
        job.piloted = spread.piloted

    def made(
        session: Session, wanted: tuple[int, int], noise: float | None, judge: Judge | None = None
    ) -> Work:
        if noise is None:
            return ClusterRange(session, wanted, pool, spread)
        return ClusterRounds(session, noise, wanted[1], judge, pool)

    return made
