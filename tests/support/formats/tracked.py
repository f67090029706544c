"""A camera that pans and travels, and files of it as trackers write them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Pose = NDArray[np.float64]
SIZE = (72, 48)
FOCAL, PITCH = 70.0, 0.5  # px, mm
#: Between cameras that look along -z with y up, and those of trackers: z ahead, y down.
FLIP = np.diag((1.0, -1.0, -1.0, 1.0))
FPS = 24.0
OPENCV = (-0.2, 0.05, 0.001, -0.002)


@dataclass(frozen=True)
class Moment:
    """Where a camera stands and looks: place in m with y up, pan to the left and tilt up in deg."""

    place: tuple[float, float, float]
    pan: float
    tilt: float

    @property
    def pose(self) -> Pose:
        """World from camera."""
        made = np.eye(4)
        made[:3, :3] = Rotation.from_euler("YX", (self.pan, self.tilt), degrees=True).as_matrix()
        made[:3, 3] = self.place
        return made


def path(count: int) -> list[Moment]:
    """Moments of frames 0, 1, ...: fast enough that lines of one frame see another set."""
    return [
        Moment((-0.25 + 0.16 * n, 1.2 + 0.05 * n, 2.4 - 0.04 * n**2), 8 - 6.0 * n, -18 + 1.5 * n)
        for n in range(count)
    ]


def sample(moment: Moment, time_s: float, **lens: Any) -> dict[str, Any]:
    """A sample of OpenTrackIO: x right, y ahead, z up."""
    x, y, z = moment.place
    sides = {"width": SIZE[0] * PITCH, "height": SIZE[1] * PITCH}
    still = {
        "activeSensorPhysicalDimensions": sides,
        "activeSensorResolution": {"width": SIZE[0], "height": SIZE[1]},
        "captureFrameRate": {"num": 24, "denom": 1},
    }
    turn = {"pan": moment.pan, "tilt": moment.tilt, "roll": 0}
    seconds = 1_700_000_000 + int(time_s)
    return {
        "static": {"camera": still},
        "lens": {"pinholeFocalLength": FOCAL * PITCH, **lens},
        "timing": {"sampleTimestamp": {"seconds": seconds, "nanoseconds": round(time_s % 1 * 1e9)}},
        "transforms": [{"translation": {"x": x, "y": -z, "z": y}, "rotation": turn}],
    }


def opentrackio(file: Path, moments: Sequence[Moment], **lens: Any) -> Path:
    """A take as lines, of which the first alone has what stays."""
    samples = [sample(one, n / FPS, **lens) for n, one in enumerate(moments)]
    for one in samples[1:]:
        del one["static"]
    file.write_text("\n\n".join(json.dumps(one) for one in samples) + "\n")
    return file


def colmap(folder: Path, moments: Sequence[Moment], name: str = "IMG_{:04d}.jpg") -> Path:
    """A model as text, pictures in no order."""
    folder.mkdir(exist_ok=True)
    numbers = " ".join(map(str, (FOCAL, FOCAL, 36.5, 24.5, *OPENCV)))
    (folder / "cameras.txt").write_text(f"7 OPENCV {SIZE[0]} {SIZE[1]} {numbers}\n")
    lines = []
    for n, one in reversed(list(enumerate(moments))):
        camera = FLIP @ np.linalg.inv(one.pose)
        x, y, z, w = Rotation.from_matrix(camera[:3, :3]).as_quat()
        words = [n + 1, w, x, y, z, *camera[:3, 3], 7, name.format(n)]
        lines += [" ".join(map(str, words)), "12.5 7.5 -1"]
    (folder / "images.txt").write_text("\n".join(lines) + "\n")
    return folder


def nerfstudio(file: Path, moments: Sequence[Moment]) -> Path:
    """A ``transforms.json``."""
    lens = dict(zip(("k1", "k2", "p1", "p2"), OPENCV, strict=True))
    frames = [
        {"file_path": f"./images/frame_{n:05d}.png", "transform_matrix": one.pose.tolist()}
        for n, one in enumerate(moments)
    ]
    size = {"w": SIZE[0], "h": SIZE[1], "fl_x": FOCAL, "fl_y": FOCAL, "cx": 36.5, "cy": 24.5}
    file.write_text(json.dumps({"camera_model": "OPENCV", **size, **lens, "frames": frames}))
    return file
