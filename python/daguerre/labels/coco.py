"""COCO files: the pictures of a call and their annotations, for detectors and segmenters.

Source: COCO, "Data format" (https://cocodataset.org/#format-data). Masks are uncompressed run
lengths, column by column, which all readers support. Beside COCO's members an image has the camera,
and an annotation has the box of the whole object and its 3D boxes; see docs/ground-truth.md.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.files.atomic import check_writable, write_bytes

if TYPE_CHECKING:
    from .annotations import Annotation, Annotations
    from .boxes import Box3
    from .categories import Category


@guarded(init=True)
class CocoFile:
    """A COCO file that is being built.

    Args:
        path: File to write; names of pictures are relative to its folder.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self._images: list[dict[str, Any]] = []
        self._annotations: list[dict[str, Any]] = []
        self._categories: dict[int, Category] = {}
        check_writable(self.path)

    def add(
        self,
        seen: Annotations,
        picture: str | os.PathLike[str],
        facts: Mapping[str, Any] | None = None,
    ) -> None:
        """Adds a picture and its annotations; ``facts``: further members of its image."""
        height, width = seen.labels.shape
        number = len(self._images) + 1
        image: dict[str, Any] = {
            "id": number,
            "file_name": self._name(Path(picture)),
            "width": width,
            "height": height,
            **(facts or {}),
            "time": seen.time,
            "world_from_camera": _plain(seen.world_from_camera),
        }
        if seen.intrinsics:
            image["intrinsics"] = {key: _plain(value) for key, value in seen.intrinsics.items()}
        self._images.append(image)
        self._categories |= {category.id: category for category in seen.categories}
        runs = runs_of(seen.labels)
        for i, thing in enumerate(seen.things):
            if thing.box is None:
                continue
            self._annotations.append(
                {"id": len(self._annotations) + 1, "image_id": number}
                | _annotation(thing)
                | {"segmentation": {"size": [height, width], "counts": runs[i + 1]}}
            )

    def write(self) -> None:
        """Writes the whole file, atomically.

        Raises:
            OutputError: The file cannot be written.
        """
        categories = [self._categories[number] for number in sorted(self._categories)]
        whole = {
            "info": {"description": "Rendered by Daguerre", "version": _core.__version__},
            "licenses": [],
            "images": self._images,
            "annotations": self._annotations,
            "categories": [
                {"id": one.id, "name": one.name, "supercategory": one.supercategory}
                for one in categories
            ],
        }
        write_bytes(self.path, json.dumps(whole, separators=(",", ":")).encode() + b"\n")

    def _name(self, picture: Path) -> str:
        folder = self.path.resolve().parent
        return Path(os.path.relpath(picture.resolve(), folder)).as_posix()


def runs_of(labels: NDArray[np.integer[Any]]) -> dict[int, list[int]]:
    """Run lengths of each label but 0, column by column: pixels outside, inside, outside, ..."""
    flat = labels.T.ravel()
    starts = np.concatenate([[0], np.flatnonzero(np.diff(flat)) + 1])
    ends = np.append(starts[1:], flat.size)
    values = flat[starts]
    order = np.argsort(values, kind="stable")
    names, firsts = np.unique(values[order], return_index=True)
    runs: dict[int, list[int]] = {}
    for name, places in zip(names.tolist(), np.split(order, firsts[1:]), strict=True):
        if name == 0:
            continue
        edges = np.stack([starts[places], ends[places]], axis=1).ravel()
        last = [flat.size] if edges[-1] < flat.size else []
        runs[name] = np.diff(np.concatenate([[0], edges, last])).astype(int).tolist()
    return runs


def _annotation(thing: Annotation) -> dict[str, Any]:
    return {
        "category_id": thing.category.id,
        "bbox": _plain(thing.box),
        "area": thing.area,
        "iscrowd": 0,
        "node": thing.name,
        "bbox_full": _plain(thing.full_box),
        "truncation": None if thing.truncation is None else _plain(thing.truncation),
        "visibility": _plain(thing.visibility),
        "bbox3d": _box3(thing.camera_box3),
        "bbox3d_world": _box3(thing.box3),
        "camera_from_node": _plain(thing.camera_from_node),
    }


def _box3(box: Box3) -> dict[str, Any]:
    return {
        "center": _plain(box.center),
        "size": _plain(box.size),
        "rotation": _plain(box.rotation),
    }


def _plain(value: object) -> Any:
    """Converts numbers to JSON, rounded to nine digits; text stays unchanged."""
    if isinstance(value, str):
        return value
    if isinstance(value, np.ndarray | list | tuple):
        return [_plain(one) for one in value]
    return float(f"{value:.9g}")
