"""Scenes and pictures that others made, if folders with them are named.

``DAGUERRE_PBRT_SCENES`` is a folder of scenes, such as a clone of ``w3ntao/pbrt-minus-scenes``;
``DAGUERRE_PBRT_FOR_MAYA`` one of ``hpd/PBRTForMaya``, which has pbrt-v3's own pictures.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.exposure.lux_seconds import display_gain
from daguerre.files import formats

from .text import counted

SCENES = os.environ.get("DAGUERRE_PBRT_SCENES", "")
MAYA = os.environ.get("DAGUERRE_PBRT_FOR_MAYA", "")
_WIDTH, _BLOCK = 128, 8
#: Median difference of blocks of 8 x 8 pixels of pictures 128 wide. Some meshes of these scenes
#: are not in the repository, and are only in pbrt's pictures; most blocks do not show them.
_DEMOS = {
    "camera_depth_of_field": 0.04,
    "camera_environment": 0.02,
    "camera_realistic": 0.06,
    "light_goniometric": 0.03,
    "light_point": 0.03,
    "light_projector": 0.03,
    "light_spot": 0.03,
    "motion_blur": 0.03,
    "texture_checker": 0.04,
}


@pytest.mark.slow
@pytest.mark.skipif(not SCENES, reason="DAGUERRE_PBRT_SCENES names no folder")
def test_public_scenes_are_read_or_refused_and_counted() -> None:
    read, told = [], []
    for path in sorted(Path(SCENES).rglob("*.pbrt")):
        if path.parent.name == "geometry":
            continue
        try:
            _, ledger = counted(path)
        except dg.InputError as error:
            told.append(str(error))
            continue
        assert ledger.waiting == 0
        read.append(path.stem)
    assert read
    wanted = ("no such file", "wanted it after WorldBegin")
    assert not [text for text in told if not any(known in text for known in wanted)]


@pytest.mark.slow
@pytest.mark.skipif(not MAYA, reason="DAGUERRE_PBRT_FOR_MAYA names no folder")
@pytest.mark.parametrize("name", _DEMOS)
def test_pictures_are_those_of_pbrt(name: str) -> None:
    root = Path(MAYA) / "maya"
    title = f"pbrt_feature_demo_{name}"
    scene = dg.load(root / "renderData" / f"{title}.pbrt", allow_dirs=[root])
    picture = formats.read("environment", root / "images" / f"{title}.exr")
    height = round(_WIDTH * picture.shape[0] / picture.shape[1])
    frame = dg.render(scene, resolution=(_WIDTH, height), spp=32)
    unit = display_gain(frame.metadata)
    ours, theirs = _blocks(frame.rgb * unit), _blocks(_shrunk(picture, height))
    assert np.median(np.abs(ours - theirs) / (theirs + 0.02)) < _DEMOS[name]


def _shrunk(picture: np.ndarray, height: int) -> np.ndarray:
    rows = np.arange(height + 1) * picture.shape[0] // height
    columns = np.arange(_WIDTH + 1) * picture.shape[1] // _WIDTH
    sums = np.add.reduceat(picture.astype(float), rows[:-1], axis=0)
    sums = np.add.reduceat(sums, columns[:-1], axis=1)
    return np.asarray(sums / (np.diff(rows)[:, None] * np.diff(columns))[..., None])


def _blocks(picture: np.ndarray) -> np.ndarray:
    height = picture.shape[0] // _BLOCK * _BLOCK
    cut = picture[:height].reshape(height // _BLOCK, _BLOCK, _WIDTH // _BLOCK, _BLOCK, 3)
    return np.asarray(cut.mean(axis=(1, 3)))
