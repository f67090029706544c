"""Faces that shape a surface and are left out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .cut import given_sharpness
from .faces import Faces
from .rules import INFINITE, Rules


def kept_faces(faces: Faces, rules: Rules) -> NDArray[np.bool_]:
    """Whether each control face is shown, shape (F,)."""
    kept = np.ones(len(faces.sizes), bool)
    kept[np.asarray(rules.holes)] = False
    if rules.boundary == "none":
        kept &= ~_at_boundary(faces, rules)
    return kept


def _at_boundary(faces: Faces, rules: Rules) -> NDArray[np.bool_]:
    """Whether a vertex of a face has a boundary edge without a crease of infinite sharpness."""
    edge_of = faces.edges[1]
    boundary = np.bincount(edge_of, minlength=len(faces.edges[0])) == 1
    loose = (boundary & (given_sharpness(faces, rules) < INFINITE))[edge_of]
    vertices = np.zeros(faces.count, bool)
    vertices[faces.vertices[loose]] = True
    vertices[faces.vertices[faces.after[loose]]] = True
    found = np.zeros(len(faces.sizes), bool)
    found[faces.face_of[vertices[faces.vertices]]] = True
    return found
