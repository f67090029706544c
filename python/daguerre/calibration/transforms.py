"""``transforms.json`` of instant-ngp and Nerfstudio: pictures with poses, and one lens or several.

Poses are world from camera, and the camera's frame is Daguerre's: x right, y up, looking along -z.
Principal points are COLMAP's, from which most of these files are made, so **pixel centres are at
halves**. The world is taken for the scene's.

Sources: Nerfstudio, "Data conventions" and nerfstudio/cameras/camera_utils.py; instant-ngp,
docs/nerf_dataset_tips.md and scripts/colmap2nerf.py.
"""

from __future__ import annotations

import math
from typing import Any

from daguerre.argument_checks import guarded
from daguerre.camera.projection import Projection
from daguerre.files.json_item import Item, short
from daguerre.files.source import Source

from .calibration import Calibration, projection
from .source import agreed, choice, load, rigid

#: camera_model -> Daguerre's model, and the names of its coefficients in Daguerre's order.
MODELS: dict[str, tuple[str, tuple[str, ...]]] = {
    "PINHOLE": ("rectilinear", ()),
    "SIMPLE_PINHOLE": ("rectilinear", ()),
    "SIMPLE_RADIAL": ("opencv", ("k1",)),
    "RADIAL": ("opencv", ("k1", "k2")),
    "OPENCV": ("opencv", ("k1", "k2", "p1", "p2", "k3")),
    "OPENCV_FISHEYE": ("kannala_brandt", ("k1", "k2", "k3", "k4")),
}
COEFFICIENTS = ("k1", "k2", "k3", "k4", "p1", "p2")


@guarded
def read_transforms(
    source: Source, *, size: tuple[int, int] | None = None, unit_m: float = 1.0
) -> dict[str, Calibration]:
    """Reads the pictures of a file, by their paths.

    Args:
        source: JSON file, or its values as a dict.
        size: Width and height of the pictures, px, if the file does not have them.
        unit_m: Length of the world's unit, m.

    Raises:
        InputError: The file cannot be used; the message has the place in it.
    """
    root = load(source)
    listed = root.list_of("frames")
    if not listed:
        root.fail("frames: no pictures")
    found: dict[str, Calibration] = {}
    for item in listed:
        named = item.need("file_path")
        name = named.text()
        if name in found:
            named.fail(f"picture {short(name)} appears twice")
        pose = rigid(item.need("transform_matrix"))
        pose[:3, 3] *= unit_m
        settings = {"transform": pose}
        found[name] = Calibration(_projection(item, root, size), name, settings=settings)
    return found


def _projection(item: Item, root: Item, size: tuple[int, int] | None) -> Projection:
    """Projection of a picture; its own values take precedence over values of the whole file."""

    def told(name: str) -> Item | None:
        found = item.get(name)
        return root.get(name) if found is None else found

    def number(name: str, default: float) -> float:
        found = told(name)
        return default if found is None else found.number()

    width, height = agreed(item, "w and h", _size(told("w"), told("h")), size)
    fx = _focal(told, "x", width, root)
    fy = fx if told("fl_y") is None and told("camera_angle_y") is None else 0.0
    fy = fy or _focal(told, "y", height, root)
    fisheye = told("is_fisheye")
    kind = "OPENCV" if fisheye is None or fisheye.value is not True else "OPENCV_FISHEYE"
    named = told("camera_model")
    model, names = MODELS[kind if named is None else choice(named, MODELS)]
    for name in COEFFICIENTS:
        other = told(name)
        if other is not None and name not in names and other.number() != 0:
            other.fail(f"wanted {', '.join(names) or 'no coefficients'} for {model}, got {name}")
    center = number("cx", width / 2) - 0.5, number("cy", height / 2) - 0.5
    values = tuple(number(name, 0.0) for name in names)
    if not any(values) and model == "opencv":
        model, values = "rectilinear", ()
    where = f"{item.file}: {item.path}"
    return projection(where, model, (width, height), (fx, fy), center, values)


def _size(width: Item | None, height: Item | None) -> tuple[int, int] | None:
    if width is None or height is None:
        return None
    sides = []
    for side in (width, height):
        value = side.number(1, 65536)
        if value != int(value):
            side.fail(f"wanted a whole number of pixels, got {value:g}")
        sides.append(int(value))
    return sides[0], sides[1]


def _focal(told: Any, axis: str, side: int, root: Item) -> float:
    """Focal length, px, as given, or from the angle of view."""
    focal, angle = told(f"fl_{axis}"), told(f"camera_angle_{axis}")
    if focal is not None:
        return float(focal.number(above=0))
    if angle is None:
        root.fail(f"missing: a focal length (fl_{axis} or camera_angle_{axis})")
    return float(side / 2 / math.tan(angle.number(1e-6, 3.14) / 2))
