"""Writes projections: by NVIDIA's lens distortion where it has the model, else by ours."""

from __future__ import annotations

from functools import partial
from typing import Any

from daguerre.camera.camera import Camera
from daguerre.camera.projection import Projection
from daguerre.importers.usd.daguerre_attributes import PREFIX, PROJECTION
from daguerre.importers.usd.omni_models import MODEL, MODELS, OmniModel

from .stage import Output

_PINHOLE, _FISHEYE, _FTHETA = "opencvPinhole", "opencvFisheye", "ftheta"


def write_projection(output: Output) -> None:
    """Writes the projection of a camera with a calibration."""
    made = output.camera.projection
    assert made is not None
    model = _of(made)
    if model is None:
        _write_ours(output, made)
        return
    output.apply(model.schema)
    output.set(MODEL, "token", model.name)
    _write_size(output, model, made)
    for i in (0, 1):
        _write_pair(output, model, i)
    for i, name in enumerate(model.terms):
        output.follow(name, "float", partial(_term, i), "projection")
    if model.field:
        output.set(model.field, "float", 2 * min(made.largest_angle, 180.0))


def _of(made: Projection) -> OmniModel | None:
    """NVIDIA's lens distortion for a projection; None: no equal model."""
    if made.model == "rectilinear" or (made.model == "opencv" and not any(made.parameters[12:])):
        return MODELS[_PINHOLE]
    if made.model in ("equidistant", "kannala_brandt"):
        return MODELS[_FISHEYE]
    if made.model == "ftheta" and made.focal[0] == made.focal[1]:
        return MODELS[_FTHETA]
    return None


def _write_size(output: Output, model: OmniModel, made: Projection) -> None:
    (name, part), (other, _) = model.size
    if part >= 0:
        output.set(name, "int2", made.size)
        return
    output.set(name, "float", made.size[0])
    output.set(other, "float", made.size[1])


def _write_pair(output: Output, model: OmniModel, axis: int) -> None:
    """Writes principal point and focal length along an axis, px from the corner."""
    name, part = model.center[axis]
    if part < 0:
        output.follow(name, "float", lambda c: _center(c)[axis], "projection")
    elif axis == 0:
        output.follow(name, "float2", _center, "projection")
    if model.focal:
        output.follow(
            model.focal[axis][0], "float", lambda c: _projection(c).focal[axis], "projection"
        )


def _projection(camera: Camera) -> Projection:
    assert camera.projection is not None
    return camera.projection


def _center(camera: Camera) -> tuple[float, float]:
    x, y = _projection(camera).center
    return x + 0.5, y + 0.5


def _term(index: int, camera: Camera) -> float:
    return _terms(camera)[index]


def _terms(camera: Camera) -> list[float]:
    """All coefficients of NVIDIA's model."""
    made = _projection(camera)
    values: list[Any] = list(made.parameters[:12])
    if made.model == "ftheta":
        slope = 1 / made.focal[0]
        values = [0.0, slope, *(k * slope**i for i, k in enumerate(values, 2))]
    return [*values, *[0.0] * (12 - len(values))]


def _write_ours(output: Output, made: Projection) -> None:
    stem = PREFIX + PROJECTION
    output.set(stem + "model", "token", made.model)
    output.set(stem + "size", "int2", made.size)
    for name, kind, of in (
        ("focal", "double2", lambda c: _projection(c).focal),
        ("principal", "double2", lambda c: _projection(c).center),
        ("parameters", "double[]", lambda c: _projection(c).parameters),
    ):
        output.follow(stem + name, kind, of, "projection")
