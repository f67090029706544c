"""Refines a control mesh to points of its limit surface."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.cached import cached_property
from daguerre.checks import integers, short, to_numbers, whole
from daguerre.errors import InputError
from daguerre.files.value import Value

from .bilinear import Bilinear
from .catmull_clark import CatmullClark
from .cut import Opened, cut_mesh, opened_mesh
from .face_varying import cut_values, linear_corners, value_indices
from .faces import Faces, checked_faces
from .holes import kept_faces
from .loop import Loop
from .rules import MAX_LEVEL, SCHEMES, FloatArray, IntArray, Rules, choice
from .scheme import Scheme
from .surface import RefinedSurface

#: Maximum number of faces of a refined mesh; they take 2 GB while it is made.
MAX_FACES = 1 << 22
_MAKERS: dict[str, Scheme] = {
    "catmull-clark": CatmullClark(), "loop": Loop(), "bilinear": Bilinear()
}  # fmt: skip


class _Output(NamedTuple):
    """Refined faces that are shown.

    Attributes:
        parents: Control face of each.
        vertices: Vertices of their corners.
        used: Vertices that they use; None: all.
    """

    parents: IntArray
    vertices: IntArray
    used: IntArray | None


class Refiner(Value):
    """A subdivision surface: topology once, points as often as they change.

    Refined faces are quadrangles, for Loop triangles, in the order of their control faces. Along
    infinitely sharp creases, at corners between them, and for bilinear surfaces along all edges,
    vertices have one copy on each side, of equal position, with the normal of that side. Vertices
    without a face are left out.

    Args:
        count: Number of control vertices.
        sizes: Corners of each control face, shape (F,); triangles for Loop.
        vertices: Vertex of each corner, shape (sum of sizes,), counter-clockwise from outside.
        scheme: "catmull-clark", "loop" or "bilinear".
        level: Number of times that each edge is halved, 1 .. 10.
        rules: Creases, corners, boundaries, seams and holes.
        where: Owner of the mesh, for messages.

    Raises:
        InputError: Numbers do not fit together, or the result has more than ``MAX_FACES`` faces.
    """

    def __init__(
        self,
        count: int,
        sizes: ArrayLike,
        vertices: ArrayLike,
        scheme: str = "catmull-clark",
        level: int = 2,
        rules: Rules | None = None,
        where: str = "subdivision",
    ) -> None:
        self.where = where
        self.scheme = choice(scheme, SCHEMES, f"{where}: scheme")
        self.level = _level(level, where)
        self._faces = checked_faces(count, sizes, vertices, where)
        if rules is not None and not isinstance(rules, Rules):
            raise InputError(f"{where}: rules: wanted Rules, got {short(rules)}")
        self.rules = (rules or Rules()).checked(count, len(self._faces.sizes), where)
        _refuse_too_many(self._faces, self.scheme, self.level, where)

    @property
    def sizes(self) -> IntArray:
        """Corners of each refined face, all 4, or 3 for Loop; shape (F',)."""
        return np.full(len(self.parents), 4 if self._scheme.quads else 3)

    @property
    def vertices(self) -> IntArray:
        """Vertex of each refined corner, shape (C',)."""
        return self._output.vertices

    @property
    def count(self) -> int:
        """Number of refined vertices."""
        used = self._output.used
        return self._main.last.count if used is None else len(used)

    @property
    def parents(self) -> IntArray:
        """Control face of each refined face, rising, shape (F',)."""
        return self._output.parents

    def surface(self, points: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Limit of the surface at refined vertices.

        Args:
            points: Control points, shape (N, 3).

        Returns:
            Positions, shape (N', 3), in the unit of ``points``, and unit normals, shape (N', 3).

        Raises:
            InputError: Another shape, or numbers that are not finite.
        """
        positions, normals = self._main.positions_and_normals(self._values(points, "points", 3))
        return self._used(positions), self._used(normals)

    def vertex(self, values: ArrayLike) -> FloatArray:
        """Values per vertex by the rule of positions, at the limit: (N, K) to (N', K).

        Raises:
            InputError: Another shape, or numbers that are not finite.
        """
        return self._used(self._main.limit(self._values(values, "values")))

    def varying(self, values: ArrayLike) -> FloatArray:
        """Values per vertex, interpolated linearly: (N, K) to (N', K).

        Raises:
            InputError: Another shape, or numbers that are not finite.
        """
        return self._used(self._main.varying(self._values(values, "values")))

    def face_varying(self, values: ArrayLike, indices: ArrayLike | None = None) -> FloatArray:
        """Values per corner of a face: smooth inside, by ``Rules.face_varying`` at seams.

        Args:
            values: Value of each control corner, shape (C, K), or, with ``indices``, (N, K).
            indices: Index of the value of each control corner, shape (C,); default: equal values
                at a vertex are the same value.

        Returns:
            Values of refined corners, shape (C', K).

        Raises:
            InputError: Another shape, a wrong index, or numbers that are not finite.
        """
        corners = len(self._faces.vertices)
        count = corners if indices is None else None
        numbers = _numbers(values, self.where, "values", None, count)
        if indices is None:
            chosen = value_indices(self._faces.vertices, numbers)
        else:
            chosen = integers(indices, self.where, "indices", len(numbers)).reshape(-1)
            if len(chosen) != corners:
                raise InputError(
                    f"{self.where}: indices: wanted {corners} (one per corner), got {len(chosen)}"
                )
        if self.rules.face_varying == "all" or self.scheme == "bilinear":
            refined = linear_corners(self._faces, self._scheme.quads, self.level, numbers[chosen])
        else:
            surface = self._seams(chosen)
            refined = surface.limit(numbers).take(surface.last.vertices, axis=0)
        kept = self._kept
        size = 4 if self._scheme.quads else 3
        return refined if kept is None else refined[np.repeat(kept, size)]

    @property
    def _scheme(self) -> Scheme:
        return _MAKERS[self.scheme]

    @cached_property
    def _opened(self) -> Opened:
        """The control mesh, opened as positions and all values are."""
        return opened_mesh(self._faces, self.rules, everywhere=self._scheme.linear)

    @cached_property
    def _main(self) -> RefinedSurface:
        return RefinedSurface(cut_mesh(self._faces, self._opened), self._scheme, self.level)

    @cached_property
    def _surfaces(self) -> dict[bytes, RefinedSurface]:
        """Surfaces of values per corner, by their indices; at most the last surface."""
        return {}

    def _seams(self, chosen: IntArray) -> RefinedSurface:
        """Surface with values as control vertices."""
        key, kept = chosen.tobytes(), self._surfaces
        found = kept.get(key)
        if found is None:
            cut = cut_values(self._faces, self._opened, self.rules.face_varying, chosen)
            found = RefinedSurface(cut, self._scheme, self.level)
            kept.clear()
            kept[key] = found
        return found

    @cached_property
    def _parents(self) -> IntArray:
        """Control face of all refined faces, also of those that are left out."""
        faces = np.arange(len(self._faces.sizes))
        if not self._scheme.quads:
            return np.repeat(faces, 4**self.level)
        return np.repeat(faces, self._faces.sizes * 4 ** (self.level - 1))

    @cached_property
    def _kept(self) -> NDArray[np.bool_] | None:
        """Whether a refined face is shown; None: all are."""
        kept = kept_faces(self._faces, self.rules)
        return None if kept.all() else kept[self._parents]

    @cached_property
    def _output(self) -> _Output:
        vertices, kept = self._main.last.vertices, self._kept
        if kept is None:
            return _Output(self._parents, vertices, None)
        size = 4 if self._scheme.quads else 3
        shown = vertices.reshape(-1, size)[kept].reshape(-1)
        used = np.zeros(self._main.last.count, bool)
        used[shown] = True
        number = np.cumsum(used) - 1
        return _Output(self._parents[kept], number[shown], np.flatnonzero(used))

    def _used(self, values: FloatArray) -> FloatArray:
        used = self._output.used
        return values if used is None else values.take(used, axis=0)

    def _values(self, values: ArrayLike, what: str, columns: int | None = None) -> FloatArray:
        return _numbers(values, self.where, what, columns, self._faces.count)


def _level(level: object, where: str) -> int:
    try:
        return whole(level, f"{where}: level", 1, MAX_LEVEL)
    except ValueError as error:
        raise InputError(str(error)) from None


def _refuse_too_many(faces: Faces, scheme: str, level: int, where: str) -> None:
    """Refuses faces that Loop cannot split, and results of too many faces."""
    if scheme == "loop" and len(faces.sizes) and faces.sizes.max() > 3:
        face = int(np.argmax(faces.sizes))
        raise InputError(
            f"{where}: sizes[{face}]: wanted triangles for loop, got {faces.sizes[face]} corners"
        )
    start = len(faces.sizes) if scheme == "loop" else len(faces.vertices)
    refined = start * 4 ** (level if scheme == "loop" else level - 1)
    if refined > MAX_FACES:
        raise InputError(
            f"{where}: level {level}: wanted at most {MAX_FACES} refined faces, got {refined}"
        )


def _numbers(
    values: ArrayLike, where: str, what: str, columns: int | None, count: int | None
) -> FloatArray:
    """Checks finite numbers of shape (count, columns); None: any."""
    wanted = f"shape ({'N' if count is None else count}, {columns or 'K'})"
    found = to_numbers(values, where, what, wanted)
    fits = found.ndim == 2 and columns in (None, found.shape[1]) and count in (None, len(found))
    if not fits:
        raise InputError(f"{where}: {what}: wanted {wanted}, got {found.shape}")
    found = np.asarray(found, np.float64)
    finite = np.isfinite(found)
    if not finite.all():
        bad = np.flatnonzero(~finite.all(axis=1))
        raise InputError(
            f"{where}: {what}[{bad[0]}]: wanted finite numbers, got {found[bad[0]].tolist()} "
            f"({len(bad)} such elements)"
        )
    return found
