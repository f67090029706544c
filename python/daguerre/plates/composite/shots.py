"""Files of a sequence of composites: which plate, objects and results make one frame.

Noise of what is added differs from frame to frame, and is the same each time: frame n has the bits
of a single composite with the seed of the sequence plus n.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from daguerre.errors import InputError, UsageError
from daguerre.rendering.names import has_frame, numbered

#: Seeds of noise by place are below this; sums below 0 count down from it.
SEEDS = 2**53


@dataclass(frozen=True)
class Shot:
    """One composite.

    Attributes:
        plate: The photograph.
        objects: The render.
        outputs: Files to write.
        seed: Seed of the noise of what is added.
        frame: Number in a sequence; None: there is none.
    """

    plate: Path
    objects: Path
    outputs: tuple[Path, ...]
    seed: int
    frame: int | None = None

    @property
    def is_complete(self) -> bool:
        """Whether its files are there: they are written whole or not at all."""
        return all(path.exists() for path in self.outputs)


def seed_of(seed: int, frame: int) -> int:
    """The seed of a frame."""
    return (seed + frame) % SEEDS


def shots_of(
    plate: Path, objects: Path, outputs: Sequence[Path], frames: Sequence[int] | None, seed: int
) -> list[Shot]:
    """Finds the composites of a call.

    Args:
        plate: The photograph; its number in the place of ``#``, or one for all frames.
        objects: The render; the same.
        outputs: Files to write.
        frames: Numbers of the frames; None: no sequence.
        seed: Seed of the sequence.

    Raises:
        UsageError: A ``#`` without frames, or frames without one, or a file would be written twice
            or is one of those that are read.
        InputError: A file is missing; the message names the first, and its frame.
    """
    _check_places(plate, objects, frames)
    if frames is None:
        shots = [Shot(plate, objects, tuple(outputs), seed)]
    else:
        shots = [
            Shot(
                numbered(plate, n),
                numbered(objects, n),
                tuple(numbered(path, n) for path in outputs),
                seed_of(seed, n),
                n,
            )
            for n in frames
        ]
    _check_files(shots)
    return shots


def _check_places(plate: Path, objects: Path, frames: Sequence[int] | None) -> None:
    marked = [path for path in (plate, objects) if has_frame(path)]
    if frames is None and marked and not marked[0].exists():
        raise UsageError(f"{marked[0]}: # stands for the number of a frame; wanted --frames")
    if frames is not None and len(frames) > 1 and not marked:
        raise UsageError(
            f"--frames: wanted a plate or objects with # for the number of a frame, such as "
            f"{plate.stem}.####{plate.suffix}; got {plate} and {objects}"
        )


def _check_files(shots: list[Shot]) -> None:
    """Errors come before the first frame is made, not after hours."""
    read = {path.resolve() for shot in shots for path in (shot.plate, shot.objects)}
    written = [path for shot in shots for path in shot.outputs]
    for path in written:
        if path.resolve() in read:
            raise UsageError(f"{path}: wanted another file than those that are read")
    if twice := [path for path, count in Counter(written).items() if count > 1]:
        raise UsageError(f"-o {twice[0]}: wanted a file for each picture, got one for several")
    missing = [
        (shot, path) for shot in shots for path in (shot.plate, shot.objects) if not path.exists()
    ]
    if missing and missing[0][0].frame is not None:
        shot, path = missing[0]
        count = len({each.frame for each, _ in missing})
        which = "it alone is missing" if count == 1 else f"{count} of {len(shots)} frames miss one"
        raise InputError(f"frame {shot.frame}: {path}: wanted a picture, got no file ({which})")
