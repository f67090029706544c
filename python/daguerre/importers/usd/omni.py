"""Reads the calibrated projection of NVIDIA's cameras: ``omni:lensdistortion:*``.

``opencvPinhole`` and ``opencvFisheye`` have OpenCV's coefficients. ``ftheta`` gives the angle of a
radius in pixels, k0 + k1 r + k2 r^2 + ...; ``kannalaBrandtK3`` and ``radTanThinPrism`` the radius
of an angle, f (a + k0 a^3 + k1 a^5 + ...), without stating f: f is ``focalLength`` on
``horizontalAperture``. Older files have ``cameraProjectionType``, and coefficients that share
names.

Sources: NVIDIA, "Lens Distortion Schemas"; "Cameras" (Omniverse Kit 104), fisheye properties;
Project Aria, "Camera Intrinsic Models" (the last two models).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np
from pxr import Usd

from daguerre.camera.projection import Projection
from daguerre.errors import InputError, UsageError
from daguerre.motion.values import keys

from .checked import Checked
from .omni_models import MODEL, MODELS, OLDER, PROJECTION_TYPE, OmniModel

#: Number of coefficients of Daguerre's model for the fisheyes that say no focal length.
_ANGLES = 4
#: Slack of a field of view, degrees, as it is of single precision.
_SLACK = 0.01


def read_distortion(read: Checked) -> Any:
    """Projection of a camera, or keys of it; None: a camera without lens distortion.

    Raises:
        InputError: The values make no projection; the message names the attribute.
    """
    model = _model(read)
    if model is None:
        return None
    absent = [name for name in model.needed if read.now(name) is None]
    if absent:
        read.notes.add(
            f"the lens distortion {model.name} of a camera leaves {', '.join(absent)} to "
            "NVIDIA's schema"
        )
    distortion = _Distortion(read, model)
    codes = distortion.codes()
    if len(codes) < 2:
        made = distortion.at(read.stage.clock.code)
        _notes(read, model, made)
        return made
    clock = read.stage.clock
    pairs = [(clock.seconds(code), distortion.at(Usd.TimeCode(code))) for code in codes]
    _notes(read, model, pairs[0][1])
    return keys(pairs, "step" if clock.holds else "linear")


def _model(read: Checked) -> OmniModel | None:
    """Lens distortion that a camera has, by its name, its schema, or its older name."""
    name = read.text(MODEL)
    listed = read.prim.GetMetadata("apiSchemas")
    applied = set(listed.GetAddedOrExplicitItems()) if listed else set()
    schemas = {model.schema: model.name for model in MODELS.values()}
    name = name or next((schemas[schema] for schema in schemas if schema in applied), None)
    if name is None:
        name = read.text(PROJECTION_TYPE)
        if name in (None, "pinhole"):
            return None
        if name in OLDER:
            return OLDER[str(name)]
    elif name in MODELS:
        return MODELS[name]
    read.notes.add(f"the lens distortion {str(name)[:40]!r} of a camera is unknown")
    return None


@dataclass(frozen=True)
class _Distortion:
    """Values of a lens distortion over time."""

    read: Checked
    model: OmniModel

    def codes(self) -> list[float]:
        """Time codes at which something changes."""
        named = [*self.model.needed, *self.model.terms]
        if not self.model.focal and self.model.name != "ftheta":
            named += ["focalLength", "horizontalAperture"]
        clock = self.read.stage.clock
        found = chain.from_iterable(
            clock.codes(self.read.prim.GetAttribute(name)) for name in named
        )
        return sorted(set(found))

    def at(self, code: Usd.TimeCode) -> Projection:
        """Projection at a time code."""
        width, height = (self._whole(name, part, code) for name, part in self.model.size)
        x, y = (self._value(name, part, code) - 0.5 for name, part in self.model.center)
        terms = [self._value(name, -1, code) for name in self.model.terms]
        focal = tuple(self._above(name, part, code) for name, part in self.model.focal)
        name, length, values = self._named(terms, width, code)
        pair = (focal[0], focal[1]) if focal else (length, length)
        try:
            return Projection(name, (width, height), pair, (x, y), _trimmed(values))
        except (UsageError, InputError) as error:
            place = self.read.place(MODEL if self.model.schema else PROJECTION_TYPE)
            raise InputError(f"{place}: {str(error).removeprefix('projection: ')}") from None

    def _named(
        self, terms: list[float], width: int, code: Usd.TimeCode
    ) -> tuple[str, float, list[float]]:
        """Daguerre's model, its focal length in px (0: it is elsewhere), and its parameters."""
        kind = self.model.name
        if kind == "opencvPinhole":
            return ("opencv" if any(terms) else "rectilinear"), 0.0, terms
        if kind == "opencvFisheye":
            return ("kannala_brandt" if any(terms) else "equidistant"), 0.0, terms
        if kind == "ftheta":
            slope = terms[1]
            if not slope > 0:
                self.read.fail(self.model.terms[1], "radians per px, above 0", f"{slope:g}")
            return "ftheta", 1 / slope, [k / slope**i for i, k in enumerate(terms) if i > 1]
        focal_length = self._above("focalLength", -1, code)
        ratio = focal_length / self._above("horizontalAperture", -1, code)
        return "kannala_brandt", ratio * width, terms[:_ANGLES]

    def _value(self, name: str, part: int, code: Usd.TimeCode) -> float:
        """Number of an attribute, or of a part of its pair; -1: it has one number."""
        value = self.read.at(name, code)
        if value is None:
            value = self.model.defaults.get(name, (0.0,))
        parts = value if isinstance(value, tuple) else (value,)
        index = max(part, 0)
        if index >= len(parts):
            self.read.fail(name, f"{index + 1} numbers", value)
        return self.read.finite(name, parts[index])

    def _above(self, name: str, part: int, code: Usd.TimeCode) -> float:
        value = self._value(name, part, code)
        if not value > 0:
            self.read.fail(name, "a number above 0", f"{value:g}")
        return value

    def _whole(self, name: str, part: int, code: Usd.TimeCode) -> int:
        value = self._value(name, part, code)
        if not (1 <= value <= 65536 and value == int(value)):
            self.read.fail(name, "1 .. 65536 whole pixels", f"{value:g}")
        return int(value)


def _trimmed(values: list[float]) -> tuple[float, ...]:
    """Drops the zeros at the end, which a projection need not have."""
    last = max((i for i, value in enumerate(values) if value), default=-1)
    return tuple(values[: last + 1])


def _notes(read: Checked, model: OmniModel, made: Projection) -> None:
    """Notes terms of a lens distortion that are not drawn, or have no definition."""
    if model.name == "ftheta" and read.now(model.terms[0]):
        read.notes.add(f"{model.terms[0]} of a camera is ignored")
    if model.name in ("kannalaBrandtK3", "radTanThinPrism"):
        read.notes.add(
            f"the lens distortion {model.name} of a camera has no focal length; focalLength and "
            f"horizontalAperture are used"
        )
    if any(read.now(name) for name in model.terms[_ANGLES:]) and model.name == "radTanThinPrism":
        read.notes.add("radTanThinPrism of a camera: only k0 .. k3 are read")
    field = read.number(model.field) if model.field else None
    if field is not None and field > 0 and _widest(made) > field / 2 + _SLACK:
        read.notes.add(f"{model.field} of a camera is ignored: the picture keeps its corners")


def _widest(made: Projection) -> float:
    """Largest angle from the axis in the corners of the picture, degrees."""
    (width, height) = made.size
    corners = [(x, y) for x in (-0.5, width - 0.5) for y in (-0.5, height - 0.5)]
    z = made.unproject(corners)[:, 2]
    return math.degrees(float(np.arccos(np.clip(np.nanmin(z, initial=1.0), -1, 1))))
