"""``daguerre post``: the darkroom, lens effects on existing pictures."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from daguerre.errors import UsageError
from daguerre.rendering.progress import RowStatus

from . import console, progress
from .flags.groups import option

if TYPE_CHECKING:
    from daguerre.post.effect import Effect
    from daguerre.post.parameter import Parameter
    from daguerre.post.recipe import Planned
    from daguerre.post.run import Report


def post(
    picture: Annotated[
        Path | None,
        typer.Argument(metavar="IN.exr", help="Scene-linear picture, from any renderer."),
    ] = None,
    output: Annotated[
        Path | None,
        option("-o", "--output", metavar="OUT.exr", help="Picture to write."),
    ] = None,
    effect: Annotated[
        list[str] | None,
        option(
            "--effect",
            metavar="EFFECT:KEY=VALUE,...",
            help="Effect with its parameters; repeatable, applied in order.",
        ),
    ] = None,
    recipe: Annotated[
        Path | None,
        option("--recipe", metavar="FILE.json", help="Recipe file: a JSON list of effects."),
    ] = None,
    channel: Annotated[
        list[str] | None,
        option(
            "--channel",
            metavar="ROLE=NAME",
            help="Channel to use as depth, motion.u or motion.v; repeatable.",
        ),
    ] = None,
    list_effects: Annotated[
        bool, option("--list", help="List every effect with its parameters, units and defaults.")
    ] = False,
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False,
    json_progress: Annotated[
        bool, option("--json-progress", help="Print progress as JSON lines on stdout.")
    ] = False,
) -> int:
    """Applies lens effects to a picture, or removes them.

    It works in strips of rows, so it needs little memory.
    """
    from daguerre.post.effects.catalogue import EFFECTS

    console.quiet = quiet
    if list_effects:
        for entry in EFFECTS.values():
            console.show("\n".join(_described(entry)))
        return 0
    if picture is None or output is None:
        raise UsageError("post: wanted IN.exr -o OUT.exr (see `daguerre post --help`)")
    planned = _planned(effect, recipe)
    with progress.choose(quiet=quiet, as_json=json_progress) as shown:
        report = _run(picture, output, planned, _roles(channel), shown)
        shown.event("done", output=str(output))
    for remark in report.remarks:
        console.note(remark)
    if report.bad_pixels:
        console.warn(f"{picture}: {report.bad_pixels} pixels are NaN or infinite; they are kept")
    console.note(f"wrote {output}")
    return 0


def _planned(words: list[str] | None, file: Path | None) -> list[Planned]:
    from daguerre.post.recipe import from_file, from_words, in_order

    planned = [*(from_file(file) if file is not None else []), *from_words(words or [])]
    if not planned:
        raise UsageError("post: wanted --effect or --recipe (see `daguerre post --list`)")
    planned, moved = in_order(planned)
    for name in moved:
        console.note(f"{name} is an effect of the film: it is applied last")
    return planned


def _roles(given: list[str] | None) -> dict[str, str]:
    from daguerre.post.channels import USUAL

    roles = {}
    for word in given or []:
        role, _, name = word.partition("=")
        if role not in USUAL or not name:
            raise UsageError(
                f"--channel: wanted ROLE=NAME, with one of {', '.join(USUAL)} as ROLE; got {word!r}"
            )
        roles[role] = name
    return roles


def _run(
    picture: Path,
    output: Path,
    planned: list[Planned],
    roles: dict[str, str],
    shown: progress.Silent,
) -> Report:
    from daguerre.files.atomic import check_writable
    from daguerre.post.run import process

    check_writable(output, over=picture)
    start = time.monotonic()

    def update(rows: int, height: int, width: int) -> None:
        elapsed = time.monotonic() - start
        rate = rows * width / max(elapsed, 1e-9)
        left = (height - rows) * width / rate if rows else None
        shown.update(RowStatus(rows / height, rate, elapsed, left))

    return process(picture, output, planned, roles=roles, progress=update)


def _described(effect: Effect) -> list[str]:
    needs = f" (needs {', '.join(effect.needs)})" if effect.needs else ""
    return [f"{effect.name}: {effect.summary}{needs}", *map(_parameter, effect.parameters)]


def _parameter(parameter: Parameter) -> str:
    unit = f" [{parameter.unit}]" if parameter.unit else ""
    kind = f" {'|'.join(parameter.choices)}" if parameter.choices else ""
    kind = " 0|1" if parameter.kind == "flag" else kind
    default = parameter.default
    if parameter.kind == "flag":
        default = int(default)
    shown = "required" if parameter.required else f"default {default}"
    after = f"; {shown}" if default is not None else ""
    return f"    {parameter.name}{unit}{kind}: {parameter.meaning}{after}"
