"""Blur by the point spread functions of a lens, which change over the frame."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.convolution.convolve import Spreader
from daguerre.errors import InputError, UsageError
from daguerre.post.array import on_array
from daguerre.post.effect import Effect, Step, Values
from daguerre.post.kernels import Floats, delta
from daguerre.post.optics import LENS, SENSOR, Plane, bench, film_plane
from daguerre.post.parameter import REQUIRED, Parameter
from daguerre.post.picture import Canvas, Image
from daguerre.post.spreading import Spreading

from .glow import IRIS, LARGEST, iris_of

if TYPE_CHECKING:
    from daguerre.analysis.bench import Bench
    from daguerre.analysis.iris import Iris
    from daguerre.analysis.pencils import Pencil

WAVES = 257  # px; wider kernels are computed with rays
FRINGES = 500.0  # wavelengths x f-number; wider kernels are computed with rays
RAYS = 96  # rays across the pupil


def _make(canvas: Canvas, values: Values) -> Step:
    """Step with kernels at a grid of points from edge to edge of the picture, blended between."""
    if len(canvas.colors) - canvas.alpha != 3:
        listed = ", ".join(canvas.colors)
        raise InputError(f"{canvas.where}: lens-psf: wanted channels R, G and B, got {listed}")
    film, lens, iris = film_plane(canvas, values), bench(values), iris_of(values)
    lens = lens.moved(lens.film_z + values["defocus"])
    points = _points(canvas, film, values["zones"])
    lights = [[_light(lens, point) for point in row] for row in points]
    found = [light for row in lights for light in row if light is not None]
    if not found:
        raise InputError(
            f"{canvas.where}: lens-psf: no light passes through {lens.lens.name} to the film"
        )
    size = _size(canvas, found, film.pitch_mm)
    narrow = size <= WAVES and size * film.pitch_mm <= FRINGES * 0.55e-3 * lens.f_stop
    waves, count = values["waves"] and narrow, values["wavelengths"]
    kernels = [
        [_kernel(lens, light, iris, film.pitch_mm, size, count, waves) for light in row]
        for row in lights
    ]
    grid = np.asarray(kernels, np.float32)
    return Spreading(canvas, Spreader(grid, (canvas.height, canvas.width)))


def _points(canvas: Canvas, film: Plane, zones: int) -> list[list[tuple[float, float]]]:
    """Film points (mm) of the grid; the picture is upside down on the film."""
    share = np.linspace(0, 1, zones) if zones > 1 else np.array([0.5])
    x, y = (
        (corner + share * extent - center) * film.pitch_mm
        for corner, extent, center in zip(
            canvas.corner, (canvas.width, canvas.height), film.center, strict=True
        )
    )
    return [[(-float(a), float(b)) for a in x] for b in y]


def _light(lens: Bench, film_mm: tuple[float, float]) -> Pencil | None:
    from daguerre.analysis.pencils import pencil

    return pencil(lens, film_mm)


def _size(canvas: Canvas, lights: list[Pencil], pitch: float) -> int:
    """Odd size, px, that holds all point spreads and some diffraction rings."""
    from daguerre.analysis.spots import spot

    reach = 0.0
    for light in lights:
        points = spot(light, grid=24).points
        reach = max(reach, float(np.abs(points).max(initial=0)))
    reach += 12 * 0.65e-3 * lights[0].bench.f_stop
    most = min(LARGEST, 2 * max(canvas.width, canvas.height) - 1)
    size = 2 * math.ceil(reach / pitch) + 3
    if size > most:
        raise UsageError(
            f"{canvas.where}: lens-psf: wanted a point spread of at most {most} px, got {size} px: "
            "the lens is too far out of focus"
        )
    return size


def _kernel(
    lens: Bench, light: Pencil | None, iris: Iris, pitch: float, size: int, count: int, waves: bool
) -> Floats:
    """Kernel from channel to channel, shape (size, size, 3, 3); identity where no light arrives."""
    from daguerre.analysis.lens_pupil import lens_pupil
    from daguerre.color.spectra import rgb_mixes
    from daguerre.post.starburst import starburst

    nm, _ = rgb_mixes(count)
    if light is None:
        return delta(size)[:, :, None, None] * np.eye(3, dtype=np.float32)
    if not waves:
        return _of_rays(light, iris, pitch, size, count)
    place = (float(light.film[0]), float(light.film[1]))
    pupil = lens_pupil(lens, place, iris, nm.tolist())
    if pupil is None:
        return _kernel(lens, None, iris, pitch, size, count, waves)
    return starburst(pupil, pitch, size, wavelengths=count)


def _of_rays(light: Pencil, iris: Iris, pitch: float, size: int, count: int) -> Floats:
    """Kernel by rays alone, for blur far wider than diffraction."""
    from daguerre.color.spectra import rgb_mixes

    wide = replace(light.bench, iris_radius=light.bench.iris_radius * iris.outer_radius)
    light = _light(wide, (float(light.film[0]), float(light.film[1]))) or light
    edges = (np.arange(size + 1) - 0.5 * size) * pitch
    at = light.grid(RAYS)
    out = np.zeros((size, size, 3, 3), np.float32)
    for nm, mix in zip(*rgb_mixes(count), strict=True):
        rays = light.trace(at, float(nm))
        unit = (rays.iris / (wide.iris_radius / iris.outer_radius)).astype(np.float32)
        share = iris.amplitude(unit[:, 0], unit[:, 1], 2 / RAYS) ** 2
        share = np.where(rays.passed, share * light.flux(at) * rays.transmittance, 0)
        off = np.where(rays.passed[:, None], light.film - rays.at(wide.film_z), 0)
        image, _, _ = np.histogram2d(-off[:, 1], off[:, 0], bins=(edges, edges), weights=share)
        image /= max(float(image.sum()), 1e-30)
        out += (image[:, :, None, None] * mix).astype(np.float32)
    return out


LENS_PSF = Effect(
    "lens-psf",
    "sharpness of a lens from centre to corners, by its point spread functions",
    (
        replace(LENS[0], default=REQUIRED),
        *LENS[1:],
        Parameter("defocus", "film shift from the focus, positive away from the lens", "mm", 0.0),
        Parameter("zones", "number of point spread functions along each side", default=5,
                  kind="whole", low=1, high=17),
        Parameter("wavelengths", "number of wavelengths, 400 to 700 nm", default=9,
                  kind="whole", low=3, high=64),
        Parameter("waves", "whether to include diffraction; 0 is far faster for wide blur",
                  kind="flag", default=True),
        *IRIS[1:],
        SENSOR,
    ),
    _make,
)  # fmt: skip


@guarded(arrays=False)
def through_lens(image: Image, **parameters: object) -> Image:
    """Blurs a picture by the point spread functions of a lens; distortion is not applied.

    Args:
        image: Scene-linear RGB picture, shape (H, W, 3), or (H, W, 4) with alpha, which is not
            changed.
        **parameters: Parameters of the effect ``lens-psf``, such as ``lens``, ``focus`` (m),
            ``zoom`` (mm), ``f_stop``, ``defocus`` (mm), ``zones``, ``sensor`` (mm, mm).
    """
    return on_array(LENS_PSF, image, parameters)
