"""Test charts as scenes with ground truth, and measurements in pictures of them.

See ``docs/charts.md``.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable

from daguerre.argument_checks import guarded
from daguerre.checks import number, short
from daguerre.errors import UsageError, suggest

from . import boards, color, dead_leaves, siemens_star, slanted_edge, step_wedge
from .boards import object_points
from .chart import Chart, Patch
from .measure import EdgeResponse, edge_response, means, places, star_modulation, texture_response
from .poses import poses
from .row_time import RowTime, row_time

__all__ = [
    "KINDS",
    "Chart",
    "EdgeResponse",
    "Patch",
    "RowTime",
    "edge_response",
    "make",
    "means",
    "object_points",
    "places",
    "poses",
    "row_time",
    "star_modulation",
    "texture_response",
]

#: Functions that make charts, by name; their parameters are the chart's.
KINDS: dict[str, Callable[..., Chart]] = {
    "apriltag": boards.apriltag,
    "charuco": boards.charuco,
    "checkerboard": boards.checkerboard,
    "colour": color.make,
    "dead-leaves": dead_leaves.make,
    "siemens-star": siemens_star.make,
    "slanted-edge": slanted_edge.make,
    "step-wedge": step_wedge.make,
}


@guarded
def make(name: str, **parameters: object) -> Chart:
    """Makes a chart.

    Args:
        name: One of ``KINDS``.
        parameters: Parameters of that kind; all take ``width`` (m). See ``docs/charts.md``.

    Raises:
        UsageError: No such chart or parameter, or a value that makes none.
    """
    if name not in KINDS:
        raise UsageError(
            f"chart: wanted {', '.join(KINDS)}; got {short(name)}{suggest(name, KINDS)}"
        )
    known = inspect.signature(KINDS[name]).parameters
    for parameter in parameters:
        if parameter not in known:
            raise UsageError(
                f"chart {name}: parameter: wanted {', '.join(known)}; got {short(parameter)}"
                f"{suggest(parameter, known)}"
            )
    number(parameters.get("width", 1.0), "chart: width", 1e-4, 1e4)
    return KINDS[name](**parameters)
