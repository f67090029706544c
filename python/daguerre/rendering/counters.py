"""Counts of what was drawn: rays, paths, and how many of them reached the film."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields


@dataclass(frozen=True)
class RenderCounters:
    """Counts of what a session drew.

    Attributes:
        camera_rays: Rays that started at the film.
        stopped_rays: Those that no light comes along: stopped by lens, iris or edge of the field.
        rays: Rays of all kinds.
        light_paths: Paths from the emitters.
        splats_off_film: Their ends that passed the lens beside the frame.
        flare_paths: Paths of ghosts.
        flare_rays: Their rays in the lens.
        flare_hits: Those that came to the film.
        scatter_paths: Paths that the lens scatters.
        scatter_hits: Those that came to the film.
    """

    camera_rays: int = 0
    stopped_rays: int = 0
    rays: int = 0
    light_paths: int = 0
    splats_off_film: int = 0
    flare_paths: int = 0
    flare_rays: int = 0
    flare_hits: int = 0
    scatter_paths: int = 0
    scatter_hits: int = 0

    @classmethod
    def of(cls, counts: Sequence[int]) -> RenderCounters:
        """Counters from the core's numbers, in the order of the fields."""
        return cls(**{item.name: int(n) for item, n in zip(fields(cls), counts, strict=True)})

    def __add__(self, other: RenderCounters) -> RenderCounters:
        return RenderCounters.of(
            [a + b for a, b in zip(astuple(self), astuple(other), strict=True)]
        )
