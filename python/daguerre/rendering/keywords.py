"""Keywords of a render for type checkers: every parameter of ``RenderSettings``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypedDict

from .diffraction import Diffraction
from .pixels import CropLike
from .settings import OverscanLike, RenderSettings


class ViewKeywords(TypedDict, total=False):
    """Parameters of any picture, each with the type of its field in ``RenderSettings``."""

    seed: int
    filter: str
    aovs: bool
    halves: bool
    cryptomatte: str | Sequence[str]
    cryptomatte_ranks: int
    gt_time: str | None
    gt_lens: str
    gt_rays: int | None
    motion: bool
    crop: CropLike | None
    overscan: OverscanLike | None
    threads: int
    max_depth: int
    strategy: str
    dispersion: str
    light_paths: str | float | tuple[float, float]
    flare: str | float
    flare_order: int
    flare_highlights: bool | str
    scatter: str | float
    technique: str
    diffraction: bool | Diffraction
    bands: int
    background: str
    see_through: bool


class SettingsKeywords(ViewKeywords, total=False):
    """Parameters of one picture."""

    resolution: tuple[int, int]


class RenderKeywords(SettingsKeywords, total=False):
    """Parameters of one picture, and the number of samples."""

    spp: int | None
    noise: float | None


class RigKeywords(ViewKeywords, total=False):
    """Parameters of several pictures, of the same size or not."""

    spp: int | None
    noise: float | None


def settings_of(given: RenderSettings | None, keywords: Mapping[str, Any]) -> RenderSettings:
    """Returns the settings, changed by the keywords."""
    made = RenderSettings() if given is None else given
    return made.with_(**keywords)
