"""Composites objects into a plate: in linear light, or in the electrons of a raw picture."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import number
from daguerre.color import srgb
from daguerre.color.spectra import xyz_of
from daguerre.errors import InputError, UsageError
from daguerre.exposure.lux_seconds import display_gain
from daguerre.frame.frame import Frame
from daguerre.frame.over import AUTO, change_of_rgb
from daguerre.frame.picture import Picture
from daguerre.frame.raw import Raw
from daguerre.pictures.exr.read import load_frame
from daguerre.plates.files import read
from daguerre.plates.match.like import PlateLook
from daguerre.plates.match.plate_camera import PlateCamera
from daguerre.plates.match.plate_raw import raw_of
from daguerre.plates.match.reader import read_plate_camera
from daguerre.plates.photograph import Photograph, encoded

from .in_raw import composite_raw

PathLike = str | os.PathLike[str]
Composite = Frame | Raw | Picture


@guarded
def composite(
    plate: PathLike | Photograph | Frame | Raw,
    objects: PathLike | Frame,
    *,
    like_plate: PathLike | PlateCamera | None = None,
    form: str = AUTO,
    scale: float | None = None,
    seed: int = 0,
) -> Composite:
    """Composites rendered objects into a photograph.

    Args:
        plate: Photograph. A raw photograph is composited in electrons.
        objects: Render of the objects, with alpha and catcher channels.
        like_plate: Matched camera of the plate, which gives objects its blur and noise. Required
            for a raw plate from a file.
        form: How catchers change the plate: ``auto``, ``ratio`` or ``difference``.
        scale: Light of the render for a plate value of 1; default: from both exposures for
            developed plates, 1 for linear plates.
        seed: Seed of the noise of added objects.

    Returns:
        A frame for a linear plate, a raw picture for a raw plate, a picture for a developed plate;
        each has ``save``.

    Raises:
        InputError: A file cannot be read, sizes differ, or a raw plate has no matched camera.
        UsageError: ``form`` is unknown, or ``scale`` is not positive.
    """
    look = _look(like_plate)
    frame = objects if isinstance(objects, Frame) else load_frame(objects)
    source = plate if isinstance(plate, Frame | Raw | Photograph) else read(plate)
    seen = frame.without_overscan() if look is None else look.seen(frame, seed)
    if isinstance(source, Photograph) and source.kind == "raw":
        source = _raw(source, look)
    if isinstance(source, Raw):
        if scale is not None:
            raise UsageError(
                "scale: leave it out for a raw plate, which has its scale in electrons"
            )
        return composite_raw(source, seen, form=form, seed=seed)
    if isinstance(source, Frame):
        return _linear(source, seen, form, 1.0 if scale is None else _positive(scale))
    return _developed(source, seen, look, form, scale, seed)


def _look(like_plate: PathLike | PlateCamera | None) -> PlateLook | None:
    if like_plate is None or isinstance(like_plate, PlateCamera):
        return None if like_plate is None else PlateLook(like_plate)
    return PlateLook(read_plate_camera(like_plate))


def _raw(source: Photograph, look: PlateLook | None) -> Raw:
    if look is None:
        raise InputError(
            f"{source.path}: composite: a raw plate needs its matched camera: run `daguerre "
            "match-plate`, then add --like-plate"
        )
    return raw_of(source, look.plate)


def _positive(scale: float) -> float:
    return number(scale, "scale", above=0.0)


def check_size(frame: Frame, size: tuple[int, int]) -> None:
    """Checks that objects have the plate's size.

    Raises:
        InputError: The sizes differ; the message has both.
    """
    if (frame.width, frame.height) != size:
        raise InputError(
            f"composite: size: wanted the plate's {size[0]} x {size[1]} px, "
            f"got {frame.width} x {frame.height} px"
        )


def _linear(plate: Frame, seen: Frame, form: str, scale: float) -> Frame:
    """Composites into a linear plate; returns a frame in the units of the plate."""
    shown = plate.without_overscan()
    check_size(seen, (shown.width, shown.height))
    rgb = change_of_rgb(seen, form).of(shown.rgb * np.float32(scale)) / np.float32(scale)
    rgb = np.asarray(rgb, np.float32)
    return Frame(rgb=rgb, xyz=xyz_of(rgb), metadata=_facts(seen, shown.metadata))


def _developed(
    plate: Photograph,
    seen: Frame,
    look: PlateLook | None,
    form: str,
    scale: float | None,
    seed: int,
) -> Picture | Frame:
    """Composites into a developed plate; returns a picture encoded like the plate."""
    check_size(seen, plate.size)
    linear = plate.kind == "linear"
    unit = _positive(scale) if scale is not None else 1.0 if linear else white_of(seen)
    change = change_of_rgb(seen, form)
    rgb = np.asarray(change.of(plate.linear() * np.float32(unit)) / np.float32(unit), np.float32)
    facts = _facts(seen, plate.facts)
    if linear:
        return Frame(rgb=rgb, xyz=xyz_of(rgb), metadata=facts)
    shown = srgb.from_linear(np.clip(rgb, 0, 1)).astype(np.float32)
    made = Picture(_noisy(shown, change.factor, plate, look, seed), "srgb", facts)
    return replace(made, pixels=_unchanged(made.pixels, plate, change.factor, change.light))


def white_of(frame: Frame) -> float:
    """Light of a frame that becomes 1 in a developed picture of its exposure."""
    return 1 / display_gain(frame.metadata)


def _noisy(
    shown: NDArray[np.float32],
    factor: NDArray[np.float32],
    plate: Photograph,
    look: PlateLook | None,
    seed: int,
) -> NDArray[np.float32]:
    """Adds the plate's noise where objects removed it, so that variances add up to the plate's."""
    if look is None:
        return shown
    whole = look.finished(Picture(shown, "srgb", dict(plate.facts)), seed).pixels
    lost = np.sqrt(np.clip(1 - np.clip(factor, 0, 1) ** 2, 0, 1))
    return np.asarray(shown + lost * (whole - shown), np.float32)


def _unchanged(
    pixels: NDArray[np.float32],
    plate: Photograph,
    factor: NDArray[np.float32],
    light: NDArray[np.float32],
) -> NDArray[np.float32]:
    """Keeps the plate's exact values where objects change nothing."""
    assert plate.pixels is not None
    same = (np.abs(1 - factor) < 1e-4) & (np.abs(light) < 1e-6)
    return np.asarray(np.where(same, encoded(plate.pixels), np.clip(pixels, 0, 1)), np.float32)


def _facts(seen: Frame, plate: dict[str, Any]) -> dict[str, Any]:
    """Metadata of the plate, completed from the render."""
    names = ("expTime", "aperture", "isoSpeed", "nominalFocalLength", "lensModel", "lensMake")
    known = {name: seen.metadata[name] for name in names if name in seen.metadata}
    size = {"resolution": (seen.width, seen.height), "crop": (0, 0, seen.width, seen.height)}
    return known | dict(plate) | size


def save(made: Composite, path: Path, **look: Any) -> None:
    """Writes a composite in the format of the file name's suffix.

    Raises:
        UsageError: A DNG is requested, but the composite is not a raw picture.
    """
    if path.suffix.lower() == ".dng" and not isinstance(made, Raw):
        raise UsageError(
            f"{path}: only the composite of a raw plate can be a DNG; write a picture, such "
            "as .png or .tif"
        )
    made.save(path, **look)
