"""Sets attributes of a prim from a camera, with time samples for animated values."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Sdf, Usd

from daguerre.camera.camera import Camera
from daguerre.camera.projection import MODELS, Projection
from daguerre.errors import UsageError
from daguerre.importers.usd.over_time import miss_of_numbers, sample_times
from daguerre.motion.values import Dynamic
from daguerre.scene.transforms import without_scale

_PAIRS = {"int2": Gf.Vec2i, "float2": Gf.Vec2f, "double2": Gf.Vec2d}
#: Most parameters of a projection.
_TERMS = max(map(len, MODELS.values()))


@dataclass
class Output:
    """A camera that becomes a prim.

    Attributes:
        prim: The prim.
        camera: The camera.
        rate: Time codes per second.
        folder: Folder of the stage; its files can be referred to.
        times: Begin and end of animated values, s; None: the first and last key.
        codes: Time codes with samples.
    """

    prim: Usd.Prim
    camera: Camera
    rate: float
    folder: Path
    times: tuple[float, float] | None = None
    codes: set[float] = field(default_factory=set)

    def code(self, time: float | None) -> Usd.TimeCode:
        """Time code of a time, s; None: the default time code, for constants."""
        if time is None:
            return Usd.TimeCode.Default()
        self.codes.add(time * self.rate)
        return Usd.TimeCode(time * self.rate)

    def rigid(self, world: NDArray[np.float64]) -> NDArray[np.float64]:
        """Transform of a camera without scale."""
        made = without_scale(np.asarray(world, np.float64))
        if made is None:
            raise UsageError("camera: transform: axes must not have zero length")
        return made

    def samples(self, *names: str) -> list[float]:
        """Times at which these parameters need samples, s; none if all are constant."""
        moving = [self.camera.motion[name] for name in names if name in self.camera.motion]
        times = (
            sample_times(_Flat(value), self.times or None, miss_of_numbers) for value in moving
        )
        return sorted({time for found in times for time in found})

    def set(self, name: str, kind: str, value: object) -> None:
        """Sets a constant attribute; None: leaves it out."""
        if value is not None:
            self._attribute(name, kind).Set(_given(kind, value))

    def follow(self, name: str, kind: str, of: Callable[[Camera], Any], *names: str) -> None:
        """Sets an attribute that follows parameters of the camera.

        Args:
            name: Attribute.
            kind: Type of the attribute.
            of: Value of the attribute for a camera at a moment; None: not written.
            *names: Parameters that it depends on.
        """
        times = self.samples(*names)
        if not times:
            self.set(name, kind, of(self.camera))
            return
        attribute = self._attribute(name, kind)
        for time in times:
            value = of(self.camera.evaluated_at(time))
            if value is not None:
                attribute.Set(_given(kind, value), self.code(time))

    def apply(self, schema: str) -> None:
        """Names a schema, which need not be known here."""
        self.prim.AddAppliedSchema(schema)

    def _attribute(self, name: str, kind: str) -> Usd.Attribute:
        return self.prim.GetAttribute(name) or self.prim.CreateAttribute(
            name, Sdf.ValueTypeNames.Find(kind), custom=False
        )


def _given(kind: str, value: Any) -> Any:
    """Value as USD's binding takes it."""
    if kind.endswith("[]"):
        return [tuple(v) if isinstance(v, tuple | list) else v for v in value]
    if kind in ("float", "double"):
        return float(value)
    return _PAIRS[kind](*value) if kind in _PAIRS else value


@dataclass(frozen=True)
class _Flat:
    """A value over time as numbers that can be compared."""

    value: Dynamic

    def at(self, time_s: float) -> NDArray[np.float64]:
        found = self.value.at(time_s)
        if isinstance(found, Projection):
            rest = (0.0,) * (_TERMS - len(found.parameters))
            found = (*found.focal, *found.center, *found.parameters, *rest)
        return np.asarray(found, np.float64)

    def breaks(self, begin: float, end: float) -> Any:
        return self.value.breaks(begin, end)
