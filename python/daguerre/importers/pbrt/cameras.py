"""Reads ``Camera``: perspective, realistic and spherical.

pbrt's camera looks along +z of a left-handed frame. Its ``fov`` spans the film's shorter side.
pbrt's factor on the picture becomes an exposure compensation, in the mode ``light``.

Source: pbrt-v4's user's guide ("Cameras"); ``cameras.cpp`` where it is silent.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.exposure import check_exposure
from daguerre.camera.parameters import OPTICS
from daguerre.camera.projection import Projection
from daguerre.errors import InputError, UsageError
from daguerre.motion.values import keys
from daguerre.scene.transforms import without_scale

from .description import Description
from .files import Files
from .film import FilmSize
from .ledger import Ledger
from .realistic import lens_of
from .seen import Seen
from .state import Entity
from .transforms import unit_of

Array = NDArray[np.float64]
#: Camera of pbrt from camera of the scene: both see x to the right and y up.
_TURN = np.diag([1.0, 1.0, -1.0, 1.0])
#: The same of a spherical camera, which has -x in its middle and -z right of it.
_TURNS = dict.fromkeys(
    ("spherical", "environment"),
    np.array([(0, 0, 1, 0), (0, 1, 0, 0), (-1, 0, 0, 0), (0, 0, 0, 1)], float),
)
#: F-stop below which an ideal lens would gather light from more than a half space.
_FASTEST = 0.5
#: Focus distance that pbrt takes for infinity, and beyond it.
_FAR = 1e6
#: Digits of an exposure compensation, EV: a lens file gives no more.
_DIGITS = 6


@dataclass(frozen=True)
class Eye:
    """Values that readers of cameras need.

    Attributes:
        entity: Directive.
        film: Film.
        size: Length of a unit of the camera's space, m.
        unit: Length of a unit of the world, m.
        version: Version of pbrt, 3 or 4.
        files: Files of the scene.
        ledger: Counts directives.
    """

    entity: Entity
    film: FilmSize
    size: float
    unit: float
    version: int
    files: Files
    ledger: Ledger


def mirror_of(entity: Entity | None) -> Array:
    """Scene from world of pbrt, (4, 4): the mirror image with a right-handed camera frame.

    pbrt's frame is left-handed, unless the camera's transform mirrors it.
    """
    if entity is None:
        return _TURN.copy()
    camera = entity.state.transform.start @ _TURNS.get(entity.kind, _TURN)
    return np.eye(4) if np.linalg.det(camera[:3, :3]) > 0 else _TURN.copy()


def read_camera(
    described: Description, film: FilmSize, files: Files, axes: Array, ledger: Ledger
) -> Camera | None:
    """Reads the camera of a scene; None: there is no camera, or, with a note, an unusable camera.

    Raises:
        InputError: A parameter is wrong, or its kind is not supported.
    """
    entity = described.camera
    if entity is None:
        return None
    reader = _KINDS.get(entity.kind)
    if reader is None:
        entity.place.fail(f"kind: wanted {', '.join(_KINDS)}, got {entity.kind[:40]!r}")
    pose, size = _pose(entity, axes, ledger)
    if pose is None:
        ledger.note(entity.place, "a camera that is scaled to zero is left out")
        return None
    eye = Eye(entity, film, size, unit_of(axes), described.version, files, ledger)
    lens = reader(eye)
    fields = {"transform": pose, **_shutter(eye), **_exposure(eye, lens), **lens.fields}
    if lens.ahead:
        fields["transform"] = _moved_ahead(pose, lens.ahead)
    ledger.use(entity.place)
    ledger.tell_unread(entity.parameters, entity.place, entity.kind)
    try:
        camera = Camera(**fields)
        OPTICS.check(camera, "camera")
        shutter.check(camera)
        check_exposure(camera)
        return camera
    except (UsageError, InputError) as error:
        entity.place.fail(str(error))


def _pose(entity: Entity, axes: Array, ledger: Ledger) -> tuple[Any, float]:
    """World from camera, rigid, and the scale that is left out."""
    moving = entity.state.transform.inverse(entity.place)
    turn = _TURNS.get(entity.kind, _TURN)
    worlds = [axes @ world @ turn for world in (moving.start, moving.end)]
    lengths = np.linalg.norm(worlds[0][:3, :3], axis=0)
    rigid = [without_scale(world) for world in worlds]
    if any(matrix is None for matrix in rigid) or not np.isfinite(lengths).all():
        return None, 1.0
    if np.ptp(lengths) > 1e-3 * lengths.max():
        ledger.notes.add("a camera that is scaled in one direction keeps its shape")
    begin, end = moving.times
    if not moving.moves or not begin < end:
        return rigid[0], float(lengths[2])
    return keys([(begin, rigid[0]), (end, rigid[1])]), float(lengths[2])


def _moved_ahead(transform: Any, metres: float) -> Any:
    offset = np.eye(4)
    offset[2, 3] = -metres
    if isinstance(transform, np.ndarray):
        return transform @ offset
    pairs = zip(transform.times.tolist(), transform.values, strict=True)
    return keys([(time, pose @ offset) for time, pose in pairs])


def _times(eye: Eye) -> tuple[float, float]:
    """When the shutter opens and closes, s."""
    number = eye.entity.parameters.number
    begin, end = number("shutteropen", 0.0), number("shutterclose", 1.0)
    return min(begin, end), max(begin, end)


def _shutter(eye: Eye) -> dict[str, Any]:
    begin, end = _times(eye)
    return {"shutter_time": end - begin, "shutter_offset": begin * 24}


def _exposure(eye: Eye, lens: Seen) -> dict[str, Any]:
    """Factor of pbrt on a picture, as EV, and the white."""
    begin, end = _times(eye)
    if lens.timed and end == begin:
        eye.entity.place.fail("shutteropen, shutterclose: the two times must differ")
    gain = eye.film.gain * lens.weight * (end - begin if lens.timed else 1.0)
    return {
        "exposure_compensation": round(math.log2(gain), _DIGITS) + 0.0,
        "white_balance": eye.film.white,
    }


def _perspective(eye: Eye) -> Seen:
    parameters, film = eye.entity.parameters, eye.film
    number = parameters.number
    window = _window(eye)
    fov = number("fov", 90.0, 1e-4, 179.99)
    half = math.tan(math.radians(fov) / 2)
    if parameters.has("halffov"):
        half = math.tan(math.radians(number("halffov", 45.0, 1e-4, 89.99)))
    focal = film.millimetres[0] / ((window[1] - window[0]) * half)
    shift = tuple(half * focal * (low + high) / 2 for low, high in (window[:2], window[2:]))
    radius = number("lensradius", 0.0, 0.0) * eye.size
    distance = number("focaldistance", _FAR, 0.0) * eye.size
    fields: dict[str, Any] = {}
    if any(abs(side) > 1e-9 * focal for side in shift):
        fields["shift"] = shift
    if not radius > 0:
        enlarged = 1.0
        fields["lens"] = "pinhole"
    else:
        # The size of pbrt's film has no effect: a larger film keeps f-stops possible.
        enlarged = max(1.0, 2 * _FASTEST * 2000 * radius / focal)
        fields |= {"aperture_diameter": 2000 * radius, "focus_distance": _distance(distance, eye)}
    fields["focal_length"] = focal * enlarged
    fields["sensor_size"] = tuple(side * enlarged for side in film.millimetres)
    if "shift" in fields:
        fields["shift"] = tuple(side * enlarged for side in shift)
    return Seen(fields, timed=eye.version == 4)


def _window(eye: Eye) -> tuple[float, float, float, float]:
    """Part of the image plane that the film shows, in units in which the short side is 2."""
    aspect = eye.entity.parameters.number("frameaspectratio", eye.film.aspect, 1e-3, 1e3)
    given = eye.entity.parameters.numbers("screenwindow", 4)
    wide, high = (aspect, 1.0) if aspect > 1 else (1.0, 1 / aspect)
    window = (-wide, wide, -high, high)
    if given is not None:
        left, right, low, top = given.tolist()
        if not (left < right and low < top):
            eye.entity.place.fail("screenwindow: left must be below right, and bottom below top")
        window = (left, right, low, top)
    shape = (window[1] - window[0]) / (window[3] - window[2])
    if not math.isclose(shape, eye.film.aspect, rel_tol=5e-3):
        eye.ledger.notes.add("pixels that are not square become square: the width is kept")
    return window


def _distance(distance: float, eye: Eye) -> float:
    if not distance > 0:
        eye.entity.place.fail("focaldistance: wanted a number above 0, got 0")
    return math.inf if distance >= _FAR * eye.size else distance


def _realistic(eye: Eye) -> Seen:
    return lens_of(eye.entity, eye.film, eye.unit, eye.files, eye.version, eye.ledger)


def _spherical(eye: Eye) -> Seen:
    usual = "equalarea" if eye.version == 4 else "equirectangular"
    mapping = eye.entity.parameters.text("mapping", usual)
    if mapping not in ("equirectangular", "equalarea"):
        eye.entity.place.fail(f"mapping: wanted equirectangular or equalarea, got {mapping[:40]!r}")
    if mapping == "equalarea":
        eye.ledger.notes.add("a spherical camera with an equal-area map is drawn equirectangular")
    for name in ("lensradius", "focaldistance", "screenwindow", "frameaspectratio"):
        eye.entity.parameters.find(name)
    width = eye.film.resolution[0] + eye.film.resolution[0] % 2
    projection = Projection.of_field("equirectangular", (width, width // 2), 360.0)
    return Seen({"projection": projection}, timed=eye.version == 4)


_KINDS: dict[str, Callable[[Eye], Seen]] = {
    "perspective": _perspective,
    "realistic": _realistic,
    "spherical": _spherical,
    "environment": _spherical,
}
