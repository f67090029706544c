"""``daguerre composite``: rendered objects into a photograph."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from daguerre import units as q
from daguerre.errors import UsageError

from . import console
from .flags.groups import Text, option


def composite(
    plate: Annotated[
        Path, typer.Argument(metavar="PLATE", help="Photograph: .dng, .exr, .jpg, .png, .tif.")
    ],
    objects: Annotated[
        Path, typer.Argument(metavar="OBJECT.exr", help="Render with alpha and catchers.")
    ],
    output: Annotated[
        list[Path],
        option(
            "-o", "--output", metavar="OUT.exr|dng|jpg|png|tif", help="File to write; repeatable."
        ),
    ],
    like_plate: Annotated[
        Path | None,
        option(
            "--like-plate",
            metavar="CAMERA.json",
            help="Matched camera of the plate: objects get its blur and noise. Raw plates need it.",
        ),
    ] = None,
    form: Annotated[
        str,
        option(
            "--form",
            metavar="auto|ratio|difference",
            help="How catchers change the plate: light is taken as a share and added as light "
            "[auto], or one of the two.",
        ),
    ] = "auto",
    scale: Annotated[
        Text,
        option(
            "--plate-scale",
            metavar="X",
            help="Light of the render that a plate's 1 stands for; by the exposure of both for "
            "developed plates, else 1.",
        ),
    ] = None,
    seed: Annotated[
        int, option("--seed", metavar="N", help="Seed of the noise of what is added [0].")
    ] = 0,
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False,
) -> int:
    """Puts rendered objects into a photograph: in light, or in the electrons of a raw file."""
    from daguerre.files.atomic import check_writable
    from daguerre.io.exr.read import read_frame
    from daguerre.plates.composite import remarks
    from daguerre.plates.composite.composite import composite as put
    from daguerre.plates.composite.composite import save
    from daguerre.plates.files import read
    from daguerre.plates.match.reader import read_plate_camera

    console.quiet = quiet
    for path in output:
        if any(
            path.exists() and each.exists() and path.samefile(each) for each in (plate, objects)
        ):
            raise UsageError(f"{path}: wanted another file than those that are read")
        check_writable(path)
    number = None if scale is None else q.plain_number("--plate-scale", scale, "a number above 0")
    camera = None if like_plate is None else read_plate_camera(like_plate)
    source, frame = read(plate), read_frame(objects)
    made = put(source, frame, like_plate=camera, form=form, scale=number, seed=seed)
    notes = [] if camera is None else remarks.of_camera(camera)
    for text in (*remarks.of_plate(source, camera), *notes, *remarks.of_objects(frame, objects)):
        console.note(text)
    for path in output:
        save(made, path)
        console.note(f"wrote {path}")
    return 0
