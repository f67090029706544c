"""Jobs: render pictures of a scene into files, in sequence, for any front end."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.camera.camera import Camera
from daguerre.camera.exposure import check_exposure
from daguerre.camera.exposure_mode import is_automatic
from daguerre.camera.settled import settled
from daguerre.errors import InputError
from daguerre.scene.far import Place
from daguerre.scene.scene import Scene
from daguerre.setup.origin import origin_of

from .checkpoint import INTERVAL_S, Checkpoint
from .film_memory import check_denoised, kept_films
from .loop import Loop
from .picture import Picture
from .reporter import Control, Finished, Reporter, Stopped
from .schedule import WorkOf, work_of

if TYPE_CHECKING:
    from daguerre.setup.built_scene import BuiltScene

    from .auto_exposure import Chosen
    from .light_paths import Plan
    from .session import Session

#: Share of the time that previews may take.
PREVIEW_SHARE = 0.1

#: Called with a picture and the session that draws it.
Hook = Callable[[Picture, "Session"], None]


def _nothing(picture: Picture, session: Session) -> None:
    pass


class Job:
    """Renders pictures of a scene: a single picture, a rig, or the frames of a sequence.

    A checkpoint beside the first file of a picture keeps its samples until the picture is complete.

    Args:
        scene: The scene, at the time of frame 0.
        pictures: Pictures, each with its camera, settings and files.
        reporter: Receives progress and messages.
        control: Decides when to stop.
        interval_s: Time between checkpoints, s, longer where a checkpoint would take more than 5 %
            of it; 0: only when the job stops.

    Attributes:
        name: Name of the scene, for messages.
        opened: Called when a picture's scene is built, before its first sample.
        written: Called when the files of a picture are written.
        skipped: Called with a picture that is complete already, so that it is not drawn.
        staged: Called with a frame's number and its scene, to add per-frame data such as a plate.
        work_of: Makes the scheduler that draws a picture, here or on a cluster.
        done: Number of pictures that are complete.
    """

    def __init__(
        self,
        scene: Scene,
        pictures: Sequence[Picture],
        reporter: Reporter | None = None,
        control: Control | None = None,
        interval_s: float = INTERVAL_S,
    ) -> None:
        self.scene, self.pictures = scene, list(pictures)
        self.reporter, self.control = reporter or Reporter(), control or Control()
        self.interval_s = interval_s
        self.name = "scene"
        self.opened: Hook = _nothing
        self.written: Hook = _nothing
        self.skipped: Callable[[Picture], None] = lambda picture: None
        self.staged: Callable[[int, Scene], None] = lambda frame, scene: None
        self.work_of: WorkOf = work_of
        self.piloted: Callable[[Picture], Plan | None] = lambda picture: None
        self.done = 0
        self._staged: tuple[int, Scene] | None = None
        self._warned: set[str] = set()
        self._scene_at: Scene | None = None
        self._built: BuiltScene | None = None
        self._exposures: dict[str, Chosen] = {}

    def run(self, *, resume: bool = False, since: float | None = None) -> bool:
        """Renders the pictures.

        Args:
            resume: Whether to continue from checkpoints and skip complete pictures.
            since: Start of the set-up of the first picture, by ``time.monotonic``, s.

        Returns:
            False if the control stopped the job.
        """
        for view in {picture.view.name: picture.view for picture in self.pictures}.values():
            check_exposure(view.camera(self.scene))  # before hours are spent, not after
        with kept_films():
            return self._run(resume, time.monotonic() if since is None else since)

    def _run(self, resume: bool, began: float) -> bool:
        for i, picture in enumerate(self.pictures):
            if picture.words:
                self.reporter.note(f"{picture.words} ({i + 1} of {len(self.pictures)})")
            if resume and self._is_complete(picture):
                self.reporter.note(f"{picture.output.paths[0]} is complete")
                self.skipped(picture)
            elif not self._render(picture, began, resume=resume):
                return False
            self.done, began = i + 1, time.monotonic()
        return True

    def scene_of(self, picture: Picture) -> Scene:
        """Returns the scene at the time of a frame; cameras of one frame rate share it."""
        scene = self._moment(picture)
        frame, last = picture.frame, self._staged
        if frame is not None and (last is None or last[0] != frame or last[1] is not scene):
            self.staged(frame, scene)
            self._staged = frame, scene
        return scene

    def _moment(self, picture: Picture) -> Scene:
        if not picture.frame:
            return self.scene
        when = self.scene.time + picture.frame / picture.view.camera(self.scene).fps
        if self._scene_at is None or self._scene_at.time != when:
            self._scene_at = self.scene.at(when)
        return self._scene_at

    def camera_of(self, picture: Picture) -> Camera:
        """Returns the camera of a picture, exposed as the meter of the job says."""
        return self._exposed(picture)[0]

    def _exposed(self, picture: Picture) -> tuple[Camera, Mapping[str, Any]]:
        """The camera of a picture, and the metadata that the meter of the job adds."""
        camera = picture.view.camera(self.scene_of(picture))
        chosen = self._metered(picture, camera)
        return (camera, {}) if chosen is None else (chosen.of(camera), chosen.facts)

    def _metered(self, picture: Picture, camera: Camera) -> Chosen | None:
        """Exposure for a camera in an automatic mode: metered once, at frame 0, and shared."""
        if not is_automatic(camera.exposure):
            return None
        if camera.exposure not in self._exposures:
            from .auto_exposure import choose

            first = picture.view.metered(self.scene)
            chosen, self._built = choose(self.scene, first, picture.settings, self._built)
            self._exposures[camera.exposure] = chosen
            if chosen.note:
                self.reporter.note(chosen.note)
            if chosen.warning:
                self.reporter.warning(chosen.warning)
        return self._exposures[camera.exposure]

    def origin_of(self, picture: Picture) -> Place:
        """Returns the origin of a picture's scene, near the first camera: a rig shares it."""
        first, scene = self.pictures[0], self.scene_of(picture)
        camera = settled(first.view.camera(scene), scene.time)
        return origin_of(camera, scene.time, first.settings.film.resolution)

    def open(self, picture: Picture) -> Session:
        """Makes and checks the session of a picture; reports warnings of each camera once."""
        from daguerre.setup.camera_facts import UNLIT, camera_warnings, lit

        from .session import Session

        scene, name = self.scene_of(picture), picture.view.name
        camera, metering = self._exposed(picture)
        first, new = not self._warned, name not in self._warned
        self._warned.add(name)
        which = f"camera {name}: " if "camera" in picture.facts else ""
        for warning in camera_warnings(camera) if new else ():
            self.reporter.warning(which + warning)
        piloted = self.piloted(picture)
        session = Session(
            scene,
            camera,
            settings=picture.settings,
            built=self._built,
            piloted=piloted,
            origin=self.origin_of(picture),
        )
        self._built = session.built
        session.metering = metering
        picture.output.check(session.metadata, self.reporter)
        if picture.output.denoise:
            x0, y0, x1, y1 = session.crop
            check_denoised((x1 - x0, y1 - y0))
        if first and not lit(scene):
            self.reporter.warning(f"{self.name}: {UNLIT}")
        for text in session.warnings:
            self.reporter.warning(f"{self.name}: {text}")
        for text in (*(picture.view.notes(camera) if new else ()), *session.notes):
            self.reporter.note(text)
        return session

    def _is_complete(self, picture: Picture) -> bool:
        """Whether all files of a frame exist; a single picture is always drawn again."""
        single = len(self.pictures) == 1 and picture.frame is None
        files = all(path.exists() for path in picture.output.written)
        return files and not single and not picture.output.checkpoint.exists()

    def _render(self, picture: Picture, began: float, *, resume: bool) -> bool:
        session = self.open(picture)
        self.opened(picture, session)
        setup_s = time.monotonic() - began
        with self.control.watching(), self.reporter.drawing(picture.facts):
            drawn = Drawing(self, picture, session, setup_s).run(resume=resume)
        if drawn:
            self.written(picture, session)
        return drawn


class Drawing:
    """One picture of a job, from the first sample to its files."""

    def __init__(self, job: Job, picture: Picture, session: Session, setup_s: float) -> None:
        self.picture, self.output, self.session = picture, picture.output, session
        self.reporter, self.control, self.setup_s = job.reporter, job.control, setup_s
        self.checkpoint = Checkpoint(self.output.checkpoint, job.interval_s)
        noise = picture.settings.sampling.noise
        work = job.work_of(session, picture.wanted, noise, self.output.judge)
        self.loop = Loop(
            session,
            work,
            self.checkpoint,
            self.reporter,
            self.control,
            self._snapshot,
            self._preview,
        )
        self._preview_took = self._previewed_at = 0.0

    def run(self, *, resume: bool) -> bool:
        """Draws and writes the picture; False if the control stopped it."""
        work = self.loop.work
        if resume and self.checkpoint.load(self.session, work):
            self.reporter.note(f"resuming at {self._samples()} of {work.total():.6g} samples")
        elif resume:
            self.reporter.note(f"nothing to resume: no {self.checkpoint.path}; starting anew")
        try:
            complete = self.loop.run()
        except MemoryError as error:
            raise InputError(self._out_of_memory()) from error
        except BaseException:
            self.loop.rescue()
            raise
        if not complete:
            self._stop()
            return False
        self._finish()
        return True

    def _out_of_memory(self) -> str:
        """Message for a pass that ran out of memory; its sums are lost."""
        kept = (
            f"{self.checkpoint.path} keeps the samples before; continue with --resume, or "
            if self.checkpoint.exists
            else ""
        )
        return (
            f"picture: out of memory while drawing; {kept}draw it in parts (--crop), use "
            "fewer --threads, or stop other programs"
        )

    def _finish(self) -> None:
        try:
            frame = self.output.frame(self.session, self.loop.work.done(), self.reporter)
            self.output.write(self.session, frame, self.output.paths, self.reporter)
            self.output.write_noisy(self.session, self.loop.work.done(), self.output.noisy)
        except BaseException:
            # A full disk, or a channel that cannot be made, must not cost hours of work.
            self.loop.rescue()
            raise
        self.checkpoint.remove()
        if self.reporter.previews:
            self.reporter.preview(self.output.look(frame, complete=True))
        loop, seconds = self.loop, time.monotonic() - self.loop.started
        self.reporter.finished(
            Finished(
                self.session, frame, self.output.files, loop.work.done(), loop.drawn_here, seconds,
                self.setup_s,
            )
        )  # fmt: skip

    def _stop(self) -> None:
        """Saves the samples; after a second request, it keeps only the last checkpoint."""
        work = self.loop.work
        saved = self.loop.rescue() if self.control.stops < 2 else None
        kept = saved or (self.checkpoint.path if self.checkpoint.exists else None)
        self.reporter.stopped(Stopped(work.done(), work.total(), kept, saved is not None))

    def _snapshot(self) -> None:
        paths: list[Path] = [p.with_suffix(f".snapshot{p.suffix}") for p in self.output.paths]
        frame = self.output.frame(self.session, self.loop.work.done(), self.reporter)
        self.output.write(self.session, frame, paths, self.reporter)
        names = ", ".join(map(str, paths))
        self.reporter.note(f"snapshot: {names} ({self._samples()} samples per pixel)")

    def _preview(self) -> None:
        """Shows the picture so far, unless that takes more than a small share of the time."""
        began = time.monotonic()
        waited = began - self._previewed_at
        if not self.reporter.previews or waited * PREVIEW_SHARE < self._preview_took:
            return
        self.reporter.preview(self.output.look(self.output.unfinished(self.session)))
        self._previewed_at = time.monotonic()
        self._preview_took = self._previewed_at - began

    def _samples(self) -> str:
        return shown(self.loop.work.done())


def shown(samples: float) -> str:
    """Samples per pixel as text; a mean has one decimal."""
    return f"{round(samples, 1):.10g}"
