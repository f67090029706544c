"""Checks of the fields of surfaces, by their annotations; the core checks ranges."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import Field, fields
from types import MappingProxyType
from typing import Any

import numpy as np

from daguerre.checks import color, number, numbers, short, shown, whole
from daguerre.errors import InputError
from daguerre.scene.spectrum import Spectrum

from .conductor import Conductor
from .diffuse import Diffuse
from .facets import DISTRIBUTIONS
from .texture_slot import TextureSlot

Check = Callable[[Any, str], object]


def check_fields(surface: Any, where: str) -> None:
    """Checks the shapes of all values of a surface or a material.

    Raises:
        InputError: The message names the field.
    """
    for field in fields(surface):
        value, place = getattr(surface, field.name), f"{where}: {field.name}"
        if field.type == "float":
            number(value, place, infinite=_endless(field), error=InputError)
        elif field.type in _CHECKS:
            _CHECKS[str(field.type)](value, place)


def check_flag(value: object, where: str) -> None:
    """Checks True or False, also as a number."""
    if not isinstance(value, bool | np.bool_) and not (isinstance(value, int) and value in (0, 1)):
        raise InputError(f"{where}: wanted True or False, got {shown(value)}")


def _endless(field: Field[Any]) -> bool:
    """Whether a number may be infinite, as its default is."""
    return isinstance(field.default, float) and math.isinf(field.default)


def _number(value: object, where: str) -> None:
    number(value, where, error=InputError)


def _coefficient(value: object, where: str) -> None:
    """Checks a colour or a spectrum."""
    if not isinstance(value, Spectrum):
        color(value, where)


def _index_of_refraction(value: object, where: str) -> None:
    if not isinstance(value, Spectrum):
        _number(value, where)


def _text(value: object, where: str) -> None:
    if not isinstance(value, str):
        raise InputError(f"{where}: wanted a string, got {shown(value)}")


def _slot(value: object, where: str) -> None:
    if not isinstance(value, TextureSlot | None):
        raise InputError(f"{where}: wanted a TextureSlot or None, got {short(value)}")
    if value is None:
        return
    whole(value.texture, f"{where}: texture", 0, 1 << 31)
    whole(value.uv_set, f"{where}: uv_set", 0, 1)
    numbers(value.transform, f"{where}: transform", 6, "six numbers")


def _distribution(value: object, where: str) -> None:
    if not isinstance(value, str) or value not in DISTRIBUTIONS:
        raise InputError(f"{where}: wanted {' or '.join(DISTRIBUTIONS)}, got {shown(value)}")


def _base(value: object, where: str) -> None:
    """Checks the surface under a coat."""
    if not isinstance(value, Diffuse | Conductor):
        raise InputError(f"{where}: wanted Diffuse or Conductor, got {short(value)}")
    check_surface(value, where)


def _optional(check: Check) -> Check:
    return lambda value, where: None if value is None else check(value, where)


_CHECKS: Mapping[str, Check] = MappingProxyType(
    {
        "Color": color,
        "Color | Spectrum": _coefficient,
        "Color | Spectrum | None": _optional(_coefficient),
        "float | None": _optional(_number),
        "float | Spectrum": _index_of_refraction,
        "bool": check_flag,
        "int": lambda value, where: whole(value, where, 0, (1 << 31) - 1),
        "str": _text,
        "TextureSlot | None": _slot,
        "Diffuse | Conductor": _base,
        "Distribution": _distribution,
    }
)


def check_surface(surface: object, where: str) -> None:
    """Checks the values of a surface, each alone and in combination.

    Raises:
        InputError: The message names the field.
    """
    check_fields(surface, where)
    if isinstance(surface, Conductor) and (surface.eta is None) != (surface.k is None):
        missing, given = ("eta", "k") if surface.eta is None else ("k", "eta")
        raise InputError(f"{where}: {missing}: missing, {given} needs it")
