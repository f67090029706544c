"""``camera.json`` of BOP, the benchmark of object poses: a pinhole without distortion.

Source: the BOP challenge, "Datasets format".
"""

from __future__ import annotations

from daguerre.files.source import Source

from .calibration import Calibration, projection
from .source import load

NAMES = ("fx", "fy", "cx", "cy", "width", "height")


def read_bop(source: Source) -> dict[str, Calibration]:
    """Reads the camera of a ``camera.json``.

    Raises:
        InputError: The file cannot be used; the message has the place in it.
    """
    root = load(source)
    fx, fy, x, y = (root.need(name).number() for name in NAMES[:4])
    width, height = (root.need(name).integer(1, 65536) for name in NAMES[4:])
    made = projection(root.file, "rectilinear", (width, height), (fx, fy), (x, y), ())
    return {"camera": Calibration(made)}
