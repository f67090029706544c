"""Projection models: cameras given by a calibration or a formula instead of a lens.

Parameters follow calibration files: focal lengths and principal point in pixels, y down, and
**pixel centres at integers** as in OpenCV (the centre of the upper left pixel is (0, 0)).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.cached import cached_property
from daguerre.checks import number, numbers, short, to_numbers, whole
from daguerre.errors import UsageError, core_errors, suggest
from daguerre.files.value import Value

FloatArray = NDArray[np.float64]

#: Names of the parameters of each model, in order; those not given are 0.
MODELS: dict[str, tuple[str, ...]] = {
    "rectilinear": (),
    "equidistant": (),
    "equisolid": (),
    "stereographic": (),
    "orthographic": (),
    "equirectangular": (),
    "cube": (),
    "opencv": (
        *("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"),
        *("s1", "s2", "s3", "s4", "tilt_x", "tilt_y"),
    ),
    "kannala_brandt": ("k1", "k2", "k3", "k4"),
    "double_sphere": ("xi", "alpha"),
    "eucm": ("alpha", "beta"),
    "omni": ("xi", "k1", "k2", "p1", "p2"),
    "fov": ("w",),
    "opencv_inverse": ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"),
    "ftheta": ("k2", "k3", "k4", "k5"),
}
#: Number of parameters that must be given, for models that do not project with all of them 0.
NEEDED = {"double_sphere": 2, "eucm": 2, "omni": 1, "fov": 1}


@guarded
@dataclass(frozen=True)
class Projection(Value):
    """Projection of directions to pixels: a camera model with its parameters.

    Attributes:
        model: One of ``MODELS``.
        size: Width and height of the picture that the parameters refer to, px. Rendering may use
            any size of the same aspect ratio.
        focal: Focal lengths along x and y, px; for ``equirectangular`` pixels per radian, for
            ``cube`` pixels per side of a face.
        principal: Principal point, where the axis meets the picture, px; None: the middle.
        parameters: Parameters of the model; see ``MODELS``.
    """

    model: str
    size: tuple[int, int]
    focal: tuple[float, float]
    principal: tuple[float, float] | None = None
    parameters: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        where = "projection"
        if str(self.model) not in MODELS:
            raise UsageError(
                f"{where}: model: wanted {', '.join(MODELS)}; got {short(self.model)}"
                f"{suggest(str(self.model), MODELS)}"
            )
        wanted = "two whole numbers of pixels"
        width, height = numbers(self.size, f"{where}: size", 2, wanted)
        for side in (width, height):
            whole(int(side) if side == int(side) else side, f"{where}: size", 1, 65536)
        focal = numbers(self.focal, f"{where}: focal", 2, "two focal lengths, px")
        for value in focal:
            number(value, f"{where}: focal", 0, 1e9, above=0)
        if self.principal is not None:
            point = numbers(self.principal, f"{where}: principal", 2, "a point (x, y), px")
            object.__setattr__(self, "principal", point)
        names = MODELS[self.model]
        least = NEEDED.get(self.model, 0)
        given = to_numbers(self.parameters, where, "parameters", "numbers", UsageError)
        if given.ndim != 1 or not least <= given.size <= len(names):
            raise UsageError(
                f"{where}: parameters: {self.model} has {', '.join(names) or 'none'}; wanted "
                f"{least} to {len(names)} numbers, got shape {given.shape}"
            )
        object.__setattr__(self, "size", (int(width), int(height)))
        object.__setattr__(self, "focal", focal)
        object.__setattr__(self, "parameters", tuple(float(k) for k in given))
        with core_errors(UsageError):
            _ = self.core

    @classmethod
    def of_field(
        cls, model: str, size: tuple[int, int], field: float, parameters: Sequence[float] = ()
    ) -> Projection:
        """Makes a projection from its horizontal field of view, with the axis in the middle.

        Args:
            model: One of ``MODELS``.
            size: Width and height of the picture, px.
            field: Horizontal field of view, degrees; ignored for ``cube``, with six faces across
                the width.
            parameters: Parameters of the model.

        Raises:
            UsageError: The field is larger than the model allows.
        """
        width, height = numbers(size, "projection: size", 2, "two whole numbers of pixels")
        if model == "cube":
            return cls(model, size, (width / 6, min(height, width / 6)), None, tuple(parameters))
        number(field, "projection: field", 0, 360, above=0)
        unit = cls(model, size, (1.0, 1.0), None, tuple(parameters))
        half = math.radians(field) / 2
        edge = unit.core.project(np.array([[math.sin(half), 0.0, math.cos(half)]]))[0, 0]
        if math.isnan(edge) or edge <= 0:
            raise UsageError(
                f"projection: field: {model} sees up to {2 * unit.largest_angle:.4g} degrees, got "
                f"{field:g}"
            )
        focal = width / 2 / edge
        return cls(model, size, (focal, focal), None, tuple(parameters))

    @cached_property
    def core(self) -> _core.ProjectionModel:
        """Model of the core, in units of the focal length."""
        return _core.ProjectionModel(self.model, [float(k) for k in self.parameters])

    @property
    def center(self) -> tuple[float, float]:
        """Principal point, px."""
        width, height = self.size
        return self.principal or ((width - 1) / 2, (height - 1) / 2)

    @property
    def largest_angle(self) -> float:
        """Largest angle from the axis at which the model is valid, degrees."""
        return math.degrees(self.core.largest_angle)

    @property
    def is_wide(self) -> bool:
        """Whether the field may reach 180 degrees or more."""
        return bool(self.core.is_wide)

    def field_of_view(self) -> tuple[float, float, float]:
        """Horizontal, vertical and diagonal field of view, degrees; NaN where nothing is seen.

        Each is the sum of the angles between the axis and two opposite edges or corners; for a
        panorama, the full turn.
        """
        (width, height), (x, y) = self.size, self.center
        left, right, top, bottom = -0.5, width - 0.5, -0.5, height - 0.5
        ends = [[left, y], [right, y], [x, top], [x, bottom], [left, top], [right, bottom]]
        if self.model in ("equirectangular", "cube"):
            return (360.0, 180.0, 360.0)
        seen = self.unproject(ends)
        angles = np.degrees(np.arctan2(np.hypot(seen[:, 0], seen[:, 1]), seen[:, 2]))
        across, down, diagonal = (float(a) for a in angles.reshape(3, 2).sum(axis=1))
        return across, down, diagonal

    @property
    def form(self) -> tuple[str, tuple[int, int]]:
        """Model and size, which all keys over time must share."""
        return self.model, self.size

    def blended(self, other: Projection, share: float) -> Projection:
        """Interpolates each parameter toward another projection of the same form."""

        def mix(a: Sequence[float], b: Sequence[float]) -> tuple[float, ...]:
            both = zip_longest(a, b, fillvalue=0.0)  # parameters that are not given are 0
            return tuple(x + share * (y - x) for x, y in both)

        focal, center = mix(self.focal, other.focal), mix(self.center, other.center)
        parameters = mix(self.parameters, other.parameters)
        return Projection(
            self.model, self.size, (focal[0], focal[1]), (center[0], center[1]), parameters
        )

    def project(self, points: ArrayLike) -> FloatArray:
        """Projects points in the camera's frame (x right, y down, z ahead) to pixels.

        Args:
            points: Shape (N, 3), of any unit.

        Returns:
            Shape (N, 2), px; NaN outside of the model's valid field.
        """
        given = _rows(points, 3)
        return np.asarray(self.core.project(given) * self.focal + self.center)

    def unproject(self, pixels: ArrayLike) -> FloatArray:
        """Returns the unit directions of pixels (x right, y down, z ahead); NaN: none.

        Args:
            pixels: Shape (N, 2), pixel centres at integers.

        Returns:
            Shape (N, 3).
        """
        given = (_rows(pixels, 2) - self.center) / self.focal
        return np.asarray(self.core.unproject(np.ascontiguousarray(given)))

    def film(self, width_mm: float) -> dict[str, Any]:
        """Focal lengths and principal point on a film of this width, mm, upright.

        Pixel centres are at integers in a projection, and at halves in a picture.
        """
        pitch = width_mm / self.size[0]
        x, y = self.center
        return {
            "focal_mm": tuple(f * pitch for f in self.focal),
            "principal_mm": (
                (x + 0.5 - self.size[0] / 2) * pitch,
                (self.size[1] / 2 - y - 0.5) * pitch,
            ),
        }

    def facts(self) -> dict[str, Any]:
        """Facts for metadata and hashes."""
        return {
            "model": self.model,
            "size": list(self.size),
            "focal_px": list(self.focal),
            "principal_px": list(self.center),
            "parameters": list(self.parameters),
        }


def check_resolution(projection: Projection, resolution: tuple[int, int]) -> None:
    """Checks that a picture has the aspect ratio of the calibration.

    Raises:
        UsageError: The aspect ratios differ.
    """
    (width, height), (columns, rows) = projection.size, resolution
    if abs(rows - columns * height / width) > 0.5:
        raise UsageError(
            f"projection: its picture is {width} x {height}: wanted a resolution with its "
            f"aspect ratio, such as {columns} x {round(columns * height / width)}, got "
            f"{columns} x {rows}"
        )


def _rows(values: ArrayLike, columns: int) -> FloatArray:
    given = to_numbers(values, "projection", "points", f"shape (N, {columns})", UsageError)
    if given.ndim != 2 or given.shape[1] != columns:
        raise UsageError(f"projection: points: wanted shape (N, {columns}), got {given.shape}")
    return np.ascontiguousarray(given, np.float64)
