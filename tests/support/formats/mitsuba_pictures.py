"""Pictures by Mitsuba 3, in a process of its own: its libraries stay out of the tests'."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np

VARIANT = "scalar_rgb"
_DRAW = """
import sys
import numpy as np
import mitsuba as mi
mi.set_variant(sys.argv[1])
picture = mi.render(mi.load_file(sys.argv[2]), seed=1)
np.save(sys.argv[3], np.array(picture, dtype=np.float32)[..., :3])
"""


def installed() -> bool:
    """Whether Mitsuba is there."""
    return importlib.util.find_spec("mitsuba") is not None


def draw(path: Path) -> np.ndarray:
    """Renders a file, shape (H, W, 3)."""
    out = path.with_suffix(".npy")
    words = [sys.executable, "-c", _DRAW, VARIANT, str(path), str(out)]
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    return np.load(out)


def blocks(picture: np.ndarray, side: int = 16) -> np.ndarray:
    """Means of square blocks, shape (rows, columns, 3)."""
    height, width = (length // side * side for length in picture.shape[:2])
    cut = picture[:height, :width].astype(np.float64)
    return cut.reshape(height // side, side, width // side, side, 3).mean(axis=(1, 3))
