"""``daguerre merge``: merges passes of a picture exactly, in any order, or joins its crops."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from daguerre.errors import UsageError
from daguerre.rendering.ranges import show_ranges

from . import console
from .flags.groups import option


def merge(
    passes: Annotated[
        list[Path],
        typer.Argument(
            metavar="PASS.exr...", help="Passes of `render --samples`, or crops of `render --crop`."
        ),
    ],
    output: Annotated[
        list[Path],
        option("-o", "--output", metavar="FILE.exr|png", help="Picture to write; repeatable."),
    ],
    strict: Annotated[
        bool, option("--strict", help="Fail if a range of samples is missing.")
    ] = False,
    keep_sums: Annotated[
        bool, option("--keep-sums", help="Write a pass that can be merged again.")
    ] = False,
    denoise: Annotated[
        bool, option("--denoise", help="Denoise the picture (needs extra `denoise`).")
    ] = False,
    tone: Annotated[
        str, option("--tone", metavar="srgb|soft", help="Tone curve of a .png [srgb].")
    ] = "srgb",
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False,
) -> int:
    """Merges passes of a picture, or joins its crops.

    The result is bit-identical to a render in one go.
    """
    from daguerre.files import atomic, in_use
    from daguerre.frame.frame import TONES, check_format
    from daguerre.pictures.exr.crops import are_crops
    from daguerre.rendering import merged, merging

    console.quiet = quiet
    formats = [check_format(path) for path in output]
    if tone not in TONES:
        raise UsageError(f"--tone: wanted {' or '.join(TONES)}; got {tone!r}")
    if keep_sums and (denoise or ".exr" not in formats):
        raise UsageError("--keep-sums needs an .exr output (-o NAME.exr), and no --denoise")
    for path in output:
        atomic.check_writable(path)
    if denoise:
        from daguerre.rendering.denoise import check_available

        check_available()
    with in_use.in_place():  # the result may replace a pass
        if are_crops(passes):
            return _join(passes, output, plain=not (strict or keep_sums or denoise))
        frame, total = merging.merge(passes)
    for remark in total.notes:
        console.note(remark)
    if strict:
        merged.refuse_gaps(total)
    elif text := merged.gaps(total):
        console.warn(text)
    if denoise:
        from daguerre.rendering.denoise import denoise as clean

        frame = clean(frame)
    frame = merged.whole(frame, total)
    for path in output:
        merged.write(path, frame, total, keep_sums=keep_sums, tone=tone)
    count, places = frame.bad_samples
    if count:
        from .render.reporter import bad_samples

        console.warn(bad_samples(count, places))
    names = ", ".join(map(str, output))
    console.note(f"wrote {names} (samples {show_ranges(total.ranges)})")
    return 0


def _join(crops: list[Path], output: list[Path], *, plain: bool) -> int:
    """Joins crops, which may be larger than memory, row by row."""
    from daguerre.pictures.exr.crops import join_crops

    if not plain or [path.suffix.lower() for path in output] != [".exr"]:
        raise UsageError(
            "merge: crops are joined into one .exr output, without --strict, --keep-sums or "
            "--denoise"
        )
    x0, y0, x1, y1 = join_crops(crops, output[0])
    console.note(f"wrote {output[0]} ({x1 - x0} x {y1 - y0} px of {len(crops)} crops)")
    return 0
