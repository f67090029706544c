"""Beside: a second picture at the same settings, by another lens, stop or model of the lens."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from daguerre.camera.ideal import WITHOUT_IRIS
from daguerre.setup.resolved import ResolvedLens

from .dials import Dials
from .shot import Shot
from .sight import offset_m
from .stage import Stage
from .switches import suited
from .widest import widest_stop

#: Dials that may differ.
NAMES = ("lens", "f_stop", "lens_model")
#: Models of a lens with a prescription.
MODELS = ("exact", "polynomial", "thin", "pinhole")


@dataclass(frozen=True)
class Other:
    """The second picture of a comparison.

    Attributes:
        shot: Shot of the second picture.
        labels: Lens and stop of the first and of the second picture.
    """

    shot: Shot
    labels: tuple[str, str]


def other_of(stage: Stage, first: Shot, change: Mapping[str, str]) -> Other:
    """Returns the picture beside the first picture, at the same size and exposure.

    Another lens focuses as far away as the first lens, at the same f-stop or, if it opens less, at
    its widest f-stop.

    Args:
        stage: Stage of the first picture.
        first: The first picture, with the exposure that a meter chose.
        change: Text of the dial that differs.

    Raises:
        DaguerreError: It cannot be drawn.
    """
    camera = first.camera.with_(**Dials().turned(change).values())
    lens = stage.set_up(first)
    if "lens" in change and camera.lens not in WITHOUT_IRIS:
        if lens.focus_distance_m is not None:
            distance = lens.focus_distance_m + offset_m(first.camera, lens)
            camera = camera.with_(focus_distance=distance)
        if lens.f_stop is not None:
            widest = widest_stop(stage, replace(first, camera=camera))
            camera = camera.with_(f_stop=max(lens.f_stop, widest))
    shot = replace(first, camera=camera, chosen=None)
    other = stage.set_up(shot)
    shot = replace(shot, settings=suited(shot.settings, other.model))
    return Other(shot, _labels(lens, other))


def models_beside(lens: ResolvedLens) -> list[str]:
    """Other models by which a lens can be drawn."""
    return [] if lens.glass is None else [one for one in MODELS if one != lens.model]


def _labels(first: ResolvedLens, other: ResolvedLens) -> tuple[str, str]:
    """Labels of two pictures; models are named if they differ."""
    named = first.model != other.model
    return _label(first, named=named), _label(other, named=named)


def _label(lens: ResolvedLens, *, named: bool) -> str:
    stop = "" if lens.f_stop is None else f"f/{lens.f_stop:.2g}"
    model = lens.model if named and lens.model != lens.name else ""
    return " · ".join(part for part in (lens.name, stop, model) if part)
