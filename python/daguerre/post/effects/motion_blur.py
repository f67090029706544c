"""Motion blur of an instant, from motion vectors.

McGuire, Hennessy, Bukowski and Osman 2012 (A reconstruction filter for plausible motion blur)
gather along the fastest motion nearby. Here each pixel is spread along its motion, and near pixels
hide far pixels for as long as they cover them.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre._core import ShutterTime
from daguerre._core import motion_blur as spread_along
from daguerre.argument_checks import guarded
from daguerre.convolution.rows import Rows
from daguerre.errors import InputError
from daguerre.post import channels
from daguerre.post.array import on_array
from daguerre.post.by_four_channels import by_four_channels
from daguerre.post.effect import Effect, Step, Values
from daguerre.post.parameter import Parameter
from daguerre.post.picture import Band, Canvas, Image, RowSource, bands

Floats = NDArray[np.float32]
SCAN = 256  # rows
SKY = 1e9  # m
DEPTH_STEP = 0.08  # relative depth difference from which one surface hides another
SPEED_STEP = 0.5  # without depth: difference of asinh(speed in px)
#: Start of the exposure relative to the instant of a ground-truth picture, in exposure times.
OPENS = {"open": 0.0, "mid": -0.5, "close": -1.0}


class _MotionBlur(Step):
    def __init__(self, canvas: Canvas, values: Values) -> None:
        self._where = canvas.where
        self._next = [channels.find(canvas, role) for role in channels.roles_of("motion")]
        self._last = [name for name in channels.BACK if name in canvas.planes]
        self._depth = _depth_channel(canvas)
        self._scale = values["scale"] * np.array([1, -1 if values["v_up"] else 1], np.float32)
        exposure = values["shutter_angle"] / 360
        offset = values["shutter_offset"]
        if offset is None:
            offset = exposure * OPENS[str(canvas.facts.get("daguerre:gt_time", "mid"))]
        self._open, self._close = offset, offset + exposure
        self._arrived = _arrived(values)
        self._missing = 0

    def prepare(self, source: RowSource) -> None:
        """Finds the longest motion."""
        farthest = 0.0
        for band in bands(source, SCAN):
            ahead, back = self._motion(band)
            for flow, frames in self._ends(ahead, back):
                farthest = max(farthest, abs(frames) * float(np.hypot(*flow.T).max()))
            u, v = (np.asarray(band.planes[name]) for name in self._next)
            self._missing += int((~np.isfinite(u) | ~np.isfinite(v)).sum())
        largest = 1e4
        if farthest > largest:
            raise InputError(
                f"{self._where}: motion: wanted at most {largest:g} px during the exposure, "
                f"got {farthest:.4g} px"
            )
        self.reach = 5 * math.ceil(farthest) + 8  # incl. the mirrored background behind edges
        self.block = max(SCAN, self.reach // SCAN * SCAN)

    def _ends(self, ahead: Floats, back: Floats) -> list[tuple[Floats, float]]:
        return [(ahead if t > 0 else back, t) for t in (self._open, self._close)]

    def _motion(self, band: Band) -> tuple[Floats, Floats]:
        """Motion to the next frame and to the previous frame, px; 0 where it is unknown."""
        ahead = self._flow(band, self._next)
        back = self._flow(band, self._last) if len(self._last) == 2 else -ahead
        ahead = np.where(np.isfinite(ahead), ahead, -back)
        back = np.where(np.isfinite(back), back, -ahead)
        known = np.isfinite(ahead).all(axis=2, keepdims=True) & np.isfinite(back).all(
            axis=2, keepdims=True
        )
        return np.where(known, ahead, 0), np.where(known, back, 0)

    def _flow(self, band: Band, names: list[str]) -> Floats:
        flow = np.stack([np.asarray(band.planes[name], np.float32) for name in names], axis=2)
        return np.asarray(flow * self._scale, np.float32)

    def _nearness(self, band: Band, ahead: Floats, back: Floats) -> tuple[Floats, float]:
        """Nearness, and the difference that hides; by depth, else faster pixels hide slower."""
        if self._depth is None:
            way = sum(abs(t) * np.hypot(*flow.T).T for flow, t in self._ends(ahead, back))
            return np.asarray(np.arcsinh(way), np.float32), SPEED_STEP
        depth = np.abs(np.asarray(band.planes[self._depth], np.float32))
        depth = np.where(np.isfinite(depth) & (depth > 0), depth, np.float32(SKY))
        return -np.log(np.clip(depth, 1e-6, SKY)).astype(np.float32), DEPTH_STEP

    def apply(self, band: Band, rows: Rows) -> Band:
        ahead, back = (np.ascontiguousarray(flow, np.float32) for flow in self._motion(band))
        nearness, step = self._nearness(band, ahead, back)
        inside = (rows.begin - band.rows.begin, rows.end - band.rows.begin)
        shutter = ShutterTime(self._open, self._close, self._arrived)

        def spread(four: Image) -> Image:
            out: Image = spread_along(
                four, ahead, back, np.ascontiguousarray(nearness), step, shutter, inside
            )
            return out

        return band.cut(rows).with_image(by_four_channels(band.image, spread))

    def remarks(self) -> list[str]:
        said = []
        if self._depth is None:
            said.append(
                "no depth channel: faster pixels are taken to be in front of slower ones "
                "(--channel depth=NAME sets one)"
            )
        if self._missing:
            said.append(
                f"{self._missing} pixels have no motion to the next frame (NaN) and are not moved"
            )
        return said


def _depth_channel(canvas: Canvas) -> str | None:
    """Depth channel; None: the picture has none. A channel that the user named must exist."""
    try:
        return channels.find(canvas, "depth")
    except InputError:
        if "depth" in canvas.roles:
            raise
        return None


def _arrived(values: Values) -> list[float]:
    """Share of the light that has arrived after equal parts of the exposure time."""
    if values["shutter_curve"] == "box":
        return [0.0, 1.0]
    ramp = 1 - values["efficiency"]  # length of the flanks that gives this mean opening
    t = np.linspace(0, 1, 513)
    opening = np.clip(np.minimum(t, 1 - t) / max(ramp, 1e-9), 0, 1)
    total = np.concatenate([[0], np.cumsum(0.5 * (opening[1:] + opening[:-1]))])
    return [float(v) for v in total / total[-1]]


MOTION_BLUR = Effect(
    "motion-blur",
    "motion blur from motion vectors, for pictures of one instant",
    (
        Parameter(
            "shutter_angle", "exposure time; 360 is one frame", "deg", 180.0, low=0, high=36000
        ),
        Parameter(
            "shutter_offset",
            "start of the exposure after the picture's instant; default: centred on it",
            "frames",
        ),
        Parameter(
            "shutter_curve",
            "opening of the shutter over time",
            kind="choice",
            default="box",
            choices=("box", "trapezoid"),
        ),
        Parameter("efficiency", "mean opening of a trapezoid", "", 0.8, low=0.5, high=1),
        Parameter(
            "scale", "px per frame and unit of motion; -1: motion from the previous frame", "", 1.0
        ),
        Parameter("v_up", "whether v is positive upward, not downward", kind="flag", default=False),
    ),
    _MotionBlur,
    needs=("motion",),
)


@guarded(arrays=False)
def motion_blur(
    image: Image, motion: NDArray[Any], depth: NDArray[Any] | None = None, **parameters: object
) -> Image:
    """Adds motion blur to a scene-linear picture of one instant.

    Args:
        image: Picture, shape (H, W, C), any channels.
        motion: Motion to the next frame, px to the right and down, shape (H, W, 2); with motion
            back to the previous frame, shape (H, W, 4). Pixels with motion that is not finite do
            not move.
        depth: Depth along the axis or the ray, shape (H, W), m; 0, infinity and NaN mean sky.
            Without depth, faster pixels hide slower pixels.
        **parameters: Parameters of the effect ``motion-blur``: ``shutter_angle`` (deg; 360 is one
            frame), ``shutter_offset`` (frames), ``shutter_curve`` ("box" or "trapezoid"),
            ``efficiency``, ``scale``, ``v_up``.

    Raises:
        UsageError: A parameter or a shape is wrong.
        InputError: ``motion`` has another shape, or moves pixels by more than 10000 px.
    """
    flow = np.asarray(motion)
    names = ("motion.U", "motion.V", "motion_back.U", "motion_back.V")
    if flow.ndim != 3 or flow.shape[2] not in (2, 4):
        raise InputError(f"motion-blur: motion: wanted shape (H, W, 2 or 4), got {flow.shape}")
    planes = {name: flow[:, :, k] for k, name in enumerate(names[: flow.shape[2]])}
    if depth is not None:
        planes["depth.Z"] = np.asarray(depth)
    return on_array(MOTION_BLUR, image, parameters, planes)
