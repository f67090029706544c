"""``--coco`` and ``--categories``: labels of all pictures in one file."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from daguerre.cli import console
from daguerre.errors import UsageError
from daguerre.rendering.picture import Picture
from daguerre.scene.scene import Scene

if TYPE_CHECKING:
    from daguerre.labels.categories import Categories
    from daguerre.labels.coco import CocoFile
    from daguerre.rendering.session import Session

    from .plan import Plan


@dataclass(frozen=True)
class Labels:
    """Collects labels of pictures.

    Attributes:
        file: The file; None: no labels.
        categories: Categories of objects; None: names of nodes.
    """

    file: CocoFile | None = None
    categories: Categories | None = None

    def check(self, scene: Scene) -> None:
        """Checks that the categories fit the scene."""
        if self.categories is not None:
            self.categories.things(scene)

    def add(self, picture: Picture, session: Session) -> None:
        """Adds the labels of a picture."""
        if self.file is None:
            return
        from daguerre.labels.annotations import annotations_of

        seen = annotations_of(session, self.categories)
        # Readers of data sets need files that image libraries can open.
        files = picture.output.files
        plain = (f for f in files if f.suffix.lower() not in (".exr", ".dng"))
        self.file.add(seen, next(plain, files[0]), picture.facts)

    def write(self) -> None:
        """Writes the file, if labels were asked for."""
        if self.file is not None:
            self.file.write()
            console.note(f"wrote {self.file.path}")


def coco_of(path: Path | None, categories: Path | None, plan: Plan) -> Labels:
    """Makes the collector of labels from the flags.

    Raises:
        UsageError: Flags exclude each other, or the name of the file is taken.
        InputError: The file of categories cannot be used.
        OutputError: The file cannot be written.
    """
    if path is None:
        if categories is not None:
            raise UsageError("--categories needs --coco FILE.json")
        return Labels()
    if path.suffix.lower() != ".json":
        raise UsageError(f"--coco: wanted a name ending in .json, got {path}")
    if not plan.flags.paths:
        raise UsageError("--coco needs a picture (-o NAME.png): only maps are written")
    if plan.pictures[0].settings.film.overscan is not None:
        raise UsageError("--coco and --overscan: wanted one of them, got both")
    taken = {os.path.realpath(file) for picture in plan.pictures for file in picture.output.written}
    if os.path.realpath(path) in taken:
        raise UsageError(f"--coco {path}: another file of this command has this name")
    from daguerre.labels.categories import Categories
    from daguerre.labels.coco import CocoFile

    return Labels(CocoFile(path), None if categories is None else Categories.read(categories))
