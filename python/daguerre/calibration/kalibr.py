"""Kalibr's camera chains: several cameras, each with a pose relative to the previous camera.

The conventions are OpenCV's. ``T_cn_cnm1`` takes points from the previous camera's frame into the
camera's frame, so the pose of a camera in the first camera's frame is the inverse of the product of
these matrices. The IMU's extrinsics of two cameras, ``T_cam_imu`` or the inverse ``T_imu_cam``,
give the same pose. IMU time is camera time plus ``timeshift_cam_imu``: of two pictures with the
same stamp, the picture of the camera with the larger shift was taken later.

Source: Kalibr's wiki, "YAML formats" and "Supported models".
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.camera.projection import Projection
from daguerre.errors import InputError
from daguerre.files.json_item import Item
from daguerre.files.source import Source

from .calibration import FLIP, Calibration, FloatArray, projection
from .source import choice, load, rigid, row

#: camera_model -> number of parameters before fu fv pu pv.
CAMERAS = {"pinhole": 0, "omni": 1, "ds": 2, "eucm": 2}
#: distortion_model -> number of coefficients.
DISTORTIONS = {"radtan": 4, "equidistant": 4, "equi": 4, "fov": 1, "none": 0}
#: (camera_model, distortion_model) -> Daguerre's model.
MODELS = {
    ("pinhole", "radtan"): "opencv",
    ("pinhole", "equidistant"): "kannala_brandt",
    ("pinhole", "fov"): "fov",
    ("pinhole", "none"): "rectilinear",
    ("omni", "radtan"): "omni",
    ("omni", "none"): "omni",
    ("ds", "none"): "double_sphere",
    ("eucm", "none"): "eucm",
}
#: Entries of poses that differ by more disagree.
_AGREE = 1e-3


@guarded
def read_kalibr(source: Source) -> dict[str, Calibration]:
    """Reads all cameras of a chain: cam0, cam1, ...

    Args:
        source: YAML file (``camchain.yaml``), or its values as a dict.

    Raises:
        InputError: The file cannot be used; the message has the place in it.
    """
    root = load(source)
    names = sorted(
        (item.key for item in root.members() if str(item.key).removeprefix("cam").isdigit()),
        key=lambda name: int(str(name).removeprefix("cam")),
    )
    if [str(name) for name in names] != [f"cam{i}" for i in range(len(names))] or not names:
        root.fail(f"wanted cameras cam0, cam1, ..., got {', '.join(map(str, names)) or 'none'}")
    for item in root.members():  # a misnamed camera would otherwise be skipped silently
        is_camera = isinstance(item.value, dict) and "camera_model" in item.value
        if is_camera and item.key not in names:
            item.fail(f"wanted the name cam{len(names)}, cam{len(names) + 1}, ... for a camera")
    found, camera_from_first = {}, np.eye(4)
    shifts = [root.need(str(name)).number_of("timeshift_cam_imu", 0.0) for name in names]
    for i, name in enumerate(map(str, names)):
        item = root.need(name)
        notes: list[str] = []
        _camera_from_imu(item)  # checked, also where it is not used
        if i > 0:
            before = root.need(str(names[i - 1]))
            camera_from_first = _from_before(item, before, notes) @ camera_from_first
        stands = FLIP @ np.linalg.inv(camera_from_first) @ FLIP
        found[name] = Calibration(
            _projection(item),
            name,
            stands if i else np.eye(4),
            notes=tuple(notes),
            delay_s=shifts[i] - shifts[0],
        )
    return found


def _from_before(item: Item, before: Item, notes: list[str]) -> FloatArray:
    """Pose of a camera in the previous camera's frame: as given, else by way of the IMU."""
    chained = item.get("T_cn_cnm1")
    here, there = _camera_from_imu(item), _camera_from_imu(before)
    by_imu = None if here is None or there is None else here @ np.linalg.inv(there)
    if chained is not None:
        pose = rigid(chained)
        if by_imu is not None and np.abs(pose - by_imu).max() > _AGREE:
            off = float(np.linalg.norm(pose[:3, 3] - by_imu[:3, 3])) * 1e3
            notes.append(
                f"{item.key}: T_cn_cnm1 and the poses of the IMU differ, by {off:.3g} mm: took "
                "T_cn_cnm1"
            )
        return pose
    if by_imu is None:
        item.fail("missing: T_cn_cnm1, or T_cam_imu or T_imu_cam of this camera and the one before")
    return np.asarray(by_imu, np.float64)


def _camera_from_imu(item: Item) -> FloatArray | None:
    """Pose that takes points of the IMU into the camera's frame; None: it is not given."""
    if (pose := item.get("T_cam_imu")) is not None:
        return rigid(pose)
    inverse = item.get("T_imu_cam")
    return None if inverse is None else np.asarray(np.linalg.inv(rigid(inverse)), np.float64)


def _projection(item: Item) -> Projection:
    camera = choice(item.need("camera_model"), CAMERAS)
    named = item.need("distortion_model")
    distortion = choice(named, DISTORTIONS)
    distortion = "equidistant" if distortion == "equi" else distortion
    if (camera, distortion) not in MODELS:
        fits = " or ".join(two for one, two in MODELS if one == camera)
        named.fail(f"wanted {fits} with camera_model {camera}, got {distortion}")
    count = DISTORTIONS[distortion]
    values = item.get("distortion_coeffs")
    own = CAMERAS[camera]
    numbers = row(item.need("intrinsics"), (own + 4,))
    (fu, fv, pu, pv), first = numbers[own:], numbers[:own]
    if min(fu, fv) <= 0:
        item.need("intrinsics").fail(f"wanted focal lengths above 0, got {fu:g}, {fv:g}")
    bent = () if values is None and count == 0 else row(item.need("distortion_coeffs"), (count,))
    width, height = (e.integer(1, 65536) for e in _pair(item.need("resolution")))
    model = MODELS[camera, distortion]
    where = f"{item.file}: {item.path}"
    return projection(where, model, (width, height), (fu, fv), (pu, pv), (*first, *bent))


def _pair(item: Item) -> list[Item]:
    sides = list(item)
    if len(sides) != 2:
        item.fail(f"wrong shape: wanted width and height, px, got {len(sides)} numbers")
    return sides


def write_kalibr(calibrations: Sequence[Calibration]) -> str:
    """Formats a chain of cameras, in order; the first must be at the origin of the rig."""
    lines: list[str] = []
    before: FloatArray = np.eye(4)  # camera from first
    for i, one in enumerate(calibrations):
        camera, distortion, numbers, bent = _named(one.projection)
        lines += [f"cam{i}:", f"  camera_model: {camera}", f"  intrinsics: {numbers}"]
        lines += [f"  distortion_model: {distortion}", f"  distortion_coeffs: {bent}"]
        lines += [f"  resolution: {list(one.projection.size)}", f"  rostopic: /cam{i}/image_raw"]
        lines += [f"  timeshift_cam_imu: {one.delay_s!r}"] if one.delay_s else []
        now = np.asarray(np.linalg.inv(FLIP @ one.rig_from_camera @ FLIP), np.float64)
        if i == 0 and not np.allclose(now, np.eye(4), atol=1e-12):
            raise InputError(
                "calibration: Kalibr: the rig_from_camera of the first camera must be the identity"
            )
        if i > 0:
            lines += ["  T_cn_cnm1:", *_rows(now @ np.linalg.inv(before))]
        before = now
    return "\n".join(lines) + "\n"


def _rows(matrix: FloatArray) -> list[str]:
    return [f"  - {[float(value) for value in line]}" for line in matrix]


def _named(made: Projection) -> tuple[str, str, list[float], list[float]]:
    """Returns Kalibr's two model names, the intrinsics and the coefficients."""
    values = list(made.parameters)
    tail = [*made.focal, *made.center]
    if made.model == "opencv" and not any(values[4:]):
        return "pinhole", "radtan", tail, [*values[:4], *[0.0] * (4 - len(values))]
    if made.model == "kannala_brandt":
        return "pinhole", "equidistant", tail, [*values, *[0.0] * (4 - len(values))]
    if made.model == "omni":
        bent = [*values[1:], *[0.0] * (5 - len(values))]
        plain = not any(bent)
        return "omni", "none" if plain else "radtan", [values[0], *tail], [] if plain else bent
    short = {"double_sphere": "ds", "eucm": "eucm"}
    if made.model in short:
        return short[made.model], "none", [*values, *tail], []
    if made.model in ("fov", "rectilinear"):
        return "pinhole", "fov" if values else "none", tail, values
    raise InputError(
        "calibration: Kalibr: wanted rectilinear, opencv with only k1 k2 p1 p2, kannala_brandt, "
        f"omni, double_sphere, eucm or fov; got {made.model} with {len(values)} parameters"
    )
