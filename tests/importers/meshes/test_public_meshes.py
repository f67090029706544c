"""Meshes and grids of public scenes, which are not part of this project: each can be read.

``DAGUERRE_PBRT_SCENES`` and ``DAGUERRE_MITSUBA_DATA`` name checkouts of w3ntao/pbrt-minus-scenes
(7,061 files of PLY) and of mitsuba-renderer/mitsuba-data.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from daguerre.files.notes import Notes
from daguerre.importers.meshes import obj, ply, serialized
from daguerre.importers.volumes import vol

_VARIABLES = ("DAGUERRE_PBRT_SCENES", "DAGUERRE_MITSUBA_DATA")
_FOLDERS = [Path(os.environ[one]) for one in _VARIABLES if os.environ.get(one)]
#: Begin of files that a large-file store left out, and of a test file that is no mesh.
_ABSENT = (b"version https://git-lfs", b"\x06\x00")


def _files(*suffixes: str) -> list[Path]:
    found = [
        path
        for folder in _FOLDERS
        for path in sorted(folder.rglob("*"))
        if path.name.lower().endswith(suffixes) and not path.read_bytes()[:40].startswith(_ABSENT)
    ]
    if not found:
        pytest.skip(f"{' and '.join(_VARIABLES)} name no folder with such files")
    return found


def test_every_mesh_can_be_read() -> None:
    notes = Notes()
    for path in _files(".ply", ".ply.gz", ".obj"):
        mesh = (obj if path.suffix == ".obj" else ply).read(path, notes)
        assert len(mesh.corners), path


def test_every_serialized_mesh_can_be_read() -> None:
    for path in _files(".serialized"):
        for index in range(serialized.count(path)):
            assert len(serialized.read(path, index).corners), (path, index)


def test_every_grid_can_be_read() -> None:
    for path in _files(".vol"):
        assert np.isfinite(vol.read(path).values).all(), path
