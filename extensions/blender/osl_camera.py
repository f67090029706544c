# SPDX-License-Identifier: GPL-3.0-or-later
"""A lens for Cycles: fits the camera's lens, writes it as a camera shader, and puts it on.

Source: docs/export.md, and Blender's manual, Cycles: custom cameras.
"""

import hashlib
import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import bpy

from daguerre import export, lenses
from daguerre.camera.camera import Camera
from daguerre.camera.ideal import IDEAL, WITHOUT_IRIS
from daguerre.errors import InputError
from daguerre.lenses.engraved import ROUNDED
from daguerre.lenses.errors import LensError
from daguerre.polynomial import LensFit, fit
from daguerre.polynomial.segments import fewest
from daguerre.setup.iris import iris_of

from . import translation

#: Degree of the polynomials, which suits all lenses of the library.
DEGREE = 7


def put_on(thing: Any, scene: Any) -> str:
    """Puts the lens of a camera object on it as a shader of Cycles; returns what was done.

    Raises:
        DaguerreError: The lens cannot be used, or Cycles cannot compile it.
    """
    camera, data = translation.camera_of(thing, scene), thing.data
    fitted, f_stop = _fitted(camera)
    code = export.code(fitted.to_dict(), ".osl")
    compiled = _compiled(code)
    data.type, data.custom_mode = "CUSTOM", "INTERNAL"
    text = _text(f"{fitted.lens}.osl", code)
    if find_spec("oslquery"):  # which Blender needs to take a text, and ``bpy`` does not have
        data.custom_shader = text
    data.custom_bytecode = compiled
    data.custom_bytecode_hash = hashlib.md5(compiled.encode(), usedforsecurity=False).hexdigest()
    _set_film(data, camera)
    given = data.cycles_custom
    given["f_stop"], given["metres"] = f_stop, float(scene.unit_settings.scale_length)
    given["chromatic"] = bool(data.daguerre.dispersion)
    data.update_tag()
    return f"{fitted.lens} at f/{f_stop:.3g}: {fitted.error.film_um[0]:.2g} um RMS off on the film"


def _fitted(camera: Camera) -> tuple[LensFit, float]:
    """Fit of a camera's lens, wide open, and its f-stop."""
    name, distance = camera.lens, camera.focus_distance
    if name is None or name in IDEAL:
        raise InputError(f"lens: wanted one with a prescription, got {name}")
    if camera.lens_model in WITHOUT_IRIS:
        raise InputError(f"lens_model: wanted exact, got {camera.lens_model}")
    if distance is None:
        raise InputError("focus: wanted a distance or an object, got autofocus")
    lens = lenses.load(name)
    if camera.zoom is not None:
        lens = lens.at_zoom(camera.zoom)
    film = [side + 2 * abs(s) for side, s in zip(camera.sensor_size, camera.shift, strict=True)]
    made = fewest(
        lambda count: fit(
            lens, DEGREE, focus=distance, focus_by="best", film=(film[0], film[1]),
            segments=count, iris=iris_of(camera),
        )
    )  # fmt: skip
    return made, _f_stop(camera, lens)


def _f_stop(camera: Camera, lens: lenses.Lens) -> float:
    """F-stop of a camera; a T-stop is converted."""
    widest = lens.first_order().f_number
    asked = camera.f_stop or widest
    if camera.t_stop is not None:
        asked = camera.t_stop * widest / lens.t_stop()
    if asked < ROUNDED * widest:
        text = f"{lens.source}: f-stop: wanted f/{widest:.3g} or narrower, got f/{asked:.3g}"
        raise LensError(text, "lens-f-stop")
    return float(max(asked, widest))


def _text(name: str, code: str) -> Any:
    """Text block of that name with the code."""
    text = bpy.data.texts.get(name) or bpy.data.texts.new(name)
    text.clear()
    text.write(code)
    return text


def _compiled(code: str) -> str:
    """Code as Cycles compiles it.

    Raises:
        InputError: This Blender has no Cycles with OSL, or it refuses the code.
    """
    try:
        import _cycles
    except ImportError:
        raise InputError("Cycles: wanted it in this Blender, got none") from None
    if not getattr(_cycles, "with_osl", True):
        raise InputError("Cycles: wanted one with Open Shading Language, got one without")
    with tempfile.TemporaryDirectory() as folder:
        source, compiled = Path(folder) / "lens.osl", Path(folder) / "lens.oso"
        source.write_text(code, encoding="utf-8")
        if not _cycles.osl_compile(str(source), str(compiled)):
            raise InputError("Cycles: wanted to compile the lens, got an error of its compiler")
        return compiled.read_text(encoding="utf-8")


def _set_film(data: Any, camera: Camera) -> None:
    """Gives Blender's camera the film and its shift; a shader's film spans the picture's width."""
    width, height = camera.sensor_size
    data.sensor_fit, data.sensor_width, data.sensor_height = "HORIZONTAL", width, height
    data.shift_x, data.shift_y = (shift / width for shift in camera.shift)
