"""Noise removal by Intel Open Image Denoise, guided by albedo and normal. An extra."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from importlib.metadata import version
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color.spectra import xyz_of
from daguerre.errors import InputError, UsageError

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame


def check_available() -> None:
    """Says how to install the denoiser, if it is not there.

    Raises:
        UsageError: It is not installed.
    """
    if find_spec("pyoidn") is None:
        raise UsageError(
            "denoise: wanted the package pyoidn, which is not installed; "
            'install it with: pip install "daguerre[denoise]"'
        )


def denoise(frame: Frame) -> Frame:
    """A copy of the frame with a clean ``rgb``; the other channels stay as they are.

    It has no channels of a sensor and no bands: noisy ones beside a clean picture would be of no
    use. A sensor is fitted from the colours.

    The denoiser wants colours of at least 0, so negative ones (outside Rec.709) become 0.

    Raises:
        UsageError: The denoiser is not installed.
        InputError: It failed.
    """
    check_available()
    pyoidn: Any = import_module("pyoidn")
    color = np.ascontiguousarray(np.maximum(np.nan_to_num(frame.rgb), 0), np.float32)
    albedo, normal = _group(frame, "albedo", "RGB"), _group(frame, "N", "XYZ")
    if albedo is not None:
        albedo = np.clip(albedo, 0, 1)
    if normal is not None:
        normal = np.clip(normal, -1, 1)
    try:
        # A normal alone is not accepted by the library; it guides only beside an albedo.
        clean = pyoidn.denoise(
            color, albedo=albedo, normal=normal if albedo is not None else None, hdr=True
        )
    except (RuntimeError, OSError) as error:
        raise InputError(f"denoise: Open Image Denoise failed: {error}") from error
    metadata = {**frame.metadata, "denoised": f"pyoidn {version('pyoidn')}"}
    rgb = np.asarray(clean, np.float32)
    return replace(frame, rgb=rgb, xyz=xyz_of(rgb), channels=None, bands=None, metadata=metadata)


def _group(frame: Frame, name: str, parts: str) -> NDArray[np.float32] | None:
    planes = [frame.aovs.get(f"{name}.{part}") for part in parts]
    if any(plane is None for plane in planes):
        return None
    return np.ascontiguousarray(np.stack([np.asarray(p) for p in planes], axis=2), np.float32)
