"""Finds the files of a sequence of composites: plate, objects and results of each frame.

The noise of added objects differs between frames and is reproducible: frame n equals a single
composite with the seed of the sequence plus n, bit for bit.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from daguerre.errors import InputError, UsageError
from daguerre.files.in_use import note_read
from daguerre.files.reading import fault_of
from daguerre.rendering.names import has_frame, numbered

#: Upper limit of seeds; sums below 0 wrap around to it.
SEEDS = 2**53


@dataclass(frozen=True)
class Shot:
    """One composite.

    Attributes:
        plate: Path of the photograph.
        objects: Path of the render.
        outputs: Paths of files to write.
        seed: Seed of the noise of added objects.
        frame: Frame number in a sequence; None: not a sequence.
    """

    plate: Path
    objects: Path
    outputs: tuple[Path, ...]
    seed: int
    frame: int | None = None

    @property
    def is_complete(self) -> bool:
        """Whether its output files exist; they are written atomically."""
        return all(path.exists() for path in self.outputs)


def seed_of(seed: int, frame: int) -> int:
    """Seed of a frame."""
    return (seed + frame) % SEEDS


def shots_of(
    plate: Path, objects: Path, outputs: Sequence[Path], frames: Sequence[int] | None, seed: int
) -> list[Shot]:
    """Finds the composites of a call.

    Args:
        plate: Path of the photograph, with ``#`` for the frame number, or one for all frames.
        objects: Path of the render, likewise.
        outputs: Paths of files to write.
        frames: Frame numbers; None: no sequence.
        seed: Seed of the sequence.

    Raises:
        UsageError: There is a ``#`` without frames, or frames without a ``#``; or a file would be
            written twice, or is also read.
        InputError: A file is missing; the message has the first one and its frame.
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
        raise UsageError(f"{marked[0]}: # stands for the frame number and needs --frames")
    if frames is not None and len(frames) > 1 and not marked:
        raise UsageError(
            f"--frames: wanted # for the frame number in the name of the plate or the objects, "
            f"such as {plate.stem}.####{plate.suffix}; got {plate} and {objects}"
        )


def _check_files(shots: list[Shot]) -> None:
    """Checks all files before the first frame is made."""
    note_read(path for shot in shots for path in (shot.plate, shot.objects))
    written = [path for shot in shots for path in shot.outputs]
    if twice := [path for path, count in Counter(written).items() if count > 1]:
        raise UsageError(f"-o {twice[0]}: several frames have this name; put #### into it")
    missing = [
        (shot, path) for shot in shots for path in (shot.plate, shot.objects) if fault_of(path)
    ]
    if missing and missing[0][0].frame is not None:
        shot, path = missing[0]
        count = len({each.frame for each, _ in missing})
        which = "only this frame" if count == 1 else f"{count} of {len(shots)} frames miss a file"
        raise InputError(f"frame {shot.frame}: {path}: {fault_of(path)} ({which})")
