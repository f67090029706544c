"""Applies a chain of effects to a file and writes another file."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from daguerre.errors import UsageError
from daguerre.files.atomic import atomic_path
from daguerre.pictures.exr.rows import ExrWriter

from . import channels
from .display import Display
from .effect import Step
from .exr_picture import ExrPicture, check_target
from .optics import stop_remark_of
from .picture import bands
from .recipe import Planned, as_json, in_order
from .tiles import BLOCK, chained

HISTORY = "daguerre:post"


@dataclass(frozen=True)
class Report:
    """Report on a written file.

    Attributes:
        width: Width, px.
        height: Height, px.
        bad_pixels: Number of input pixels with a NaN or infinite value.
        remarks: Notes from the effects.
    """

    width: int
    height: int
    bad_pixels: int
    remarks: list[str]


def process(
    source: str | os.PathLike[str],
    target: str | os.PathLike[str],
    planned: Sequence[Planned],
    *,
    roles: Mapping[str, str] = {},
    progress: Callable[[int, int, int], None] = lambda done, height, width: None,
) -> Report:
    """Applies effects to an OpenEXR file in bands, so that memory does not grow with its height.

    Channels that no effect changes, attributes and windows are kept. The attribute
    ``daguerre:post`` records the effects.

    Args:
        source: Path of an .exr; its first part is used.
        target: Path of the .exr to write, atomically; may be the source. A .png gets the colours
            only, for viewing.
        planned: Effects from ``recipe.from_words`` or ``recipe.plan``.
        roles: Channels by role (``depth``, ``motion.u``, ``motion.v``) where names are unusual.
        progress: Function that is called with the rows done, all rows, and the width.

    Raises:
        InputError: The file cannot be read, or lacks a channel that an effect needs.
        UsageError: A value does not fit this picture.
        OutputError: The target cannot be written.
    """
    shown = Path(target).suffix.lower() == ".png"
    if not shown:
        check_target(target)
    planned, _ = in_order(planned)
    _check_distinct(target, planned)
    picture = ExrPicture(source, roles)
    with picture.reader as reader, atomic_path(target, over=source) as temp:
        steps = [step_of(p, picture) for p in planned]
        made = chained(steps, picture)
        before = reader.facts.get(HISTORY)
        history = f"{before}\n{as_json(planned)}" if before else as_json(planned)
        out: ExrWriter | Display
        if shown:
            out = Display(temp, picture.canvas, target)
        else:
            out = ExrWriter(temp, reader.header, {HISTORY: history})
        with out as writer:
            for band in bands(made, BLOCK):
                if isinstance(writer, Display):
                    writer.write(band.image)
                else:
                    writer.write(picture.planes(band))
                progress(band.rows.end, reader.height, reader.width)
    remarks = [f"{source}: {text}" for text in picture.remarks]
    remarks += [f"{p.effect.name}: {r}" for p, s in zip(planned, steps, strict=True)
               for r in s.remarks()]  # fmt: skip
    remarks += [text for p in planned if (text := stop_remark_of(p.values))]
    if reader.header.parts > 1:
        remarks.append(f"{source}: only the first of its {reader.header.parts} parts is written")
    return Report(reader.width, reader.height, picture.bad_pixels, remarks)


def _check_distinct(target: str | os.PathLike[str], planned: Sequence[Planned]) -> None:
    """Checks that no effect writes to the picture's file, or to a file of another effect.

    Raises:
        UsageError: An effect does; the message names it.
    """
    taken = {os.path.realpath(target)}
    for one in planned:
        for path in one.written:
            if os.path.realpath(path) in taken:
                raise UsageError(f"{one.where}: {path}: another output has this name")
            taken.add(os.path.realpath(path))


def step_of(planned: Planned, picture: ExrPicture) -> Step:
    """Makes the step for this picture, and checks that it has the channels that are needed."""
    for need in planned.effect.needs:
        for role in channels.roles_of(need):
            channels.find(picture.canvas, role)
    return planned.effect.make(picture.canvas, planned.values)
