"""Saving: the newest picture, or its camera, into a file that is not there yet."""

from __future__ import annotations

import itertools
import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from daguerre.errors import OutputError, UsageError
from daguerre.files.atomic import write_bytes
from daguerre.rendering.reporter import Reporter

from .drawn import Drawn

_MOST = 10_000


def save(drawn: Drawn, folder: Path, kind: str) -> Path:
    """Writes a picture as the command line would, and returns its file.

    Args:
        drawn: The picture, at full size.
        folder: Folder for files.
        kind: Suffix without its point: exr, png, jpg or dng.

    Raises:
        UsageError: The picture is a small preview.
        OutputError: The file cannot be written.
    """
    shot = drawn.shot
    if not drawn.whole:
        raise UsageError("save: the picture is not drawn at full size yet; try again in a moment")
    facts = {
        "resolution": shot.settings.film.resolution,
        "crop": drawn.session.crop,
        "samples": drawn.samples,
    }
    frame = replace(drawn.frame, metadata={**drawn.frame.metadata, **facts})
    path = _free(folder, drawn, kind)
    shot.photograph.write(frame, [path], shot.tone, Reporter())
    return path


def save_camera(drawn: Drawn, folder: Path, command: str, dials: Mapping[str, str]) -> Path:
    """Writes the dials and the command line that has them as JSON."""
    path = _free(folder, drawn, "json")
    write_bytes(path, json.dumps({"command": command, "dials": dict(dials)}, indent=2).encode())
    return path


def _free(folder: Path, drawn: Drawn, kind: str) -> Path:
    """First name with a number that no file has, such as ``desk-3.png``."""
    scene = drawn.shot.scene.path
    stem = "scene" if scene is None else scene.stem
    for number in itertools.count(1):
        path = folder / f"{stem}-{number}.{kind}"
        if not path.exists():
            return path
        if number > _MOST:
            break
    raise OutputError(f"{folder}: holds {_MOST} files {stem}-N.{kind} already; move some of them")
