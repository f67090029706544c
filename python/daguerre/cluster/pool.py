"""Worker pool: workers that draw for a client, and the tasks that were submitted to them."""

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
from .task import SceneKey, Task
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
class Submission:
    """A task that was sent to the workers.

    Attributes:
        task: The task.
        future: Dask's future of the answer.
        parts: Submissions with answers that this task adds; empty: the task draws.
        failed_on: Workers on which the task failed.
        only: Workers that may draw the task; empty: all.
        alone: Whether the client must take the answer itself, unfolded.
        home: Preferred worker; empty: any.
        answer: The answer, once it is fetched.
        began: Time at which the task was sent, by ``time.monotonic``, s.
    """

    task: Task
    future: Any
    parts: tuple[Submission, ...] = ()
    failed_on: tuple[str, ...] = ()
    only: frozenset[str] = frozenset()
    alone: bool = False
    home: str = ""
    answer: Answer | None = None
    began: float = field(default_factory=time.monotonic)

    @property
    def done(self) -> bool:
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


class WorkerPool:
    """Workers of a Dask cluster that draw tasks.

    Args:
        client: ``distributed.Client``.
        mixed: Whether workers of another build may draw.
        tell: Called with a sentence when a worker is lost or a task fails.

    Attributes:
        submissions: Tasks under way.
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
        self.submissions: list[Submission] = []
        self.drawn_again = 0
        self.per_second = self.answer_s = 0.0

    def look(self) -> None:
        """Updates the workers, and waits for a scheduler that is gone; both may come and go.

        Raises:
            InputError: The scheduler did not come back.
        """
        try:
            self.workers.look()
        except (OSError, RuntimeError) as error:  # TimeoutError and CommClosedError are OSErrors
            self._wait_for_scheduler(error)
        good = self.workers.good
        for submission in [one for one in self.submissions if one.only and not one.only & good]:
            if not submission.done:  # all that might draw it are gone
                self.drop(submission)
                self.begin(submission.task, submission.failed_on)

    def serve(self) -> None:
        """Sends values to workers that ask for them, for whatever picture.

        Raises:
            GivenUp: Several workers cannot keep them.
        """
        for submission in [one for one in self.submissions if one.has_words and one.answer is None]:
            submission.answer = self._answer(submission)
            if isinstance(submission.answer, Needs):
                self.submissions.remove(submission)
                self._provide(submission, submission.answer)

    def begin(
        self,
        task: Task,
        failed_on: Iterable[str] = (),
        but: Iterable[str] = (),
        home: str = "",
    ) -> Submission:
        """Sends a task to the workers, preferably to its home and not where it failed."""
        good, avoided = self.workers.good, {*failed_on, *but}
        free = avoided.isdisjoint(good) and self.workers.all_are_good
        only = frozenset() if free else frozenset(good - avoided or good)
        home = home if free and home in good else ""
        future = self._submit(only, on_worker.draw, task.to_text(), home=home)
        submission = Submission(task, future, failed_on=tuple(failed_on), only=only, home=home)
        self.submissions.append(submission)
        return submission

    def fold(self, submissions: Sequence[Submission]) -> Submission:
        """Has a worker add the answers of submissions with adjacent samples."""
        task = replace(submissions[0].task, end=submissions[-1].task.end)
        only = frozenset() if self.workers.all_are_good else frozenset(self.workers.good)
        future = self._submit(
            only, on_worker.fold, task.to_text(), *(f.future for f in submissions)
        )
        for one in submissions:
            self.submissions.remove(one)
        submission = Submission(task, future, parts=tuple(submissions), only=only)
        self.submissions.append(submission)
        return submission

    def result(self, submission: Submission, key: dict[str, str]) -> Sums | None:
        """Returns the sums of a submission that is done; None: new submissions replace it.

        Args:
            submission: The submission.
            key: Key of the picture.

        Raises:
            GivenUp: Its task failed on several workers.
        """
        self.submissions.remove(submission)
        answer = self._answer(submission)
        if isinstance(answer, Sums):
            answer = self._checked(answer, key)
        if isinstance(answer, Sums):
            return answer
        if submission.parts:
            self._take_apart(submission)
        elif answer is None:
            self._again(submission)
        elif isinstance(answer, Needs):
            self._provide(submission, answer)
        else:
            self._failed(submission, answer)
        return None

    def piloted(self, submission: Submission) -> Plan | None:
        """Result of the worker's pilot render, from a submission that is done; None: not known."""
        submission.answer = self._answer(submission)
        return submission.answer.piloted if isinstance(submission.answer, Sums) else None

    def is_late(self, submission: Submission) -> bool:
        """Whether a task takes much longer than the speed of the workers predicts."""
        should = (
            (submission.task.end - submission.task.begin) / self.per_second
            if self.per_second
            else inf
        )
        return time.monotonic() - submission.began > max(LATE * should, LATE_S)

    def drop(self, *submissions: Submission) -> None:
        """Gives up tasks."""
        self.client.cancel([submission.future for submission in submissions], force=True)
        self.submissions = [one for one in self.submissions if one not in submissions]

    def unfold(self, submission: Submission) -> None:
        """Gives up a fold; the client takes the answers of its parts."""
        self.drop(submission)
        self._take_apart(submission)

    def drop_all(self) -> None:
        """Gives up all tasks."""
        self.drop(*self.submissions)

    def close(self) -> None:
        """Gives up all tasks, and a connection that it opened itself."""
        with suppress(OSError, RuntimeError):  # the cluster may be gone
            self.drop_all()
            if self.client is not self._given:
                self.client.close()

    def submissions_of(self, place: SceneKey) -> list[Submission]:
        """Submissions of a picture, in the order of their begin."""
        own = [
            f for f in self.submissions if (f.task.scene, f.task.view) == (place.scene, place.view)
        ]
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

    def _answer(self, submission: Submission) -> Answer | None:
        """Answer of a submission; None: the scheduler lost it."""
        if submission.answer is not None or submission.future.status in ("cancelled", "lost"):
            return submission.answer
        try:
            direct = self.workers.all_are_reached
            return answer_of(self.client.gather(submission.future, direct=direct))
        except InputError as error:
            return Failed("a worker", str(error))
        except CancelledError:
            return None
        except Exception as error:  # whatever Dask raises: a killed worker, no memory
            if submission.future.status in ("cancelled", "lost"):
                return None
            worker = getattr(error, "last_worker", None)  # KilledWorker
            return Failed(str(worker.address) if worker else "a worker", str(error))

    def _checked(self, sums: Sums, key: dict[str, str]) -> Sums | Failed:
        """Sums of the picture of a key; refuses a worker with sums of another picture."""
        try:
            sums.check_key(key, mixed=self.mixed)
        except MismatchError as error:
            self.workers.refuse(sums.worker, str(error))
            return Failed(sums.worker, str(error))
        return sums

    def _provide(self, submission: Submission, needs: Needs) -> None:
        """Sends values to the worker that asked for them, and the task anew."""
        try:
            reason = self.values.send(self.client, needs.worker, needs.names, submission.began)
        except (OSError, RuntimeError):  # the worker is gone, or the scheduler: look() waits for it
            self._again(submission)
            return
        if reason:  # its disk is full
            self.workers.refuse(needs.worker, reason)
            self._failed(submission, Failed(needs.worker, reason))
        else:
            self.begin(submission.task, submission.failed_on, home=submission.home)

    def _take_apart(self, fold: Submission) -> None:
        for part in fold.parts:
            part.alone = True
        self.submissions.extend(fold.parts)

    def _failed(self, submission: Submission, failed: Failed) -> None:
        failed_on, task = (*submission.failed_on, failed.worker), submission.task
        if len(failed_on) >= TRIES or self.workers.good <= set(failed_on):
            raise GivenUp(task, failed_on, failed.reason)
        self._tell(f"cluster: {failed.worker}: {failed.reason}; its task is drawn again elsewhere")
        self._again(submission, failed_on)

    def _again(self, submission: Submission, failed_on: tuple[str, ...] | None = None) -> None:
        self.drawn_again += 1
        again = submission.failed_on if failed_on is None else failed_on
        self.begin(submission.task, again, home=submission.home)

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
