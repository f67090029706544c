"""Calibrates a lens by its chief rays: fits a projection that maps directions to pixels."""

from __future__ import annotations

import contextlib
import math
from dataclasses import dataclass
from typing import Any, TypedDict, Unpack

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.camera.parameters.bench import CALIBRATE, SEEN
from daguerre.camera.projection import MODELS, NEEDED, Projection
from daguerre.checks import number, numbers, whole
from daguerre.errors import InputError, UsageError, suggest
from daguerre.files.value import BriefRecord
from daguerre.lenses import Lens, load
from daguerre.lenses.setting import By, LensSetting
from daguerre.parameters.keywords import takes

from .bench import Bench, FloatArray, on_bench
from .chief import ChiefRays, chief_rays
from .least_squares import least_squares
from .plotted import Plotted

#: Initial parameters of models that are not valid with zeros.
STARTS = {"double_sphere": (0.0, 0.5), "eucm": (0.5, 1.0), "omni": (1.0,), "fov": (0.5,)}
UNFIT = ("equirectangular", "cube")  # panoramas, which no lens projects
#: Names that formats of calibration files use for models.
OTHER_NAMES = {
    "fisheye": "kannala_brandt",
    "brown_conrady": "opencv",
}
#: Number of parameters fitted by default, as in OpenCV's own calibration.
PARAMETERS = {"opencv": 5}
#: Numbers of parameters that ``calibrate_all`` compares.
COUNTS = {"opencv": (4, 5, 8, 12)}
ACROSS = 41  # chief rays across the picture
LEAST = 50  # chief rays that a fit needs
NOTHING = 1e-13  # smaller parameters are 0 by symmetry, and left over from rounding
NEAR = 0.25  # radius for the first guess of the focal length, of the picture's shorter side


class _PictureKeywords(TypedDict, total=False):
    sensor_size: tuple[float, float]
    f_stop: float | None
    focus_distance: float
    focal_length: float | None
    focus_by: By
    shift: tuple[float, float]


class SeenKeywords(_PictureKeywords, total=False):
    """Keywords of ``calibrate_all``."""

    wavelength_nm: float


class CalibrateKeywords(_PictureKeywords, total=False):
    """Keywords of ``calibrate``."""

    terms: int | None
    wavelength_nm: float


@dataclass(frozen=True, repr=False)
class ProjectionFit(BriefRecord, Plotted):
    """A fitted projection, and how well it fits.

    Attributes:
        projection: The fitted model.
        bench: The lens at its setting.
        pixel_pitch_um: Pixel pitch of the picture, um.
        pixels: Pixels of the chief rays, shape (N, 2), pixel centres at integers.
        directions: Unit vectors, x right, y down, z ahead, from the entrance pupil, shape (N, 3).
        unseen: Number of points of the picture without a chief ray.
        camera: Camera with the lens at this setting.
    """

    projection: Projection
    bench: Bench
    pixel_pitch_um: float
    pixels: FloatArray
    directions: FloatArray
    unseen: int
    camera: Camera

    @property
    def residuals(self) -> FloatArray:
        """Pixels of the model less pixels of the lens, px, shape (N, 2)."""
        return self.projection.project(self.directions) - self.pixels

    @property
    def rms(self) -> float:
        """RMS length of the residuals, px: OpenCV's reprojection error."""
        return float(np.sqrt((self.residuals**2).sum(axis=1).mean()))

    @property
    def largest(self) -> float:
        """Largest length of a residual, px."""
        return float(np.hypot(*self.residuals.T).max())


@takes(CALIBRATE, CalibrateKeywords)
@guarded
def calibrate(
    lens: Lens | str,
    model: str = "opencv",
    *,
    resolution: tuple[int, int],
    **keywords: Unpack[CalibrateKeywords],
) -> ProjectionFit:
    """Fits a projection to a lens, by least squares of pixels evenly over the picture.

    Args:
        lens: A lens, its name in the library, or a file.
        model: One of ``MODELS`` except panoramas; ``fisheye`` is OpenCV's, kannala_brandt.
        resolution: Width and height of the picture, px.
        {keywords}

    Raises:
        UsageError: ``model`` is unknown, or a number is out of range.
        InputError: The lens has a wider field than the model, or too little of the picture is lit.
    """
    asked = CALIBRATE.filled({"resolution": resolution, **keywords}, "calibrate")
    model = OTHER_NAMES.get(model, model)
    count = _count(model, asked.pop("terms"))
    return _see(lens, asked).fitted(model, count)


@takes(SEEN, SeenKeywords)
@guarded
def calibrate_all(
    lens: Lens | str, *, resolution: tuple[int, int], **keywords: Unpack[SeenKeywords]
) -> list[ProjectionFit]:
    """Fits every model that covers the field of the lens; returns the best (by RMS) first.

    Args: those of :func:`calibrate`; ``opencv`` is fitted with 4, 5, 8 and 12 parameters.

    Raises:
        UsageError: A number is out of range.
        InputError: Too little of the picture is lit.
    """
    asked = {"resolution": resolution, **keywords}
    seen = _see(lens, SEEN.filled(asked, "calibrate_all", "calibrate"))
    found = []
    for model in MODELS:
        for count in COUNTS.get(model, (len(MODELS[model]),)) if model not in UNFIT else ():
            with contextlib.suppress(InputError):  # the model's field is too small
                found.append(seen.fitted(model, count))
    return sorted(found, key=lambda fit: fit.rms)


@dataclass(frozen=True)
class _Picture:
    """Picture and wavelength for which a lens is calibrated.

    Attributes:
        resolution: Width and height, px.
        sensor_mm: Width and height of the sensor, mm; the picture spans its width.
        shift_mm: Shift of the sensor, right and up, mm.
        wavelength_nm: Wavelength, nm.
    """

    resolution: tuple[int, int]
    sensor_mm: tuple[float, float]
    shift_mm: tuple[float, float]
    wavelength_nm: float

    def __post_init__(self) -> None:
        where = "calibrate: resolution"
        for side in numbers(self.resolution, where, 2, "two whole numbers of pixels"):
            whole(int(side) if side == int(side) else side, where, 2, 65536)
        for side in numbers(self.sensor_mm, "calibrate: sensor_size", 2, "width and height, mm"):
            number(side, "calibrate: sensor_size", 0, 1e5, above=0)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height, px."""
        return int(self.resolution[0]), int(self.resolution[1])

    @property
    def pitch_mm(self) -> float:
        """Pixel pitch, mm."""
        return self.sensor_mm[0] / self.size[0]

    @property
    def axis(self) -> FloatArray:
        """Point where the lens's axis meets the picture, px."""
        middle = (np.array(self.size) - 1) / 2
        shift = np.array(numbers(self.shift_mm, "calibrate: shift", 2, "two lengths, mm"))
        return np.asarray(middle + shift / self.pitch_mm * (-1, 1))


@dataclass(frozen=True)
class _Seen:
    """Chief rays of a lens, before a model is fitted."""

    bench: Bench
    size: tuple[int, int]
    pixels: FloatArray
    directions: FloatArray
    unseen: int
    axis: FloatArray  # point where the axis meets the picture, px
    camera: Camera

    def fitted(self, model: str, count: int) -> ProjectionFit:
        name = self.bench.lens.name
        made = fit_projection(
            model, self.size, self.pixels, self.directions, count, name, self.axis
        )
        pitch_um = 1e3 * self.camera.sensor_size[0] / self.size[0]
        return ProjectionFit(
            made, self.bench, pitch_um, self.pixels, self.directions, self.unseen, self.camera
        )


def _see(lens: Lens | str, asked: dict[str, Any]) -> _Seen:
    """Traces chief rays, with the parameters in ``SEEN``."""
    picture = _Picture(
        asked["resolution"], asked["sensor_size"], asked["shift"], asked["wavelength_nm"]
    )
    setting = LensSetting(
        asked["f_stop"], asked["focus_distance"], asked["focal_length"], asked["focus_by"]
    )
    item = load(lens)
    bench = on_bench(item, setting)
    size, pitch, axis = picture.size, picture.pitch_mm, picture.axis
    pixels, film = _grid(bench, size, pitch, axis)
    directions = directions_seen(bench, chief_rays(bench, film, picture.wavelength_nm))
    known = np.isfinite(directions).all(axis=1)
    if known.sum() < LEAST:
        width, height = picture.sensor_mm
        raise InputError(
            f"{bench.lens.name}: calibrate: wanted {LEAST} chief rays or more, got {known.sum()} "
            f"at {known.size} points of a sensor of {width:g} x {height:g} mm: is "
            "it much larger than the image circle?"
        )
    camera = Camera(
        lens=item,
        f_stop=bench.f_stop,
        focus_distance=setting.focus_m,
        focus_by=setting.focus_by,
        zoom=setting.zoom_mm,
        sensor_size=(size[0] * pitch, size[1] * pitch),
        shift=(float(picture.shift_mm[0]), float(picture.shift_mm[1])),
    )
    unseen = int((~known).sum())
    return _Seen(bench, size, pixels[known], directions[known], unseen, axis, camera)


def fit_projection(
    model: str,
    size: tuple[int, int],
    pixels: FloatArray,
    directions: FloatArray,
    terms: int,
    name: str = "calibrate",
    axis: FloatArray | None = None,
) -> Projection:
    """Fits a model that maps directions to pixels.

    Args:
        model: One of ``MODELS``.
        size: Width and height of the picture, px.
        pixels: Shape (N, 2), pixel centres at integers.
        directions: Shape (N, 3), x right, y down, z ahead.
        terms: Number of parameters of the model to fit.
        name: Name of the lens, for messages.
        axis: First guess of the principal point, px; None: the centre of the picture.

    Raises:
        InputError: Directions are outside the model's field.
    """
    middle = (np.array(size) - 1) / 2 if axis is None else axis
    start = np.array([*STARTS.get(model, ()), *[0.0] * terms][:terms])
    unit = Projection(model, size, (1.0, 1.0), (0.0, 0.0), tuple(start))
    flat = unit.project(directions)
    if not np.isfinite(flat).all():
        ahead = directions[:, 2] / np.linalg.norm(directions, axis=1)
        raise InputError(
            f"{name}: calibrate: the picture shows up to {_degrees(ahead.min()):.4g} degrees from "
            f"the axis, {model} up to {unit.largest_angle:.4g}: wanted a model with a wider field, "
            "such as kannala_brandt"
        )
    away = pixels - middle
    near = np.hypot(*away.T) <= max(NEAR * min(size), np.sort(np.hypot(*away.T))[8])
    length = float((away[near] * flat[near]).sum() / (flat[near] ** 2).sum())

    def made(x: FloatArray) -> Projection:
        f, c = x[:2] * length, middle + x[2:4] * length
        focal, center = (float(f[0]), float(f[1])), (float(c[0]), float(c[1]))
        return Projection(model, size, focal, center, tuple(x[4:]))

    def misses(x: FloatArray) -> FloatArray:
        try:
            return np.asarray((made(x).project(directions) - pixels).ravel())
        except UsageError:  # invalid parameters
            return np.full(2 * len(pixels), np.nan)

    first = np.concatenate([[1.0, 1.0, 0.0, 0.0], start])
    found = least_squares(misses, first, np.ones(len(first)))
    return made(np.where(np.abs(found) < NOTHING, 0.0, found))


def directions_seen(bench: Bench, rays: ChiefRays) -> FloatArray:
    """Directions to points in focus on chief rays, from the paraxial entrance pupil.

    The pupil is the camera's position. The points are on the plane in focus; for fisheyes, with a
    field too wide for a plane, on a sphere of the same distance.

    Returns:
        Unit directions, x right, y down, z ahead, shape (N, 3); NaN where there is no chief ray.
    """
    # Rays come toward the lens along +z of its frame; looking out, x is right and y up.
    d, pupil = rays.directions, np.array([0.0, 0.0, bench.order.entrance_pupil.z])
    seen = -d
    with np.errstate(invalid="ignore", divide="ignore"):
        if math.isfinite(bench.focus_mm):
            from_pupil = rays.points - pupil
            if bench.is_fisheye:
                along = (from_pupil * d).sum(axis=1)
                square = (from_pupil**2).sum(axis=1) - bench.focus_mm**2
                back = along + np.sqrt(along**2 - square)
            else:
                back = (from_pupil[:, 2] + bench.focus_mm) / d[:, 2]
                back[d[:, 2] <= 0] = np.nan
            seen = from_pupil - back[:, None] * d
        seen = seen / np.linalg.norm(seen, axis=1, keepdims=True)
    return np.asarray(seen * (1, -1, -1))


def _grid(
    bench: Bench, size: tuple[int, int], pitch: float, axis: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Pixels evenly over the picture, corners included, and their film points, mm."""
    width, height = size
    rows = max(3, round((ACROSS - 1) * height / width) + 1)
    x, y = np.linspace(-0.5, width - 0.5, ACROSS), np.linspace(-0.5, height - 0.5, min(rows, 101))
    pixels = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    # The image on the film is upside down; y is up.
    film = (pixels - axis) * pitch * (-1, 1)
    if bench.is_fisheye:  # outside its image circle is only the barrel
        inside = np.hypot(*film.T) <= bench.field_mm * (1 + 1e-9)
        pixels, film = pixels[inside], film[inside]
    return pixels, film


def names_of_models() -> list[str]:
    """Names of the models that can be fitted."""
    return ["fisheye", *(name for name in MODELS if name not in UNFIT)]


def _count(model: str, terms: int | None) -> int:
    if model not in MODELS or model in UNFIT:
        known = names_of_models()
        raise UsageError(
            f"calibrate: model: wanted {', '.join(known)}; got {model!r}{suggest(model, known)}"
        )
    most = len(MODELS[model])
    if terms is None:
        return PARAMETERS.get(model, most)
    return whole(terms, f"calibrate: terms of {model}", NEEDED.get(model, 0), most)


def _degrees(cosine: float) -> float:
    return math.degrees(math.acos(min(max(cosine, -1.0), 1.0)))
