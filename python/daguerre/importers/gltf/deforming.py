"""Vertices of a primitive after morphs and skins, at one time or over time.

Source: glTF 2.0 specification, chapters 3.7.2.2 and 3.7.3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes, Silence
from daguerre.files.value import Value
from daguerre.scene.motion import Vertices
from daguerre.scene.normals import unit_normals, unit_tangents

from .morphs import KeptShapes, morph
from .over_time import PartOverTime
from .skins import SkinOverTime, skin

FloatArray = NDArray[np.float32]
Arrays = dict[str, FloatArray]


@dataclass(frozen=True, eq=False)
class MeshOverTime(Value):
    """The vertices of a primitive over time.

    Attributes:
        arrays: Attributes by their names in glTF, with the values of the file.
        triangles: Shape (M, 3), wound for the vertices at the time of reading.
        displacements: Weighted displacements over time.
        shapes: Values of the displacements.
        skin: Skin that moves the vertices; None: no skin.
    """

    arrays: Arrays
    triangles: NDArray[np.uint32]
    displacements: PartOverTime
    shapes: KeptShapes
    skin: SkinOverTime | None

    def at(self, time_s: float) -> Vertices:
        """Vertices at a time, s."""
        arrays = dict(self.arrays)
        with np.errstate(all="ignore"):
            morph(arrays, self.displacements.at(time_s), self.shapes)
            if self.skin is not None:
                skin(arrays, self.skin.influences, self.skin.at(time_s))
            return finished(arrays, self.arrays, self.triangles, Silence())

    def breaks(self, begin: float, end: float) -> NDArray[np.float64]:
        """Times of all keys of weights and joints."""
        morphs = self.displacements.breaks(begin, end)
        if self.skin is None:
            return morphs
        return np.union1d(morphs, self.skin.breaks(begin, end))


def finished(arrays: Arrays, base: Arrays, triangles: NDArray[np.uint32], notes: Notes) -> Vertices:
    """Normalises normals and tangents; arrays shared with ``base`` are copied."""

    def own(name: str) -> FloatArray | None:
        array = arrays.get(name)
        return array.copy() if array is not None and array is base.get(name) else array

    normals = own("NORMAL")
    if normals is not None:
        normals = unit_normals(normals, arrays["POSITION"], triangles, notes)
    colors = arrays.get("COLOR_0")
    if colors is not None and colors.shape[1] == 3:
        colors = np.concatenate([colors, np.ones((len(colors), 1), np.float32)], axis=1)
    return Vertices(
        arrays["POSITION"],
        normals,
        unit_tangents(own("TANGENT"), notes),
        arrays.get("TEXCOORD_0"),
        arrays.get("TEXCOORD_1"),
        colors,
    )
