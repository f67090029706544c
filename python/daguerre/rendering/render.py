"""One-call renders: ``render``, and ``iter_render``, which refines a picture step by step."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from daguerre.camera.camera import Camera
from daguerre.checks import MAX_SAMPLES, whole
from daguerre.frame.frame import Frame
from daguerre.scene.scene import Scene

from .adaptive import check_noise
from .rounds import rounds
from .session import Session

DEFAULT_SPP = 64


def render(
    scene: Scene,
    camera: Camera | str | None = None,
    *,
    spp: int | None = None,
    noise: float | None = None,
    **options: Any,
) -> Frame:
    """Renders a picture.

    Args:
        scene: The scene.
        camera: Camera, or its name in the scene; default: the scene's own.
        spp: Samples per pixel; default: 64. With ``noise`` the most that a pixel may get;
            default then: 16384.
        noise: Relative error to reach (0.05 is grainy, 0.01 clean): the root mean square over
            pixels and channels of standard error / sqrt(value^2 + 0.01). Pixels then get as many
            samples as each needs.
        **options: Options of :class:`Session`: resolution, seed, filter, aovs, gt_time, gt_lens,
            motion, crop, threads, max_depth.

    Returns:
        The frame; ``frame.rgb`` is float32 (H, W, 3), scene-linear Rec.709.
    """
    _most_samples(spp, noise)  # before anything is built
    return finish(Session(scene, camera, **options), spp, noise)


def finish(session: Session, spp: int | None = None, noise: float | None = None) -> Frame:
    """Draws and returns the picture of a session; arguments are those of :func:`render`."""
    spp = _most_samples(spp, noise)
    if noise is None:
        session.draw(0, spp)
    else:
        for _ in rounds(session, noise, spp):
            pass
    return session.frame()


def iter_render(
    scene: Scene,
    camera: Camera | str | None = None,
    *,
    spp: int | None = None,
    noise: float | None = None,
    **options: Any,
) -> Iterator[Frame]:
    """Yields the picture as it refines: after 1, 2, 4, ... and at last ``spp`` samples.

    With ``noise``, after each round of adaptive sampling. Arguments are those of :func:`render`.
    """
    spp = _most_samples(spp, noise)
    session = Session(scene, camera, **options)
    if noise is not None:
        for _ in rounds(session, noise, spp):
            yield session.frame()
        return
    begin, end = 0, 1
    while begin < spp:
        session.draw(begin, min(end, spp))
        yield session.frame()
        begin, end = end, 2 * end


def _most_samples(spp: int | None, noise: float | None) -> int:
    if noise is not None:
        return check_noise(noise, spp)[1]
    return whole(DEFAULT_SPP if spp is None else spp, "spp", 1, MAX_SAMPLES, "1 .. 2^31")
