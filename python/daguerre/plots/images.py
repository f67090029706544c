"""Pictures of the bench in axes: the lens in section, spots, point spread functions, wavefronts."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from .lens_file import add_shape

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from daguerre.analysis.psf import Psf
    from daguerre.analysis.spots import Spot
    from daguerre.analysis.wavefronts import Wavefront

    from .lens_section import Drawing

INK = "#222222"
SPECTRUM = "turbo"
SHORTEST, LONGEST = 400.0, 700.0  # nm, the ends of its colours


def lens(axes: Axes, drawing: Drawing, scale: float = 0.8) -> None:
    """Draws the section of a lens with its rays, and a scale bar."""
    for shape in drawing.shapes:
        add_shape(axes, shape, scale)
    axes.set_aspect("equal")
    axes.set_xlim(drawing.left, drawing.right)
    axes.set_ylim(-drawing.top, drawing.top)
    axes.set_axis_off()
    axes.margins(0)
    scale_bar(axes, drawing.left, -drawing.top, drawing.right - drawing.left, 9 * scale)


def scale_bar(axes: Axes, x: float, y: float, span: float, size: float) -> None:
    """Draws a scale bar of 1, 2 or 5 times a power of ten, mm, with text of a size in points."""
    length = round_length(0.2 * span)
    axes.plot([x, x + length], [y, y], color=INK, lw=1)
    axes.text(x + 0.5 * length, y, f"{length:g} mm", size=size, ha="center", va="bottom")


def round_length(about: float) -> float:
    """Largest 1, 2 or 5 times a power of ten, up to ``about``."""
    power = 10.0 ** math.floor(math.log10(about))
    return max(k * power for k in (1, 2, 5) if k * power <= about)


def spot(axes: Axes, found: Spot) -> None:
    """Plots where the rays of each wavelength meet the film, about their centroid."""
    from matplotlib import colormaps

    axes.set_aspect("equal")
    axes.set_xlabel("sagittal, µm")
    axes.set_ylabel("tangential, µm")
    if not len(found.weights):
        axes.set_title("Spot: no light arrives")
        return
    off = 1e3 * (found.points - found.centroid)
    for nm in np.unique(found.wavelength_nm):
        color = colormaps[SPECTRUM]((nm - SHORTEST) / (LONGEST - SHORTEST))
        of = found.wavelength_nm == nm
        axes.plot(*off[of].T, ".", ms=2, mew=0, color=color, label=f"{nm:.0f} nm", rasterized=True)
    axes.set_title(f"Spot: RMS {1e3 * found.rms:.3g} µm")
    axes.legend(markerscale=4)


def psf(axes: Axes, found: Psf) -> None:
    """Draws the point spread function, the square root of its light."""
    half = 1e3 * found.half_mm
    image = np.sqrt(found.image / (found.image.max() or 1.0))
    axes.imshow(image, extent=(-half, half, -half, half), origin="lower", cmap="inferno")
    axes.grid(visible=False)
    axes.set_title(f"Square root of the PSF, by {'waves' if found.diffraction else 'rays'}")
    axes.set_xlabel("sagittal, µm")
    axes.set_ylabel("tangential, µm")


def wavefront(axes: Axes, found: Wavefront) -> None:
    """Draws the wavefront over the directions of the light, in wavelengths."""
    (left, right), (low, high) = (
        (found.cosines[..., k].min(), found.cosines[..., k].max()) for k in range(2)
    )
    reach = float(np.nanmax(np.abs(found.waves), initial=1e-6))
    drawn = axes.imshow(
        found.waves, extent=(left, right, low, high), origin="lower", cmap="RdBu", vmin=-reach,
        vmax=reach,
    )  # fmt: skip
    axes.figure.colorbar(drawn, ax=axes, label="wavelengths")
    axes.grid(visible=False)
    axes.set_title(f"Wavefront at {found.wavelength_nm:.4g} nm: RMS {found.rms_waves:.3g}")
    axes.set_xlabel("direction cosine, sagittal")
    axes.set_ylabel("tangential")
