"""At which stop, focus and zoom a lens was fitted, and where its prescription comes from."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import daguerre._core as _core
from daguerre.errors import InputError


@dataclass(frozen=True)
class FitSetting:
    """Setting of a lens that was fitted, which the polynomials do not say.

    Attributes:
        f_stop: F-stop as engraved.
        focus_m: From the entrance pupil; may be infinite.
        zoom_mm: Focal length of a zoom; None: no zoom.
        source: Patent or book of the prescription.
        iris: Its shape: None is round; "picture"; or edges in units of the iris radius, as
            `daguerre.export.plan.Blades` names them.
    """

    f_stop: float
    focus_m: float = math.inf
    zoom_mm: float | None = None
    source: str | None = None
    iris: dict[str, Any] | str | None = None

    def to_dict(self) -> dict[str, Any]:
        """JSON-able: an infinite distance is null."""
        focus = None if math.isinf(self.focus_m) else self.focus_m
        return {**self.__dict__, "focus_m": focus}

    @classmethod
    def from_dict(cls, data: Any) -> FitSetting:
        """The inverse of ``to_dict``.

        Raises:
            InputError: Data of another form.
        """
        try:
            focus = math.inf if data["focus_m"] is None else float(data["focus_m"])
            return cls(**{**data, "focus_m": focus})
        except (KeyError, TypeError, ValueError) as error:
            text = f"{type(error).__name__}: {error}"
            raise InputError(f"lens fit: setting: wanted f_stop, focus_m ..., got {text}") from None


def iris_shape(iris: _core.Iris) -> dict[str, Any] | str | None:
    """The shape of an iris as `FitSetting` has it."""
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
