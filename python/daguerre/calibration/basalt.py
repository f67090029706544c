"""basalt's calibration of a rig: one JSON file with all cameras, and their places by the IMU.

The conventions are OpenCV's. ``T_imu_cam`` takes points of a camera into the frame of the IMU.
``ucm`` is the extended unified model with beta = 1.

Source: basalt-headers, calibration.hpp and camera/*_camera.hpp (names and equations).
"""

from __future__ import annotations

import numpy as np

from daguerre.files.json_item import Item
from daguerre.files.source import Source

from .calibration import FLIP, Calibration, FloatArray, projection
from .source import choice, load, turned

#: camera_type -> Daguerre's model, names of its parameters in order, and fixed ones behind them.
MODELS: dict[str, tuple[str, tuple[str, ...], tuple[float, ...]]] = {
    "pinhole": ("rectilinear", (), ()),
    "pinhole-radtan8": ("opencv", ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"), ()),
    "kb4": ("kannala_brandt", ("k1", "k2", "k3", "k4"), ()),
    "ds": ("double_sphere", ("xi", "alpha"), ()),
    "eucm": ("eucm", ("alpha", "beta"), ()),
    "ucm": ("eucm", ("alpha",), (1.0,)),
    "fov": ("fov", ("w",), ()),
}
_POSE = ("px", "py", "pz", "qx", "qy", "qz", "qw")


def read_basalt(source: Source) -> dict[str, Calibration]:
    """Reads all cameras of a rig: cam0, cam1, ...

    Raises:
        InputError: The file cannot be used; the message has the place in it.
    """
    root = load(source)
    root = root.get("value0") or root
    cameras, sizes = root.list_of("intrinsics"), root.list_of("resolution")
    places = root.list_of("T_imu_cam")
    if not cameras or not len(cameras) == len(sizes) == len(places):
        root.fail(
            "wanted as many T_imu_cam and resolution as intrinsics, got "
            f"{len(places)}, {len(sizes)} and {len(cameras)}"
        )
    poses = [_pose(item) for item in places]
    found = {}
    for i, (camera, size, pose) in enumerate(zip(cameras, sizes, poses, strict=True)):
        stands = FLIP @ np.linalg.inv(poses[0]) @ pose @ FLIP if i else np.eye(4)
        model, names, fixed = MODELS[choice(camera.need("camera_type"), MODELS)]
        numbers = camera.need("intrinsics")
        fx, fy, x, y = (numbers.need(name).number() for name in ("fx", "fy", "cx", "cy"))
        values = (*(numbers.need(name).number() for name in names), *fixed)
        where = f"{camera.file}: {camera.path}"
        width, height = (int(side) for side in size.numbers(2, 1, 65536))
        made = projection(where, model, (width, height), (fx, fy), (x, y), values)
        found[f"cam{i}"] = Calibration(made, f"cam{i}", stands)
    return found


def _pose(item: Item) -> FloatArray:
    """Pose with position px py pz and quaternion qx qy qz qw."""
    values = {name: item.need(name).number(-1e9, 1e9) for name in _POSE}
    turn = np.array([values[name] for name in ("qw", "qx", "qy", "qz")])
    length = float(np.linalg.norm(turn))
    if not abs(length - 1) < 1e-3:
        item.fail(f"wanted a quaternion of length 1, got {length:.4g}")
    pose = np.eye(4)
    pose[:3, :3] = turned(turn / length)
    pose[:3, 3] = [values[name] for name in ("px", "py", "pz")]
    return pose
