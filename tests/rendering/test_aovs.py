"""The table of auxiliary channels: its lists are those of the core, and names stand once."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

import daguerre as dg
from daguerre.frame.aovs import (
    BY_NAME,
    EXACT_ONLY,
    FILM_CHANNELS,
    MEANS_CHANNELS,
    TABLE,
    Source,
    channels_of,
)


def sky() -> dg.Scene:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    return scene


def test_each_name_is_of_one_row() -> None:
    names = [name for row in TABLE for name in (row.name, *row.aliases)]
    assert len(names) == len(set(names)) == len(BY_NAME)


def test_frames_have_the_channels_that_the_table_says() -> None:
    camera = dg.Camera(lens_model="pinhole")
    size = (4, 3)
    frame = dg.render(sky(), camera, resolution=size, spp=1, aovs=True)
    assert tuple(frame.aovs) == FILM_CHANNELS
    assert frame.aovs["object_id"].dtype == np.uint32
    means = dg.render(sky(), camera, resolution=size, spp=1, gt_lens="mean", motion=True)
    assert set(means.aovs) == {*MEANS_CHANNELS, *channels_of(Source.MOTION)}


def test_channels_that_only_ground_truth_has() -> None:
    assert EXACT_ONLY == ("distance", "material_id", "motion", "motion_back", "coverage")


def test_no_other_file_lists_them() -> None:
    """``N.X`` next to ``N.Y`` in quotes is a list of channels."""
    package = Path(dg.__file__).parent
    listed = re.compile(r'"(?:P|N)\.X",\s*"(?:P|N)\.Y"')
    found = [path.name for path in package.rglob("*.py") if listed.search(path.read_text())]
    assert found == []
