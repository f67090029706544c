"""One picture on its way to its files: draw, answer signals, save, say how it went."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.cli import console
from daguerre.errors import InputError

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame
    from daguerre.rendering.loop import Loop
    from daguerre.rendering.session import Session

    from .plan import Plan

INTERRUPTED = 75


class Job:
    """One picture on its way to its files."""

    def __init__(
        self,
        session: Session,
        plan: Plan,
        tone: str,
        setup_s: float,
        stats: bool,
        facts: dict[str, Any] | None = None,
    ) -> None:
        self.session, self.plan, self.tone = session, plan, tone
        self.setup_s, self.stats = setup_s, stats
        self.facts = facts or {}  # which picture of several this is
        self.loop: Loop

    def run(self, *, resume: bool, quiet: bool, as_json: bool) -> int:
        """Draws and saves; returns the exit code."""
        from daguerre.cli import progress
        from daguerre.rendering.loop import Loop, Signals
        from daguerre.rendering.schedule import Range, Rounds, Work

        plan = self.plan
        work: Work = Range(self.session, plan.wanted)
        if plan.noise is not None:
            work = Rounds(self.session, plan.noise, plan.wanted[1])
        reporter = progress.choose(quiet=quiet, as_json=as_json, which=self.facts)
        self.loop = Loop(
            self.session, work, plan.checkpoint, plan.interval_s, reporter, self._snapshot
        )
        with Signals() as signals, reporter, core_errors("render"):
            if resume:
                found = self.loop.resume()
                console.note(
                    f"resuming at {self._samples()} of {work.total():.6g} samples"
                    if found
                    else f"nothing to resume: no {plan.checkpoint}; starting anew"
                )
            if not self.loop.run(signals):
                # A second Ctrl-C means now: the last checkpoint has to do.
                self._interrupted(reporter, save=signals.stops < 2)
                return INTERRUPTED
            self._finish()
            reporter.event("done", outputs=[str(p) for p in plan.files], samples=work.done())
        return 0

    def _finish(self) -> None:
        try:
            frame = self._frame()
            self._write(frame, self.plan.outputs)
        except BaseException:
            # Hours of work must not die with a full disk, or with a channel that cannot be made.
            if not self.plan.checkpoint.exists() and self.loop.save():
                console.say(f"daguerre: the samples are kept in {self.plan.checkpoint}")
            raise
        self.plan.checkpoint.unlink(missing_ok=True)
        count, places = frame.bad_samples
        if count:
            console.warn(bad_samples(count, places))
        elapsed = time.monotonic() - self.loop.started
        names = ", ".join(str(path) for path in self.plan.files)
        console.note(f"wrote {names} ({self._samples()} samples per pixel, {elapsed:.1f} s)")
        self._name_noise(frame.metadata.get("noise"))
        if self.stats:
            self._print_stats(elapsed)

    def _interrupted(self, reporter: Any, *, save: bool) -> None:
        done, checkpoint = self.loop.work.done(), self.plan.checkpoint
        total = self.loop.work.total()
        kept = "nothing was saved"
        if save and done and self.loop.save():
            kept = f"saved in {checkpoint}"
        elif checkpoint.exists():
            kept = f"the last checkpoint is {checkpoint}"
        command = console.command_line("--resume")
        console.say(
            f"daguerre: interrupted after {self._samples()} of {total:.6g} samples; {kept}; "
            "resume with:"
        )
        console.say(command)
        reporter.event("interrupted", samples=done, resume=command)

    def _frame(self) -> Frame:
        """The picture so far, with the channels that were asked for."""
        frame = self.session.frame(truth=False)
        facts = {
            "resolution": (self.session.width, self.session.height),
            "crop": self.session.crop,
            "samples": self.loop.work.done(),
            "aovs": self.plan.aovs,
        }
        frame = replace(frame, metadata={**frame.metadata, **facts})
        if self.plan.denoise:
            from daguerre.rendering.denoise import denoise

            frame = denoise(frame)  # by means over the samples, blurred as the picture is
            if self.plan.photograph.sensor is not None:
                console.note("denoised: the sensor's channels are fitted from the clean colours")
        frame = self.session.with_truth(frame)
        if "disparity" in self.plan.aovs:
            from daguerre.rendering.rig import disparity

            apart = disparity(frame, self.plan.baseline)
            frame = replace(frame, aovs={**frame.aovs, "disparity.X": apart})
        frame = self.plan.photograph.metered(frame, self.plan.outputs)
        if self.plan.exposed:
            truth = frame.exposure_truth(self.plan.photograph.sensor)
            frame = replace(frame, aovs=frame.aovs | truth)
        keep = {
            name: plane
            for name, plane in frame.aovs.items()
            if name.split(".")[0] in self.plan.aovs
        }
        return replace(frame, aovs=keep)

    def _write(self, frame: Frame, paths: list[Path]) -> None:
        from daguerre.rendering.passes import pass_of, write_pass

        passes = [p for p in paths if self.plan.is_pass and p.suffix.lower() == ".exr"]
        for path in passes:
            drawn = pass_of(self.session)
            write_pass(path, frame, replace(drawn, metadata=frame.metadata))
        pictures = [path for path in paths if path not in passes]
        self.plan.photograph.write(frame, pictures, self.tone)

    def _snapshot(self) -> None:
        paths = [p.with_suffix(f".snapshot{p.suffix}") for p in self.plan.outputs]
        self._write(self._frame(), paths)
        console.note(
            f"snapshot: {', '.join(map(str, paths))} ({self._samples()} samples per pixel)"
        )

    def _samples(self) -> str:
        """Samples per pixel that are drawn; a mean with one decimal."""
        return f"{round(self.loop.work.done(), 1):.10g}"

    def _name_noise(self, reached: float | None) -> None:
        wanted = self.plan.noise
        if wanted is None or reached is None:
            return
        console.note(f"noise {reached:.3g}, wanted {wanted:g}")
        if reached > wanted:
            console.warn(
                f"--noise {wanted:g} is not reached: --spp {self.plan.wanted[1]} ended it before"
            )

    def _stopped(self) -> str:
        """The share of the camera's rays that no light comes along."""
        counters = self.session.counters
        share = counters.stopped_rays / max(1, counters.camera_rays)
        return f"{share:.1%} of the camera's rays, by lens, iris or edge of the field"

    def _light_stats(self) -> dict[str, str]:
        """Counts of light paths, and of those that passed the lens and missed the frame."""
        from daguerre.rendering.light_paths import show_plan

        counters, plan = self.session.counters, show_plan(self.session.light_paths)
        if plan is None:
            return {"light paths": "off"}
        return {
            "light paths": f"{counters.light_paths} ({plan} per sample), "
            f"{counters.splats_off_film} beside the frame"
        }

    def _flare_stats(self) -> dict[str, str]:
        """Counts of ghosts: their sources, and the share of their rays on the frame."""
        session, counters = self.session, self.session.counters
        if not counters.flare_rays:
            return {}
        share = counters.flare_hits / counters.flare_rays
        return {
            "flare": f"{counters.flare_paths} paths, {share:.0%} of their rays on the frame",
            "highlights": f"{session.flare_spots} bright spots, by {session.survey_rays} rays",
        }

    def _scatter_stats(self) -> dict[str, str]:
        """Counts of light that the lens's parts scatter."""
        counters = self.session.counters
        count = counters.scatter_paths
        if not count:
            return {}
        share = counters.scatter_hits / count
        return {"scatter": f"{count} paths, {share:.1%} of them to the frame"}

    def _print_stats(self, elapsed: float) -> None:
        import resource

        from daguerre.rendering.loop import frame_pixels
        from daguerre.rendering.progress import quantity

        usage = resource.getrusage(resource.RUSAGE_SELF)
        drawn = round(self.loop.drawn_here * frame_pixels(self.session))
        rays = int(self.session.counters.rays)
        rows = {
            "set-up": f"{self.setup_s:.2f} s",
            "drawing": f"{elapsed:.2f} s",
            "processor": f"{usage.ru_utime + usage.ru_stime:.2f} s",
            "camera samples": f"{drawn} ({quantity(drawn / elapsed)} per s)",
            "stopped": self._stopped(),
            "rays": f"{rays} ({quantity(rays / elapsed)} per s)",
            **self._light_stats(),
            **self._flare_stats(),
            **self._scatter_stats(),
            "bad samples": str(self.session.bad_samples[0]),
            "peak memory": f"{usage.ru_maxrss / 1024:.0f} MB",
        }
        for name, value in rows.items():
            console.say(f"daguerre: {name}: {value}")


def bad_samples(count: int, places: list[tuple[int, int, int]]) -> str:
    """How many samples were dropped, and the first of them by name."""
    named = ", ".join(f"sample {sample} of pixel ({x}, {y})" for x, y, sample in places[:4])
    more = ", ..." if len(places) > 4 else ""
    return f"{count} samples were NaN or Inf and are left out: {named}{more}"


@contextmanager
def core_errors(where: str) -> Iterator[None]:
    """The core raises plain ``ValueError`` for input that it cannot use."""
    try:
        yield
    except ValueError as error:
        if type(error) is not ValueError:
            raise
        raise InputError(f"{where}: {error}") from error
