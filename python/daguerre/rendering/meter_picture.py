"""Picture of a light meter, and the point of it that a metering pattern looks at."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import daguerre._core as _core
from daguerre.camera.exposure_mode import split_pattern
from daguerre.errors import InputError, UsageError
from daguerre.frame.seen_by import sensor_metadata
from daguerre.scene.node_names import find_node, no_node
from daguerre.scene.scene import Scene
from daguerre.units import numbers

from .film_frame import frame_of
from .light_plan import plan_film, plan_light
from .picture_truth import ground_truth
from .prepare import Prepared

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame


def metered_point(
    prepared: Prepared, pattern: str, size: tuple[int, int] | None = None
) -> tuple[float, float] | None:
    """Point that a metering pattern looks at, px of a picture; None: the middle.

    Args:
        prepared: The picture.
        pattern: Metering pattern, such as ``spot:480,270`` or ``spot:NODE``.
        size: Size of the picture that ``spot:X,Y`` refers to, px; None: the size of ``prepared``.

    Raises:
        UsageError: The pixel is not in the picture.
        InputError: There is no such node, or it is not in view.
    """
    _, place = split_pattern(pattern)
    if not place:
        return prepared.camera.focus_at
    if (instances := _instances(prepared.scene, place)) is not None:
        return _seen_at(prepared, place, instances)
    width, height = size or prepared.size
    x, y = numbers("--meter spot", place, 2, "480,270, or the name of a node")
    if not (0 <= x < width and 0 <= y < height):
        raise UsageError(
            f"--meter spot:{place}: wanted a pixel of the picture of {width} x {height} px"
        )
    return (x + 0.5) * prepared.size[0] / width, (y + 0.5) * prepared.size[1] / height


def _instances(scene: Scene, name: str) -> list[int] | None:
    """Instances of a node; None: the text gives a pixel."""
    known = set(scene.nodes) | set(scene.node_positions)
    found = find_node(name, known)
    if found is not None:
        return list(scene.nodes.get(found, ()))
    if name[:1].isdigit() or "," in name:
        return None
    raise InputError(f"--meter spot: {no_node(name, known)}")


def _seen_at(prepared: Prepared, name: str, instances: list[int]) -> tuple[float, float]:
    """Pixel of a node nearest to the mean position of its pixels."""
    truth = ground_truth(prepared, prepared.crop, prepared.overscan)
    seen = np.isin(truth.object_ids(truth.moment(0)), [i + 1 for i in instances])
    rows, columns = np.nonzero(seen)
    if not rows.size:
        raise InputError(f"--meter spot:{name}: this node is not in view")
    away = (rows - rows.mean()) ** 2 + (columns - columns.mean()) ** 2
    at = int(away.argmin())
    left, top = prepared.crop[:2]
    return left + float(columns[at]) + 0.5, top + float(rows[at]) + 0.5


def meter_picture(prepared: Prepared) -> Frame:
    """Draws the picture of a meter, without flare, scatter, crop or plate."""
    plan = plan_light(prepared, None)
    film, samples = (
        plan_film(prepared, plan).film(),
        (0, prepared.settings.sampling.most),
    )
    for part in plan.parts:
        part.draw(_core.render, prepared.core_scene, film, (0, 0), samples, None)
    facts = {"resolution": prepared.size, "crop": prepared.crop, **sensor_metadata(prepared.sensor)}
    return frame_of(film, facts, aovs=False)
