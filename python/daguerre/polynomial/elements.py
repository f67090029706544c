"""Elements of a system, each the Taylor expansion of its exact transfer about a base ray.

Lengths in mm. z points along the light, also after a mirror: distances are positive, and a radius
is positive when the centre lies ahead. Every element ends on a plane normal to z through the vertex
of its surface, where the next one begins.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

import daguerre._core as _core
from daguerre.checks import doubles, number, numbers, short, shown, whole
from daguerre.errors import UsageError, core_errors

from .forms import Form
from .system import System
from .wavelengths import Index, index_at, nodes_of, with_glass

AXIS = (0.0, 0.0, 0.0, 0.0)
MAX_DEGREE = 15


def propagate(distance: float, *, degree: int = 5, about: ArrayLike = AXIS) -> System:
    """Returns the propagation to a plane ahead.

    Args:
        distance: Distance of the plane, mm; negative: back.
        degree: Degree, 1 to 15. A composed system has the lower degree of its parts.
        about: Base ray of the expansion (x, y, dx, dy), shape (4,); default: the axis.
    """
    nodes, rays = _about(about, [])
    length = number(distance, "propagate: distance in mm")
    with core_errors(UsageError):
        return System(_core.polynomial_propagation(length, checked(degree), nodes, rays))


def refract(
    form: Form,
    n1: Index,
    n2: Index,
    *,
    degree: int = 5,
    wavelength: ArrayLike | None = None,
    about: ArrayLike = AXIS,
) -> System:
    """Returns the refraction at a surface, from and to the plane at its vertex.

    Args:
        form: ``sphere(50)``, ``plane()``, ``conic``, ``asphere``, ``cylinder`` ...
        n1: Index in front: a number, a number for each wavelength, or a glass.
        n2: Index behind, likewise.
        degree: Degree, 1 to 15.
        wavelength: Wavelength nodes, nm, shape () or (W,); default: numbers hold for any
            wavelength, glasses are taken at 587.56 nm.
        about: Base ray, shape (4,) or (W, 4), such as the ``image`` of the preceding system.

    Raises:
        UsageError: The base ray misses or is totally reflected, or the form is not smooth there.
    """
    nodes, rays = _about(about, with_glass(nodes_of(wavelength), n1, n2))
    first, second = index_at(n1, nodes), index_at(n2, nodes)
    surface = _surface(form)
    with core_errors(UsageError, str(form)):
        return System(
            _core.polynomial_refraction(surface, first, second, checked(degree), nodes, rays)
        )


def reflect(form: Form, *, degree: int = 5, about: ArrayLike = AXIS) -> System:
    """Returns the reflection at a mirror; then z points along the reflected light, x and y stay.

    Args:
        form: Form of the mirror; its radius is positive when the centre lies ahead of the incoming
            light.
        degree: Degree, 1 to 15.
        about: Base ray, shape (4,); default: the axis.
    """
    nodes, rays = _about(about, [])
    surface = _surface(form)
    with core_errors(UsageError, str(form)):
        return System(_core.polynomial_reflection(surface, checked(degree), nodes, rays))


def place(
    decenter: ArrayLike = (0.0, 0.0, 0.0),
    tilt: ArrayLike = (0.0, 0.0, 0.0),
    *,
    back: bool = False,
    degree: int = 5,
    about: ArrayLike = AXIS,
) -> System:
    """Returns the change into a frame that is moved, then turned, or back out of it.

    The axis is no longer the base ray there: expand each system ``about=`` the ``image`` of the
    preceding system, so that no constants arise::

        into = po.place((0, 1, 0), (2, 0, 0))
        bend = po.refract(po.sphere(40), 1.0, 1.5, about=into.image) @ into
        bend = po.place((0, 1, 0), (2, 0, 0), back=True, about=bend.image) @ bend

    Args:
        decenter: Shift of the frame along x, y and z, mm, shape (3,).
        tilt: About x, then about the y that turned with it, then that z, degrees, shape (3,).
        back: From the plane z = 0 of that frame to the plane z = 0 before, instead.
        degree: 1 to 15.
        about: Base ray, shape (4,).
    """
    shift = numbers(decenter, "place: decenter", 3, "three finite numbers, mm")
    turn = numbers(tilt, "place: tilt", 3, "three finite numbers, degrees")
    nodes, rays = _about(about, [])
    if not isinstance(back, bool):
        raise UsageError(f"place: back: wanted True or False, got {shown(back)}")
    with core_errors(UsageError):
        return System(
            _core.polynomial_placement(list(shift), list(turn), back, checked(degree), nodes, rays)
        )


def checked(degree: int) -> int:
    """Checks a degree.

    Raises:
        UsageError: The degree is not 1 .. 15.
    """
    return whole(degree, "degree", 1, MAX_DEGREE, f"1 to {MAX_DEGREE}")


def _about(about: ArrayLike, nodes: list[float]) -> tuple[list[float], list[list[float]]]:
    """Base rays for the core: a single ray, or a ray for each node."""
    rays = np.atleast_2d(doubles(about, "polynomial system", "about", "a ray (x, y, dx, dy)"))
    if rays.ndim != 2 or rays.shape[1] != 4 or len(rays) not in (1, len(nodes)):
        raise UsageError(
            f"about: wanted a ray (x, y, dx, dy), or one for each of {len(nodes)} wavelengths, "
            f"got shape {np.shape(about)}"
        )
    return nodes, rays.tolist()


def _surface(form: Form) -> _core.Surface:
    if not isinstance(form, Form):
        raise UsageError(f"form: wanted a form such as sphere(50) or plane(), got {short(form)}")
    return form.surface
