"""Frames from the sums of a film."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError, MismatchError, core_errors
from daguerre.frame.aovs import FILM_CHANNELS
from daguerre.frame.catcher import layers
from daguerre.frame.frame import Frame
from daguerre.frame.world import in_world

from .mattes import mattes_of

if TYPE_CHECKING:
    from daguerre import _core

    from .diffraction import Kernels

#: Part of the sums that is lists: shape (H, entries of the longest row, 4).
OBJECTS = "objects"


def set_film_state(film: _core.Film, state: Mapping[str, NDArray[np.uint32]], where: str) -> None:
    """Puts sums from ``film.state``, by part, into a film of the same size.

    Raises:
        MismatchError: A part is missing, unknown or of another size; the film is unchanged then.
        InputError: A list is damaged.
    """
    check_layout(film, {part: np.shape(words) for part, words in state.items()}, where)
    with core_errors(InputError, where):
        for part, words in state.items():
            film.set_state(part, np.ascontiguousarray(words, np.uint32))


def check_layout(film: _core.Film, given: Mapping[str, tuple[int, ...]], where: str) -> None:
    """Checks that sums have the shapes of a film's, by part.

    Raises:
        MismatchError: They do not.
    """
    shapes = {part: _shape(part, film.state(part).shape) for part in film.state_parts()}
    got = {part: _shape(part, shape) for part, shape in given.items()}
    if got != shapes:
        raise MismatchError(f"{where}: sums of another layout: wanted {shapes}, got {got}")


def _shape(part: str, shape: tuple[int, ...]) -> tuple[int, ...]:
    """Shape that films of the same layout share; for lists the number of rows."""
    return (*shape[:1], *shape[2:]) if part == OBJECTS else shape


def frame_of(
    film: _core.Film,
    metadata: dict[str, Any],
    *,
    aovs: bool,
    waves: bool = True,
    kernels: Kernels | None = None,
) -> Frame:
    """Makes the frame of a film: means, variance and counts as plain arrays.

    Args:
        film: Film of the core.
        metadata: Metadata of the frame.
        aovs: Whether the film has auxiliary channels.
        waves: Whether to add diffraction if the film has bands; variance is always that before
            diffraction.
        kernels: Cache of the kernels of diffraction of this picture; None: they are not kept.
    """
    planes: dict[str, NDArray[Any]] = {}
    if aovs:
        planes = {name: _plane(film, name) for name in FILM_CHANNELS}
        planes = in_world(planes, metadata.get("world_origin"))
    parts, keep = film.state_parts(), bool(metadata.get("bands"))
    alpha = film.coverage() if "coverage" in parts else np.ones(film.shape, np.float32)
    if waves and "bands" in parts and ("pupils" in metadata or not keep):
        from .diffraction import developed, rgb_of

        made = developed(film, metadata.get("pupils"), keep=keep, kernels=kernels)
        xyz, channels, bands = made.xyz, made.channels, made.bands
        rgb = rgb_of(xyz)
    else:
        xyz, rgb = film.mean_xyz(), film.mean_rgb()
        channels = film.mean_channels() if "channels" in parts else None
        bands = film.mean_bands() if keep and "bands" in parts else None
    names = metadata.get("sensor_channels") or []
    if channels is not None and channels.shape[2] != len(names):
        raise InputError(f"sensor_channels: wanted {channels.shape[2]} names, got {names}")
    layers_of_plates: dict[str, Any] = {**_catchers(film, alpha), **_mattes(film, metadata)}
    return Frame(
        rgb=rgb,
        xyz=xyz,
        alpha=alpha,
        variance=film.variance_rgb(),
        samples=film.sample_counts(),
        aovs=planes,
        metadata=metadata,
        bad_samples=(int(film.bad_sample_count), list(film.bad_samples)),
        flare=film.flare_rgb() if "flare" in parts else None,
        splats=film.splats_rgb() if aovs and "splats" in parts else None,
        halves=_halves(film) if "halves" in parts else None,
        channels=channels,
        bands=bands,
        **layers_of_plates,
    )


def _catchers(film: _core.Film, alpha: NDArray[np.float32]) -> dict[str, NDArray[np.float32]]:
    """Layers of catchers, if the film has any."""
    parts = film.state_parts()
    made: dict[str, NDArray[np.float32]] = {}
    if "catchers" in parts:
        pair = film.catcher_rgb(True), film.catcher_rgb(False)
        made["catcher"], made["catcher_ratio"] = layers(*pair, alpha)
    if "catcher_channels" in parts:
        pair = film.catcher_channels(True), film.catcher_channels(False)
        made["catcher_channels"], made["catcher_ratio_channels"] = layers(*pair, alpha)
    return made


def _mattes(film: _core.Film, metadata: dict[str, Any]) -> dict[str, Any]:
    """Mattes by name, if the film has objects; ``mattes_cut`` counts pixels with too many."""
    facts = metadata.get("mattes")
    if facts is None or OBJECTS not in film.state_parts():
        return {}
    found, cut, most = mattes_of(film, facts)
    if cut:
        metadata["mattes_cut"] = {"pixels": cut, "share": most}
    return {"cryptomatte": found}


def _halves(film: _core.Film) -> NDArray[np.float32]:
    """Pictures of even and odd samples, by camera and by light paths, shape (H, W, 2, 2, 3)."""
    halves = [[film.half_rgb(odd, splats) for splats in (False, True)] for odd in (False, True)]
    return np.stack([np.stack(half, axis=2) for half in halves], axis=2)


def _plane(film: _core.Film, name: str) -> NDArray[Any]:
    """Returns a channel of a film; ids are integers and never means."""
    return np.asarray(film.object_ids() if name == "object_id" else film.aov(name))
