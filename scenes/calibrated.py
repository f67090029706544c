#!/usr/bin/env python3
"""Makes a desk by a window for cameras that are known by their calibrations.

    python scenes/calibrated.py [-o FOLDER]        (default: out/calibrated)

Its cameras stand where a phone, a fisheye and the left of two stereo cameras would; files of their
calibrations, as OpenCV, ROS and Kalibr write them, lie in scenes/calibrated. Everything is made
by arithmetic: no downloads, the same bytes on every run.
"""

from __future__ import annotations

from kit.command import write_scenes

SCENES = ("desk",)

if __name__ == "__main__":
    write_scenes("calibrated", SCENES, __doc__ or "")
