"""camodocal's cameras, which VINS-Mono and VINS-Fusion use: one YAML file of OpenCV for each.

The conventions are OpenCV's. ``KANNALA_BRANDT`` counts its coefficients from k2, as the first
belongs to theta itself; ``MEI`` is the unified camera on a sphere, with radial and tangential
distortion.

Source: camodocal, camera_models/PinholeCamera, EquidistantCamera, CataCamera (equations and names).
"""

from __future__ import annotations

from daguerre.files.source import Source

from .calibration import Calibration, projection
from .source import choice, load

#: model_type -> Daguerre's model; section and names of focal lengths and principal point; then of
#: the parameters.
_PINHOLE = tuple(("projection_parameters", name) for name in ("fx", "fy", "cx", "cy"))
_DISTORTED = tuple(("distortion_parameters", name) for name in ("k1", "k2", "p1", "p2"))
_Names = tuple[tuple[str, str], ...]
MODELS: dict[str, tuple[str, _Names, _Names]] = {
    "PINHOLE": ("opencv", _PINHOLE, _DISTORTED),
    "PINHOLE_FULL": (
        "opencv",
        _PINHOLE,
        (*_DISTORTED, *(("distortion_parameters", name) for name in ("k3", "k4", "k5", "k6"))),
    ),
    "KANNALA_BRANDT": (
        "kannala_brandt",
        tuple(("projection_parameters", name) for name in ("mu", "mv", "u0", "v0")),
        tuple(("projection_parameters", name) for name in ("k2", "k3", "k4", "k5")),
    ),
    "MEI": (
        "omni",
        tuple(("projection_parameters", name) for name in ("gamma1", "gamma2", "u0", "v0")),
        (("mirror_parameters", "xi"), *_DISTORTED),
    ),
}


def read_camodocal(source: Source) -> dict[str, Calibration]:
    """Reads the camera of a file.

    Raises:
        InputError: The file cannot be used; the message has the place in it.
    """
    root = load(source)
    model, focal, parameters = MODELS[choice(root.need("model_type"), MODELS)]
    width, height = (root.need(name).integer(1, 65536) for name in ("image_width", "image_height"))
    fx, fy, x, y = (root.need(section).need(name).number() for section, name in focal)
    values = tuple(root.need(section).need(name).number() for section, name in parameters)
    made = projection(root.file, model, (width, height), (fx, fy), (x, y), values)
    name = root.get("camera_name")
    return {"camera": Calibration(made, "" if name is None else name.text())}
