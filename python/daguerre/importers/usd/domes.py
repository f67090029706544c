"""Reads dome lights as the scene's environment.

A panorama of USD has +z of the dome at its centre, +x left of it and its pole on top; the scene's
has -z at its centre. A dome that is turned about another axis than the pole, or several domes, are
resampled into one panorama.

Source: OpenUSD, documentation of UsdLuxDomeLight and UsdLuxDomeLight_1, which quotes OpenEXR,
"Environment Maps". The pole of a ``DomeLight`` is +y of the dome whatever axis of the stage is up.
"""

from __future__ import annotations

import math
import os
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Ar, Usd, UsdGeom, UsdLux

from daguerre.errors import InputError
from daguerre.files import formats
from daguerre.files.notes import Notes
from daguerre.files.reading import MISSING
from daguerre.motion.values import at as value_at
from daguerre.motion.values import is_dynamic
from daguerre.pictures.panorama import resampled
from daguerre.scene.over_time.blackbody import Color
from daguerre.scene.over_time.emission import MOST, WHITE, Emission, Strength
from daguerre.scene.scene import Scene

Array = NDArray[np.float64]
Picture = NDArray[np.float32]
#: Rotation that takes +y of a dome, its pole, to +z, and its +z to -y.
_POLE_UP_Z = np.array([(1, 0, 0), (0, 0, -1), (0, 1, 0)], float)
_LATLONG = (None, "automatic", "latlong")
_MAX_ROWS = 4096


@dataclass(frozen=True, eq=False)
class Dome:
    """A dome light.

    Attributes:
        emission: Luminance, or factor of the picture.
        image: Picture, shape (H, W, 3), or None.
        turn: Scene from dome, orthogonal, shape (3, 3).
    """

    emission: Color | Emission
    image: Picture | None
    turn: Array

    @property
    def angle(self) -> float | None:
        """Turn about the scene's +y, degrees; None if the pole is elsewhere, or it is mirrored."""
        upright = np.allclose(self.turn[:, 1], (0, 1, 0), atol=1e-6)
        if not upright or np.linalg.det(self.turn) < 0:
            return None
        return math.degrees(math.atan2(self.turn[0, 2], self.turn[2, 2]))

    def picture(self, time: float) -> tuple[Array, Any]:
        """Colour and strength of the picture; the strength, and only that, may change over time.

        Args:
            time: Time of a colour that changes, s.
        """
        if isinstance(self.emission, Emission) and self.emission.keeps_hue:
            hue = np.maximum(self.emission.hue(time), 0.0)
            plain = replace(self.emission, color=WHITE, temperature=None)
            return hue, Strength(plain)
        color = np.array(value_at(self.emission, time))
        top = float(color.max())
        return (color / top if top > 0 else color), top


def is_dome(prim: Usd.Prim) -> bool:
    """Whether a prim is a dome light."""
    return bool(prim.IsA(UsdLux.DomeLight) or prim.IsA(UsdLux.DomeLight_1))


def is_latlong(prim: Usd.Prim) -> bool:
    """Whether the picture of a dome is a panorama of latitudes and longitudes."""
    return prim.GetAttribute("inputs:texture:format").Get() in _LATLONG


def turn_of(prim: Usd.Prim, world: Array) -> Array:
    """Scene from dome, orthogonal, shape (3, 3).

    Args:
        prim: The dome.
        world: Scene from prim, shape (4, 4).
    """
    lengths = np.linalg.norm(world[:3, :3], axis=0)
    u, _, v = np.linalg.svd(world[:3, :3] / np.where(lengths > 0, lengths, 1.0))
    turn: Array = u @ v
    return turn @ _POLE_UP_Z if _has_pole_on_z(prim) else turn


def _has_pole_on_z(prim: Usd.Prim) -> bool:
    if not prim.IsA(UsdLux.DomeLight_1):
        return False
    axis = str(UsdLux.DomeLight_1(prim).GetPoleAxisAttr().Get())
    return axis == "Z" or (axis != "Y" and UsdGeom.GetStageUpAxis(prim.GetStage()) == "Z")


def read_panorama(path: Path, notes: Notes) -> Picture:
    """Reads a picture of a dome, also from a package.

    Args:
        path: The picture.
        notes: Receives a note if its colours are converted.

    Raises:
        InputError: The picture cannot be read.
    """
    name = str(path)
    if not Ar.IsPackageRelativePath(name):
        return formats.read("environment", path, notes)  # type: ignore[no-any-return]
    asset = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(name))
    if asset is None:
        raise InputError(f"{name}: {MISSING}")
    handle, copy = tempfile.mkstemp(suffix=Path(name.rstrip("]")).suffix[:16])
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(asset.GetBuffer())
        return formats.read("environment", Path(copy), notes)  # type: ignore[no-any-return]
    except InputError as error:
        raise InputError(str(error).replace(copy, name)) from None
    finally:
        Path(copy).unlink(missing_ok=True)


def set_environment(scene: Scene, domes: list[Dome], notes: Notes) -> None:
    """Sets the environment of a scene from its domes."""
    if len(domes) > 1:
        domes = [_still(dome, scene.time, notes) for dome in domes]
    if domes and all(dome.image is None for dome in domes):
        _set_color(scene, [dome.emission for dome in domes])
    elif len(domes) == 1:
        _set_picture(scene, domes[0], notes)
    elif domes:
        _set_sum(scene, domes)


def _still(dome: Dome, time: float, notes: Notes) -> Dome:
    if not is_dynamic(dome.emission):
        return dome
    notes.add("one of several dome lights changes over time: it stays as at the scene's time")
    return replace(dome, emission=value_at(dome.emission, time))


def _set_color(scene: Scene, emissions: list[Any]) -> None:
    total = emissions[0]
    if len(emissions) > 1:
        total = tuple(float(min(sum(parts), MOST)) for parts in zip(*emissions, strict=True))
    scene.set_environment(color=total)


def _set_picture(scene: Scene, dome: Dome, notes: Notes) -> None:
    if isinstance(dome.emission, Emission) and not dome.emission.keeps_hue:
        notes.add(
            "a dome light with a picture and a changing colour keeps its colour at the scene's time"
        )
    image, (hue, scale), angle = dome.image, dome.picture(scene.time), dome.angle
    assert image is not None
    if angle is None:
        image, angle = resampled(image, dome.turn, min(len(image), _MAX_ROWS)), 180.0
    tinted = image if np.all(hue == 1) else _bounded(image * hue)
    scene.set_environment(tinted, scale=scale, rotation=angle + 180.0)


def _set_sum(scene: Scene, domes: list[Dome]) -> None:
    rows = min(max(len(dome.image) for dome in domes if dome.image is not None), _MAX_ROWS)
    total = np.zeros((rows, 2 * rows, 3), np.float32)
    for dome in domes:
        hue, scale = dome.picture(scene.time)
        color = np.asarray(hue * scale, np.float32)
        total += color if dome.image is None else color * resampled(dome.image, dome.turn, rows)
    scene.set_environment(_bounded(total))


def _bounded(image: NDArray[Any]) -> Picture:
    made: Picture = np.minimum(image, MOST).astype(np.float32)
    return made
