"""Distortion by the core's projection models, which also serve rendering and calibration."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from functools import lru_cache
from typing import ClassVar

import numpy as np

import daguerre._core as _core
from daguerre.errors import UsageError, core_errors

from .model import WIDEST, Distortion, FloatArray


@dataclass(frozen=True)
class Projected(Distortion):
    """Base class of the core's models; the fields are the model's parameters, in order."""

    _projection: ClassVar[str]

    def _distorted(self, points: FloatArray) -> FloatArray:
        return np.asarray(_model(self).project(np.column_stack([points, np.ones(len(points))])))

    def _ideal(self, points: FloatArray) -> FloatArray:
        seen = _model(self).unproject(np.ascontiguousarray(points))
        depth = np.where(seen[:, 2:] > math.cos(WIDEST), seen[:, 2:], np.nan)
        return np.asarray(seen[:, :2] / depth)


@lru_cache(16)
def _model(of: Projected) -> _core.ProjectionModel:
    """Core's model, kept outside the value so that the value can be pickled."""
    numbers = [float(getattr(of, field.name)) for field in fields(of)]
    with core_errors(UsageError, type(of).__name__):
        return _core.ProjectionModel(of._projection, numbers)
