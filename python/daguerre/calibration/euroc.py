"""``sensor.yaml`` of a camera in a data set of EuRoC's layout (ASL), also of TUM-VI.

The conventions are OpenCV's. ``T_BS`` is the pose of the camera on the body that carries it, not
relative to the other cameras, which have separate files; so each camera is drawn at the place of
the scene's camera.

Source: Burri et al. 2016, "The EuRoC micro aerial vehicle datasets", and its files.
"""

from __future__ import annotations

from daguerre.files.source import Source

from .calibration import Calibration, projection
from .source import choice, load, needed, rigid, row

#: distortion_model -> Daguerre's model, and its number of coefficients.
MODELS = {
    **dict.fromkeys(("radial-tangential", "radtan", "plumb_bob"), ("opencv", 4)),
    **dict.fromkeys(("equidistant", "equi"), ("kannala_brandt", 4)),
    "none": ("rectilinear", 0),
}


def read_euroc(source: Source) -> dict[str, Calibration]:
    """Reads the camera of a ``sensor.yaml``.

    Raises:
        InputError: The file cannot be used; the message has the place in it.
    """
    root = load(source)
    choice(root.need("camera_model"), ("pinhole",))
    size = [side.integer(1, 65536) for side in root.need("resolution")]
    if len(size) != 2:
        root.need("resolution").fail(f"wanted width and height, px, got {len(size)} numbers")
    fx, fy, x, y = row(root.need("intrinsics"), (4,))
    named = root.get("distortion_model")
    model, count = MODELS["none" if named is None else choice(named, MODELS)]
    values: tuple[float, ...] = ()
    if count:
        names = ("distortion_coefficients", "distortion_coeffs")
        values = row(needed(root, "coefficients", *names), (count,))
    notes: tuple[str, ...] = ()
    if (place := root.get("T_BS")) is not None:
        rigid(place)
        notes = ("T_BS, the camera's place on its body, is not used: the scene's camera has one",)
    made = projection(root.file, model, (size[0], size[1]), (fx, fy), (x, y), values)
    return {"camera": Calibration(made, notes=notes)}
