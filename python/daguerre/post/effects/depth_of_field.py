"""Depth of field for pinhole pictures, from a depth channel."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre import units
from daguerre._core import defocus
from daguerre.argument_checks import guarded
from daguerre.convolution.rows import Rows
from daguerre.errors import InputError, UsageError
from daguerre.post import channels
from daguerre.post.array import on_array
from daguerre.post.by_four_channels import by_four_channels
from daguerre.post.effect import Effect, Step, Values
from daguerre.post.iris import BLADES, iris_shape
from daguerre.post.optics import FOCAL_LENGTH, SENSOR, film_plane, focal_length_mm, offsets
from daguerre.post.parameter import Parameter
from daguerre.post.picture import Band, Canvas, Image, RowSource, bands

Floats = NDArray[np.float32]
SCAN = 256  # rows


@dataclass(frozen=True)
class ThinLens:
    """A thin lens: the quantities that set the size of the blur.

    Attributes:
        aperture_mm: Diameter of the entrance pupil.
        film_mm: Distance of the film, as for a pinhole with the same field of view.
        focus_m: Distance in focus, from the entrance pupil along the axis.
    """

    aperture_mm: float
    film_mm: float
    focus_m: float

    def radius_mm(self, depth_m: Floats) -> Floats:
        """Radius of the circle of confusion on the film, mm; negative behind the focus.

        A point at distance s along the axis has the radius A F (1/s - 1/s_f) / 2, by similar
        triangles. If F is the image distance f s_f / (s_f - f), the diameter is
        |s - s_f| / s  f^2 / (N (s_f - f)). A thick lens follows the same law with distances from
        its entrance pupil.
        """
        scale = 0.5e-3 * self.aperture_mm * self.film_mm
        with np.errstate(divide="ignore"):
            return np.asarray(scale * (1 / depth_m - 1 / self.focus_m), np.float32)


def thin_lens(canvas: Canvas, values: Values) -> ThinLens:
    """Makes the lens from the parameters, else from the file's metadata.

    Raises:
        UsageError: A value is in neither, or the focus is within the focal length.
    """
    focal = focal_length_mm(canvas, values)
    f_stop = _given(canvas, values, "f_stop", "aperture", "the f-number, such as f_stop=2.8")
    focus = _given(canvas, values, "focus", "focus", "the distance in focus, such as focus=2.5m")
    if focus * 1e3 <= focal:
        raise UsageError(
            f"depth-of-field: focus: wanted a distance beyond the focal length of {focal:g} mm, "
            f"got {focus * 1e3:g} mm"
        )
    breathes = values["focus_breathing"] and math.isfinite(focus)
    film = focal / (1 - focal * 1e-3 / focus) if breathes else focal
    return ThinLens(focal / f_stop, film, focus)


def _given(canvas: Canvas, values: Values, name: str, fact: str, wanted: str) -> float:
    value = values[name] if values[name] is not None else canvas.facts.get(fact)
    if isinstance(value, int | float) and value > 0:
        return float(value)
    raise UsageError(f"{canvas.where}: {name}: the file has none; give {wanted}")


class _DepthOfField(Step):
    def __init__(self, canvas: Canvas, values: Values) -> None:
        self._canvas = canvas
        self._plane = channels.find(canvas, "depth")
        self._along_ray = values["depth_along"] == "ray"
        self._lens = thin_lens(canvas, values)
        self._film = film_plane(canvas, values)
        self._iris = iris_shape(values)
        largest = values["largest"]
        self._largest = float(0.1 * canvas.full_size[0] if largest is None else largest)
        self._held = self._unknown = 0

    def prepare(self, source: RowSource) -> None:
        """Finds the largest blur, and counts pixels without a depth."""
        low = high = 0.0
        for band in bands(source, SCAN):
            radius = self._radii(band)
            self._check(band)
            self._held += int((np.abs(radius) >= self._largest).sum())
            low = min(low, float(np.nanmin(radius, initial=0)))
            high = max(high, float(np.nanmax(radius, initial=0)))
        rim = self._iris.outer_radius
        deepest = rim * (high - low) + 2  # behind edges, where the background is mirrored
        self.reach = math.ceil(rim * max(high, -low) + 2 * deepest) + 4
        self.block = max(SCAN, self.reach // SCAN * SCAN)

    def _check(self, band: Band) -> None:
        depth = band.planes[self._plane]
        self._unknown += int(np.isnan(depth).sum())
        wrong = np.argwhere(depth < 0)
        if wrong.size:
            y, x = wrong[0]
            raise InputError(
                f"{self._canvas.where}: {self._plane}: wanted distances of at least 0 m "
                f"(0 or infinity: the sky), got {depth[y, x]:g} at pixel "
                f"{x}, {band.rows.begin + y}"
            )

    def _radii(self, band: Band) -> Floats:
        """Radius of the blur, px; a depth of 0 or NaN is the sky."""
        depth = np.asarray(band.planes[self._plane], np.float32)
        depth = np.where(np.isnan(depth) | (depth == 0), np.float32(np.inf), depth)
        if self._along_ray:
            x, y = offsets(self._canvas, band.rows, self._film.center)
            slope = np.hypot(x, y) * np.float32(self._film.pitch_mm / self._lens.film_mm)
            depth = np.asarray(depth / np.hypot(1, slope), np.float32)
        radius = self._lens.radius_mm(depth) / np.float32(self._film.pitch_mm)
        return np.asarray(np.clip(radius, -self._largest, self._largest), np.float32)

    def apply(self, band: Band, rows: Rows) -> Band:
        radius = np.ascontiguousarray(self._radii(band))
        inside = (rows.begin - band.rows.begin, rows.end - band.rows.begin)
        image = by_four_channels(band.image, lambda four: defocus(four, radius, self._iris, inside))
        return band.cut(rows).with_image(image)

    def remarks(self) -> list[str]:
        said = []
        if self._held:
            said.append(
                f"{self._held} pixels are blurred less than by the lens: their blur radius was "
                f"limited to {self._largest:g} px (largest=)"
            )
        if self._unknown:
            said.append(f"{self._unknown} pixels without a depth (NaN) are taken as sky")
        return said


DEPTH_OF_FIELD = Effect(
    "depth-of-field",
    "depth of field from a depth channel, for pinhole pictures",
    (
        Parameter(
            "f_stop",
            "f-stop; default: from the file",
            low=1e-2,
            high=1e9,
            parse=units.f_number,
            wants=units.F_NUMBER,
        ),
        Parameter("focus", "focus distance along the axis; default: from the file", "m", low=1e-6),
        FOCAL_LENGTH,
        SENSOR,
        *BLADES,
        Parameter(
            "depth_along",
            "how depth is measured: along the axis (as in depth.Z) or along the ray (distance.Z)",
            kind="choice",
            default="axis",
            choices=("axis", "ray"),
        ),
        Parameter(
            "focus_breathing",
            "whether the field of view narrows with focus, as in real cameras",
            kind="flag",
            default=False,
        ),
        Parameter("largest", "largest blur radius; default: a tenth of the width", "px", low=0),
    ),
    _DepthOfField,
    needs=("depth",),
)


@guarded(arrays=False)
def depth_of_field(image: Image, depth: NDArray[Any], **parameters: object) -> Image:
    """Adds depth of field to a scene-linear pinhole picture, by the depth of its pixels.

    Near surfaces hide far surfaces by the share of the lens that they cover. The background behind
    their blurred edges is filled in from beside them. A plane at one depth is convolved with the
    iris.

    Args:
        image: Picture, shape (H, W, C), any channels.
        depth: Depth, shape (H, W), m; 0, infinity and NaN mean sky.
        **parameters: Parameters of the effect ``depth-of-field``: ``focal_length`` (mm),
            ``f_stop``, ``focus`` (m), ``sensor`` (mm, mm), ``blades``, ``blade_rotation`` (deg),
            ``blade_curvature``, ``aperture_image``, ``depth_along`` ("axis" or "ray"),
            ``focus_breathing``, ``largest`` (px).

    Raises:
        UsageError: A parameter is missing or wrong, or ``depth`` has another shape.
        InputError: A depth is negative.
    """
    return on_array(DEPTH_OF_FIELD, image, parameters, {"depth.Z": np.asarray(depth)})
