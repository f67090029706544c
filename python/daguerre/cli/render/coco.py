"""``--coco`` and ``--categories``: checked before anything is drawn."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from daguerre.errors import UsageError

if TYPE_CHECKING:
    from daguerre.labels.categories import Categories
    from daguerre.labels.coco import CocoFile

    from .pictures import Picture


def coco_of(
    path: Path | None, categories: Path | None, wanted: list[Picture]
) -> tuple[CocoFile | None, Categories | None]:
    """The file in the making, and what things are.

    Raises:
        UsageError: Flags that do not go together, or a name that is taken.
        InputError: The file of categories cannot be used.
        OutputError: The file cannot be written.
    """
    if path is None:
        if categories is not None:
            raise UsageError("--categories: wanted --coco FILE.json too")
        return None, None
    if path.suffix.lower() != ".json":
        raise UsageError(f"--coco: wanted a name ending in .json, got {path}")
    if not wanted[0].plan.outputs:
        raise UsageError("--coco: wanted a picture with -o, got maps alone")
    if wanted[0].plan.overscan is not None:
        raise UsageError("--coco and --overscan: wanted one of them: pictures have no overscan")
    taken = {file.resolve() for picture in wanted for file in picture.plan.written}
    if path.resolve() in taken or (
        categories is not None and path.resolve() == categories.resolve()
    ):
        raise UsageError(f"--coco {path}: this name is taken by another file of this call")
    from daguerre.labels.categories import Categories
    from daguerre.labels.coco import CocoFile

    return CocoFile(path), None if categories is None else Categories.read(categories)
