"""Setting of a fitted lens: f-stop, focus, zoom, and the source of its prescription."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import daguerre._core as _core
from daguerre.errors import InputError


@dataclass(frozen=True)
class FitSetting:
    """Setting of a fitted lens, which its polynomials do not contain.

    Attributes:
        f_stop: F-stop as engraved.
        focus_m: Focus distance from the entrance pupil, m; may be infinite.
        zoom_mm: Focal length of a zoom, mm; None: not a zoom.
        source: Patent or book of the prescription.
        iris: Shape of the iris: None: round; ``"picture"``; or edges in units of the iris radius,
            as in `daguerre.export.plan.Blades`.
    """

    f_stop: float
    focus_m: float = math.inf
    zoom_mm: float | None = None
    source: str | None = None
    iris: dict[str, Any] | str | None = None

    def to_dict(self) -> dict[str, Any]:
        """Returns JSON-compatible data; an infinite distance is null."""
        focus = None if math.isinf(self.focus_m) else self.focus_m
        return {**self.__dict__, "focus_m": focus}

    @classmethod
    def from_dict(cls, data: Any) -> FitSetting:
        """Makes a setting from the data of ``to_dict``.

        Raises:
            InputError: The data have another form.
        """
        try:
            focus = math.inf if data["focus_m"] is None else float(data["focus_m"])
            return cls(**{**data, "focus_m": focus})
        except (KeyError, TypeError, ValueError) as error:
            text = f"{type(error).__name__}: {error}"
            raise InputError(
                f"lens fit: setting: wanted the numbers of a lens setting (f_stop, "
                f"focus_m ...), got {text}"
            ) from None


def iris_shape(iris: _core.Iris) -> dict[str, Any] | str | None:
    """Shape of an iris in the form of `FitSetting`."""
    if iris.is_picture:
        return "picture"
    if not iris.edges:
        return None
    return {
        "edges": [list(edge) for edge in iris.edges],
        "apothem": iris.apothem,
        "bend": iris.bend,
        "center": iris.arc_center,
        "arc_radius": iris.arc_radius,
        "outer": iris.outer_radius,
    }
