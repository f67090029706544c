"""Flags of ``composite``: placing of objects into a plate, and frames of a sequence.

Annotations must be real objects here (see ``groups.py``), so no ``annotations`` future.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from daguerre import units as q

from .groups import Text, option


@dataclass(frozen=True)
class PlacingFlags:
    """Placing of objects into a plate."""

    like_plate: Annotated[
        Path | None,
        option(
            "--like-plate",
            metavar="CAMERA.json",
            help="Camera file of the plate, by `match-plate`: gives objects its blur and noise; "
            "raw plates need it.",
        ),
    ] = None
    form: Annotated[
        str,
        option(
            "--form",
            metavar="auto|ratio|difference",
            help="Way in which catchers change the plate: ratio (a share of the plate's light), "
            "difference (light added), or auto: shadows by ratio, light by difference [auto].",
        ),
    ] = "auto"
    scale: Annotated[
        Text,
        option(
            "--plate-scale",
            metavar="X",
            help="Value in the render that equals 1 in the plate [developed plates: from the "
            "exposures of both; others: 1].",
        ),
    ] = None
    seed: Annotated[
        int,
        option(
            "--seed",
            metavar="N",
            help="Seed of the noise added to objects; frame f of a sequence uses N + f [0].",
        ),
    ] = 0

    def given(self) -> dict[str, Any]:
        """Options of ``composite`` without the seed; reads the camera file once for all frames."""
        from daguerre.plates.match.reader import read_plate_camera

        text, file = self.scale, self.like_plate
        scale = None if text is None else q.plain_number("--plate-scale", text, "a number above 0")
        camera = None if file is None else read_plate_camera(file)
        return {"like_plate": camera, "form": self.form, "scale": scale}


@dataclass(frozen=True)
class SequenceFlags:
    """Frames of a sequence, and reports on them."""

    frames: Annotated[
        Text,
        option(
            "--frames",
            metavar="A-BxS",
            help="Frames to composite, such as 1-48; # in file names stands for the frame "
            "number, as in -o NAME.####.exr.",
        ),
    ] = None
    resume: Annotated[bool, option("--resume", help="Skip frames whose files exist already.")] = (
        False
    )
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False
    json_progress: Annotated[
        bool, option("--json-progress", help="Print progress as JSON lines on stdout.")
    ] = False
