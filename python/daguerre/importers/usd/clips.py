"""Lists the files of value clips, which USD opens when it asks for values.

Source: OpenUSD, "Sequenceable, Re-timeable Animated Value Clips" (openusd.org).
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pxr import Ar, Sdf

from daguerre.errors import InputError

from .anchored import anchored
from .layer_names import asset_names

#: Most times that a template of clips may step through, with a look at the disk for each.
_MOST_TIMES = 200_000
_RANGE = ("templateStartTime", "templateEndTime", "templateStride")
_HASHES = re.compile(r"\\?#+")


class Clips:
    """Checks how many clips are named by templates, over all layers.

    Args:
        file: File, for messages.
    """

    def __init__(self, file: str) -> None:
        self._file = file
        self._partial = False
        self._ranges: list[tuple[float, float, float]] = []
        self._parts: dict[str, list[float]] = {name: [] for name in _RANGE}

    def add(self, sets: dict[str, Any]) -> None:
        """Adds the sets of clips of a prim in a layer."""
        for clip_set in sets.values():
            if not isinstance(clip_set, dict):
                continue
            ranges = [clip_set[name] for name in _RANGE if _is_number(clip_set.get(name))]
            if len(ranges) == len(_RANGE):
                self._ranges.append((ranges[0], ranges[1], ranges[2]))
            elif ranges or "templateAssetPath" in clip_set:
                self._partial = True
            for name in _RANGE:
                if _is_number(clip_set.get(name)):
                    self._parts[name].append(clip_set[name])

    def check(self) -> None:
        """Checks the number of times.

        Stronger layers may replace any of the three numbers of a range; where some layer states
        only part of them, the widest range and the smallest step of all count.

        Raises:
            InputError: There are too many times.
        """
        ranges = list(self._ranges)
        if self._partial and all(self._parts.values()):
            starts, ends, steps = (self._parts[name] for name in _RANGE)
            ranges.append((min(starts), max(ends), min(steps)))
        for start, end, stride in ranges:
            if stride > 0 and not end - start <= stride * _MOST_TIMES:
                raise InputError(
                    f"{self._file}: clips: wanted a template of at most {_MOST_TIMES} times, got "
                    f"{start:g} to {end:g} in steps of {stride:g}"
                )


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not math.isnan(value)


def named_clips(sets: dict[str, Any]) -> Iterator[str]:
    """Clips and manifests that a prim names in a layer, as authored."""
    for clip in sets.values():
        if isinstance(clip, dict):
            yield from asset_names(clip.get("assetPaths"))
            yield from asset_names(clip.get("manifestAssetPath"))


def templates(sets: dict[str, Any]) -> Iterator[str]:
    """Templates of clips that a prim names in clip layer, as authored."""
    for clip in sets.values():
        if isinstance(clip, dict) and isinstance(clip.get("templateAssetPath"), str):
            yield clip["templateAssetPath"]


def clips_of_template(layer: Sdf.Layer, template: str, search: Path) -> Iterator[str]:
    """Absolute paths of files that match a template of clips, at any time.

    The template itself comes first, to be checked before its folder is listed.

    Args:
        layer: Layer that names the template.
        template: The template, with ``#`` for digits in the name of the file.
        search: Folder of the stage, which is searched, too.
    """
    for pattern in dict.fromkeys((anchored(layer, template), str(search / template))):
        folder, _, name = pattern.rpartition("/")
        if not _HASHES.search(name):  # no template: it may be empty, or the folder itself
            continue
        yield pattern
        if Ar.IsPackageRelativePath(pattern):
            continue
        form = re.compile(_HASHES.sub(r"-?\\d+", re.escape(name)))
        try:
            inside = [entry.name for entry in Path(folder or "/").iterdir()]
        except (OSError, ValueError):  # no folder; no name of a folder
            continue
        yield from (f"{folder}/{name}" for name in inside if form.fullmatch(name))
