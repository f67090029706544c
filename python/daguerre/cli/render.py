"""``daguerre render``: from a scene to a picture, with progress, checkpoints and passes."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre.errors import UsageError

from . import console
from .camera_flags import CameraFlags
from .flags import option, with_flags
from .job import INTERRUPTED, Job, core_errors
from .plan import Plan, check_outputs, make_plan
from .scene_flags import SceneFlags

if TYPE_CHECKING:
    from daguerre.session import Session

_OUTPUT = "Output"
_SAMPLING = "Sampling"


@with_flags(camera_flags=CameraFlags, scene_flags=SceneFlags)
def render(
    scene_path: Annotated[Path, typer.Argument(metavar="SCENE", help="A .glb or .gltf file.")],
    camera_flags: CameraFlags,
    scene_flags: SceneFlags,
    output: Annotated[
        list[Path],
        option(
            "-o", "--output", metavar="FILE", help=".exr or .png; may be repeated.", panel=_OUTPUT
        ),
    ],
    res: Annotated[
        str | None,
        option("--res", metavar="WxH|50%", help="Size in pixels [960x540].", panel=_OUTPUT),
    ] = None,
    crop: Annotated[
        str | None,
        option("--crop", metavar="X0,X1,Y0,Y1", help="Only these pixels.", panel=_OUTPUT),
    ] = None,
    aov: Annotated[
        list[str] | None,
        option(
            "--aov",
            metavar="LIST",
            help="Channels beside the picture: depth,P,N,albedo,object_id or all.",
            panel=_OUTPUT,
        ),
    ] = None,
    aovs: Annotated[bool, option("--aovs", help="All of them.", panel=_OUTPUT)] = False,
    tone: Annotated[
        str, option("--tone", metavar="srgb|soft", help="Curve of a PNG [srgb].", panel=_OUTPUT)
    ] = "srgb",
    denoise: Annotated[
        bool, option("--denoise", help="Needs the extra `denoise`.", panel=_OUTPUT)
    ] = False,
    spp: Annotated[
        int | None, option("--spp", metavar="N", help="Samples per pixel [64].", panel=_SAMPLING)
    ] = None,
    noise: Annotated[
        float | None,
        option(
            "--noise",
            metavar="X",
            help="Draw until the relative error is X, say 0.02; more samples where they are "
            "needed, --spp of a pixel at most [16384].",
            panel=_SAMPLING,
        ),
    ] = None,
    samples: Annotated[
        str | None,
        option("--samples", metavar="A:B", help="A pass of samples, for `merge`.", panel=_SAMPLING),
    ] = None,
    seed: Annotated[int, option("--seed", metavar="N", help="[0]", panel=_SAMPLING)] = 0,
    threads: Annotated[int, option("--threads", metavar="N", help="[0: all]", panel=_SAMPLING)] = 0,
    filter: Annotated[
        str,
        option(
            "--filter",
            metavar="NAME",
            help="box, gaussian, mitchell or blackman_harris; NAME:PX sets its radius "
            "[blackman_harris].",
            panel=_SAMPLING,
        ),
    ] = "blackman_harris",
    max_depth: Annotated[
        int, option("--max-depth", metavar="N", help="Surfaces along a path [16].", panel=_SAMPLING)
    ] = 16,
    resume: Annotated[
        bool, option("--resume", help="Go on from OUT.checkpoint.exr.", panel=_SAMPLING)
    ] = False,
    checkpoint: Annotated[
        str,
        option(
            "--checkpoint", metavar="S", help="Time between checkpoints, s [60].", panel=_SAMPLING
        ),
    ] = "60",
    quiet: Annotated[bool, option("--quiet", "-q", help="Errors only.")] = False,
    json_progress: Annotated[
        bool, option("--json-progress", help="Progress as JSON lines on stdout.")
    ] = False,
    stats: Annotated[bool, option("--stats", help="Counts and times at the end.")] = False,
    dry_run: Annotated[bool, option("--dry-run", help="Check everything, draw nothing.")] = False,
) -> int:
    """Renders a scene to a picture.

    Stop with Ctrl-C: what was drawn is kept, and the command that goes on is printed.
    """
    from daguerre.info import lit

    console.quiet = quiet
    sampling = (spp, samples, noise)
    plan = make_plan(output, res, crop, aov or [], aovs, tone, denoise, *sampling, checkpoint)
    _check_numbers(seed, threads, max_depth)
    changes = camera_flags.changes()
    check_outputs(plan)
    launched = time.monotonic()
    try:
        scene = scene_flags.load(scene_path)
        for warning in scene.warnings:
            console.warn(f"{scene_path}: {warning}")
        session = _session(
            scene,
            scene.camera(camera_flags.camera).with_(**changes),
            plan,
            {
                "seed": seed,
                "filter": filter,
                "threads": threads,
                "max_depth": max_depth,
            },
        )
    except KeyboardInterrupt:
        console.say("daguerre: interrupted before the first sample; nothing was written")
        return INTERRUPTED
    for text in session.notes:
        console.note(text)
    if not lit(scene):
        console.warn(f"{scene_path}: nothing shines, so the picture will be black; --env lights it")
    if dry_run:
        _describe(plan, session, scene_path)
        return 0
    job = Job(session, plan, tone, time.monotonic() - launched, stats)
    return job.run(resume=resume, quiet=quiet, as_json=json_progress)


def _check_numbers(seed: int, threads: int, max_depth: int) -> None:
    for flag, value, low, high in (
        ("--seed", seed, 0, 2**64 - 1),
        ("--threads", threads, 0, 4096),
        ("--max-depth", max_depth, 1, 100000),
    ):
        if not low <= value <= high:
            raise UsageError(f"{flag}: wanted {low} to {high}, got {value}")


def _session(scene: Any, camera: Any, plan: Plan, settings: dict[str, Any]) -> Session:
    from daguerre.info import camera_warnings
    from daguerre.session import Session

    for warning in camera_warnings(camera):
        console.warn(warning)
    with core_errors("render"):
        return Session(
            scene,
            camera,
            resolution=plan.resolution,
            aovs=bool(plan.aovs) or plan.denoise,
            crop=plan.crop,
            **settings,
        )


def _describe(plan: Plan, session: Session, scene_path: Path) -> None:
    """What would be drawn, on stdout."""
    from daguerre.io.exr import jsonable, without_infinity

    facts = {
        "scene": str(scene_path),
        "outputs": [str(path) for path in plan.outputs],
        "resolution": list(plan.resolution),
        "crop": list(session.crop),
        "samples": list(plan.wanted),
        "noise": plan.noise,
        "aovs": plan.aovs,
        "camera": session.metadata.get("camera"),
        "key": session.key,
    }
    print(json.dumps(without_infinity(facts), indent=2, default=jsonable))
