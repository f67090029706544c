"""``daguerre composite``: rendered objects into a photograph."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre.errors import InputError, UsageError
from daguerre.rendering.progress import FrameStatus

from . import console, progress
from .flags.composite import PlacingFlags, SequenceFlags
from .flags.groups import option, with_flags
from .render.frames import check_names, frame_numbers

if TYPE_CHECKING:
    from daguerre.plates.composite.shots import Shot


@with_flags(placing=PlacingFlags, sequence=SequenceFlags)
def composite(
    plate: Annotated[
        Path,
        typer.Argument(
            metavar="PLATE",
            help="Photograph: .dng, .exr, .jpg, .png or .tif; with --frames a sequence such as "
            "plate.####.dng, or one photograph for all frames.",
        ),
    ],
    objects: Annotated[
        Path,
        typer.Argument(
            metavar="OBJECT.exr",
            help="Render with alpha and catchers; with --frames a sequence such as "
            "object.####.exr.",
        ),
    ],
    output: Annotated[
        list[Path],
        option(
            "-o",
            "--output",
            metavar="OUT.exr|dng|jpg|png|tif",
            help="Picture to write; repeatable.",
        ),
    ],
    *,
    placing: PlacingFlags,
    sequence: SequenceFlags,
) -> int:
    """Puts rendered objects into a photograph.

    It adds linear light, or electrons if the photograph is a raw file.
    """
    from daguerre.files.atomic import check_writable
    from daguerre.plates.composite.remarks import of_camera
    from daguerre.plates.composite.shots import shots_of

    console.quiet = sequence.quiet
    if sequence.resume and sequence.frames is None:
        raise UsageError("--resume needs --frames")
    numbers = None if sequence.frames is None else frame_numbers("--frames", sequence.frames)
    check_names(output, numbers)
    shots = shots_of(plate, objects, output, numbers, placing.seed)
    for path in (path for shot in shots for path in shot.outputs):
        check_writable(path)
    silent, how = sequence.quiet or numbers is None, placing.given()
    for text in of_camera(how["like_plate"]):
        console.note(text)
    with progress.choose(quiet=silent, as_json=sequence.json_progress) as shown:
        _run(shots, how, shown, resume=sequence.resume)
    return 0


def _run(shots: list[Shot], how: dict[str, Any], shown: progress.Silent, *, resume: bool) -> None:
    """Composites frame after frame."""
    began, made = time.monotonic(), 0
    for i, shot in enumerate(shots):
        if shot.frame is not None:
            console.note(f"frame {shot.frame} ({i + 1} of {len(shots)})")
        if resume and shot.is_complete:
            console.note(f"{shot.outputs[0]} is complete")
        else:
            _make(shot, how, shown)
            made += 1
        done, elapsed = i + 1, time.monotonic() - began
        left = (len(shots) - done) * elapsed / made if made else None
        shown.update(FrameStatus(done / len(shots), done, len(shots), elapsed, left))


def _make(shot: Shot, how: dict[str, Any], shown: progress.Silent) -> None:
    from daguerre.pictures.exr.read import load_frame
    from daguerre.plates.composite import remarks
    from daguerre.plates.composite.composite import composite as put
    from daguerre.plates.composite.composite import save
    from daguerre.plates.files import read

    try:
        source, frame = read(shot.plate), load_frame(shot.objects)
        made = put(source, frame, **how, seed=shot.seed)
    except InputError as error:
        if shot.frame is None:
            raise
        raise InputError(f"frame {shot.frame}: {error}") from None
    camera = how["like_plate"]
    # A sequence has one camera file, which was matched to one of its plates.
    known = camera if shot.frame is None else None
    for text in (*remarks.of_plate(source, known), *remarks.of_objects(frame, shot.objects)):
        console.note(text)
    for path in shot.outputs:
        save(made, path)
        console.note(f"wrote {path}")
    number = {} if shot.frame is None else {"frame": shot.frame}
    shown.event("done", **number, outputs=[str(path) for path in shot.outputs])
