"""Runs a plan: a job with the console as its reporter, maps and labels beside the pictures."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.cli import console
from daguerre.cli.signals import Signals
from daguerre.rendering.job import Job
from daguerre.rendering.picture import Picture
from daguerre.scene.scene import Scene

from .coco import Labels
from .plan import Plan
from .reporter import ConsoleReporter

if TYPE_CHECKING:
    from daguerre.cluster.pool import WorkerPool
    from daguerre.rendering.session import Session

INTERRUPTED = 75


def run(
    plan: Plan,
    scene: Scene,
    path: Path,
    labels: Labels,
    launched: float,
    pool: WorkerPool | None = None,
) -> int:
    """Draws the pictures in turn; returns the exit code.

    Args:
        plan: Plan with the pictures.
        scene: The scene at the time of frame 0.
        path: File of the scene, for messages.
        labels: Collector of labels.
        launched: Start of the command, by ``time.monotonic``, s.
        pool: Workers of a cluster that draw; None: this machine does.
    """
    job = _job(plan, scene, path)
    if pool is not None:
        from daguerre.cluster.work import work_of

        job.work_of = work_of(pool, job)

    def opened(picture: Picture, session: Session) -> None:
        maps = plan.maps_of(picture)
        if maps.files:
            settings = picture.settings
            maps.write(
                session.scene,
                session.focused_camera,
                settings.film.resolution,
                session.overscan,
                settings.truth.moment,
            )

    def skipped(picture: Picture) -> None:
        if labels.file is not None:
            labels.add(picture, job.open(picture))

    job.opened, job.written, job.skipped = opened, labels.add, skipped
    labels.check(scene)
    try:
        if plan.flags.paths:
            complete = job.run(resume=plan.flags.resume, since=launched)
        else:
            from .maps import write_maps

            complete = write_maps(plan, job)
    except KeyboardInterrupt:
        return (
            interrupted_between(job.done, len(plan.pictures)) if job.done else interrupted_early()
        )
    if not complete:
        return INTERRUPTED
    labels.write()
    return 0


def describe(plan: Plan, scene: Scene, path: Path) -> int:
    """Prints the pictures without drawing: the first frame of a sequence, each camera of a rig."""
    from daguerre.pictures.exr.write import jsonable, without_infinity

    job, frame = _job(plan, scene, path), plan.pictures[0].frame
    first = [picture for picture in plan.pictures if picture.frame == frame]
    told = {picture.view.name: _facts(job, picture, path) for picture in first}
    facts = {"cameras": told} if len(first) > 1 else next(iter(told.values()))
    console.show(json.dumps(without_infinity(facts), indent=2, default=jsonable))
    return 0


def _facts(job: Job, picture: Picture, path: Path) -> dict[str, Any]:
    session = job.open(picture)
    return {
        "scene": str(path),
        "outputs": [str(path) for path in picture.output.files],
        "resolution": list(picture.settings.film.resolution),
        "crop": list(session.crop),
        "samples": list(picture.wanted),
        "noise": picture.settings.sampling.noise,
        "aovs": list(picture.output.aovs),
        "camera": session.metadata.get("camera"),
        "key": session.key,
    }


def _job(plan: Plan, scene: Scene, path: Path) -> Job:
    flags = plan.flags
    told = ConsoleReporter(
        quiet=flags.quiet, as_json=flags.json_progress, stats=flags.stats, preview=flags.preview
    )
    job = Job(scene, plan.pictures, told, Signals(), plan.interval_s)
    job.name = str(path)
    job.staged = plan.stage
    return job


def interrupted_between(done: int, wanted: int) -> int:
    """Reports an interruption between two pictures and how to resume; returns the exit code."""
    console.say(f"daguerre: interrupted after {done} of {wanted} pictures; resume with:")
    console.say(console.command_line("--resume"))
    return INTERRUPTED


def interrupted_early() -> int:
    """Reports an interruption before the first sample; returns the exit code."""
    console.say("daguerre: interrupted before the first sample; nothing was written")
    return INTERRUPTED
