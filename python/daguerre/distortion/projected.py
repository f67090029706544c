"""Distortion by the models of the core, which also draw rays and calibrate cameras."""

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
    """A model of the core; its fields are the model's parameters, in their order."""

    _projection: ClassVar[str]

    def _distorted(self, points: FloatArray) -> FloatArray:
        return np.asarray(_model(self).project(np.column_stack([points, np.ones(len(points))])))

    def _ideal(self, points: FloatArray) -> FloatArray:
        seen = _model(self).unproject(np.ascontiguousarray(points))
        depth = np.where(seen[:, 2:] > math.cos(WIDEST), seen[:, 2:], np.nan)
        return np.asarray(seen[:, :2] / depth)


@lru_cache(16)
def _model(of: Projected) -> _core.ProjectionModel:
    """The core's model: beside the value, so that the value travels without it."""
    numbers = [float(getattr(of, field.name)) for field in fields(of)]
    with core_errors(UsageError, type(of).__name__):
        return _core.ProjectionModel(of._projection, numbers)
