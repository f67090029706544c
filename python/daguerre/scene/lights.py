"""Lights that are not meshes. They are at the origin of their transform and shine along -z."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from daguerre.checks import color, number, short, shown
from daguerre.errors import InputError

if TYPE_CHECKING:
    from .light_profile import LightProfile

Color = tuple[float, float, float]


@dataclass(frozen=True)
class PointLight:
    """Point light: intensity in cd; with a radius (m), a visible ball of the same intensity.

    A profile multiplies the intensity by direction.
    """

    intensity: Color = (1.0, 1.0, 1.0)
    range: float = math.inf
    radius: float = 0.0
    name: str = ""
    profile: LightProfile | None = None


@dataclass(frozen=True)
class SpotLight:
    """Spot light: intensity on the axis in cd, half angles in degrees."""

    intensity: Color = (1.0, 1.0, 1.0)
    inner_angle: float = 0.0
    outer_angle: float = 45.0
    range: float = math.inf
    name: str = ""


@dataclass(frozen=True)
class DirectionalLight:
    """Directional light: illuminance in lux on a surface that faces it.

    It shines from a disc of even luminance at infinity, ``angle`` degrees across, which makes the
    edges of shadows soft; 0: a parallel beam, and sharp shadows. The illuminance does not depend on
    the angle. Neither the camera nor a perfect mirror shows the disc.
    """

    illuminance: Color = (1.0, 1.0, 1.0)
    name: str = ""
    angle: float = 0.0


@dataclass(frozen=True)
class SphereLight:
    """Visible ball of uniform luminance (cd/m2); radius in m.

    A profile multiplies the luminance by the direction in which the light leaves.
    """

    luminance: Color = (1.0, 1.0, 1.0)
    radius: float = 0.1
    name: str = ""
    profile: LightProfile | None = None


Light = PointLight | SpotLight | DirectionalLight | SphereLight


def check_light(light: Light) -> None:
    """Checks a light and its values.

    Raises:
        InputError: It is not a light, or a value is wrong; the message names light and field.
    """
    if not isinstance(light, Light):
        raise InputError(
            f"light: wanted a point, spot, directional or sphere light, got {short(light)}"
        )
    if not isinstance(light.name, str):
        raise InputError(f"light: name: wanted a string, got {shown(light.name)}")
    where = f"light {light.name!r}"
    for name, value in vars(light).items():
        if name in ("intensity", "illuminance", "luminance"):
            color(value, f"{where}: {name}")
        elif name == "range":
            number(value, f"{where}: range", above=0, infinite=True, error=InputError)
        elif name == "angle":
            number(value, f"{where}: angle", 0, 360, error=InputError)
        elif name == "radius":
            number(value, f"{where}: radius", 0, error=InputError)
        elif name == "profile" and value is not None:
            from .light_profile import check_profile

            check_profile(value, where)
    if isinstance(light, SphereLight) and not light.radius > 0:
        raise InputError(f"{where}: radius: wanted a number above 0, got {light.radius}")
    if isinstance(light, SpotLight):
        inner = number(light.inner_angle, f"{where}: inner_angle", 0, error=InputError)
        outer = number(light.outer_angle, f"{where}: outer_angle", 0, error=InputError)
        if not inner < outer <= 90:
            raise InputError(
                f"{where}: wanted 0 <= inner_angle < outer_angle <= 90 degrees, "
                f"got {inner:g} and {outer:g}"
            )
