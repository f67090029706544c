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
        scene: Receives what is read.
        unit_m: Length of a unit of the file, m.
        notes: Receives notes.
    """

    document: Document
    scene: Scene
    unit_m: float
    notes: Notes

    @property
    def world(self) -> NDArray[np.float64]:
        """Scene from the file's world, shape (4, 4)."""
        return np.diag([self.unit_m, self.unit_m, self.unit_m, 1.0])
