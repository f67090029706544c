"""Diffraction in a render: the film has wavelength bands, each convolved with its own kernel.

The picture is the sum of the bands times their colours, after convolution of each with the point
spread function of a perfect wave through the pupil. Spectra that are steep within a band have
another colour than the band; the difference between the film's XYZ and the bands is spread by the
mean of their kernels, so that no light and no colour is lost. The traced picture has the
aberrations already. To a good approximation the transfer function of a lens is the product of both
(Goodman, Introduction to Fourier Optics, 3rd ed., section 6.4); it is exact where either is small.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import whole
from daguerre.color.spectra import band_colors, band_wavelengths
from daguerre.errors import InputError, UsageError
from daguerre.files.value import BriefRecord
from daguerre.sensors.bands import MOST_BANDS, weights_of_bands

if TYPE_CHECKING:
    from daguerre import _core
    from daguerre.analysis.diffraction import Pupil
    from daguerre.camera.camera import Camera
    from daguerre.sensors import Sensor
    from daguerre.setup.resolved import ResolvedCamera

MOST_ZONES = 9
LEAST_WAVELENGTHS = 24  # of all bands together
ONE_ZONE, MANY_ZONES = 2049, 1025  # maximum width of kernels, px
#: Kernels of all bands of a picture, by their size and the wavelengths; at most one entry.
Kernels = dict[tuple[int, bytes], NDArray[np.float32]]
DARK = 2e-4  # of the brightest band's colour: darker bands share the mean kernel


@guarded
@dataclass(frozen=True)
class Diffraction:
    """Settings of diffraction.

    Attributes:
        bands: Number of wavelength bands, 380 to 780 nm.
        zones: Number of points along each side of the frame that have their own kernels.
    """

    bands: int = 16
    zones: int = 1

    def __post_init__(self) -> None:
        whole(self.bands, "diffraction: bands", 3, MOST_BANDS, f"3 .. {MOST_BANDS}")
        whole(self.zones, "diffraction: zones", 1, MOST_ZONES, f"1 .. {MOST_ZONES}")

    @property
    def words(self) -> str:
        """Description for metadata."""
        return f"{self.bands} bands, {self.zones} x {self.zones} zones"


def check_diffraction(value: object) -> Diffraction | None:
    """Checks ``diffraction`` of a session: False, True, or a ``Diffraction``."""
    if value is None or value is False:
        return None
    if value is True:
        return Diffraction()
    if isinstance(value, Diffraction):
        return value
    raise UsageError(f"diffraction: wanted True, False or a Diffraction, got {value!r:.80}")


def with_bands(wanted: Diffraction | None, bands: int) -> Diffraction | None:
    """Diffraction in the bands that the frame keeps (0: none)."""
    return wanted if wanted is None or not bands else replace(wanted, bands=bands)


def plan(
    wanted: Diffraction,
    camera: Camera,
    setup: ResolvedCamera,
    resolution: tuple[int, int],
    sensor: Sensor | None = None,
) -> dict[str, Any]:
    """Data from which the kernels of a picture are made, as JSON, and a sensor's weights of bands.

    Raises:
        UsageError: The camera is a pinhole, which has no pupil.
    """
    from .pupil_files import to_json

    return {
        "bands": wanted.bands,
        "pitch_mm": setup.frame_size_mm[0] / resolution[0],
        **({} if sensor is None else {"channels": weights_of_bands(sensor, wanted.bands).tolist()}),
        **to_json(_pupils(wanted, camera, setup)),
    }


def _pupils(wanted: Diffraction, camera: Camera, setup: ResolvedCamera) -> list[list[Pupil]]:
    from daguerre.analysis.bench import on_bench
    from daguerre.analysis.diffraction import PlainPupil
    from daguerre.analysis.iris import iris_of
    from daguerre.analysis.lens_pupil import zone_pupils
    from daguerre.analysis.off_axis import off_axis
    from daguerre.camera.parameters.needs import TRACED
    from daguerre.setup.checks import lens_and_model
    from daguerre.setup.imperfections import decenters

    if setup.lens.f_stop is None:
        raise UsageError("diffraction: wanted a lens with an iris, got a pinhole")
    lens, _ = lens_and_model(camera)
    if lens is None or setup.lens.model not in TRACED:
        efl = setup.lens.effective_focal_length_mm
        seen = setup.lens.f_stop * setup.lens.pinhole_focal_length_mm / efl
        return [[PlainPupil(seen, iris_of(camera))]]  # the same everywhere
    bench = off_axis(on_bench(lens, setup.setting), decenters(camera), camera.tilt)
    iris = iris_of(camera, bench.order.stop_semi_diameter / bench.iris_radius)
    x, y = setup.shift_mm  # of the frame against the picture, which is upside down on the film
    return zone_pupils(bench, setup.frame_size_mm, wanted.zones, iris, center_mm=(-x, -y))


@dataclass(repr=False)
class Developed(BriefRecord):
    """A diffracted picture.

    Attributes:
        xyz: Shape (H, W, 3).
        channels: Channels of the plan's sensor, (H, W, C); None: no sensor.
        bands: Wavelength bands, (H, W, bands), if they are kept.
    """

    xyz: NDArray[np.float32]
    channels: NDArray[np.float32] | None = None
    bands: NDArray[np.float32] | None = None


def developed(
    film: _core.Film,
    planned: Any,
    *,
    keep: bool = False,
    threads: int = 0,
    kernels: Kernels | None = None,
) -> Developed:
    """Computes the diffracted picture of a film with bands.

    Args:
        film: Film of the core.
        planned: Plan from ``plan``.
        keep: Whether to return the bands, too.
        threads: Number of threads; 0: all cores.
        kernels: Cache of the kernels of this plan, which is filled; None: they are not kept.

    Raises:
        InputError: The plan comes from a damaged file.
    """
    from daguerre.convolution.convolve import spread

    from .pupil_files import from_json

    bands = film.mean_bands()
    try:
        pupils, pitch = from_json(planned), float(planned["pitch_mm"])
        if not 1e-5 < pitch < 10 or planned["bands"] != bands.shape[2]:
            raise ValueError("pitch or bands")
        sensor = np.asarray(planned.get("channels", ()), np.float32)
        if sensor.size and (sensor.shape[:1] != bands.shape[2:] or not np.isfinite(sensor).all()):
            raise ValueError("channels")
    except (ValueError, TypeError, KeyError) as error:
        raise InputError(f"diffraction: damaged pupil data: {error}") from None
    sums = [(film.mean_xyz, band_colors(bands.shape[2]).astype(np.float32))]
    if sensor.size:
        sums.append((film.mean_channels, sensor))
    light = np.sum([colours.sum(axis=1) for _, colours in sums], axis=0)
    dark = light <= (-1 if keep else DARK * light.max())
    bright = np.flatnonzero(~dark)
    if not len(bright):
        return Developed(*(np.asarray(mean()) for mean, _ in sums))
    nm = band_wavelengths(bands.shape[2], -(-LEAST_WAVELENGTHS // bands.shape[2]))[bright]
    size = _size(pupils, pitch, bands.shape[:2])
    known = {} if kernels is None else kernels
    if (key := (size, nm.tobytes())) not in known:
        known.clear()
        known[key] = _kernels(pupils, nm, pitch, size, threads)
    found = known[key]
    pictures = [np.zeros((*bands.shape[:2], c.shape[1]), np.float32) for _, c in sums]
    kept = np.empty_like(bands) if keep else None
    plane, made = (np.empty((*bands.shape[:2], 1), np.float32) for _ in range(2))
    for b, half in zip(bright, found, strict=True):
        plane[:] = bands[:, :, b, None]
        spread(plane, _whole(half), threads=threads, out=made)
        for picture, (_, colours) in zip(pictures, sums, strict=True):
            _add(picture, made, colours[b])
        if kept is not None:
            kept[:, :, b] = made[:, :, 0]
    mean = _whole(np.tensordot(light[bright] / light[bright].sum(), found, 1))
    del known, found, half  # frees kernels that no cache keeps; half is a view of them all
    for picture, (all_of, colours) in zip(pictures, sums, strict=True):
        rest = all_of()  # a new array at each call
        colours[dark] = 0
        for row, row_bands in zip(rest, bands, strict=True):
            row -= row_bands @ colours  # light that the bands do not represent
        for k, unit in enumerate(np.eye(rest.shape[2], dtype=np.float32)):
            plane[:] = rest[:, :, k, None]
            spread(plane, mean, threads=threads, out=made)
            _add(picture, made, unit)
    return Developed(pictures[0], pictures[1] if sensor.size else None, kept)


def _add(xyz: NDArray[np.float32], plane: NDArray[np.float32], colour: NDArray[np.float32]) -> None:
    """Adds light (H, W, 1) of a colour; row by row, to save memory."""
    for row, light in zip(xyz, plane, strict=True):
        row += light * colour


def rgb_of(xyz: NDArray[np.float32]) -> NDArray[np.float32]:
    """Converts XYZ to linear Rec.709, shape (H, W, 3)."""
    from daguerre.color.spectra import rgb_from_xyz

    return np.asarray(xyz @ rgb_from_xyz().T.astype(np.float32))


def _size(pupils: list[list[Pupil]], pitch: float, frame: tuple[int, ...]) -> int:
    from daguerre.analysis.diffraction import window_of

    most = ONE_ZONE if len(pupils) == 1 else MANY_ZONES
    most = min(most, 2 * max(frame[0], frame[1]) - 1)
    return max(window_of(p, pitch, most) for row in pupils for p in row)


def _kernels(
    pupils: list[list[Pupil]], nm: NDArray[np.float64], pitch: float, size: int, threads: int
) -> NDArray[np.float32]:
    """Kernels of bands with wavelengths, nm, shape (B, n); each preserves energy.

    Returns:
        Their right halves, shape (B, Z, Z, size, size // 2 + 1): kernels of perfect waves are
        symmetric about their middle.
    """
    from daguerre.analysis.diffraction import far_fields, light_of

    each = nm.shape[1]
    out = np.zeros((len(nm), len(pupils), len(pupils), size, size // 2 + 1), np.float32)
    for y, row in enumerate(pupils):
        for x, pupil in enumerate(row):
            found = far_fields(pupil, nm.ravel().tolist(), pitch, size, threads=threads)
            for n, kernel in enumerate(found):
                out[n // each, y, x] += kernel / np.float32(each * light_of(kernel))
    return out


def _whole(half: NDArray[np.float32]) -> NDArray[np.float32]:
    """Kernels (Z, Z, h, w, 1, 1) from their right halves."""
    from daguerre.analysis.diffraction import both_halves

    return both_halves(half)[..., None, None]
