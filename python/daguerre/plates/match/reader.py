"""Reads camera files of plates: JSON of the schema ``daguerre-plate-camera/0.1``."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre import sensors
from daguerre.annotation_kinds import is_path
from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.development.looks import LOOKS
from daguerre.files.json_file import read_json_file
from daguerre.files.json_item import Item, short
from daguerre.sensors import Sensor

from .blur import Blur
from .falloff import Falloff
from .grain import HALF, Grain
from .plate_camera import PlateCamera
from .sharpness import Sharpness
from .transfer import Transfer
from .writer import SCHEMA, UPPER

MEMBERS = (
    *("schema", "plate", "camera", "sensor", "noise", "sharpness", "vignetting"),
    *("development", "notes"),
)
KINDS = ("raw", "display", "linear")
_MOST_PIXELS = 65536


@guarded
def read_plate_camera(path: str | os.PathLike[str]) -> PlateCamera:
    """Reads the matched camera of a plate, as written by ``PlateCamera.save``.

    Raises:
        InputError: The file cannot be used; the message has the file and JSON path.
    """
    file = Path(path)
    return read_json_file(file, SCHEMA, MEMBERS, lambda root: _plate(root, file))


def _plate(root: Item, file: Path) -> PlateCamera:
    plate = root.need("plate")
    columns, rows = (item.integer(1, _MOST_PIXELS) for item in _some(plate.need("resolution"), 2))
    kind = plate.need("kind").choice(KINDS)
    focal = _known(plate, "focal_length_mm")
    return PlateCamera(
        plate=plate.need("file").text(),
        sha256=plate.need("sha256").text(),
        kind=kind,
        resolution=(columns, rows),
        camera=_camera(root.need("camera")),
        sensor=_sensor(_known(root, "sensor"), file, kind),
        noise=_noise(_known(root, "noise"), kind),
        sharpness=_sharpness(_known(root, "sharpness")),
        falloff=_falloff(_known(root, "vignetting")),
        focal_length=None if focal is None else focal.number(above=0),
        look=_look(root.need("development").need("look")),
        notes=tuple(item.text() for item in root.list_of("notes")),
    )


def _known(item: Item, key: str) -> Item | None:
    """Member that may be null or absent."""
    member = item.get(key)
    return None if member is None or member.value is None else member


def _some(item: Item, count: int) -> list[Item]:
    found = list(item)
    if len(found) != count:
        item.fail(f"wrong length: wanted {count} values, got {len(found)}")
    return found


def _look(item: Item) -> str:
    name = item.text()
    return name if name.startswith("ocio:") else str(item.choice(tuple(LOOKS)))


def _camera(item: Item) -> Camera:
    def number(key: str) -> float | None:
        member = _known(item, key)
        return None if member is None else member.number(above=0)

    lens = _known(item, "lens")
    width, height = item.need("sensor_size_mm").numbers(2, 1e-3, 1e5)
    return Camera(
        lens=None if lens is None else lens.text(),
        focal_length=number("focal_length_mm"),
        zoom=number("zoom_mm"),
        f_stop=item.need("f_stop").number(above=0),
        exposure_f_stop=number("exposure_f_stop"),
        focus_distance=_focus(_known(item, "focus_m")),
        shutter_time=item.need("shutter_s").number(0),
        iso=item.need("iso").number(above=0),
        responsivity=item.number_of("responsivity", 1.0, above=0),
        sensor_size=(width, height),
        white_balance=_white(_known(item, "white_balance")),
    )


def _focus(item: Item | None) -> float | None:
    if item is None:
        return None
    return math.inf if item.value == "inf" else item.number(above=0)


def _white(item: Item | None) -> Any:
    if item is None or not isinstance(item.value, list):
        return None if item is None else item.number(above=0)
    return item.numbers(2, 0.0, 1.0)


def _sensor(item: Item | None, file: Path, kind: str) -> Sensor | None:
    if item is None:
        return None
    name = item.text()
    if not name or Path(name).name != name or not is_path(name):
        item.fail(f"wanted the name of a file in the same folder, got {short(name)}")
    if kind != "raw":
        item.fail(f"a plate of kind {kind} takes no sensor file, got {short(name)}")
    return sensors.read(file.with_name(name))


def _noise(item: Item | None, plate: str) -> Transfer | Grain | None:
    if item is None:
        return None
    kind = item.need("kind").choice((plate,))
    return _transfer(item) if kind == "raw" else _grain(item, linear=kind == "linear")


def _transfer(item: Item) -> Transfer:
    error = _known(item, "read_noise_error")
    gains = (Item(g.value, g.key, g.parent) for g in item.list_of("gain_by_channel"))
    return Transfer(
        gain=item.need("gain_dn_per_e").number(above=0),
        gain_error=item.number_of("gain_error", 0.0, 0),
        read_noise=item.need("read_noise_e").number(0),
        read_noise_error=math.inf if error is None else error.number(0),
        prnu=item.number_of("prnu", 0.0, 0, 1),
        blocks=item.need("flat_blocks").integer(0),
        darkest=item.number_of("darkest_e", 0.0),
        by_channel=tuple(math.nan if g.value is None else g.number() for g in gains),
    )


def _grain(item: Item, *, linear: bool) -> Grain:
    levels, deviations = _rows(item.need("levels")), _rows(item.need("deviations"))
    if levels.shape != deviations.shape:
        got = f"{deviations.shape[1]} values for each colour, got {levels.shape[1]}"
        item.need("levels").fail(f"wrong length: wanted {got}")
    if (np.diff(levels, axis=1) < 0).any() or (deviations < 0).any():
        item.need("levels").fail("wanted levels in ascending order, and deviations of at least 0")
    spectra = np.zeros((HALF, HALF, 3, 3))
    for (i, j), plane in zip(UPPER, _some(item.need("spectra"), len(UPPER)), strict=True):
        values = np.array([row.numbers(HALF) for row in _some(plane, HALF)])
        spectra[:, :, i, j] = spectra[:, :, j, i] = values
    return Grain(linear, levels, deviations, spectra)


def _rows(item: Item) -> NDArray[np.float64]:
    rows = _some(item, 3)
    count = len(list(rows[0]))
    if count == 0:
        rows[0].fail("wanted at least one value, got none")
    return np.array([row.numbers(count) for row in rows])


def _sharpness(item: Item | None) -> Sharpness | None:
    if item is None:
        return None
    frequency = item.need("frequency")
    count = len(list(frequency))
    blur = item.need("blur")
    return Sharpness(
        np.array(frequency.numbers(count, 0, 1)),
        np.array(item.need("response").numbers(count)),
        item.need("edges").integer(0),
        Blur(blur.need("sigma_px").number(0, 100), blur.need("sharpen").number(0, 10)),
    )


def _falloff(item: Item | None) -> Falloff | None:
    if item is None:
        return None
    lens = _known(item, "lens_k")
    k1, k2, k3 = item.need("k").numbers(3)
    own = None
    if lens is not None:
        a, b, c = lens.numbers(3)
        own = (a, b, c)
    return Falloff((k1, k2, k3), own, item.number_of("rest", 0.0, 0))
