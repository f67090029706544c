"""Effects that spread light: bloom, halation, stars, diffraction, veiling glare, any kernel."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from daguerre import units
from daguerre.argument_checks import guarded
from daguerre.convolution.convolve import spreader_of
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

LARGEST = 2049  # px, largest width of a kernel
COARSE = 768  # px, shorter side of the reduced picture on which veils are spread

IRIS = (
    Parameter(
        "f_number",
        "working f-number (image side)",
        default=REQUIRED,
        low=0.3,
        parse=units.f_number,
        wants=f"{units.F_NUMBER}, at least 0.3",
    ),
    Parameter("blades", "number of iris blades; 0: round", default=0, kind="whole", low=0, high=64),
    Parameter("rotation", "rotation of the blades", "deg", 0.0),
    Parameter(
        "curvature", "curvature of the blades; 0: straight, 1: round", default=0.0, low=-1, high=1
    ),
    Parameter("dust", "path of a picture of dust on the iris; white is clear", kind="file"),
)


def _shared(canvas: Canvas, share: float | Floats, kernel: Floats) -> Step:
    """Step that spreads a share of the light and keeps the rest; the sum does not change."""
    shares = np.asarray(share, np.float32)
    return Spreading(canvas, spreader_of(kernel * shares, _shape(canvas)), 1 - shares)


def _shape(canvas: Canvas) -> tuple[int, int, int]:
    """Shape of the picture's colours, without alpha."""
    return canvas.height, canvas.width, len(canvas.colors) - canvas.alpha


def _window(canvas: Canvas, wanted_px: float) -> int:
    """Odd size of a kernel: the wanted size, limited to pixels that can reach the picture."""
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
    # The emulsion's last layer, next to the base, records red.
    shares = np.array([values["red"], values["green"], values["blue"]], np.float32)
    shares = values["share"] * (shares if colors == 3 else shares[:1])
    if (shares > 1).any():
        raise UsageError(f"{canvas.where}: halo: share times red, green or blue must be at most 1")

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
    """Makes the iris from the parameters."""
    from daguerre.analysis.iris import Iris

    if values["blades"] in (1, 2):
        raise UsageError(f"blades: wanted 0 (round) or 3 to 64, got {values['blades']}")
    mask = None
    if values["dust"] is not None:
        from daguerre.pictures.iris import read_grey

        mask = np.minimum(read_grey(Path(values["dust"])), 1)
    return Iris(values["blades"], values["rotation"], values["curvature"], mask=mask)


def _needs_rgb(canvas: Canvas, name: str) -> None:
    if len(canvas.colors) - canvas.alpha != 3:
        listed = ", ".join(canvas.colors)
        raise InputError(f"{canvas.where}: {name}: wanted channels R, G and B, got {listed}")


def _psf(canvas: Canvas, values: Values) -> Step:
    from daguerre.pictures.light import read_environment

    kernel: Any = read_environment(Path(values["file"]), is_data=True)
    height, width = kernel.shape[:2]
    if height > canvas.height or width > canvas.width:
        raise InputError(
            f"{values['file']}: point spread: wanted at most the picture's size, "
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
    "a soft glow around bright areas",
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
    "halation of film: a ring around lamps, by reflection at the back of the base",
    (
        Parameter("thickness", "thickness of the base", "mm", 0.13, low=1e-3),
        Parameter("index", "refractive index of the base", default=1.48, low=1.01, high=3),
        SHARE,
        Parameter("red", "factor on share for red", default=1.0, low=0),
        Parameter("green", "factor on share for green", default=0.3, low=0),
        Parameter("blue", "factor on share for blue", default=0.05, low=0),
        SENSOR,
    ),
    _halo,
)
GLARE = Effect(
    "glare",
    "veiling glare: light scattered over the whole picture by glass, barrel and dust",
    (
        Parameter("share", "share of the light (veiling glare index)", default=0.02, low=0, high=1),
        Parameter("shoulder", "radius at which the power law begins", "mm", 0.5, low=1e-3),
        Parameter("slope", "exponent of the power law", default=2.0, low=0, high=6),
        SENSOR,
    ),
    _glare,
)
DIFFRACTION = Effect(
    "diffraction",
    "diffraction at the iris: softness, rings and stars",
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
    "the diffraction star of an iris with any strength, without loss of sharpness",
    (Parameter("share", "share of the light in the star", default=0.02, low=0, high=1),
     *DIFFRACTION.parameters),
    _star,
)  # fmt: skip
PSF = Effect(
    "psf",
    "convolution with a point spread function from a file, the same everywhere",
    (
        Parameter(
            "file",
            "path of the kernel, a picture; linear if .exr or .hdr",
            kind="file",
            default=REQUIRED,
        ),
        Parameter(
            "normalise",
            "whether to scale the kernel to sum 1 in each colour",
            kind="flag",
            default=True,
        ),
    ),
    _psf,
)


@guarded(arrays=False)
def bloom(image: Image, **parameters: object) -> Image:
    """Adds bloom: a ``share`` of the light is spread, half of it within ``radius`` (px).

    Args:
        image: Scene-linear picture, shape (H, W, C).
        **parameters: Parameters of the effect ``bloom``.
    """
    return on_array(BLOOM, image, parameters)


@guarded(arrays=False)
def halo(image: Image, **parameters: object) -> Image:
    """Adds halation of film.

    Args:
        image: Scene-linear picture, shape (H, W, C).
        **parameters: Parameters of the effect ``halo``: ``thickness`` (mm) and ``index`` of the
            base, ``share``, ``red``, ``green``, ``blue``, ``sensor`` (mm, mm).
    """
    return on_array(HALO, image, parameters)


@guarded(arrays=False)
def glare(image: Image, **parameters: object) -> Image:
    """Adds veiling glare.

    Args:
        image: Scene-linear picture, shape (H, W, C).
        **parameters: Parameters of the effect ``glare``: ``share``, ``shoulder`` (mm), ``slope``,
            ``sensor`` (mm, mm).
    """
    return on_array(GLARE, image, parameters)


@guarded(arrays=False)
def diffract(image: Image, **parameters: object) -> Image:
    """Adds diffraction at an iris.

    Args:
        image: Scene-linear RGB picture, shape (H, W, C).
        **parameters: Parameters of the effect ``diffraction``, such as ``f_number``, ``blades``,
            ``rotation`` (deg), ``sensor`` (mm, mm).
    """
    return on_array(DIFFRACTION, image, parameters)


@guarded(arrays=False)
def star(image: Image, **parameters: object) -> Image:
    """Adds only the diffraction star, with a ``share`` of the light.

    Args:
        image: Scene-linear RGB picture, shape (H, W, C).
        **parameters: ``share``, and the parameters of :func:`diffract`.
    """
    return on_array(STAR, image, parameters)


@guarded(arrays=False)
def spread_by(image: Image, **parameters: object) -> Image:
    """Convolves a picture with a point spread function from a file.

    Args:
        image: Scene-linear picture, shape (H, W, C).
        **parameters: ``file``, the path of the kernel, and ``normalise``: whether to scale it to
            sum 1 in each colour (default: True).
    """
    return on_array(PSF, image, parameters)
