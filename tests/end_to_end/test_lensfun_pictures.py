"""A board photographed through a lens, corrected by lensfun with the lens's own profile."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import charts, export
from daguerre.export.lensfun.frame import PIXELS
from daguerre.export.lensfun.traced import SENSOR, STOP
from daguerre.lenses import load
from tests.support.lenses import lensfun

cv2 = pytest.importorskip("cv2", reason="opencv-python-headless is not installed")

SIZE, SPP = (1536, 1024), 24
CORNERS = (17, 11)  # of squares, over the frame
SQUARE = 100.0  # m, so that the pupil is a point


def photograph(name: str, focal_mm: float) -> np.ndarray:
    """A board that fills the frame, in red, green and blue of a sensor, shape (H, W, 3)."""
    board = charts.make("checkerboard", columns=CORNERS[0] + 1, rows=CORNERS[1] + 1, square=SQUARE)
    pose = np.eye(4)
    pose[2, 3] = (CORNERS[0] + 1.4) * SQUARE * focal_mm / 36
    camera = dg.Camera(
        lens=name,
        lens_model="exact",
        f_stop=STOP,
        focus_by="best",
        focus_distance=math.inf,
        sensor=SENSOR,
        sensor_size=(36, 24),
        transform=pose,
        **({"zoom": focal_mm} if load(name).zoom_range_mm else {}),
    )
    frame = dg.render(
        board.scene(1.0), camera, resolution=SIZE, spp=SPP, filter="box", max_depth=1, seed=3
    )
    assert frame.channels is not None
    return frame.channels


def corners(picture: np.ndarray) -> np.ndarray:
    """Corners of the board, px, shape (N, 2), the upper left first."""
    soft = cv2.GaussianBlur(picture, (0, 0), 1.0)
    soft = (np.clip(soft / soft.max(), 0, 1) * 255).astype(np.uint8)
    known, near = cv2.findChessboardCorners(soft, CORNERS)
    assert known
    fine = cv2.cornerSubPix(soft, near, (12, 12), (-1, -1), (3, 50, 1e-4))
    found = np.asarray(fine.reshape(-1, 2), np.float64)
    return found if found[0].sum() < found[-1].sum() else found[::-1]


def rms_px(misses: np.ndarray) -> float:
    """RMS length, px of 24 MP."""
    return math.sqrt((misses**2).sum(axis=1).mean() * PIXELS / math.prod(SIZE))


def residuals(picture: np.ndarray) -> tuple[float, float, float]:
    """Corners of green against an even grid; those of red, and of blue, against green's."""
    red, green, blue = (corners(np.ascontiguousarray(picture[..., k])) for k in range(3))
    grid = np.stack(np.meshgrid(*map(np.arange, CORNERS)), -1).reshape(-1, 2)
    grid = grid - grid.mean(axis=0)
    seen = green - green.mean(axis=0)
    even = grid * ((grid * seen).sum() / (grid**2).sum())
    return rms_px(seen - even), rms_px(red - green), rms_px(blue - green)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "focal_mm"),
    [("nikon-28mm-f2.8", 28.0), ("canon-ef-24-70mm-f2.8", 24.7), ("sigma-35mm-f1.4", 33.72)],
)
def test_a_rendered_grid_is_straight_and_without_fringes(name: str, focal_mm: float) -> None:
    read = lensfun.read(export.lensfun_profile(name))
    shown = photograph(name, focal_mm)
    at: Any = read.modifier(SIZE, focal_mm).apply_subpixel_geometry_distortion()
    straight = np.stack(
        [
            cv2.remap(shown[..., k], at[..., k, 0], at[..., k, 1], cv2.INTER_LANCZOS4)
            for k in range(3)
        ],
        axis=-1,
    )
    before, after = residuals(shown), residuals(straight)
    assert before[0] > 2
    assert after[0] < 0.3
    assert max(after[1:]) < 0.3
