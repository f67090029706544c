"""Session with samples drawn by a cluster."""

from __future__ import annotations

from collections.abc import Callable
from typing import Unpack

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.checks import short
from daguerre.errors import UsageError
from daguerre.parameters.keywords import takes
from daguerre.rendering.keywords import SettingsKeywords
from daguerre.rendering.parameters import TABLE
from daguerre.rendering.schedule import Work
from daguerre.rendering.session import Session
from daguerre.rendering.settings import RenderSettings
from daguerre.scene.scene import Scene
from daguerre.setup.built_scene import BuiltScene

from .pool import WorkerPool
from .work import ClusterParts, ClusterRange
from .workers import is_client

Progress = Callable[[float], bool]


@guarded(init=True)
@takes(TABLE, SettingsKeywords)
class ClusterSession(Session):
    """A session with samples drawn by the workers of a Dask cluster; the rest is as in ``Session``.

    The result is bit for bit as on a single machine. ``frame`` returns the picture of the samples
    that have arrived.

    Args:
        scene: The scene.
        camera: Camera, or its name in the scene; default: the scene's own.
        client: ``distributed.Client`` of the cluster.
        settings: How it is rendered; the keywords change it.
        built: ``Session.built`` of another session of the same, unchanged scene; it is reused if
            both expose at the same time.
        {keywords}

    Raises:
        UsageError: A parameter is out of its range.
        InputError: The scene or the lens cannot be used, or no worker may draw.
    """

    def __init__(
        self,
        scene: Scene,
        camera: Camera | str | None = None,
        *,
        client: object,
        settings: RenderSettings | None = None,
        built: BuiltScene | None = None,
        **keywords: Unpack[SettingsKeywords],
    ) -> None:
        if not is_client(client):
            raise UsageError(f"client: wanted a distributed.Client, got {short(client)}")
        super().__init__(scene, camera, settings=settings, built=built, **keywords)
        self._pool = WorkerPool(client)
        self._pool.workers.wait()

    def draw(self, begin: int, end: int, progress: Progress | None = None) -> bool:
        """Has samples [begin, end) of every pixel drawn.

        Args:
            begin: First sample index.
            end: One past the last.
            progress: Called with the fraction done; returning False stops.

        Returns:
            False if stopped. The samples that arrived before are in the picture; see ``ranges``.
        """
        wanted = self._new_range(begin, end)
        return self._work_off(ClusterRange(self, wanted, self._pool), progress)

    def draw_round(self, until: int, progress: Progress | None = None) -> bool:
        """Has the parts of ``round`` up to ``until`` drawn; see ``Session.draw_round``."""
        self._planned_round()
        return self._work_off(ClusterParts(self, until, self._pool), progress)

    def _work_off(self, work: Work, progress: Progress | None) -> bool:
        try:
            while work.prepare(1.0):
                work.draw(lambda fraction: True)
                if progress is not None and not progress(work.done() / work.total()):
                    return False
        finally:
            self._pool.drop_all()
        return True
