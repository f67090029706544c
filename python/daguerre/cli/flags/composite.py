"""Flags of ``composite``: how objects come into a plate, and the frames of a sequence.

Annotations must be real objects here (see ``groups.py``), so no ``annotations`` future.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from daguerre import units as q

from .groups import Text, option


@dataclass(frozen=True)
class PlacingFlags:
    """How objects come into a plate."""

    like_plate: Annotated[
        Path | None,
        option(
            "--like-plate",
            metavar="CAMERA.json",
            help="Matched camera of the plate: objects get its blur and noise. Raw plates need it.",
        ),
    ] = None
    form: Annotated[
        str,
        option(
            "--form",
            metavar="auto|ratio|difference",
            help="How catchers change the plate: light is taken as a share and added as light "
            "[auto], or one of the two.",
        ),
    ] = "auto"
    scale: Annotated[
        Text,
        option(
            "--plate-scale",
            metavar="X",
            help="Light of the render that a plate's 1 stands for; by the exposure of both for "
            "developed plates, else 1.",
        ),
    ] = None
    seed: Annotated[
        int,
        option(
            "--seed",
            metavar="N",
            help="Seed of the noise of what is added; frame f of a sequence has N + f [0].",
        ),
    ] = 0

    def given(self) -> dict[str, Any]:
        """Options of ``composite`` but the seed; the camera file is read once for all frames."""
        from daguerre.plates.match.reader import read_plate_camera

        text, file = self.scale, self.like_plate
        scale = None if text is None else q.plain_number("--plate-scale", text, "a number above 0")
        camera = None if file is None else read_plate_camera(file)
        return {"like_plate": camera, "form": self.form, "scale": scale}


@dataclass(frozen=True)
class SequenceFlags:
    """Frames of a sequence, and what is said of them."""

    frames: Annotated[
        Text,
        option(
            "--frames",
            metavar="A-BxS",
            help="Frames of a sequence, in the place of # in names, into -o NAME.####.exr.",
        ),
    ] = None
    resume: Annotated[
        bool, option("--resume", help="Skip frames whose files are there already.")
    ] = False
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False
    json_progress: Annotated[
        bool, option("--json-progress", help="Print progress as JSON lines on stdout.")
    ] = False
