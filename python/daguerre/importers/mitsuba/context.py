"""State that all parts of a reader share."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes
from daguerre.scene.scene import Scene

from .document import Document


@dataclass(frozen=True, eq=False)
class Context:
    """File, scene, unit and notes of a reader.

    Attributes:
        document: The file.
        scene: Receives the content of the file.
        unit_m: Length of a unit of the file, m.
        notes: Receives notes.
        mirrored: Whether the scene is the mirror image of the file's, because the file's camera is
            mirrored, which no lens is.
    """

    document: Document
    scene: Scene
    unit_m: float
    notes: Notes
    mirrored: bool = False

    @property
    def world(self) -> NDArray[np.float64]:
        """Scene from the file's world, shape (4, 4)."""
        return self.mirror @ np.diag([self.unit_m, self.unit_m, self.unit_m, 1.0])

    @property
    def mirror(self) -> NDArray[np.float64]:
        """Mirror image of the file's world, or nothing, shape (4, 4)."""
        return np.diag([-1.0 if self.mirrored else 1.0, 1.0, 1.0, 1.0])
