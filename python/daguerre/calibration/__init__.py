"""Calibration files: OpenCV, ROS, Kalibr, OpenTrackIO; COLMAP and transforms.json (read only)."""

from __future__ import annotations

from .calibration import Calibration
from .colmap import read_colmap
from .files import FORMATS, WRITTEN, pick, read, read_all, write
from .kalibr import read_kalibr
from .opencv import read_opencv
from .opentrackio import read_opentrackio
from .ros import read_ros
from .stereo import read_stereo
from .take import Take
from .track import read_take, read_track
from .transforms import read_transforms

__all__ = [
    "FORMATS",
    "WRITTEN",
    "Calibration",
    "Take",
    "pick",
    "read",
    "read_all",
    "read_colmap",
    "read_kalibr",
    "read_opencv",
    "read_opentrackio",
    "read_ros",
    "read_stereo",
    "read_take",
    "read_track",
    "read_transforms",
    "write",
]
