"""Opens a stage, confined to its folder, and reads its units, axes and time codes.

USD itself follows every path that a layer names. Here each layer is checked before it is opened:
it must be in the stage's folder or in one of ``allow_dirs``, links followed.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Tf, Usd, UsdGeom, UsdUtils

from daguerre.checks import short
from daguerre.errors import InputError, UsageError, suggest
from daguerre.files.notes import Notes
from daguerre.files.reading import size_of

from .assets import Assets
from .composed import check_count
from .layer_files import check_file
from .layers import Layers, read_anew
from .values import Clock

_Z_UP = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], np.float64)


@dataclass(frozen=True)
class Opened:
    """An open stage.

    Attributes:
        file: File, for messages.
        stage: The stage of USD.
        clock: Time codes of the stage.
        metres: Length of a scene unit, m.
        root: Scene (m, +y up) from stage, shape (4, 4).
        assets: Files that the stage may read.
        fps: Frames per second, if stated.
        binds_collections: Whether materials may be bound to collections.
    """

    file: str
    stage: Usd.Stage
    clock: Clock
    metres: float
    root: NDArray[np.float64]
    assets: Assets
    fps: float | None
    binds_collections: bool = False


@contextmanager
def usd_errors(file: str) -> Iterator[None]:
    """Turns errors of USD into ``InputError``, and keeps its warnings from being printed."""
    delegate = UsdUtils.CoalescingDiagnosticDelegate()
    try:
        yield
    except (Tf.ErrorException, UnicodeDecodeError) as error:
        raise InputError(f"{file}: {_without(_sentence(_text(error)), file)}") from None
    finally:
        del delegate


@contextmanager
def typed(file: str, place: str) -> Iterator[None]:
    """Turns errors from values of other types than the schema's into ``InputError``."""
    try:
        yield
    except (InputError, UsageError):  # subclasses of ValueError
        raise
    except (TypeError, ValueError, AttributeError) as error:
        raise InputError(
            f"{file}: {place}: values do not have the types of the schema ({short(error)})"
        ) from None


def _text(error: Exception) -> str:
    try:
        return str(error)
    except UnicodeDecodeError as fault:  # it quotes bytes of the file
        return fault.object.decode("utf-8", "replace")


def _sentence(text: str) -> str:
    """The message of an error of USD, without the place in USD's own source."""
    quoted = re.search(r" : '(.*?)'\s*(\)?$|Error in ')", text, re.DOTALL)
    words = (quoted[1] if quoted else text).split()
    return short_text(" ".join(words))


def _without(sentence: str, file: str) -> str:
    """A sentence of USD without the name of the file, which the message begins with."""
    for name in (os.path.realpath(file), file):
        sentence = sentence.removeprefix(f"{name}:")
    return sentence.strip()


def short_text(text: str, limit: int = 300) -> str:
    """Shortens a text for a message."""
    return text if len(text) <= limit else text[: limit - 3] + "..."


def open_stage(
    path: Path,
    time: float,
    variants: Iterable[str],
    allow_dirs: Iterable[str | os.PathLike[str]],
    notes: Notes,
) -> Opened:
    """Opens a stage.

    Args:
        path: File.
        time: Scene time, s.
        variants: Selections of variants, each as ``/prim:set=name``.
        allow_dirs: Further folders from which it may read.
        notes: Receives notes on layers that are missing.

    Raises:
        InputError: A layer is damaged, or outside of the folders; or unit or time code is invalid.
        UsageError: The stage has no such variant.
    """
    file = str(path)
    size_of(path)
    assets = Assets(path, allow_dirs)
    layers = Layers(path, assets)
    check_count(layers.root, file)
    stage = Usd.Stage.Open(layers.root.root, Usd.Stage.LoadAll)
    _select(stage, file, list(variants))
    for used in stage.GetUsedLayers():  # including layers of value clips
        if used.realPath:
            assets.check("layer", used.realPath)
    _note_missing(stage, notes)
    metres, z_up = _units(stage, file, notes)
    root = (_Z_UP if z_up else np.eye(4)) * np.array([metres, metres, metres, 1.0])[:, None]
    clock = _clock(stage, file, time)
    stated = stage.HasAuthoredMetadata("framesPerSecond")
    fps = _rate(file, "framesPerSecond", stage.GetFramesPerSecond()) if stated else None
    return Opened(file, stage, clock, metres, root, assets, fps, layers.bind_collections)


def _select(stage: Usd.Stage, file: str, variants: list[str]) -> None:
    stage.SetEditTarget(stage.GetSessionLayer())
    for text in variants:
        path, _, choice = text.rpartition(":") if "=" in text else ("", "", "")
        name, _, value = choice.partition("=")
        valid = Sdf.Path.IsValidPathString(path)[0] and Sdf.Path(path).IsAbsoluteRootOrPrimPath()
        if not valid or not path.startswith("/") or not name or not value:
            raise UsageError(f"variant: wanted /prim:set=name, got {text!r}")
        prim = stage.GetPrimAtPath(path)
        if not prim:
            raise UsageError(f"{file}: variant: no prim named {path}")
        if prim.IsInstanceProxy():
            raise UsageError(f"{file}: variant: {path} is in an instance, which is shared")
        sets = prim.GetVariantSets()
        if name not in sets.GetNames():
            hint = suggest(name, sets.GetNames(), few=True)
            raise UsageError(f"{file}: {path}: no set of variants {name!r}{hint}")
        known = sets.GetVariantSet(name).GetVariantNames()
        if value not in known:
            hint = suggest(value, known, few=True)
            raise UsageError(f"{file}: {path}: {name}: no variant {value!r}{hint}")
        sets.SetSelection(name, value)


def _note_missing(stage: Usd.Stage, notes: Notes) -> None:
    for error in stage.GetCompositionErrors():
        kind = type(error).__name__.removeprefix("Error")
        if kind.startswith("Invalid") and ("Asset" in kind or "Sublayer" in kind):
            if re.search(r"asset @[^@]*\.mtlx@", str(error)):
                continue  # the reader of materials finds these
            notes.add("a layer of the stage cannot be opened; its contents are left out")
        else:
            words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", kind).lower()
            notes.add(f"a composition error, {words!r}: the part that it affects is left out")


def _units(stage: Usd.Stage, file: str, notes: Notes) -> tuple[float, bool]:
    metres = float(UsdGeom.GetStageMetersPerUnit(stage))
    if not (math.isfinite(metres) and 1e-12 <= metres <= 1e12):
        raise InputError(f"{file}: metersPerUnit: wanted a number above 0, got {metres:g}")
    if not UsdGeom.StageHasAuthoredMetersPerUnit(stage):
        notes.add("metersPerUnit is not stated: a unit is 0.01 m, USD's default")
    up = str(UsdGeom.GetStageUpAxis(stage))
    if up not in ("Y", "Z"):
        raise InputError(f"{file}: upAxis: wanted Y or Z, got {up[:40]!r}")
    return metres, up == "Z"


def _clock(stage: Usd.Stage, file: str, time: float) -> Clock:
    rate = _rate(file, "timeCodesPerSecond", stage.GetTimeCodesPerSecond())
    holds = stage.GetInterpolationType() == Usd.InterpolationTypeHeld
    return Clock(file, rate, time, bool(holds))


def _rate(file: str, name: str, value: float) -> float:
    if not (math.isfinite(value) and 0 < value <= 1e9):
        raise InputError(f"{file}: {name}: wanted a number above 0, got {value:g}")
    return float(value)


def duration(opened: Opened) -> float | None:
    """Time of the last time code of a stage, s; None if it states none."""
    stage: Any = opened.stage
    if not stage.HasAuthoredTimeCodeRange():
        return None
    return max(0.0, opened.clock.seconds(float(stage.GetEndTimeCode())))


def time_of_code(path: str | os.PathLike[str], code: float) -> float:
    """Converts a time code of a stage to s.

    Raises:
        InputError: The file cannot be read, or states no valid rate.
    """
    check_file(Path(path), str(path))
    with usd_errors(str(path)):
        layer = read_anew(os.path.realpath(path))
        if layer is None:
            raise InputError(f"{path}: not a stage that USD can open")
        rate = _rate(str(path), "timeCodesPerSecond", layer.timeCodesPerSecond)
        return Clock(str(path), rate, 0.0).seconds(code)
