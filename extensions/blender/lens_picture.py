# SPDX-License-Identifier: GPL-3.0-or-later
"""Section of the chosen lens as a picture for its panel, painted when it is first shown."""

from typing import Any

import numpy as np
from bpy.utils import previews
from numpy.typing import NDArray

from daguerre.plots.lens_section import section
from daguerre.plots.raster import painted

from .lens_facts import Facts, key_of
from .reports import told

#: Pictures that are kept; one more, and all are painted anew.
MOST = 64

_kept: Any = None
_failed: dict[str, str] = {}


def shown(group: Any, facts: Facts) -> int | str:
    """Number of the picture's icon; a text: why there is none."""
    key = repr(key_of(group))
    if key not in _kept and key not in _failed:
        if len(_kept) + len(_failed) >= MOST:
            forget()
        try:
            fill(_kept.new(key), painted(section(facts.lens, half_image=_half(facts))))
        except Exception as error:  # whatever it is, the panel shows a sentence
            _kept.pop(key, None)
            _failed[key] = told(error)
    return _failed[key] if key in _failed else int(_kept[key].icon_id)


def _half(facts: Facts) -> float | None:
    return facts.circle_mm and facts.circle_mm / 2


def fill(preview: Any, picture: NDArray[np.float32]) -> None:
    """Puts a picture, shape (H, W, 3), into a preview, whose bottom row comes first."""
    height, width = picture.shape[:2]
    preview.image_size = width, height
    pixels = np.dstack([picture, np.ones_like(picture[..., :1])])[::-1]
    preview.image_pixels_float.foreach_set(np.ascontiguousarray(pixels, np.float32).reshape(-1))


def forget() -> None:
    """Removes all pictures."""
    _kept.clear()
    _failed.clear()


def register() -> None:
    """Makes room for pictures."""
    global _kept
    _kept = previews.new()


def unregister() -> None:
    """Removes the pictures and their room."""
    global _kept
    forget()
    previews.remove(_kept)
    _kept = None
