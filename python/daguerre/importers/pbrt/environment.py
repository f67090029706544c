"""Reads lights from infinity.

pbrt-v4 has equal-area square maps (``filename``), pbrt-v3 panoramas (``mapname``); both have +z of
the light's space in their middle or on top. Several lights are added to one panorama.

Source: pbrt-v4's user's guide ("infinite"), and ``lights.cpp`` for ``illuminance``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import asked_by
from daguerre.files import formats
from daguerre.pictures.panorama import resampled
from daguerre.scene.scene import Scene

from .emission import scaled_by
from .files import Files
from .ledger import Ledger
from .octahedral import directions_of, panorama_of
from .spectra import Color, Spectra, luminance, scaled
from .state import Entity

Array = NDArray[np.float64]
Picture = NDArray[np.float32]
_MOST_ROWS, _MOST_PICTURES = 4096, 16
#: Largest light of a pixel, so that three sum to a finite float.
_MOST = 1e38
#: Axes of a panorama for ``resampled`` (+z at the middle, +x left of the middle, +y on top) from
#: axes of pbrt-v3 (-x at the middle, +y left of the middle, +z on top).
_DOME = np.array([(0, 0, -1), (1, 0, 0), (0, 1, 0)], float)


@dataclass(frozen=True, eq=False)
class Sky:
    """A light from infinity: a color, or a picture times a color.

    Attributes:
        color: Luminance, cd/m2, or factor.
        picture: Panorama of the scene, or None.
    """

    color: Color
    picture: Picture | None = None


class Skies:
    """Reads lights from infinity.

    Args:
        files: Files of the scene.
        spectra: Spectra of the scene.
        axes: Scene from world of pbrt, shape (4, 4).
        version: Version of pbrt, 3 or 4.
        ledger: Counts directives.
    """

    def __init__(
        self, files: Files, spectra: Spectra, axes: Array, version: int, ledger: Ledger
    ) -> None:
        self._files, self._spectra, self._axes = files, spectra, axes
        self._version, self._ledger = version, ledger
        self._left = _MOST_PICTURES

    def read(self, entity: Entity) -> Sky | None:
        """Reads a light; None, and a note: its picture is missing.

        Raises:
            InputError: A parameter or the picture is wrong.
        """
        parameters = entity.parameters
        light = parameters.find("L")
        color = scaled_by(entity, self._spectra.light(light), self._spectra)
        illuminance = parameters.number("illuminance", -1.0)
        for name in ("samples", "nsamples"):
            parameters.find(name)
        if parameters.find("portal") is not None:
            self._ledger.notes.add("the portal of an infinite light is left out")
        old = parameters.text("mapname")
        name = parameters.text("filename") or old
        self._ledger.tell_unread(parameters, entity.place, entity.kind)
        if not name:
            self._ledger.use(entity.place)
            factor = illuminance / math.pi if illuminance > 0 else 1.0
            return Sky(scaled(color, factor))
        path = self._files.find(name, entity.place, "filename")
        if path is None:
            sentence = "an infinite light whose picture is missing is left out"
            self._ledger.note(entity.place, sentence, name)
            return None
        self._left -= 1
        if self._left < 0:
            entity.place.fail(f"too many environment pictures: the limit is {_MOST_PICTURES}")
        self._ledger.use(entity.place)
        turn = _orthogonal(self._axes @ entity.state.transform.start)
        return self._pictured(entity, path, color, illuminance, turn, bool(old))

    def _pictured(
        self, entity: Entity, path: Path, color: Color, illuminance: float, turn: Array, old: bool
    ) -> Sky:
        with asked_by(entity.place):
            image: Picture = formats.read("environment", path, self._ledger.notes)
        if old:
            if illuminance > 0:
                self._ledger.notes.add("'illuminance' of a light of pbrt-v3 is left out")
            return Sky(color, resampled(image, turn @ _DOME, min(len(image), _MOST_ROWS)))
        if image.shape[0] != image.shape[1]:
            entity.place.fail(
                f"filename: {path}: wanted a square equal-area picture (imgtool makeequiarea), got "
                f"{image.shape[1]} x {image.shape[0]} pixels"
            )
        if illuminance > 0:
            whole = _upward(image)
            color = scaled(color, illuminance / whole if whole > 0 else 0.0)
        return Sky(color, panorama_of(_smaller(image), turn))


def set_skies(scene: Scene, skies: list[Sky]) -> None:
    """Sets the environment of a scene to the sum of lights from infinity."""
    if not skies:
        return
    plain = [sky.color for sky in skies if sky.picture is None]
    total = np.sum(np.array(plain), axis=0) if plain else np.zeros(3)
    pictures = [sky for sky in skies if sky.picture is not None]
    if not pictures:
        scene.set_environment(color=tuple(np.minimum(total, _MOST).tolist()))
        return
    rows = max(len(sky.picture) for sky in pictures if sky.picture is not None)
    image = np.zeros((rows, 2 * rows, 3), np.float64) + total
    for sky in pictures:
        assert sky.picture is not None
        image += _as_large(sky.picture, rows) * np.array(sky.color)
    scene.set_environment(np.minimum(image, _MOST).astype(np.float32))


def _as_large(picture: Picture, rows: int) -> Picture:
    """The panorama with another number of rows, looked up."""
    if len(picture) == rows:
        return picture
    high = np.arange(rows) * len(picture) // rows
    across = np.arange(2 * rows) * picture.shape[1] // (2 * rows)
    return picture[high][:, across]


def _upward(image: Picture) -> float:
    """Illuminance of a surface that faces +z of an equal-area map."""
    size = len(image)
    middle = (np.arange(size) + 0.5) / size
    s, t = np.meshgrid(middle, middle)
    cosine = np.maximum(directions_of(s, t)[..., 2], 0)
    sums = np.einsum("ijc,ij->c", image.astype(np.float64), cosine)
    # pbrt counts half of each pixel's solid angle here; this repeats it, to match its pictures.
    red, green, blue = (sums * (2 * math.pi / size**2)).tolist()
    return luminance((red, green, blue))


def _smaller(image: Picture) -> Picture:
    """The map with at most ``_MOST_ROWS`` rows, by means of pixels."""
    step = -(-len(image) // _MOST_ROWS)
    if step == 1:
        return image
    size = len(image) // step
    cut = image[: size * step, : size * step].reshape(size, step, size, step, 3)
    return np.asarray(cut.mean(axis=(1, 3), dtype=np.float32))


def _orthogonal(world: Array) -> Array:
    u, _, v = np.linalg.svd(world[:3, :3])
    return np.asarray(u @ v)
