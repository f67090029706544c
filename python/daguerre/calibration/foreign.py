"""Recognizes calibration files of other programs that are not read, and names a way to convert."""

from __future__ import annotations

import os
import re
from pathlib import Path

from daguerre.errors import InputError
from daguerre.files.reading import is_file, opened, reading

#: Formats that are read, for errors.
READ = (
    "calibrations that are read: OpenCV, ROS camera_info, Kalibr, EuRoC sensor.yaml, camodocal, "
    "basalt, BOP camera.json, KITTI, OpenTrackIO, a folder of COLMAP, transforms.json"
)
_START = 1 << 16
#: Members of OpenTrackIO samples, the only lists that are read.
_SAMPLE = re.compile(rb'"(timing|protocol|static|lens)"')
#: Pattern in the first bytes of a file, name of its program, and how to convert the file.
_SIGNS = (
    (rb'"projection_type"', "OpenSfM", "`opensfm export_colmap` writes a folder of COLMAP"),
    (
        rb"<document\b[^>]*>\s*<chunk|<chunk\b[^>]*label=|<calibration>\s*<projection>",
        "Metashape",
        "export its calibration for OpenCV (.xml), or its cameras for COLMAP",
    ),
    (
        rb'"(camera_intrinsic|sensor_token)"',
        "nuScenes",
        "it has no size: give camera_intrinsic as K, and image_size, in a file of OpenCV",
    ),
    (
        rb'CameraModelType|"CameraCalibrations"',
        "Project Aria",
        "its model FISHEYE624 is not one of Daguerre's",
    ),
    (
        rb"(?m)^\s*\"?Camera\d?\.(fx|type|width)\"?\s*:",
        "ORB-SLAM3",
        "give its numbers as K, D, image_width and image_height in a file of OpenCV",
    ),
    (
        rb"(?m)^cam0\s*=\s*\[",
        "Middlebury stereo",
        "give cam0 as K, width and height in a file of OpenCV",
    ),
    (rb'"cam_K"', "BOP scene_camera.json", "give the camera.json of the data set"),
)


def refuse(source: object) -> None:
    """Refuses a file with a pattern of another program; accepts other files and other sources.

    Raises:
        InputError: The message names the program, how to convert, and the formats that are read.
    """
    if not isinstance(source, str | os.PathLike) or not is_file(Path(source)):
        return
    with opened(source) as file, reading(source):
        start = file.read(_START)
    for sign, name, way in _SIGNS:
        if re.search(sign, start):
            raise InputError(f"{source}: a file of {name}, which is not read: {way}; {READ}")
    listed = Path(source).suffix.lower() == ".json" and re.match(rb"\s*\[\s*[^\s\]]", start)
    if listed and not _SAMPLE.search(start):
        raise InputError(f"{source}: wanted names and values, got a list; {READ}")
