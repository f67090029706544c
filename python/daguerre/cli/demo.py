"""``daguerre demo``: a first picture, without downloads."""

from __future__ import annotations

import runpy
import shlex
from pathlib import Path
from typing import Annotated

import typer

import daguerre
from daguerre.errors import OutputError, UsageError
from daguerre.files import extras

from . import console
from .flags.groups import option


def demo(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", help="Folder for the scene and its pictures.")
    ] = Path("out"),
    res: Annotated[
        str, option("--res", metavar="WxH", help="Size of the picture, px [720x480].")
    ] = "720x480",
    spp: Annotated[
        int, option("--spp", metavar="N", help="Samples per pixel, at least 1 [32].")
    ] = 32,
    view: Annotated[
        bool, option("--view", help="Open the scene in the viewfinder, and render nothing.")
    ] = False,
) -> int:
    """Renders a demo scene: a table-top at night.

    The lens is a double Gauss at f/2. Writes night_table.glb, demo.png and demo.exr, and prints the
    command that renders them.
    """
    from . import main

    scene = folder / "night_table.glb"
    write_scene(scene)
    words = ["view" if view else "render", str(scene), "--lens", "double-gauss-50mm-f2"]
    words += ["--f-stop", "2", "--res", res, "--spp", str(spp)]
    if view:
        return main(words)
    words += ["--tone", "soft", "-o", str(folder / "demo.png")]
    if why_not := _cannot_denoise():
        words += ["-o", str(folder / "demo.exr")]
        console.show(f"not denoised; {why_not}")
    else:
        words += ["--denoise", "--noisy", str(folder / "demo.exr")]
    console.show(shlex.join(["daguerre", *words]))
    return main(words)


def _cannot_denoise() -> str:
    """Reason why no denoiser is available; empty: a denoiser is available."""
    from daguerre.rendering.denoise import check_available

    if extras.missing("mitsuba_oidn"):
        return f"denoising needs an extra: {extras.hint('mitsuba_oidn')}"
    try:
        check_available()
    except UsageError as error:
        return str(error)
    return ""


def write_scene(path: Path) -> None:
    """Writes the demo scene as .glb.

    Raises:
        OutputError: The file cannot be written.
    """
    package = Path(daguerre.__file__).parent
    installed, checkout = package / "scenes", package.parents[1] / "scenes"
    made = runpy.run_path(str((checkout if checkout.exists() else installed) / "night_table.py"))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        made["write"](path)
    except OSError as error:
        raise OutputError(f"{path}: cannot write: {error.strerror or error}") from error
