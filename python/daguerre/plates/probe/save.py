"""Writes environments and suns to files."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError, OutputError
from daguerre.files.atomic import atomic_path
from daguerre.files.formats import check_written

from .sun import Sun

ENVIRONMENTS, SUNS = (".exr", ".hdr"), (".glb",)


def write_environment(
    path: str | os.PathLike[str], image: NDArray[np.float32], facts: Mapping[str, Any]
) -> None:
    """Writes an environment; an EXR also gets the facts, as JSON in ``daguerre:light_probe``.

    Raises:
        UsageError: The path has another suffix.
        OutputError: The file cannot be written.
    """
    if check_written(path, ENVIRONMENTS) == ".hdr":
        _write_hdr(path, image)
        return
    from daguerre import _core
    from daguerre.pictures.exr.write import attributes, write_planes

    header = attributes({"version": _core.__version__})
    header["daguerre:light_probe"] = json.dumps(facts, sort_keys=True)
    write_planes(path, header, {"RGB": np.ascontiguousarray(image)}, {})


def _write_hdr(path: str | os.PathLike[str], image: NDArray[np.float32]) -> None:
    import OpenImageIO as oiio

    height, width = image.shape[:2]
    with atomic_path(path) as temp:
        output: Any = oiio.ImageOutput.create(str(temp))
        spec = oiio.ImageSpec(width, height, 3, oiio.FLOAT)
        done = (
            output is not None
            and output.open(str(temp), spec)
            and output.write_image(image)
            and output.close()
        )
        if not done:
            said = oiio.geterror() if output is None else output.geterror()
            reason = str(said or "unknown reason").replace(str(temp), str(path))
            raise OutputError(f"{path}: cannot write: {reason}")


def write_sun(path: str | os.PathLike[str], sun: Sun | None) -> None:
    """Writes the sun as a directional light of KHR_lights_punctual, in lux.

    Raises:
        InputError: There is no sun.
        UsageError: The path has another suffix.
        OutputError: The file cannot be written.
    """
    from daguerre.exporters.gltf import Glb

    check_written(path, SUNS)
    if sun is None:
        raise InputError(f"{path}: no sun was found in the photographs, so there is none to write")
    file = Glb("daguerre light-probe")
    lux = max(sun.illuminance)
    light = {
        "type": "directional",
        "name": "sun",
        "color": [v / lux for v in sun.illuminance],
        "intensity": lux,
    }
    file.json["extensions"] = {"KHR_lights_punctual": {"lights": [light]}}
    file.use("KHR_lights_punctual")
    extensions = {"KHR_lights_punctual": {"light": 0}}
    file.add_node("sun", rotation=_turn(sun), extensions=extensions)
    file.write(Path(path))


def _turn(sun: Sun) -> tuple[float, float, float, float]:
    """Quaternion x, y, z, w that turns -z, along which lights shine, away from the sun.

    Between unit vectors a and b it is (a x b, 1 + a . b), normalised.
    """
    a, b = np.array([0.0, 0.0, -1.0]), -np.array(sun.direction)
    real = 1 + float(a @ b)
    if real < 1e-9:  # half a turn about any perpendicular axis
        return 0.0, 1.0, 0.0, 0.0
    x, y, z = np.cross(a, b)
    length = math.sqrt(x * x + y * y + z * z + real * real)
    return x / length, y / length, z / length, real / length
