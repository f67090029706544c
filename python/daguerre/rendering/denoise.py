"""Denoising by Intel Open Image Denoise (extra ``denoise``), guided by albedo and normal.

``README.md`` explains its inputs and its error estimate.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from importlib import import_module
from importlib.metadata import version
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color.spectra import xyz_of
from daguerre.errors import InputError, UsageError
from daguerre.files import extras

from .adaptive import DARK
from .denoise_catchers import clean_catchers
from .denoiser import Denoiser

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

Image = NDArray[np.float32]

MODULE = "mitsuba_oidn"
PACKAGE = extras.EXTRAS[MODULE][0]
#: Side of the squares over which means are compared, to find light that denoising moved, px.
BLOCK = 8


def check_available() -> None:
    """Checks that the denoiser is installed and can be loaded.

    Raises:
        UsageError: It is not; the message says how to install it.
    """
    extras.need(MODULE, "denoise")
    try:
        import_module(MODULE)
    except (ImportError, OSError, RuntimeError) as error:  # such as a system without libatomic
        raise UsageError(
            f"denoise: {PACKAGE} is installed but cannot be loaded ({error}); it needs the "
            "system's libatomic: on Debian and Ubuntu, apt install libatomic1"
        ) from error


def denoise(frame: Frame) -> Frame:
    """Returns a copy of the frame with denoised ``rgb`` and catcher layers; the rest is unchanged.

    Ghosts of the lens stay as drawn, as the guides do not show them. Scattered light without ghosts
    is denoised separately. The copy has no sensor channels and no bands, which would be noisy
    beside a clean picture; sensors are fitted to the colours instead.

    The denoiser needs colours of at least 0, so negative values (outside Rec.709) become 0.

    Metadata ``denoised`` names the denoiser. If the frame has halves, ``denoised_noise`` is the
    relative error that is left (see ``error_left``). If a target noise was set, ``noise`` has that
    value too, and ``noise_of`` says so.

    Raises:
        UsageError: The denoiser is not installed.
        InputError: The denoiser failed.
    """
    check_available()
    return denoised(frame, Denoiser(f"{PACKAGE} {version(PACKAGE)}", _run))


def preview(frame: Frame) -> Frame:
    """Returns a copy of the frame that is denoised quickly, by one thread of the CPU.

    It has more errors than :func:`denoise` leaves, and no estimate of them.

    Raises:
        UsageError: The denoiser is not installed.
        InputError: The denoiser failed.
    """
    check_available()
    return denoised(replace(frame, halves=None), Denoiser(f"{PACKAGE}, fast", _run_fast))


def denoised(frame: Frame, by: Denoiser) -> Frame:
    """Returns a copy of the frame that another denoiser made; see :func:`denoise`."""
    cleaner = Cleaner.of(frame, by.run)
    clean, left = _cleaned(frame, cleaner)
    facts: dict[str, Any] = {"denoised": by.name}
    if left is not None:
        facts["denoised_noise"] = left
        if "noise" in frame.metadata:
            facts |= {"noise": left, "noise_of": "denoised"}
    rgb = (
        clean if frame.flare is None else clean + _by_the_lens(frame.flare, frame.metadata, by.run)
    )
    return replace(
        frame, rgb=rgb, xyz=xyz_of(rgb), channels=None, bands=None,
        metadata={**frame.metadata, **facts}, **clean_catchers(frame, cleaner),
    )  # fmt: skip


def _by_the_lens(flare: Image, facts: Mapping[str, Any], run: Callable[..., Image]) -> Image:
    """Light that the lens added: ghosts as drawn, or scattered light alone, denoised."""
    drawn = np.asarray(flare, np.float32)
    alone = "scatter" in facts and "flare" not in facts
    return run(color=np.maximum(_finite(drawn), 0)) if alone else drawn


def noise_after(frame: Frame) -> float | None:
    """Relative error that denoising this frame would leave; None: unknown."""
    return _cleaned(frame, Cleaner.of(frame))[1]


def _cleaned(frame: Frame, cleaner: Cleaner) -> tuple[Image, float | None]:
    """Denoises the scene without ghosts; returns it and the error that is left (None: unknown)."""
    scene = _without(np.asarray(frame.rgb, np.float32), frame.flare)
    clean = cleaner(scene)
    return clean, _error_left(frame, cleaner, scene, clean)


@dataclass(frozen=True)
class Cleaner:
    """Denoiser of a frame, for pictures (H, W, 3) of its scene.

    It denoises the light of light paths separately: discs of defocused lamps have edges that no
    guide shows, and their noise differs from the noise of the scene.

    Attributes:
        run: Filter, as ``run`` of a ``Denoiser``.
        guides: Denoised albedo and normal; None: there are none.
        splats: Light that light paths added; None: there is none, or it is unknown.
    """

    run: Callable[..., Image]
    guides: tuple[Image, Image] | None = None
    splats: Image | None = None

    @classmethod
    def of(cls, frame: Frame, run: Callable[..., Image] | None = None) -> Cleaner:
        """Makes the denoiser of a frame, by default of the package; denoises the guides once."""
        run = run or _run
        albedo, normal = (
            _group(frame, "denoise_albedo", "RGB"),
            _group(frame, "denoise_normal", "XYZ"),
        )
        splats = None if frame.splats is None else np.maximum(_finite(frame.splats), 0)
        if albedo is None or normal is None:
            return cls(run, None, splats)
        guides = run(albedo=np.clip(albedo, 0, 1)), run(normal=np.clip(normal, -1, 1))
        return cls(run, guides, splats)

    def __call__(self, scene: Image) -> Image:
        """Denoises the scene."""
        return self._clean(_without(scene, self.splats), self.splats)

    def half(self, parts: Image) -> Image:
        """Denoises a picture of half the samples, given by its camera paths and light paths.

        Args:
            parts: Shape (H, W, 2, 3).
        """
        by_camera, by_light = (_without(parts[:, :, k], None) for k in (0, 1))
        return self._clean(by_camera, None if self.splats is None else by_light)

    def _clean(self, by_camera: Image, by_light: Image | None) -> Image:
        images: dict[str, Image] = {"color": by_camera}
        if self.guides is not None:
            images |= dict(zip(("albedo", "normal"), self.guides, strict=True))
        clean = self.run(**images)
        return clean if by_light is None else clean + self.run(color=by_light)


def _run(**images: Image) -> Image:
    """Filters the picture by clean guides, or filters a guide."""
    # The largest network is for the picture: guides are nearly clean.
    return _filtered(images, "High" if "color" in images else "Balanced")


def _run_fast(**images: Image) -> Image:
    """Filters like ``_run``, but by a small network and one thread."""
    return _filtered(images, "Fast", numThreads=1, setAffinity=0)


def _filtered(images: Mapping[str, Image], quality: str, **device: int) -> Image:
    library: ModuleType = import_module(MODULE)
    given = {name: np.ascontiguousarray(image, np.float32) for name, image in images.items()}
    made = np.empty_like(next(iter(given.values())))
    try:
        # A CPU gives the same bits for any number of threads; a GPU gives others.
        processor = library.Device(library.DeviceType.CPU)
        for name, value in device.items():
            processor.set_int(name, value)
        run = processor.new_filter("RT")
        for name, image in (*given.items(), ("output", made)):
            run.set_image(name, image)
        color = "color" in given
        run.quality = getattr(library.Quality, quality)
        run.hdr = color
        run.clean_aux = len(given) > 1
        run.execute()
    except (RuntimeError, OSError, library.Error) as error:
        raise InputError(f"denoise: Open Image Denoise failed: {error}") from error
    return made


def _error_left(frame: Frame, cleaner: Cleaner, scene: Image, clean: Image) -> float | None:
    # Ghosts keep their own noise, and diffraction comes after the halves.
    if frame.halves is None or frame.flare is not None or "diffraction" in frame.metadata:
        return None
    even, odd = (cleaner.half(frame.halves[:, :, k]) for k in (0, 1))
    variance = np.zeros_like(scene) if frame.variance is None else frame.variance
    return error_left(even, odd, clean - scene, variance)


def error_left(even: Image, odd: Image, moved: Image, variance: Image) -> float:
    """Estimates the relative error of a denoised picture from its own samples.

    Like ``noise`` of a frame it is the root mean square, over pixels and channels, of
    error / sqrt(value^2 + 0.01). It has two parts:

    - noise that is left: two denoised pictures without common samples differ by twice the error of
      their mean, for any kind of noise;
    - light that moved further than ``BLOCK`` pixels: the change of the means of squares of pixels,
      minus the part that the noise before denoising explains.

    It does not include smaller detail that the filter removes, nor light that no sample has met.
    ``value`` is the smaller of the two pictures, so that a firefly does not hide its own error.

    Args:
        even: Denoised picture of one half of the samples, (H, W, 3).
        odd: Denoised picture of the other half.
        moved: Denoised picture of all samples minus the noisy picture.
        variance: Variance of the noisy picture.
    """
    value = np.minimum(even, odd).astype(np.float64)
    weight = 1 / (value**2 + DARK)
    left = float(((even - odd).astype(np.float64) ** 2 * weight).mean()) / 4
    offset = _blocks(moved * np.sqrt(weight)) ** 2 - _blocks(variance * weight) / BLOCK**2
    return float(np.sqrt(left + max(float(offset.mean()), 0)))


def _blocks(image: NDArray[np.floating[Any]]) -> NDArray[np.float64]:
    """Means over squares of pixels; incomplete squares at the edges are dropped unless all are."""
    height, width = (max(side // BLOCK, 1) for side in image.shape[:2])
    rows, columns = (min(side, BLOCK) for side in image.shape[:2])
    cut = image[: height * rows, : width * columns]
    return np.asarray(cut.reshape(height, rows, width, columns, -1).mean((1, 3)))


def _without(image: Image, layer: Image | None) -> Image:
    """Subtracts a layer from a picture, clipped at 0."""
    rest = image if layer is None else image - layer
    return np.ascontiguousarray(np.maximum(_finite(rest), 0), np.float32)


def _finite(image: Image) -> Image:
    return np.asarray(np.nan_to_num(image), np.float32)


def _group(frame: Frame, name: str, parts: str) -> Image | None:
    planes = [frame.aovs.get(f"{name}.{part}") for part in parts]
    if any(plane is None for plane in planes):
        return None
    return np.ascontiguousarray(np.stack([np.asarray(p) for p in planes], axis=2), np.float32)
