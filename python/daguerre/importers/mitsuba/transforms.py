"""Transforms: products of the steps in a ``<transform>``; each acts after the previous steps.

Source: Mitsuba 3, documentation of the scene format, "Transformations".
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes

from .ledger import Entry
from .node import Node
from .numbers import numbers

Matrix = NDArray[np.float64]
Attributes = dict[str, str]
#: Our lamp or camera from Mitsuba's: half a turn about +y.
TURN = np.diag([-1.0, 1.0, -1.0, 1.0])


def step(tag: str, attributes: Attributes, entry: Entry) -> Matrix:
    """Matrix of one step, shape (4, 4).

    Raises:
        InputError: An attribute or a number is wrong.
    """
    make = STEPS.get(tag)
    if make is None:
        entry.fail(f"wanted one of {', '.join(STEPS)} in a transform, got <{tag[:40]}>")
    made = make(attributes, entry)
    if not np.isfinite(made).all():
        entry.fail("numbers of a transform must be finite")
    return made


def axes(attributes: Attributes, entry: Entry, default: float) -> NDArray[np.float64]:
    """Three numbers by ``x``, ``y`` and ``z``, or by ``value``, of one or three numbers."""
    if "value" in attributes:
        if {"x", "y", "z"} & attributes.keys():
            entry.fail("set either value or x, y and z, not both")
        found = numbers(attributes["value"], entry, 1, 3)
        return np.array(found * 3 if len(found) == 1 else found)
    given = [numbers(attributes.get(axis, str(default)), entry, 1)[0] for axis in "xyz"]
    return np.array(given)


def _known(attributes: Attributes, entry: Entry, *names: str) -> None:
    for name in attributes:
        if name not in names:
            entry.fail(f"wanted attributes {', '.join(names)}, got {name[:40]!r}")


def _translate(attributes: Attributes, entry: Entry) -> Matrix:
    _known(attributes, entry, "x", "y", "z", "value")
    made = np.eye(4)
    made[:3, 3] = axes(attributes, entry, 0.0)
    return made


def _scale(attributes: Attributes, entry: Entry) -> Matrix:
    _known(attributes, entry, "x", "y", "z", "value")
    return np.diag([*axes(attributes, entry, 1.0), 1.0])


def _rotate(attributes: Attributes, entry: Entry) -> Matrix:
    """Rotation about an axis by an angle in degrees, by Rodrigues' formula."""
    _known(attributes, entry, "x", "y", "z", "value", "angle")
    (angle,) = numbers(_needed(attributes, entry, "angle"), entry, 1)
    axis = axes(attributes, entry, 0.0)
    length = float(np.linalg.norm(axis))
    if not 0 < length < math.inf:
        entry.fail("the axis must not have zero length")
    x, y, z = axis / length
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = math.radians(math.remainder(angle, 360))
    made = np.eye(4)
    made[:3, :3] += math.sin(turn) * cross + (1 - math.cos(turn)) * (cross @ cross)
    return made


def _look_at(attributes: Attributes, entry: Entry) -> Matrix:
    """Frame with +z toward the target, +x to the left, +y up."""
    _known(attributes, entry, "origin", "target", "up")
    origin, target = (
        np.array(numbers(_needed(attributes, entry, name), entry, 3))
        for name in ("origin", "target")
    )
    up = np.array(numbers(attributes.get("up", "0 0 0"), entry, 3))
    forward = _unit(target - origin, entry, "the target must differ from the origin")
    if not up.any():
        up = frame(forward)[:, 0]
    left = _unit(np.cross(up, forward), entry, "up must not be parallel to the view direction")
    made = np.eye(4)
    made[:3, 0], made[:3, 1], made[:3, 2] = left, np.cross(forward, left), forward
    made[:3, 3] = origin
    return made


def frame(axis: NDArray[np.float64]) -> Matrix:
    """Columns x, y, z with z along a unit vector, shape (3, 3).

    Source: Duff et al. 2017, Building an Orthonormal Basis, Revisited, JCGT 6(1).
    """
    x, y, z = axis
    sign = math.copysign(1.0, z)
    a = -1 / (sign + z)
    b = x * y * a
    first = (1 + sign * x * x * a, sign * b, -sign * x)
    second = (b, sign + y * y * a, -y)
    return np.stack([first, second, axis], axis=1)


def _unit(vector: NDArray[np.float64], entry: Entry, rule: str) -> NDArray[np.float64]:
    length = float(np.linalg.norm(vector))
    if not 1e-12 < length < math.inf:
        entry.fail(rule)
    return vector / length


def _matrix(attributes: Attributes, entry: Entry) -> Matrix:
    """16 or 9 numbers by rows."""
    _known(attributes, entry, "value")
    found = numbers(_needed(attributes, entry, "value"), entry, 9, 16)
    size = 4 if len(found) == 16 else 3
    made = np.eye(4)
    made[:size, :size] = np.reshape(found, (size, size))
    return made


def _needed(attributes: Attributes, entry: Entry, name: str) -> str:
    if name not in attributes:
        entry.fail(f"the attribute {name!r} is missing")
    return attributes[name]


STEPS: dict[str, Callable[[Attributes, Entry], Matrix]] = {
    "translate": _translate,
    "scale": _scale,
    "rotate": _rotate,
    "lookat": _look_at,
    "lookAt": _look_at,
    "matrix": _matrix,
}


def uv_part(matrix: Matrix) -> tuple[float, float, float, float, float, float]:
    """Affine transform of texture coordinates in a ``to_uv``, by rows."""
    (a, b, _, c), (d, e, _, f) = matrix[:2].tolist()
    return a, b, c, d, e, f


def product(steps: Sequence[tuple[str, Attributes]], entries: Sequence[Entry]) -> Matrix:
    """Matrix of all steps; each acts after the previous steps.

    Raises:
        InputError: A step is wrong, or the product is not finite.
    """
    made = np.eye(4)
    for (tag, attributes), entry in zip(steps, entries, strict=True):
        with np.errstate(all="ignore"):
            made = step(tag, attributes, entry) @ made
        if not np.isfinite(made).all():
            entry.fail("numbers of a transform must be finite")
    return made


def rigid(matrix: Matrix, node: Node, notes: Notes) -> Matrix:
    """Rotation and translation of a transform, without its scale or, with a note, its mirror.

    Raises:
        InputError: The transform flattens or shears.
    """
    made = orthogonal(matrix, node)
    if mirrors(made):
        made[:3, 0] *= -1
        notes.add(f"a {node.kind} that is mirrored is drawn without the mirroring")
    return made


def mirrors(matrix: Matrix) -> bool:
    """Whether a transform turns left into right."""
    return bool(np.linalg.det(matrix[:3, :3]) < 0)


def orthogonal(matrix: Matrix, node: Node) -> Matrix:
    """Rotation, mirror and translation of a transform, without its scale.

    Raises:
        InputError: The transform flattens or shears.
    """
    axes_, place = matrix[:3, :3], matrix[:3, 3]
    lengths = np.linalg.norm(axes_, axis=0)
    if not (lengths > 1e-12).all():
        node.fail("the transform must only rotate and translate, but it flattens")
    turned = axes_ / lengths
    if np.abs(turned.T @ turned - np.eye(3)).max() > 1e-3:
        node.fail("the transform must only rotate and translate, but it shears")
    u, _, v = np.linalg.svd(turned)  # exactly orthogonal
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = u @ v, place
    return made
