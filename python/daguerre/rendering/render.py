"""One-call renders: ``render``, and ``iter_render``, which refines a picture step by step."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Unpack

from daguerre.camera.camera import Camera
from daguerre.frame.frame import Frame
from daguerre.scene.scene import Scene

from .keywords import RenderKeywords, settings_of, takes
from .rounds import rounds
from .session import Session
from .settings import RenderSettings


@takes(RenderKeywords)
def render(
    scene: Scene,
    camera: Camera | str | None = None,
    *,
    settings: RenderSettings | None = None,
    **keywords: Unpack[RenderKeywords],
) -> Frame:
    """Renders a picture.

    Args:
        scene: The scene.
        camera: Camera, or its name in the scene; default: the scene's own.
        settings: How it is rendered; the keywords change it.
        {keywords}

    Returns:
        The frame; ``frame.rgb`` is float32 (H, W, 3), scene-linear Rec.709.
    """
    return finish(Session(scene, camera, settings=settings_of(settings, keywords)))


def finish(session: Session) -> Frame:
    """The picture of a session, of as many samples as its settings ask for."""
    sampling = session.settings.sampling
    if sampling.noise is None:
        session.draw(0, sampling.most)
    else:
        for _ in rounds(session, sampling.noise, sampling.most):
            pass
    return session.frame()


@takes(RenderKeywords)
def iter_render(
    scene: Scene,
    camera: Camera | str | None = None,
    *,
    settings: RenderSettings | None = None,
    **keywords: Unpack[RenderKeywords],
) -> Iterator[Frame]:
    """Yields the picture as it refines: after 1, 2, 4, ... and at last ``spp`` samples.

    With ``noise``, after each round of adaptive sampling. Arguments are those of :func:`render`.
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
