"""Rules of a subdivision surface: creases, corners, boundaries, seams and holes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.checks import MAX_NUMBERS, integers, short, to_numbers
from daguerre.errors import InputError, suggest
from daguerre.files.value import Value

SCHEMES = ("catmull-clark", "loop", "bilinear")
BOUNDARIES = ("edge and corner", "edge only", "none")
FACE_VARYING = ("corners plus1", "all", "none", "boundaries", "corners only", "corners plus2")
#: Sharpness from which on an edge or vertex stays sharp at all levels.
INFINITE = 10.0
MAX_LEVEL = 10

IntArray = NDArray[np.int64]
FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Rules(Value):
    """Rules of a subdivision surface; the defaults are the defaults of USD.

    Attributes:
        creases: Edges, pairs of control vertices, shape (E, 2); pairs that are no edge are ignored.
        crease_sharpness: Sharpness of each edge, shape (E,), or of all: the number of levels for
            which it is sharp; 10 and more is infinite.
        corners: Control vertices, shape (V,).
        corner_sharpness: Sharpness of each corner, shape (V,), or of all.
        boundary: "edge and corner": boundaries are creases, and vertices of one face are corners;
            "edge only": such vertices are smooth; "none": faces at a boundary are left out, unless
            its edges are creases of infinite sharpness.
        face_varying: Interpolation of values per corner at their seams. "none": smooth; "corners
            only": corners of one face are kept; "corners plus1": also vertices where more than two
            values meet; "corners plus2": also ends of seams and concave corners; "boundaries":
            all values on seams are kept; "all": linear everywhere.
        holes: Faces that shape the surface and are left out, shape (H,).
    """

    creases: ArrayLike = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    crease_sharpness: ArrayLike = INFINITE
    corners: ArrayLike = field(default_factory=lambda: np.zeros(0, np.int64))
    corner_sharpness: ArrayLike = INFINITE
    boundary: str = "edge and corner"
    face_varying: str = "corners plus1"
    holes: ArrayLike = field(default_factory=lambda: np.zeros(0, np.int64))

    def checked(self, count: int, faces: int, where: str) -> Rules:
        """Returns the rules with arrays of numbers, all of them in range.

        Args:
            count: Number of control vertices.
            faces: Number of control faces.
            where: Owner of the rules, for messages.

        Raises:
            InputError: An index, a sharpness or a name is wrong.
        """
        creases = integers(self.creases, where, "creases", count)
        if creases.size % 2 or (creases.ndim != 1 and creases.shape[1:] != (2,)):
            raise InputError(f"{where}: creases: wanted shape (E, 2), got {creases.shape}")
        creases = creases.reshape(-1, 2)
        corners = integers(self.corners, where, "corners", count).reshape(-1)
        choice(self.boundary, BOUNDARIES, f"{where}: boundary")
        choice(self.face_varying, FACE_VARYING, f"{where}: face_varying")
        return Rules(
            creases,
            _sharpness(self.crease_sharpness, where, "crease_sharpness", len(creases)),
            corners,
            _sharpness(self.corner_sharpness, where, "corner_sharpness", len(corners)),
            self.boundary,
            self.face_varying,
            integers(self.holes, where, "holes", faces).reshape(-1),
        )


@dataclass(frozen=True, eq=False)
class Subdivision(Value):
    """A subdivision surface of a mesh.

    Attributes:
        scheme: "catmull-clark", "loop" (triangles) or "bilinear".
        level: Number of times that each edge is halved, 1 .. 10; each level has four times the
            faces.
        rules: Creases, corners, boundaries, seams and holes.
    """

    scheme: str = "catmull-clark"
    level: int = 2
    rules: Rules = field(default_factory=Rules)


def edges_of_chains(
    vertices: ArrayLike, lengths: ArrayLike, sharpness: ArrayLike, where: str = "creases"
) -> tuple[IntArray, FloatArray]:
    """Makes edges for ``Rules.creases`` from chains of vertices, the form of files.

    Args:
        vertices: Vertices of all chains, chain by chain, shape (sum of lengths,).
        lengths: Number of vertices of each chain, at least 2, shape (K,).
        sharpness: Sharpness of each chain, shape (K,), or of each edge.
        where: Owner of the chains, for messages.

    Returns:
        Pairs of vertices, shape (E, 2), and the sharpness of each, shape (E,).

    Raises:
        InputError: Numbers do not fit together.
    """
    flat = integers(vertices, where, "vertices", MAX_NUMBERS).reshape(-1)
    counts = integers(lengths, where, "lengths", MAX_NUMBERS).reshape(-1)
    if counts.size and counts.min() < 2:
        raise InputError(f"{where}: lengths: wanted at least 2 vertices, got {counts.min()}")
    if int(counts.sum()) != len(flat):
        raise InputError(f"{where}: vertices: wanted {int(counts.sum())}, got {len(flat)}")
    given = to_numbers(sharpness, where, "sharpness", "numbers").reshape(-1).astype(np.float64)
    edges = len(flat) - len(counts)
    if len(given) not in (len(counts), edges):
        raise InputError(f"{where}: sharpness: wanted {len(counts)} or {edges}, got {len(given)}")
    starts = np.ones(len(flat), bool)
    starts[np.cumsum(counts) - 1] = False
    first = np.flatnonzero(starts)
    each = given if len(given) == edges else np.repeat(given, counts - 1)
    return np.stack([flat[first], flat[first + 1]], axis=1), each


def choice(value: object, known: tuple[str, ...], where: str) -> str:
    """Checks one of several names.

    Raises:
        InputError: Another value.
    """
    if not isinstance(value, str) or value not in known:
        near = suggest(value, known)
        raise InputError(f"{where}: wanted one of {', '.join(known)}, got {short(value)}{near}")
    return value


def _sharpness(values: ArrayLike, where: str, what: str, count: int) -> FloatArray:
    """Checks numbers of at least 0: a single number, or ``count`` of them."""
    found = to_numbers(values, where, what, "numbers").astype(np.float64)
    if found.ndim == 0:
        found = np.full(count, float(found))
    if found.shape != (count,):
        raise InputError(f"{where}: {what}: wanted {count} numbers, got shape {found.shape}")
    if not (found >= 0).all():
        bad = found[~(found >= 0)][0]
        raise InputError(f"{where}: {what}: wanted numbers of at least 0, got {bad}")
    return found
