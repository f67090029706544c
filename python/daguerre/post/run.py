"""A file through a chain of effects into another file."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from daguerre.files.atomic import atomic_path
from daguerre.io.exr.rows import ExrWriter

from . import channels
from .display import Display
from .effect import Step
from .exr_picture import ExrPicture, check_target
from .picture import bands
from .recipe import Planned, as_json, in_order
from .tiles import BLOCK, chained

HISTORY = "daguerre:post"


@dataclass(frozen=True)
class Report:
    """Report on a file that was made.

    Attributes:
        width: px.
        height: px.
        bad_pixels: Pixels of the input with a value that is NaN or infinite.
        remarks: Remarks of the effects.
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
    """Applies effects to an OpenEXR file, in bands: memory does not grow with its height.

    Channels that no effect changes, attributes and windows are kept; the effects are written down
    in the attribute ``daguerre:post``.

    Args:
        source: An .exr; its first part is used.
        target: The .exr to write, whole or not at all; may be the same file. Or a .png: the colours
            alone, as a screen shows them.
        planned: From ``recipe.from_words`` or ``recipe.plan``.
        roles: Channels by role (``depth``, ``motion.u``, ``motion.v``) where names are unusual.
        progress: Called with rows done, of how many, and their width.

    Raises:
        InputError: The file cannot be read, or has not what an effect needs.
        UsageError: A value that does not fit this picture.
        OutputError: The target cannot be written.
    """
    shown = Path(target).suffix.lower() == ".png"
    if not shown:
        check_target(target)
    planned, _ = in_order(planned)
    picture = ExrPicture(source, roles)
    with picture.reader as reader, atomic_path(target) as temp:
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
    remarks = [f"{p.effect.name}: {r}" for p, s in zip(planned, steps, strict=True)
               for r in s.remarks()]  # fmt: skip
    if reader.header.parts > 1:
        remarks.append(f"{source}: only the first of its {reader.header.parts} parts is written")
    return Report(reader.width, reader.height, picture.bad_pixels, remarks)


def step_of(planned: Planned, picture: ExrPicture) -> Step:
    """The step for this picture, which has the channels that the effect needs."""
    for need in planned.effect.needs:
        for role in channels.roles_of(need):
            channels.find(picture.canvas, role)
    return planned.effect.make(picture.canvas, planned.values)
