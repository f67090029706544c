"""Boards for camera calibration: checkerboards, ChArUco boards, grids of markers.

Corners are listed in the order in which OpenCV finds them, in m in the plane of the chart, y up;
OpenCV's boards have y down (``object_points``). The surroundings of a board are grey.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from daguerre.argument_checks import guarded
from daguerre.checks import number, rows, whole
from daguerre.errors import UsageError

from . import markers
from .chart import Chart, FloatArray, Patch, grey, rectangle

WHITE, SURROUND = 0.9, 0.18
PAPER_LAYER = 1


def checkerboard(columns: int = 10, rows: int = 7, square: float = 0.03) -> Chart:
    """Makes a checkerboard with a white margin and exactly known corners.

    The upper left square is black. Unless one of ``columns`` and ``rows`` is even and the other
    odd, the board looks the same upside down, and detectors cannot find its orientation.

    Args:
        columns: Number of squares across, 3 to 200.
        rows: Number of squares down, 3 to 200.
        square: Side of a square, m.
    """
    centers = _centers(columns, rows, square, 3)
    size = (square * (columns + 2), square * (rows + 2))
    black = _black_squares(centers, square)
    truth = _grid(columns, rows, square) | {"corners_m": _inner(centers, square).tolist()}
    return _board("checkerboard", size, black, truth)


def charuco(
    columns: int = 8,
    rows: int = 5,
    square: float = 0.04,
    marker: float = 0.75,
    dictionary: str = "5X5_250",
) -> Chart:
    """Makes a ChArUco board: a checkerboard with markers, so that a partial view suffices.

    Args:
        columns: Number of squares across, 2 to 200.
        rows: Number of squares down, 2 to 200.
        square: Side of a square, m.
        marker: Side of a marker as a share of a square's, 0.3 to 0.95.
        dictionary: OpenCV's name of the dictionary, such as 4X4_50 or DICT_6X6_250.
    """
    centers = _centers(columns, rows, square, 2)
    number(marker, "chart: marker", 0.3, 0.95)
    places = [(r, c) for r in range(rows) for c in range(columns) if (r + c) % 2]
    name, _ = markers.checked(dictionary, 0, len(places))
    size = (square * (columns + 1), square * (rows + 1))
    shown = _black_squares(centers, square)
    side, facts = marker * square, []
    for i, (r, c) in enumerate(places):
        shown += markers.patches(name, i, centers[r, c], side, 1, grey(WHITE))
        facts.append({"id": i, "corners_m": markers.corners(centers[r, c], side).tolist()})
    truth = _grid(columns, rows, square) | {
        "marker_m": side,
        "dictionary": name,
        "corners_m": _inner(centers, square).tolist(),
        "markers": facts,
    }
    return _board("charuco", size, shown, truth)


def apriltag(
    columns: int = 6,
    rows: int = 4,
    tag: float = 0.04,
    gap: float = 0.3,
    dictionary: str = "APRILTAG_36H11",
    first: int = 0,
    border: int = 1,
) -> Chart:
    """Makes a grid of tags on white, with ids from the upper left: AprilTag 36h11 or ArUco.

    Args:
        columns: Number of tags across, 1 to 100.
        rows: Number of tags down, 1 to 100.
        tag: Side of a tag with its black border, m.
        gap: Gap between tags as a share of a tag's side, 0.1 to 2.
        dictionary: OpenCV's name of the dictionary.
        first: Id of the first tag.
        border: Width of the black border around the bits, in bits, 1 to 4.
    """
    number(gap, "chart: gap", 0.1, 2)
    number(tag, "chart: tag", 1e-4, 1e3)
    border = whole(border, "chart: border", 1, 4)
    apart = tag * (1 + gap)
    centers = _centers(columns, rows, apart, 1, 100)
    name, first = markers.checked(dictionary, first, columns * rows)
    margin = max(gap, 0.3) * tag
    size = (apart * columns - gap * tag + 2 * margin, apart * rows - gap * tag + 2 * margin)
    shown: list[Patch] = []
    facts = []
    for i, center in enumerate(centers.reshape(-1, 2)):
        shown += markers.patches(name, first + i, center, tag, border, grey(WHITE))
        facts.append({"id": first + i, "corners_m": markers.corners(center, tag).tolist()})
    truth = {
        "columns": columns,
        "rows": rows,
        "tag_m": tag,
        "gap_m": gap * tag,
        "border_bits": border,
        "dictionary": name,
        "markers": facts,
    }
    return _board("apriltag", size, shown, truth)


@guarded
def object_points(points_m: ArrayLike) -> FloatArray:
    """Converts points of a chart to OpenCV's board frame: y down, z into the board, shape (N, 3).

    Args:
        points_m: Points in the chart's plane, y up, m, shape (N, 2).
    """
    points = rows(points_m, "object_points: points_m", 2)
    return np.column_stack([points[:, 0], -points[:, 1], np.zeros(len(points))])


def outline(chart: Chart) -> FloatArray:
    """Returns the corners of a board with its white margin, m, shape (4, 2)."""
    return rectangle((0, 0), chart.size)


def _centers(columns: int, rows: int, side: float, least: int, most: int = 200) -> FloatArray:
    """Centres of cells, shape (rows, columns, 2), from the upper left cell."""
    whole(columns, "chart: columns", least, most)
    whole(rows, "chart: rows", least, most)
    number(side, "chart: square", 1e-4, 1e3)
    x = side * (np.arange(columns) - (columns - 1) / 2)
    y = side * ((rows - 1) / 2 - np.arange(rows))
    return np.stack(np.meshgrid(x, y), axis=-1)


def _inner(centers: FloatArray, square: float) -> FloatArray:
    """Inner corners, row by row from the upper left, shape (N, 2)."""
    return np.asarray((centers[:-1, :-1] + [square / 2, -square / 2]).reshape(-1, 2))


def _black_squares(centers: FloatArray, square: float) -> list[Patch]:
    """Black squares: every other square, from the first."""
    rows, columns = centers.shape[:2]
    return [
        Patch("square", rectangle(centers[r, c], (square, square)), grey(0.0), markers.BLACK_LAYER)
        for r in range(rows)
        for c in range(columns)
        if (r + c) % 2 == 0
    ]


def _grid(columns: int, rows: int, square: float) -> dict[str, Any]:
    return {
        "columns": columns,
        "rows": rows,
        "inner_corners": [columns - 1, rows - 1],
        "square_m": square,
    }


def _board(
    name: str, size: tuple[float, float], shown: list[Patch], truth: dict[str, Any]
) -> Chart:
    if max(size) > 1e4:
        raise UsageError(f"chart: size: wanted at most 10 km, got a board of {max(size):g} m")
    paper = Patch("paper", rectangle((0, 0), size), grey(WHITE), PAPER_LAYER)
    return Chart(name, size, (paper, *shown), grey(SURROUND), truth)
