"""Sizes the stop of files that give the size of the beam instead."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from daguerre.lenses.errors import LensError, reported
from daguerre.lenses.json_lens import lens_of


@dataclass(frozen=True)
class Pupil:
    """Aperture of the axial beam.

    Attributes:
        kind: ``diameter`` of the entrance pupil (mm), ``f-number`` (focal length / diameter),
            ``working`` f-number at the file's object distance, or ``aperture``: sin of the angle
            at the object.
        value: Value of that kind.
    """

    kind: str
    value: float


def size_stops(data: dict[str, Any], file: str, pupils: list[Pupil | None]) -> None:
    """Writes the stop's semi-diameter into a lens file, for each configuration with a pupil.

    The entrance pupil is the stop's paraxial image, so its diameter goes with the stop's.
    """
    stops = [s for s in data["surfaces"] if s["kind"] == "stop" or s.get("stop")]
    if len(stops) != 1 or all(p is None for p in pupils):
        return
    sizes = []
    for configuration, pupil in zip(data["configurations"], pupils, strict=False):
        if pupil is None:
            sizes.append(configuration.get("stop_semi_diameter", stops[0]["semi_diameter"]))
            continue
        sizes.append(_semi_diameter(data, stops[0], file, configuration, pupil))
    stops[0]["semi_diameter"] = sizes[0]
    for configuration, size in zip(data["configurations"], sizes, strict=True):
        configuration.pop("stop_semi_diameter", None)
        if size is not None and size != sizes[0]:
            configuration["stop_semi_diameter"] = size


def _semi_diameter(
    data: dict[str, Any],
    stop: dict[str, Any],
    file: str,
    configuration: dict[str, Any],
    pupil: Pupil,
) -> float:
    probe = 1e-3
    stop_free = {**stop, "semi_diameter": probe}
    surfaces = [stop_free if s is stop else s for s in data["surfaces"]]
    bare = {k: v for k, v in configuration.items() if k != "stop_semi_diameter"}
    with reported(file):
        lens = lens_of({**data, "surfaces": surfaces, "configurations": [bare]}, file)
        order = lens.first_order()
    f, wanted = abs(order.efl), pupil.value
    distance = configuration["object_distance_mm"]
    if pupil.kind == "diameter":
        diameter = wanted
    elif pupil.kind == "f-number" or (pupil.kind == "working" and distance is None):
        diameter = f / wanted
    elif distance is None:
        raise LensError(
            f"{file}: aperture: wanted a finite object distance for an aperture in object space, "
            "got infinity",
            "lens-f-stop",
        )
    else:
        to_pupil = distance + order.entrance_pupil.z
        if pupil.kind == "aperture":
            diameter = 2 * abs(to_pupil) * math.tan(math.asin(min(wanted, 0.999)))
        else:  # the marginal ray leaves with slope 1 / (2 N), and enters with m = f / x times that
            diameter = abs(to_pupil * f / (distance + order.front_focal_point)) / wanted
    size = probe * diameter / order.entrance_pupil.diameter
    if not 0 < size < 1e5:
        raise LensError(
            f"{file}: aperture: wanted a stop of more than 0 and less than 1e5 mm, got {size:g} mm",
            "lens-f-stop",
        )
    return float(size)
