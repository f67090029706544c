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
from .light_plan import film_layout, new_film, plan_light
from .picture_truth import ground_truth
from .prepare import Prepared

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame


def metered_point(
    one: Prepared, pattern: str, size: tuple[int, int] | None = None
) -> tuple[float, float] | None:
    """Point that a metering pattern looks at, px of a picture; None: the middle.

    Args:
        one: The picture.
        pattern: Metering pattern, such as ``spot:480,270`` or ``spot:NODE``.
        size: Size of the picture, px, of which ``spot:X,Y`` is a pixel; None: this one's.

    Raises:
        UsageError: The pixel is not in the picture.
        InputError: There is no such node, or it is not in view.
    """
    _, place = split_pattern(pattern)
    if not place:
        return one.camera.focus_at
    if (instances := _instances(one.scene, place)) is not None:
        return _seen_at(one, place, instances)
    width, height = size or one.size
    x, y = numbers("--meter spot", place, 2, "480,270, or the name of a node")
    if not (0 <= x < width and 0 <= y < height):
        raise UsageError(
            f"--meter spot:{place}: wanted a pixel of the picture of {width} x {height} px"
        )
    return (x + 0.5) * one.size[0] / width, (y + 0.5) * one.size[1] / height


def _instances(scene: Scene, name: str) -> list[int] | None:
    """Instances of a node; None: the text gives a pixel."""
    known = set(scene.nodes) | set(scene.node_positions)
    found = find_node(name, known)
    if found is not None:
        return list(scene.nodes.get(found, ()))
    if name[:1].isdigit() or "," in name:
        return None
    raise InputError(f"--meter spot: {no_node(name, known)}")


def _seen_at(one: Prepared, name: str, instances: list[int]) -> tuple[float, float]:
    """Pixel of a node that is nearest to the middle of its pixels."""
    truth = ground_truth(one, one.crop, one.overscan)
    seen = np.isin(truth.object_ids(truth.moment(0)), [i + 1 for i in instances])
    rows, columns = np.nonzero(seen)
    if not rows.size:
        raise InputError(f"--meter spot:{name}: this node is not in view")
    away = (rows - rows.mean()) ** 2 + (columns - columns.mean()) ** 2
    at = int(away.argmin())
    left, top = one.crop[:2]
    return left + float(columns[at]) + 0.5, top + float(rows[at]) + 0.5


def meter_picture(one: Prepared) -> Frame:
    """Draws the picture of a meter, without flare, scatter, crop or plate."""
    plan = plan_light(one, None)
    film, samples = new_film(one, film_layout(one, plan)), (0, one.settings.sampling.most)
    for part in plan.parts:
        part.draw(_core.render, one.core_scene, film, (0, 0), samples, None)
    facts = {"resolution": one.size, "crop": one.crop, **sensor_metadata(one.sensor)}
    return frame_of(film, facts, aovs=False)
