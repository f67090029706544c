"""Light that is spread: bloom, halos, stars, diffraction, veiling glare, and any kernel."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from daguerre.convolution.convolve import spreader_of
from daguerre.doors import guarded
from daguerre.errors import InputError, UsageError
from daguerre.post import kernels
from daguerre.post.array import on_array
from daguerre.post.effect import Effect, Step, Values
from daguerre.post.kernels import Floats
from daguerre.post.optics import SENSOR, film_plane
from daguerre.post.parameter import REQUIRED, Parameter
from daguerre.post.picture import Canvas, Image
from daguerre.post.spreading import Spreading, Veil

if TYPE_CHECKING:
    from daguerre.analysis.iris import Iris

LARGEST = 2049  # px across, of kernels that could be larger
COARSE = 768  # px, of the smaller side of a picture on which veils are spread

IRIS = (
    Parameter("f_number", "working f-number, seen from the film", default=REQUIRED, low=0.3),
    Parameter("blades", "number of iris blades; 0: round", default=0, kind="whole", low=0, high=64),
    Parameter("rotation", "rotation of the blades", "deg", 0.0),
    Parameter(
        "curvature", "curvature of the blades; 1: round, 0: straight", default=0.0, low=-1, high=1
    ),
    Parameter("dust", "picture of dust on the iris: white lets light through", kind="text"),
)


def _shared(canvas: Canvas, share: float | Floats, kernel: Floats) -> Step:
    """(1 - share) of the light stays, share is spread: their sum is what it was."""
    shares = np.asarray(share, np.float32)
    return Spreading(canvas, spreader_of(kernel * shares, _shape(canvas)), 1 - shares)


def _shape(canvas: Canvas) -> tuple[int, int, int]:
    """Shape of the picture's colours, without alpha."""
    return canvas.height, canvas.width, len(canvas.colors) - canvas.alpha


def _window(canvas: Canvas, wanted_px: float) -> int:
    """An odd size of a kernel: what is wanted, no more than matters."""
    most = min(LARGEST, 2 * max(canvas.width, canvas.height) - 1)
    return max(1, min(math.ceil(wanted_px), most)) | 1


def _bloom(canvas: Canvas, values: Values) -> Step:
    size = _window(canvas, 60 * values["radius"])
    return _shared(canvas, values["share"], kernels.bloom(values["radius"], size))


def _halo(canvas: Canvas, values: Values) -> Step:
    thickness = values["thickness"] / film_plane(canvas, values).pitch_mm
    size = _window(canvas, 60 * thickness)
    kernel = kernels.halation(thickness, values["index"], size)
    colors = len(canvas.colors) - canvas.alpha
    # The emulsion's last layer, next to the base, is the red one.
    shares = np.array([values["red"], values["green"], values["blue"]], np.float32)
    shares = values["share"] * (shares if colors == 3 else shares[:1])
    if (shares > 1).any():
        raise UsageError(f"{canvas.where}: halo: share: wanted at most 1 of each colour")

    return _shared(canvas, shares, kernel[:, :, None])


def _glare(canvas: Canvas, values: Values) -> Step:
    shoulder = values["shoulder"] / film_plane(canvas, values).pitch_mm
    factor = max(1, min(canvas.width, canvas.height) // COARSE)
    size = 2 * math.ceil(max(canvas.width, canvas.height) / factor) + 1
    kernel = kernels.scatter(shoulder / factor, values["slope"], size)
    return Veil(canvas, kernel, factor, values["share"])


def _waves(canvas: Canvas, values: Values) -> Floats:
    """The 3 x 3 kernel of an iris."""
    from daguerre.analysis.diffraction import PlainPupil, window_of
    from daguerre.post.starburst import starburst

    _needs_rgb(canvas, "diffraction")
    pupil = PlainPupil(values["f_number"], iris_of(values))
    pitch = film_plane(canvas, values).pitch_mm
    size = window_of(pupil, pitch, _window(canvas, values["size"] or LARGEST))
    return starburst(pupil, pitch, size, wavelengths=values["wavelengths"])


def _diffraction(canvas: Canvas, values: Values) -> Step:
    return Spreading(canvas, spreader_of(_waves(canvas, values), _shape(canvas)))


def _star(canvas: Canvas, values: Values) -> Step:
    pitch = film_plane(canvas, values).pitch_mm
    core = max(2.0, 4 * 1.22 * 0.55e-3 * values["f_number"] / pitch)
    from daguerre.post.starburst import tail_only

    kernel = tail_only(_waves(canvas, values), core)
    return _shared(canvas, values["share"], kernel)


def iris_of(values: Values) -> Iris:
    """The iris that parameters describe."""
    from daguerre.analysis.iris import Iris

    if values["blades"] in (1, 2):
        raise UsageError(f"blades: wanted 0 (round) or 3 to 64, got {values['blades']}")
    mask = None
    if values["dust"] is not None:
        from daguerre.io.iris import read_grey

        mask = np.minimum(read_grey(Path(values["dust"])), 1)
    return Iris(values["blades"], values["rotation"], values["curvature"], mask=mask)


def _needs_rgb(canvas: Canvas, name: str) -> None:
    if len(canvas.colors) - canvas.alpha != 3:
        listed = ", ".join(canvas.colors)
        raise InputError(f"{canvas.where}: {name}: wanted channels R, G and B, got {listed}")


def _psf(canvas: Canvas, values: Values) -> Step:
    from daguerre.io.images import read_environment

    kernel = read_environment(Path(values["file"]))
    height, width = kernel.shape[:2]
    if height > canvas.height or width > canvas.width:
        raise InputError(
            f"{values['file']}: point spread: wanted no more than the picture's "
            f"{canvas.width} x {canvas.height} px, got {width} x {height}"
        )
    if not (np.isfinite(kernel).all() and (kernel.sum(axis=(0, 1)) > 0).all()):
        raise InputError(f"{values['file']}: point spread: wanted finite values, some above 0")
    colors = len(canvas.colors) - canvas.alpha
    kernel = kernel[:, :, :3] if colors == 3 else kernel[:, :, :3].mean(axis=2, keepdims=True)
    if values["normalise"]:
        kernel = kernel / kernel.sum(axis=(0, 1), dtype=np.float64)
    return Spreading(canvas, spreader_of(kernel, _shape(canvas)))


SHARE = Parameter("share", "share of the light that is spread", default=0.05, low=0, high=1)

BLOOM = Effect(
    "bloom",
    "a soft glow about bright things",
    (
        Parameter(
            "radius", "radius within which half of the spread light falls", "px", 12.0, low=0.1
        ),
        SHARE,
    ),
    _bloom,
)
HALO = Effect(
    "halo",
    "halation of film: a ring about lamps, by reflection at the back of the base",
    (
        Parameter("thickness", "thickness of the base", "mm", 0.13, low=1e-3),
        Parameter("index", "refractive index of the base", default=1.48, low=1.01, high=3),
        SHARE,
        Parameter("red", "share of red that takes part", default=1.0, low=0),
        Parameter("green", "share of green that takes part", default=0.3, low=0),
        Parameter("blue", "share of blue that takes part", default=0.05, low=0),
        SENSOR,
    ),
    _halo,
)
GLARE = Effect(
    "glare",
    "veiling glare: light that glass, barrel and dust scatter over the whole picture",
    (
        Parameter("share", "veiling glare index, of the light", default=0.02, low=0, high=1),
        Parameter("shoulder", "radius at which the power law begins", "mm", 0.5, low=1e-3),
        Parameter("slope", "exponent of the power law", default=2.0, low=0, high=6),
        SENSOR,
    ),
    _glare,
)
DIFFRACTION = Effect(
    "diffraction",
    "diffraction of light by an iris: softness, rings and stars",
    (
        *IRIS,
        SENSOR,
        Parameter("size", "width of the kernel", "px", kind="whole", low=1, high=8191),
        Parameter(
            "wavelengths",
            "number of wavelengths, 400 to 700 nm",
            default=24,
            kind="whole",
            low=3,
            high=400,
        ),
    ),
    _diffraction,
)
STAR = Effect(
    "star",
    "the star of an iris alone, as strong as wanted: sharpness stays",
    (Parameter("share", "share of the light in the star", default=0.02, low=0, high=1),
     *DIFFRACTION.parameters),
    _star,
)  # fmt: skip
PSF = Effect(
    "psf",
    "a point spread of one's own, the same everywhere",
    (
        Parameter("file", "a picture, linear if it is .exr or .hdr", kind="text", default=REQUIRED),
        Parameter(
            "normalise", "whether to keep the light of each colour", kind="flag", default=True
        ),
    ),
    _psf,
)


@guarded(arrays=False)
def bloom(image: Image, **parameters: Any) -> Image:
    """A soft glow: ``radius`` (px) holds half of the ``share`` of the light that is spread.

    Args:
        image: Scene-linear, shape (H, W, C).
        **parameters: Those of the effect ``bloom``.
    """
    return on_array(BLOOM, image, parameters)


@guarded(arrays=False)
def halo(image: Image, **parameters: Any) -> Image:
    """Halation: ``thickness`` (mm) and ``index`` of the base, ``share``, ``sensor`` (mm, mm)."""
    return on_array(HALO, image, parameters)


@guarded(arrays=False)
def glare(image: Image, **parameters: Any) -> Image:
    """Veiling glare: ``share``, ``shoulder`` (mm), ``slope``, ``sensor`` (mm, mm)."""
    return on_array(GLARE, image, parameters)


@guarded(arrays=False)
def diffract(image: Image, **parameters: Any) -> Image:
    """Diffraction at an iris, of RGB: ``f_number``, ``blades``, ``rotation`` (deg), ``sensor``."""
    return on_array(DIFFRACTION, image, parameters)


@guarded(arrays=False)
def star(image: Image, **parameters: Any) -> Image:
    """The star alone, with a ``share`` of the light; else as :func:`diffract`."""
    return on_array(STAR, image, parameters)


@guarded(arrays=False)
def spread_by(image: Image, **parameters: Any) -> Image:
    """Convolution with the picture ``file``; its sum is 1 unless ``normalise`` is False."""
    return on_array(PSF, image, parameters)
