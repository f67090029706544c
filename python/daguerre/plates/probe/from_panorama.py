"""Makes environments from photographed panoramas, turned and resized."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

from .asked import Asked
from .brackets import read_view
from .latlong import FloatArray
from .panorama import resized, turned


@dataclass(frozen=True)
class PanoramaLight:
    """An environment before the search for the sun.

    Attributes:
        light: Light, float32, shape (H, W, 3).
        clipped: Mask of clipped pixels, shape (H, W).
        absolute: Whether light is in cd/m2.
        facts: Facts about its making, for JSON.
        sun: Direction and illuminance of a sun that is not in ``light``; None: unknown.
    """

    light: NDArray[np.float32]
    clipped: NDArray[np.bool_]
    absolute: bool
    facts: dict[str, Any] = field(default_factory=dict)
    sun: tuple[FloatArray, FloatArray] | None = None


def panorama(asked: Asked) -> PanoramaLight:
    """Reads a bracketed panorama, 2:1, in the frame of environments.

    Raises:
        InputError: The picture is not 2:1.
    """
    view = read_view(asked.photographs, asked.ev, asked.reading)
    width, height = view.shots[0].size
    if width != 2 * height:
        raise InputError(
            f"{view.path}: panorama: wanted a width of twice the height, got {width}x{height} px; "
            "for photographs of a ball use --ball mirror or --ball grey"
        )
    size = (asked.res or width, (asked.res or width) // 2)
    light = resized(turned(view.merged.light, asked.rotate), *size)
    clipped = view.merged.clipped.astype(np.float32)[..., None]
    over = resized(turned(clipped, asked.rotate), *size)[..., 0]
    facts = {"photographs": view.facts(), "response": view.curve, "kind": "panorama"}
    return PanoramaLight(light, over > 1e-3, view.exposures.absolute, facts)
