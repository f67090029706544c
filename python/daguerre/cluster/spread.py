"""Spread of a job over workers: a picture for each worker, then idle workers help with the rest.

A worker that draws a whole picture sets it up once, and adds its answers without sending them.
"""

from __future__ import annotations

import math
import time
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import astuple
from typing import TYPE_CHECKING

from daguerre.rendering.ranges import Range, missing_ranges

from .pool import GivenUp, WorkerPool
from .task import SceneKey, Task

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera
    from daguerre.rendering.job import Job
    from daguerre.rendering.light_paths import Plan
    from daguerre.rendering.picture import Picture
    from daguerre.rendering.session import Session
    from daguerre.rendering.settings import RenderSettings
    from daguerre.scene.far import Place
    from daguerre.scene.scene import Scene

    from .sharing import Sharing

#: Pictures of each worker beyond the picture under way with sums that may wait at the worker.
PICTURES_AHEAD = 2
#: Time between two looks for sums, s.
WAIT_S = 0.02


class Spread:
    """Tasks of the picture under way, and of later pictures of its job.

    Args:
        pool: Workers.
        job: The job; None: a single picture.
    """

    def __init__(self, pool: WorkerPool, job: Job | None = None) -> None:
        self.pool, self.job = pool, job
        self._now = 0  # number of the picture under way
        self._places: dict[int, SceneKey] = {}
        self._homes: dict[int, str] = {}

    def open(self, session: Session) -> SceneKey:
        """Place of the picture that begins now."""
        if self.job is None:
            self.pool.drop_all()  # of a picture before that was stopped
            self._homes.clear()
            piloted, origin = session.light_plan.piloted, session.built.origin
            place = self._kept(session.scene, session.camera, session.settings, piloted, origin)
            self._places = {0: place}
            return place
        self._now = self.job.done
        for number in [n for n in self._places if n < self._now]:
            for name in astuple(self._places.pop(number)):
                self.pool.values.forget(name)
        return self._place(self._now, session)

    def piloted(self, picture: Picture) -> Plan | None:
        """Result of a picture's pilot render, after waiting for a worker; None: no worker draws."""
        assert self.job is not None
        place, control = self._places.get(self.job.pictures.index(picture)), self.job.control
        while place is not None and not control.stops:
            try:
                self.pool.look()
                self.pool.serve()
            except GivenUp:  # the picture's own work will find out
                return None
            submissions = self.pool.submissions_of(place)
            for one in submissions:
                if one.has_sums:
                    return self.pool.piloted(one)
            if not submissions or any(one.done or self.pool.is_late(one) for one in submissions):
                return None
            time.sleep(WAIT_S)
            control.poll()
        return None

    def fill(self, sharing: Sharing, wanted: Range, known: Sequence[Range]) -> bool:
        """Begins tasks while there is room; False: nothing is left to begin.

        Args:
            sharing: How the picture under way is drawn.
            wanted: Samples of it.
            known: Those that are drawn, or given up.
        """
        room = sharing.room()
        if room <= 0:
            return True
        free = self._free(wanted, known)
        pending = Counter(one.home for one in self.pool.submissions if not one.done)
        good = sorted(self.pool.workers.good)
        for _ in range(room):
            worker = min(good, key=lambda one: pending[one], default="")
            number = self._choice(worker, free)
            if number is None:
                return False
            left = sum(b - a for ranges in free.values() for a, b in ranges)
            (begin, last), *others = free[number]
            tasks = max(1, round((last - begin) / sharing.size(left)))
            end = begin + math.ceil((last - begin) / tasks)
            free[number] = [(end, last), *others] if end < last else others
            place = self._place(number)
            several = len(free) > 1  # the last picture is everybody's
            home = worker if several and self._homes[number] == worker else ""
            self.pool.begin(Task(place.scene, place.view, begin, end), home=home)
            pending[home] += 1
        return True

    def _numbers(self) -> Iterator[int]:
        """Numbers of the pictures that may be drawn now."""
        yield self._now
        if self.job is None:
            return
        ahead = PICTURES_AHEAD * max(1, len(self.pool.workers.good))
        for number in range(self._now + 1, min(self._now + 1 + ahead, len(self.job.pictures))):
            if self.job.pictures[number].settings.sampling.noise is not None:
                return  # adaptive sampling waits for its own sums
            yield number

    def _free(self, wanted: Range, known: Sequence[Range]) -> dict[int, list[Range]]:
        """Samples that no worker draws, by the number of the picture."""
        taken = defaultdict(list)
        for one in self.pool.submissions:
            taken[one.task.scene, one.task.view].append((one.task.begin, one.task.end))
        found = {}
        for number in self._numbers():
            place = self._places.get(number)
            own = [] if place is None else taken[place.scene, place.view]
            if number == self._now:
                found[number] = missing_ranges([*known, *own], wanted)
            else:
                assert self.job is not None
                found[number] = missing_ranges(own, self.job.pictures[number].wanted)
        return found

    def _choice(self, worker: str, free: dict[int, list[Range]]) -> int | None:
        """Picture that a worker draws next: its own, else a new picture, else another worker's."""
        unfinished = [number for number, ranges in free.items() if ranges]
        for number in unfinished:
            if self._homes.get(number) == worker:
                return number
        for number in unfinished:
            if self._homes.get(number) not in self.pool.workers.good:  # without a worker
                self._homes[number] = worker
                return number
        return unfinished[0] if unfinished else None

    def _place(self, number: int, session: Session | None = None) -> SceneKey:
        """Place of a picture; with its session, workers need no pilot render."""
        if number not in self._places:
            assert self.job is not None
            picture, job = self.job.pictures[number], self.job
            scene, camera = job.scene_of(picture), job.camera_of(picture)
            piloted = None if session is None else session.light_plan.piloted
            origin = job.origin_of(picture)
            self._places[number] = self._kept(scene, camera, picture.settings, piloted, origin)
        return self._places[number]

    def _kept(
        self,
        scene: Scene,
        camera: Camera,
        settings: RenderSettings,
        piloted: Plan | None,
        origin: Place,
    ) -> SceneKey:
        """Place of a picture; the pool keeps its values."""
        keep = self.pool.values.keep
        return SceneKey(keep(scene), keep((camera, settings, piloted, origin)))
