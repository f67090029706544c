"""Fits a profile to a lens, and writes it as a file of lensfun's database."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.checks import numbers
from daguerre.errors import InputError, UsageError
from daguerre.files.atomic import write_bytes
from daguerre.files.formats import check_written
from daguerre.lenses import load
from daguerre.lenses.image_circle import film_mm
from daguerre.lenses.lens import Lens
from daguerre.lenses.zoom import positions

from .frame import Frame
from .models import POLY5, PTLENS
from .profile import LensfunProfile
from .traced import Geometry, geometry, vignetting
from .xml import as_xml

SUFFIXES = (".xml",)
#: px RMS below which poly5 serves: lensfun computes roots for ptlens with 12 bits, poly5 exactly.
SAME = 0.1
STEP = 1.08  # largest ratio of neighbouring focal lengths of a zoom


@guarded
def lensfun_profile(
    lens: Lens | str | Path, *, sensor_size: tuple[float, float] | None = None
) -> LensfunProfile:
    """Fits lensfun's models of distortion, lateral colour and vignetting to a lens.

    Args:
        lens: A lens, a name of the library, or a lens file.
        sensor_size: Width and height of the sensor, mm; None: the lens's format, else 3:2 in its
            image circle, else 36 x 24.

    Raises:
        InputError: The lens is a fisheye, has no focal length or no axial symmetry, or no light
            reaches the edge of the picture.
    """
    lens = load(lens)
    _check(lens)
    frame = _frame(lens, sensor_size)
    settings = [geometry(at, frame) for at in _at(lens, _focal_lengths(lens))]
    stated = _at(lens, [position.efl for position in positions(lens)])
    return LensfunProfile(
        maker=lens.data.get("maker") or "Daguerre",
        name=lens.name,
        frame=frame,
        model=_best(settings),
        geometry=tuple(settings),
        vignetting=tuple(itertools.chain(*(vignetting(at, frame) for at in stated))),
    )


@guarded
def save_lensfun(profile: LensfunProfile, path: str | Path) -> None:
    """Writes a profile as a file of lensfun's database.

    Raises:
        UsageError: The name does not end in .xml.
        OutputError: The file cannot be written.
    """
    check_written(path, SUFFIXES)
    write_bytes(path, as_xml(profile).encode())


def _check(lens: Lens) -> None:
    where = f"{lens.name}: lensfun"
    law = lens.nominal.projection or "rectilinear"
    if law != "rectilinear":
        raise InputError(f"{where}: wanted a rectilinear lens, got a fisheye ({law})")
    if not lens.prescription.is_axially_symmetric:
        raise InputError(f"{where}: wanted an axially symmetric lens")
    lens.first_order()  # raises an error without a focal length


def _frame(lens: Lens, given: tuple[float, float] | None) -> Frame:
    if given is None:
        given = film_mm(lens)
    sides = numbers(given, "lensfun: sensor_size", 2, "width and height, mm")
    if min(sides) <= 0 or max(sides) >= 1e4:
        raise UsageError(
            "lensfun: sensor_size: wanted width and height above 0 and below 10000 mm, got "
            f"{sides[0]:g} x {sides[1]:g}"
        )
    return Frame(max(sides), min(sides))


def _focal_lengths(lens: Lens) -> list[float]:
    """Focal lengths of a zoom: positions of its file, and steps between them; empty for primes."""
    if lens.zoom_range_mm is None:
        return []
    found = [p.efl for p in positions(lens)]
    out = found[:1]
    for short, long in itertools.pairwise(found):
        steps = max(math.ceil(math.log(long / short) / math.log(STEP)), 1)
        out += np.geomspace(short, long, steps + 1)[1:].tolist()
    return out


def _at(lens: Lens, focal_lengths: list[float]) -> list[Lens]:
    if lens.zoom_range_mm is None:
        return [lens]
    return [lens.at_zoom(mm) for mm in focal_lengths]


def _best(settings: list[Geometry]) -> str:
    """The model with the smaller residual at its worst focal length."""
    worst = {m: max(setting.distortion[m].rms for setting in settings) for m in (POLY5, PTLENS)}
    return POLY5 if worst[POLY5] < max(SAME, worst[PTLENS]) else PTLENS
