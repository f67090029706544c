"""``daguerre render``: from a scene to a picture, with progress, checkpoints and passes."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre.errors import InputError, UsageError, suggest

from . import console
from . import quantities as q
from .flags import CameraFlags, SceneFlags, option, with_flags

if TYPE_CHECKING:
    from daguerre.frame import Frame
    from daguerre.render import Session

DEFAULT_RESOLUTION = (960, 540)
DEFAULT_SPP = 64
INTERRUPTED = 75
#: what may be asked for with --aov -> group of channels
AOVS = {
    "depth": "depth",
    "P": "P",
    "position": "P",
    "N": "N",
    "normal": "N",
    "albedo": "albedo",
    "object_id": "object_id",
    "id": "object_id",
}
#: groups that every EXR has, so asking for them changes nothing
ALWAYS = ("variance", "samples")

_OUTPUT = "Output"
_SAMPLING = "Sampling"


@dataclass(frozen=True)
class Plan:
    """What a command line asks for, checked, before anything heavy is loaded."""

    outputs: list[Path]
    resolution: tuple[int, int]
    crop: tuple[int, int, int, int] | None
    wanted: tuple[int, int]
    is_pass: bool
    aovs: list[str]
    denoise: bool
    interval_s: float

    @property
    def checkpoint(self) -> Path:
        """Where the sums are kept until the picture is complete."""
        return self.outputs[0].with_suffix(".checkpoint.exr")


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
    console.quiet = quiet
    plan = _plan(output, res, crop, aov or [], aovs, tone, denoise, spp, samples, checkpoint)
    _check_numbers(seed, threads, max_depth)
    changes = camera_flags.changes()
    _check_outputs(plan)
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
    if dry_run:
        _describe(plan, session, scene_path)
        return 0
    job = Job(session, plan, tone, time.monotonic() - launched, stats)
    return job.run(resume=resume, quiet=quiet, as_json=json_progress)


class Job:
    """One picture on its way to its files."""

    def __init__(
        self, session: Session, plan: Plan, tone: str, setup_s: float, stats: bool
    ) -> None:
        from .loop import Loop

        self.session, self.plan, self.tone = session, plan, tone
        self.setup_s, self.stats = setup_s, stats
        self.loop: Loop

    def run(self, *, resume: bool, quiet: bool, as_json: bool) -> int:
        """Draws and saves; returns the exit code."""
        from . import progress
        from .loop import Loop, Signals

        plan = self.plan
        reporter = progress.choose(quiet=quiet, as_json=as_json)
        self.loop = Loop(
            self.session, plan.wanted, plan.checkpoint, plan.interval_s, reporter, self._snapshot
        )
        with Signals() as signals, reporter, _core_errors("render"):
            if resume:
                found = self.loop.resume()
                done = self.loop.done()
                console.note(
                    f"resuming at {done} of {plan.wanted[1] - plan.wanted[0]} samples"
                    if found
                    else f"nothing to resume: no {plan.checkpoint}; starting anew"
                )
            if not self.loop.run(signals):
                # A second Ctrl-C means now: the last checkpoint has to do.
                self._interrupted(reporter, save=signals.stops < 2)
                return INTERRUPTED
            self._finish()
            reporter.event("done", outputs=[str(p) for p in plan.outputs], samples=self.loop.done())
        return 0

    def _finish(self) -> None:
        frame = self._frame()
        try:
            self._write(frame, self.plan.outputs)
        except BaseException:
            # Hours of work must not die with a full disk.
            if not self.plan.checkpoint.exists() and self.loop.save():
                console.say(f"daguerre: the samples are kept in {self.plan.checkpoint}")
            raise
        self.plan.checkpoint.unlink(missing_ok=True)
        count, places = frame.bad_samples
        if count:
            x, y, sample = places[0] if places else ("?", "?", "?")
            console.warn(
                f"{count} samples were NaN or Inf and count as black; "
                f"the first is sample {sample} of pixel ({x}, {y})"
            )
        elapsed = time.monotonic() - self.loop.started
        names = ", ".join(str(path) for path in self.plan.outputs)
        console.note(f"wrote {names} ({self.loop.done()} samples per pixel, {elapsed:.1f} s)")
        if self.stats:
            self._print_stats(elapsed)

    def _interrupted(self, reporter: Any, *, save: bool) -> None:
        done, checkpoint = self.loop.done(), self.plan.checkpoint
        total = self.plan.wanted[1] - self.plan.wanted[0]
        kept = "nothing was saved"
        if save and self.session.ranges and self.loop.save():
            kept = f"saved in {checkpoint}"
        elif checkpoint.exists():
            kept = f"the last checkpoint is {checkpoint}"
        command = console.command_line("--resume")
        console.say(f"daguerre: interrupted after {done} of {total} samples; {kept}; resume with:")
        console.say(command)
        reporter.event("interrupted", samples=done, resume=command)

    def _frame(self) -> Frame:
        """The picture so far, with the channels that were asked for."""
        frame = self.session.frame()
        facts = {
            "resolution": (self.session.width, self.session.height),
            "crop": self.session.crop,
            "samples": self.loop.done(),
            "bad_samples": frame.bad_samples[0],
            "aovs": self.plan.aovs,
            "scene_hash": self.session.key["scene"],
        }
        frame = replace(frame, metadata={**frame.metadata, **facts})
        if self.plan.denoise:
            from daguerre.denoise import denoise

            frame = denoise(frame)
        keep = {
            name: plane
            for name, plane in frame.aovs.items()
            if name.split(".")[0] in self.plan.aovs
        }
        return replace(frame, aovs=keep)

    def _write(self, frame: Frame, paths: list[Path]) -> None:
        from daguerre.io.passes import pass_of, write_pass

        for path in paths:
            if self.plan.is_pass and path.suffix.lower() == ".exr":
                drawn = pass_of(self.session)
                write_pass(path, frame, replace(drawn, metadata=frame.metadata))
            else:
                frame.save(path, tone=self.tone)

    def _snapshot(self) -> None:
        paths = [p.with_suffix(f".snapshot{p.suffix}") for p in self.plan.outputs]
        self._write(self._frame(), paths)
        console.note(
            f"snapshot: {', '.join(map(str, paths))} ({self.loop.done()} samples per pixel)"
        )

    def _print_stats(self, elapsed: float) -> None:
        import resource

        from .loop import frame_pixels
        from .progress import quantity

        usage = resource.getrusage(resource.RUSAGE_SELF)
        drawn = self.loop.drawn_here * frame_pixels(self.session)
        rays = int(self.session.rays)
        rows = {
            "set-up": f"{self.setup_s:.2f} s",
            "drawing": f"{elapsed:.2f} s",
            "processor": f"{usage.ru_utime + usage.ru_stime:.2f} s",
            "camera samples": f"{drawn} ({quantity(drawn / elapsed)} per s)",
            "rays": f"{rays} ({quantity(rays / elapsed)} per s)",
            "bad samples": str(self.session.bad_samples[0]),
            "peak memory": f"{usage.ru_maxrss / 1024:.0f} MB",
        }
        for name, value in rows.items():
            console.say(f"daguerre: {name}: {value}")


def _plan(
    output: list[Path],
    res: str | None,
    crop: str | None,
    aov: list[str],
    all_aovs: bool,
    tone: str,
    denoise: bool,
    spp: int | None,
    samples: str | None,
    checkpoint: str,
) -> Plan:
    from daguerre.frame import TONES, check_format

    formats = [check_format(path) for path in output]
    if tone not in TONES:
        raise UsageError(f"--tone: wanted {' or '.join(TONES)}; got {tone!r}{suggest(tone, TONES)}")
    resolution = q.resolution("--res", res, DEFAULT_RESOLUTION) if res else DEFAULT_RESOLUTION
    if spp is not None and not 1 <= spp < 2**32:
        raise UsageError(f"--spp: wanted a number from 1, got {spp}")
    wanted = q.sample_range("--samples", samples) if samples else (0, spp or DEFAULT_SPP)
    if samples and spp is not None and wanted[1] > spp:
        raise UsageError(f"--samples {samples}: wanted at most --spp {spp}")
    if samples and ".exr" not in formats:
        raise UsageError("--samples: a pass keeps its sums in an .exr; got none with -o")
    if samples and denoise:
        raise UsageError(
            "--samples and --denoise: denoise after merging, `daguerre merge --denoise`"
        )
    if denoise:
        from daguerre.denoise import check_available

        check_available()
    return Plan(
        output,
        resolution,
        _crop(crop, resolution),
        wanted,
        samples is not None,
        _aov_groups(aov, all_aovs),
        denoise,
        q.time_s("--checkpoint", checkpoint),
    )


def _crop(text: str | None, resolution: tuple[int, int]) -> tuple[int, int, int, int] | None:
    """Command line order x0, x1, y0, y1 to corners x0, y0, x1, y1; px, half open."""
    if text is None:
        return None
    x0, x1, y0, y1 = q.integers("--crop", text, 4, "100,400,50,300")
    if not (0 <= x0 < x1 <= resolution[0] and 0 <= y0 < y1 <= resolution[1]):
        raise UsageError(
            f"--crop: wanted x0 < x1 within 0..{resolution[0]} and y0 < y1 within "
            f"0..{resolution[1]}; got {text!r}"
        )
    return x0, y0, x1, y1


def _aov_groups(names: list[str], everything: bool) -> list[str]:
    groups = set(AOVS.values()) if everything else set()
    for name in (part.strip() for text in names for part in text.split(",")):
        if name == "all":
            groups |= set(AOVS.values())
        elif name in AOVS:
            groups.add(AOVS[name])
        elif name not in ALWAYS:
            known = [*AOVS, *ALWAYS, "all"]
            raise UsageError(
                f"--aov: no channels {name!r}{suggest(name, known)}; known: {', '.join(known)}"
            )
    return sorted(groups)


def _check_numbers(seed: int, threads: int, max_depth: int) -> None:
    for flag, value, low, high in (
        ("--seed", seed, 0, 2**64 - 1),
        ("--threads", threads, 0, 4096),
        ("--max-depth", max_depth, 1, 100000),
    ):
        if not low <= value <= high:
            raise UsageError(f"{flag}: wanted {low} to {high}, got {value}")


def _check_outputs(plan: Plan) -> None:
    """Before hours are spent: can the files be written at all?"""
    from daguerre.io.atomic import check_writable

    names = [path.resolve() for path in plan.outputs]
    if len(set(names)) < len(names):
        raise UsageError("-o: the same file is named twice")
    if plan.checkpoint.resolve() in names:
        raise UsageError(f"-o {plan.checkpoint}: this name is kept for the checkpoint")
    for path in plan.outputs:
        check_writable(path)


def _session(scene: Any, camera: Any, plan: Plan, settings: dict[str, Any]) -> Session:
    from daguerre.info import camera_warnings
    from daguerre.render import Session

    for warning in camera_warnings(camera):
        console.warn(warning)
    with _core_errors("render"):
        return Session(
            scene,
            camera,
            resolution=plan.resolution,
            aovs=bool(plan.aovs) or plan.denoise,
            crop=plan.crop,
            **settings,
        )


@contextmanager
def _core_errors(where: str) -> Iterator[None]:
    """The core raises plain ``ValueError`` for input that it cannot use."""
    try:
        yield
    except ValueError as error:
        if type(error) is not ValueError:
            raise
        raise InputError(f"{where}: {error}") from error


def _describe(plan: Plan, session: Session, scene_path: Path) -> None:
    """What would be drawn, on stdout."""
    from daguerre.io.exr import jsonable

    facts = {
        "scene": str(scene_path),
        "outputs": [str(path) for path in plan.outputs],
        "resolution": list(plan.resolution),
        "crop": list(session.crop),
        "samples": list(plan.wanted),
        "aovs": plan.aovs,
        "camera": session.metadata.get("camera"),
        "key": session.key,
    }
    print(json.dumps(facts, indent=2, default=jsonable))
