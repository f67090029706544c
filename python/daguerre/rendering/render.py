"""One-call renders: ``render``, and ``iter_render``, which yields a picture as it refines."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Unpack

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.frame.frame import Frame
from daguerre.parameters.keywords import takes
from daguerre.scene.scene import Scene

from .checkpoint import Checkpoint
from .keywords import RenderKeywords, settings_of
from .loop import Loop
from .parameters import TABLE
from .progress import Status
from .reporter import Control, Reporter
from .rounds import rounds
from .schedule import WorkOf, work_of
from .session import Session
from .settings import RenderSettings

#: Callback that receives the progress of a picture; returning False stops it.
Progress = Callable[[Status], bool | None]


@takes(TABLE, RenderKeywords)
@guarded
def render(
    scene: Scene,
    camera: Camera | str | None = None,
    *,
    settings: RenderSettings | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    cluster: object = None,
    **keywords: Unpack[RenderKeywords],
) -> Frame:
    """Renders a picture.

    Args:
        scene: The scene.
        camera: Camera, or its name in the scene; default: the scene's own.
        settings: Render settings; the keywords override them.
        checkpoint: File (.exr) that keeps the samples until the picture is complete. It is written
            every minute, and when ``progress`` stops the render. If it exists, the render continues
            from it.
        progress: Called about ten times a second with a ``rendering.Status``. Returning False
            stops the render after the current samples and returns the picture so far.
        cluster: ``distributed.Client`` of a Dask cluster that draws, or an address as for
            ``--cluster``, such as ``local:4``; None: this machine draws. The bits are the same.
        {keywords}

    Returns:
        The frame; ``frame.rgb`` is float32 (H, W, 3), scene-linear Rec.709.

    Raises:
        UsageError: A parameter is out of its range.
        InputError: The scene or the lens cannot be used.
        MismatchError: The checkpoint belongs to another picture.
    """
    session = Session(scene, camera, settings=settings_of(settings, keywords))
    if checkpoint is None and progress is None and cluster is None:
        return finish(session)
    kept = Checkpoint(None if checkpoint is None else Path(checkpoint))
    with nullcontext(work_of) if cluster is None else _on_cluster(cluster) as make_work:
        _draw(session, kept, _Watch(progress or (lambda status: None)), make_work)
    return session.frame()


def finish(session: Session) -> Frame:
    """Draws a session to the samples of its settings and returns the picture."""
    sampling = session.settings.sampling
    if sampling.noise is None:
        session.draw(0, sampling.most)
    else:
        for _ in rounds(session, sampling.noise, sampling.most):
            pass
    return session.frame()


class _Watch(Reporter, Control):
    """Reports progress to a callback, and stops when that returns False."""

    def __init__(self, told: Progress) -> None:
        self._told = told

    def progress(self, status: Status) -> None:
        """Calls the callback; at least one pass is drawn, as a picture needs samples."""
        if self._told(status) is False and status.samples:
            self.stops = 1


def _on_cluster(cluster: object) -> AbstractContextManager[WorkOf]:
    """Context of the work of a cluster."""
    from daguerre.cluster.opened import work_on

    return work_on(cluster)


def _draw(session: Session, checkpoint: Checkpoint, watch: _Watch, make_work: WorkOf) -> None:
    sampling = session.settings.sampling
    work = make_work(session, (0, sampling.most), sampling.noise, None)
    checkpoint.load(session, work)
    loop = Loop(session, work, checkpoint, watch, watch)
    if loop.run():
        checkpoint.remove()
    else:
        checkpoint.save(session)


@takes(TABLE, RenderKeywords)
@guarded
def iter_render(
    scene: Scene,
    camera: Camera | str | None = None,
    *,
    settings: RenderSettings | None = None,
    **keywords: Unpack[RenderKeywords],
) -> Iterator[Frame]:
    """Yields the picture as it refines: after 1, 2, 4, ... and finally ``spp`` samples.

    With ``noise`` it yields the picture after each round of adaptive sampling.

    Args:
        scene: The scene.
        camera: Camera, or its name in the scene; default: the scene's own.
        settings: Render settings; the keywords override them.
        {keywords}
    """
    session = Session(scene, camera, settings=settings_of(settings, keywords))
    sampling = session.settings.sampling
    if sampling.noise is not None:
        for _ in rounds(session, sampling.noise, sampling.most):
            yield session.frame()
        return
    begin, end = 0, 1
    while begin < sampling.most:
        session.draw(begin, min(end, sampling.most))
        yield session.frame()
        begin, end = end, 2 * end
