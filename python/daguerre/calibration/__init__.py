"""Calibration files in and out: OpenCV, ROS, Kalibr, OpenTrackIO."""

from __future__ import annotations

from .calibration import Calibration
from .files import FORMATS, pick, read, read_all, write
from .kalibr import read_kalibr
from .opencv import read_opencv
from .opentrackio import read_opentrackio
from .ros import read_ros

__all__ = [
    "FORMATS",
    "Calibration",
    "pick",
    "read",
    "read_all",
    "read_kalibr",
    "read_opencv",
    "read_opentrackio",
    "read_ros",
    "write",
]
