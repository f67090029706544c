"""Light profiles: how the light of a lamp depends on direction, on the photometric sphere.

Directions are in the lamp's frame; it shines along -z. theta is the angle from -z, the nadir of a
hanging lamp. phi is the angle from +x toward +y: counter-clockwise, seen along -z.
Source: IES LM-63-2019, type C photometry.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.cached import cached_property
from daguerre.checks import array, as_readonly, color, number, short, to_numbers
from daguerre.color.spectra import luminance_of_rgb
from daguerre.errors import InputError, core_errors
from daguerre.files import formats
from daguerre.files.value import FixedArrays, Value

from .photometric_circle import whole_circle

Color = tuple[float, float, float]
#: Maximum number of values of a table.
MAX_VALUES = 1 << 20
#: Range of theta up to which a table is one of a hemisphere; hdEmbree's limit (see ``normalized``).
_HEMISPHERE_DEG = 90 + math.degrees(0.1)


@dataclass(frozen=True, eq=False)
class ProfileCone(Value):
    """Cutoff at ``angle`` degrees off the axis, smooth over the share ``softness`` of it."""

    angle: float
    softness: float = 0.0


@dataclass(frozen=True, eq=False)
class ProfileFocus(Value):
    """Factor c + ``tint`` (1 - c), with c = |cos theta|^exponent."""

    exponent: float
    tint: Color = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class ProfileTable(FixedArrays):
    """Values at theta (T,) and phi (P,) in degrees, shape (T, P); phi covers the circle."""

    theta_deg: NDArray[np.float64]
    phi_deg: NDArray[np.float64]
    values: NDArray[np.float32]


Part = ProfileCone | ProfileFocus | ProfileTable


@guarded
@dataclass(frozen=True, eq=False)
class LightProfile(Value):
    """Factor on a lamp's light by direction, for ``profile`` of lights and materials.

    ``LightProfile.from_ies``, ``table``, ``cone`` and ``focus`` make profiles, and ``*`` multiplies
    them. A factor of 1 leaves the light as it is. An IES file gives candelas, so a ``PointLight``
    of 1 cd with its profile is the luminaire that was measured.

    Attributes:
        parts: Factors by direction, which are multiplied.
        scale: Number that multiplies them.
    """

    parts: tuple[Part, ...] = ()
    scale: float = 1.0

    def __post_init__(self) -> None:
        given: object = self.parts
        if not isinstance(given, tuple) or not all(isinstance(part, Part) for part in given):
            raise InputError(f"light profile: parts: wanted a tuple of parts, got {short(given)}")
        number(self.scale, "light profile: scale", 0, error=InputError)
        with core_errors(InputError):
            _ = self.core

    def __repr__(self) -> str:
        names = [type(part).__name__.removeprefix("Profile").lower() for part in self.parts]
        return f"<LightProfile {' x '.join(names) or 'even'}: peak {self.peak:g}>"

    def __hash__(self) -> int:
        return hash((self.scale, len(self.parts), self.peak))

    @classmethod
    def table(
        cls, theta_deg: ArrayLike, values: ArrayLike, phi_deg: ArrayLike | None = None
    ) -> LightProfile:
        """Makes a profile of a table; it is bilinear between angles, and 0 beyond the given theta.

        Args:
            theta_deg: Angles from the axis -z, rising, in [0, 180], shape (T,), degrees.
            values: Factors of at least 0, shape (T, P), or (T,) without ``phi_deg``.
            phi_deg: Angles about the axis, rising, shape (P,), degrees. A range of 0 .. 90,
                0 .. 180 or 90 .. 270 is completed by symmetry as in LM-63.

        Raises:
            InputError: A shape, an angle or a value is wrong.
        """
        where = "light profile"
        theta = _line(theta_deg, f"{where}: theta_deg")
        given = to_numbers(values, where, "values", "numbers of shape (T, P)").astype(np.float64)
        phi = np.zeros(1) if phi_deg is None else _line(phi_deg, f"{where}: phi_deg")
        given = given[:, None] if given.ndim == 1 and phi_deg is None else given
        if given.shape != (len(theta), len(phi)):
            wanted = (len(theta), len(phi))
            raise InputError(f"{where}: values: wanted shape {wanted}, got {given.shape}")
        if given.size > MAX_VALUES:
            raise InputError(f"{where}: values: wanted at most {MAX_VALUES}, got {given.size}")
        phi, given = whole_circle(phi, given, f"{where}: phi_deg")
        with np.errstate(over="ignore"):
            single = as_readonly(given, np.float32)
        return cls((ProfileTable(as_readonly(theta), as_readonly(phi), single),))

    @classmethod
    def from_ies(cls, path: str | os.PathLike[str]) -> LightProfile:
        """Reads a photometric file, IES LM-63-1986 to -2019, type C; the factors are candelas.

        Raises:
            InputError: It cannot be used; the message names the line.
        """
        return formats.read("profile", path)  # type: ignore[no-any-return]

    @classmethod
    def cone(cls, angle: float, softness: float = 0.0) -> LightProfile:
        """Makes a cone: no light leaves at more than ``angle`` from the axis.

        Args:
            angle: Angle from the axis, in (0, 180], degrees.
            softness: Share of the angle over which light falls to 0, smoothly; 0 is a hard edge.

        Source: UsdLux ShapingAPI, ``shaping:cone:angle`` and ``shaping:cone:softness``.
        """
        number(angle, "light profile: cone: angle", above=0, high=180, error=InputError)
        number(softness, "light profile: cone: softness", 0, 1, error=InputError)
        return cls((ProfileCone(float(angle), float(softness)),))

    @classmethod
    def focus(cls, exponent: float, tint: Color = (0.0, 0.0, 0.0)) -> LightProfile:
        """Makes a focus: the factor c + tint (1 - c), with c = |cos theta|^exponent.

        Source: UsdLux ShapingAPI, ``shaping:focus`` and ``shaping:focusTint``.
        """
        number(exponent, "light profile: focus: exponent", 0, error=InputError)
        return cls((ProfileFocus(float(exponent), color(tint, "light profile: focus: tint")),))

    def __mul__(self, other: LightProfile | float) -> LightProfile:
        """Multiplies by another profile, or by a number."""
        if isinstance(other, LightProfile):
            return LightProfile(self.parts + other.parts, self.scale * other.scale)
        return replace(self, scale=self.scale * number(other, "light profile: factor", 0))

    __rmul__ = __mul__

    @cached_property
    def core(self) -> _core.LightProfile:
        """Profile of the core."""
        cones, focuses, tables = [], [], []
        for part in self.parts:
            if isinstance(part, ProfileCone):
                cones.append((math.radians(part.angle), part.softness))
            elif isinstance(part, ProfileFocus):
                focuses.append((part.exponent, part.tint))
            else:
                theta, phi = np.radians(part.theta_deg), np.radians(part.phi_deg)
                tables.append((theta.astype(np.float32), phi.astype(np.float32), part.values))
        return _core.LightProfile.make(self.scale, cones, focuses, tables)

    def factors(self, directions: ArrayLike) -> NDArray[np.float32]:
        """Factors on light that leaves along directions.

        Args:
            directions: Directions in the lamp's frame, shape (N, 3), of any length above 0.

        Returns:
            Factors on linear RGB, shape (N, 3).
        """
        given = array(directions, "light profile", "directions", 3)
        if not (np.linalg.norm(given, axis=1) > 0).all():
            raise InputError("light profile: directions: wanted lengths above 0, got 0")
        return np.asarray(self.core.factors(given))

    @property
    def peak(self) -> float:
        """Largest factor; of an IES file in cd."""
        return float(self.core.peak)

    @property
    def mean(self) -> Color:
        """Mean factor over all directions, of linear RGB."""
        red, green, blue = self.core.mean
        return red, green, blue

    @property
    def power(self) -> float:
        """Luminous flux of a white lamp of 1 cd with the profile, lm."""
        return float(4 * math.pi * (luminance_of_rgb() @ np.asarray(self.mean)))

    def relative(self) -> LightProfile:
        """Scales the profile to a peak of 1; a dark one stays dark."""
        return self * (1 / self.peak) if self.peak > 0 else self

    def normalized(self) -> LightProfile:
        """Scales the profile to a mean of 1, so that the lamp keeps its power.

        The mean is that over the sphere, or over a hemisphere if tables cover no more than one.
        Source: UsdLux ShapingAPI, ``shaping:ies:normalize``; that its power is a mean, and when
        of a hemisphere, is from OpenUSD's hdEmbree (``pxrIES``).
        """
        tables = [part for part in self.parts if isinstance(part, ProfileTable)]
        ranges = [float(part.theta_deg[-1] - part.theta_deg[0]) for part in tables]
        share = 0.5 if any(extent <= _HEMISPHERE_DEG for extent in ranges) else 1.0
        mean = self.power / (4 * math.pi * share)
        return self * (1 / mean) if mean > 0 else self

    def stretched(self, angle_scale: float) -> LightProfile:
        """Stretches the tables over theta by a factor, from -z or, if it is negative, from +z.

        0 leaves them as they are. Source: UsdLux ShapingAPI, ``shaping:ies:angleScale``.
        """
        number(angle_scale, "light profile: angle_scale", error=InputError)
        if angle_scale == 0:
            return self
        parts = (
            _stretched(p, angle_scale) if isinstance(p, ProfileTable) else p for p in self.parts
        )
        return replace(self, parts=tuple(parts))


def _line(values: ArrayLike, where: str) -> NDArray[np.float64]:
    numbers = to_numbers(values, where, "angles", "shape (N,)").astype(np.float64)
    if numbers.ndim != 1 or not numbers.size or not np.isfinite(numbers).all():
        raise InputError(f"{where}: wanted finite angles of shape (N,), got {short(values)}")
    if not (np.diff(numbers) > 0).all():
        raise InputError(f"{where}: wanted increasing angles, got {short(values)}")
    return numbers


def _stretched(table: ProfileTable, scale: float) -> ProfileTable:
    """Scales the theta of a table about its origin; angles beyond the poles are cut off."""
    theta = table.theta_deg
    moved = theta * scale if scale > 0 else 180 + (theta - 180) * -scale
    ends = np.clip(moved[[0, -1]], 0.0, 180.0)
    inside = moved[(moved > ends[0]) & (moved < ends[1])]
    cut = np.concatenate([ends[:1], inside, ends[1:]]) if ends[1] > ends[0] else ends[:1]
    columns = [np.interp(cut, moved, column) for column in table.values.T.astype(np.float64)]
    values = np.stack(columns, axis=1) * float(moved[-1] >= 0 and moved[0] <= 180)
    return ProfileTable(as_readonly(cut), table.phi_deg, as_readonly(values, np.float32))


def check_profile(profile: object, where: str) -> None:
    """Checks that a value is a light profile or None.

    Raises:
        InputError: It is something else.
    """
    if profile is not None and not isinstance(profile, LightProfile):
        raise InputError(f"{where}: profile: wanted a LightProfile or None, got {short(profile)}")
