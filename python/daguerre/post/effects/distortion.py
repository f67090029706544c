"""Adds or removes geometric distortion."""

from __future__ import annotations

import dataclasses
import inspect
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from daguerre import distortion as models
from daguerre.argument_checks import guarded
from daguerre.checks import numbers
from daguerre.distortion import Distortion
from daguerre.errors import UsageError, suggest
from daguerre.post.array import step_on_array
from daguerre.post.effect import Effect, Step, Values
from daguerre.post.optics import (
    FOCAL_LENGTH,
    LENS,
    SENSOR,
    axis,
    bench,
    film_plane,
    focal_length_mm,
)
from daguerre.post.parameter import Parameter
from daguerre.post.picture import Canvas, Image
from daguerre.post.warp import FloatArray, PointMap, Warp
from daguerre.post.warp_step import FILTER, WarpStep, how

#: Wavelengths for red, green and blue of linear Rec.709 under D65: the means of 1 / wavelength^2,
#: which dispersion follows to first order (Cauchy). Such broad channels also blur; a map moves each
#: by its mean only.
CHANNEL_NM = (650.0, 545.0, 443.0)

MODELS: dict[str, type[Distortion]] = {
    "brown-conrady": models.BrownConrady,
    "opencv": models.OpenCV,
    "opencv-fisheye": models.OpenCVFisheye,
    "division": models.Division,
    "equidistant": models.Equidistant,
    "equisolid": models.Equisolid,
    "stereographic": models.Stereographic,
    "orthographic": models.Orthographic,
}
COEFFICIENTS = tuple(f.name for f in dataclasses.fields(models.OpenCV))


@guarded(arrays=False)
def distort(
    image: Image,
    model: Distortion | Sequence[Distortion],
    *,
    focal_px: float | tuple[float, float],
    centre: tuple[float, float] | None = None,
    scale: float = 1.0,
    filter: str = "cubic",
    antialias: bool = True,
    inverse: bool = False,
) -> Image:
    """Distorts an ideal (rectilinear) picture.

    Args:
        image: Scene-linear picture, shape (H, W, C).
        model: One model, or a model each for red, green and blue.
        focal_px: Focal length, px; a number, or horizontal and vertical.
        centre: Centre of the distortion, px from the top left corner of the picture; default: its
            middle. OpenCV counts from the middle of the first pixel: add 0.5 to its cx and cy.
        scale: Magnification of the ideal picture; above 1 it shows less of the scene, larger.
        filter: Interpolation: ``cubic`` or ``linear``.
        antialias: Whether to average where the map shrinks the picture.
        inverse: Whether to undistort instead.

    Returns:
        Picture of the same shape; 0 where the source has no pixel or the model is not defined.
    """
    given = [model] if isinstance(model, Distortion) else list(model)
    focal = pair_px(focal_px)

    def make(canvas: Canvas) -> Step:
        middle = canvas.center if centre is None else centre
        maps = [point_map(m, focal, middle, scale=scale, inverse=inverse) for m in given]
        warps = Warp.of_each(canvas, maps)
        return WarpStep(canvas, warps, filter=filter, antialias=antialias)

    return step_on_array("distort", image, make)


@guarded(arrays=False)
def undistort(
    image: Image, model: Distortion | Sequence[Distortion], **parameters: object
) -> Image:
    """Undistorts a picture; takes the parameters of :func:`distort` except ``inverse``."""
    known = inspect.signature(distort).parameters
    for name in parameters:
        if name not in known or name in ("image", "model", "inverse"):
            raise UsageError(
                f"undistort: wanted a parameter of distort, got {name!r}{suggest(name, known)}"
            )
    return distort(image, model, **dict[str, Any](parameters), inverse=True)


def pair_px(focal_px: float | tuple[float, float]) -> tuple[float, float]:
    """Horizontal and vertical focal lengths; one number is both."""
    given: Any = (focal_px, focal_px) if np.ndim(focal_px) == 0 else focal_px
    across, down = numbers(given, "focal_px", 2, "one or two focal lengths in px")
    return across, down


def point_map(
    model: Distortion,
    focal_px: tuple[float, float],
    centre: tuple[float, float],
    *,
    scale: float = 1.0,
    inverse: bool = False,
) -> PointMap:
    """Returns the map from points of the result to points of the source, px.

    To distort, it maps each point of the result to its ideal point.
    """
    focal = np.array(numbers(focal_px, "focal_px", 2, "one or two focal lengths in px"))
    middle = np.array(numbers(centre, "centre", 2, "a point (x, y) in px"))

    def straight_from_bent(points: FloatArray) -> FloatArray:
        ideal = model.undistort((points - middle) / focal)
        return np.asarray(ideal * (focal * scale) + middle)

    def bent_from_straight(points: FloatArray) -> FloatArray:
        bent = model.distort((points - middle) / (focal * scale))
        return np.asarray(bent * focal + middle)

    return bent_from_straight if inverse else straight_from_bent


def _make(canvas: Canvas, values: Values) -> Step:
    given, focal, centre = camera(canvas, values)
    maps = [
        point_map(m, focal, centre, scale=values["scale"], inverse=values["inverse"]) for m in given
    ]
    warps = Warp.of_each(canvas, maps)
    if values["stmap"] is not None:
        from daguerre.post.stmap_rows import write_stmap

        write_stmap(values["stmap"], warps[len(warps) // 2], canvas)
    forward = point_map(
        given[len(given) // 2], focal, centre, scale=values["scale"], inverse=not values["inverse"]
    )
    return WarpStep(canvas, warps, forward=forward, **how(values))


def camera(
    canvas: Canvas, values: Values
) -> tuple[list[Distortion], tuple[float, float], tuple[float, float]]:
    """Returns the models (shared or per colour), focal lengths and centre (px) of the values."""
    middle = axis(canvas, values)
    centre = tuple(
        middle[k] if values[name] is None else values[name] + 0.5
        for k, name in enumerate(("cx", "cy"))
    )
    if values["model"] == "lens":
        colors = CHANNEL_NM if values["lateral_colour"] else CHANNEL_NM[1:2]
        made, focal_px = lens_models(canvas, values, colors)
        return made, focal_px, (centre[0], centre[1])
    if values["fx"] is not None:
        focal = (values["fx"], values["fy"] or values["fx"])
    else:
        pixels = focal_length_mm(canvas, values) / film_plane(canvas, values).pitch_mm
        focal = (pixels, pixels)
    return [_model(values)], focal, (centre[0], centre[1])


def lens_models(
    canvas: Canvas, values: Values, wavelengths_nm: Sequence[float]
) -> tuple[list[Distortion], tuple[float, float]]:
    """Returns the models of a lens, one per wavelength, and the picture's focal lengths, px.

    The focal lengths are the lens's, horizontal and vertical, so that nothing moves near the axis.
    """
    from daguerre.distortion.lens import LensDistortion
    from daguerre.distortion.lens_map import LensMap

    if values["lens"] is None:
        raise UsageError("distortion: model=lens needs a lens, such as lens=double-gauss-50mm-f2")
    film = film_plane(canvas, values)
    corners = np.array([(x, y) for x in (0, canvas.width) for y in (0, canvas.height)])
    reach = 1.02 * film.pitch_mm * np.abs(corners + canvas.corner - film.center).max(axis=0)
    item = bench(values)
    if not item.lens.prescription.is_axially_symmetric:
        maps = LensMap.of_colours(item, (float(reach[0]), float(reach[1])), wavelengths_nm)
        across, down = maps[0].focal_mm
        return list(maps), (across / film.pitch_mm, down / film.pitch_mm)
    made = LensDistortion.of_colours(item, math.hypot(*reach), wavelengths_nm)
    pixels = made[0].focal_length_mm / film.pitch_mm
    return list(made), (pixels, pixels)


def _model(values: Values) -> Distortion:
    kind = MODELS[values["model"]]
    given = {name: values[name] for name in COEFFICIENTS if values[name] is not None}
    known = {f.name for f in dataclasses.fields(kind)}  # type: ignore[arg-type]
    if kind is models.BrownConrady:
        known = {"k1", "k2", "k3", "p1", "p2"}
    for name in given:
        if name not in known:
            raise UsageError(
                f"distortion: wanted a coefficient of {values['model']} "
                f"({', '.join(sorted(known)) or 'it has none'}), got {name}"
            )
    return kind(**given)


DISTORTION = Effect(
    "distortion",
    "lens distortion, or its removal",
    (
        Parameter(
            "model", "distortion model", kind="choice", default="brown-conrady",
            choices=(*MODELS, "lens"),
        ),
        *(Parameter(name, "tilt of the sensor" if "tau" in name else "coefficient of OpenCV",
                    "rad" if "tau" in name else "") for name in COEFFICIENTS),
        FOCAL_LENGTH,
        SENSOR,
        Parameter("fx", "horizontal focal length, instead of focal_length", "px", low=1e-3),
        Parameter("fy", "vertical focal length; default: fx", "px", low=1e-3),
        Parameter("cx", "centre, x; 0 is the middle of the first pixel, as in OpenCV", "px"),
        Parameter("cy", "centre, y; 0 is the middle of the first pixel, as in OpenCV", "px"),
        *LENS,
        Parameter(
            "lateral_colour", "whether model=lens includes lateral colour", kind="flag",
            default=True,
        ),
        Parameter("scale", "magnification of the ideal picture; below 1 shows more of the scene",
                  default=1.0, low=1e-3),
        *FILTER,
        Parameter("stmap", "path of an .exr for the map of green, written as well", kind="output"),
        Parameter("inverse", "undistort instead of distorting", kind="flag", default=False),
    ),
    _make,
)  # fmt: skip
