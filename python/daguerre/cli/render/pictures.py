"""Pictures of one scene that is loaded once: each gets its time, its camera and its files."""

from __future__ import annotations

import json
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.cli import console
from daguerre.errors import UsageError

from .job import INTERRUPTED, Job

if TYPE_CHECKING:
    from daguerre.cli.flags.calibration import CalibrationFlags
    from daguerre.labels.categories import Categories
    from daguerre.labels.coco import CocoFile
    from daguerre.rendering.session import Session
    from daguerre.scene.scene import Scene
    from daguerre.setup.built_scene import BuiltScene

    from .plan import Plan
    from .views import View


@dataclass(frozen=True)
class Picture:
    """One picture of a call.

    Attributes:
        frame: Frame number in a sequence; None: the only one.
        view: The camera.
        plan: Its files, size and samples.
        words: Which one it is, for people; empty: the only one.
        facts: The same for programs.
    """

    frame: int | None
    view: View
    plan: Plan
    words: str = ""
    facts: dict[str, Any] = field(default_factory=dict)


def pictures(
    plan: Plan, views: list[View], sizes: list[tuple[int, int]], frames: list[int] | None
) -> list[Picture]:
    """Lists all pictures of a call, frame after frame, each by all cameras.

    Args:
        plan: Plan that they share; its outputs have places for frames and cameras.
        views: The cameras.
        sizes: Sizes of their pictures, px.
        frames: Frame numbers; None: no sequence.
    """
    several, made = len(views) > 1, []
    for number in [None] if frames is None else frames:
        for view, size in zip(views, sizes, strict=True):
            one = plan.of_view(view, size, several=several)
            words: list[str] = []
            facts: dict[str, Any] = {}
            if number is not None:
                one = one.of_frame(number)
                words, facts = [f"frame {number}"], {"frame": number}
            if several:
                words.append(f"camera {view.name}")
                facts["camera"] = view.name
            made.append(Picture(number, view, one, ", ".join(words), facts))
    return made


def check_distinct(wanted: list[Picture]) -> None:
    """Each picture has files of its own.

    Raises:
        UsageError: Two would share one, such as of cameras whose names differ by a slash.
    """
    paths = [path for picture in wanted for path in picture.plan.written]
    if twice := [path for path, count in Counter(paths).items() if count > 1]:
        raise UsageError(f"-o {twice[0]}: wanted a file for each picture, got one for several")


@dataclass
class Shoot:
    """Draws the pictures of a call, which share all of this.

    Attributes:
        scene: The scene at the time of frame 0.
        scene_path: Its file.
        calibrations: Calibrations that replace lenses.
        changes: Changes that the command line makes to the cameras.
        settings: Settings of the session.
        tone: Curve of a PNG.
        stats: Print counts and times.
        coco: File of annotations of what the pictures show; None: none.
        categories: File of categories for ``coco``; None: by the names of nodes.
    """

    scene: Scene
    scene_path: Path
    calibrations: CalibrationFlags
    changes: dict[str, Any]
    settings: dict[str, Any]
    tone: str
    stats: bool
    coco: CocoFile | None = None
    categories: Categories | None = None
    _warned: set[str] = field(default_factory=set)
    _seen: Scene | None = None
    _built: BuiltScene | None = None

    def draw_all(self, wanted: list[Picture], launched: float, **how: bool) -> int:
        """Draws pictures one after the other; the exit code of the first that is not complete."""
        # An error comes before hours are spent, not after.
        for view in {picture.view.name: picture.view for picture in wanted}.values():
            view.of(self.scene, self.calibrations, self.changes)
        if self.categories is not None:
            self.categories.things(self.scene)
        for i, picture in enumerate(wanted):
            if picture.words:
                console.note(f"{picture.words} ({i + 1} of {len(wanted)})")
            try:
                code = self._draw(picture, launched, alone=len(wanted) == 1, **how)
            except KeyboardInterrupt:
                return interrupted_early() if i == 0 else interrupted_between(i, len(wanted))
            if code:
                return code
            launched = time.monotonic()
        if self.coco is not None:
            self.coco.write()
            console.note(f"wrote {self.coco.path}")
        return 0

    def _draw(
        self,
        picture: Picture,
        launched: float,
        *,
        alone: bool,
        resume: bool,
        quiet: bool,
        as_json: bool,
    ) -> int:
        """Draws one picture into its files; the exit code."""
        plan = picture.plan
        if not plan.outputs:
            self._write_maps(picture)
            return 0
        complete = all(path.exists() for path in plan.written) and not plan.checkpoint.exists()
        if resume and complete and not (alone and picture.frame is None):
            console.note(f"{plan.outputs[0]} is complete")
            if self.coco is not None:
                self._annotate(picture, self._session(picture))
            return 0
        session = self._session(picture)
        if plan.maps.files:
            scene, camera = session.scene, session.focused_camera
            plan.maps.write(scene, camera, plan.resolution, session.overscan, plan.gt_time)
        job = Job(session, plan, self.tone, time.monotonic() - launched, self.stats, picture.facts)
        code = job.run(resume=resume, quiet=quiet, as_json=as_json)
        if not code:
            self._annotate(picture, session)
        return code

    def _annotate(self, picture: Picture, session: Session) -> None:
        """Notes what a picture shows, if that is wanted."""
        if self.coco is None:
            return
        from daguerre.labels.annotations import annotations_of

        seen = annotations_of(session, self.categories)
        # Readers of data sets want files that image libraries open.
        files = picture.plan.files
        plain = (f for f in files if f.suffix.lower() not in (".exr", ".dng"))
        self.coco.add(seen, next(plain, files[0]), picture.facts)

    def _write_maps(self, picture: Picture) -> None:
        """The maps of a camera, without its picture."""
        from daguerre.camera.overscan import check_overscan
        from daguerre.camera.shutter import interval
        from daguerre.distortion.overscan import note, to_undistort
        from daguerre.distortion.rectified import RectifiedView
        from daguerre.rendering.truth import focused
        from daguerre.setup.camera import set_up
        from daguerre.setup.scene import build

        plan, scene = picture.plan, self._scene_of(picture)
        camera = picture.view.of(scene, self.calibrations, self.changes)
        size = plan.resolution
        # Nothing is drawn, but what is in focus may have to be found.
        setup = set_up(scene, camera, size, build(scene, interval(camera, scene.time, size)))
        camera = focused(camera, setup.lens.focus_distance_m)
        overscan = check_overscan(plan.overscan, size, "--overscan")
        if overscan is None:
            overscan = to_undistort(
                RectifiedView(camera, size, scene=scene), "--overscan undistort"
            )
            console.note(note(overscan))
        plan.maps.write(scene, camera, size, overscan, plan.gt_time)

    def describe(self, wanted: list[Picture]) -> int:
        """Prints the facts of pictures: for a sequence its first frame, for a rig each camera."""
        from daguerre.io.exr.write import jsonable, without_infinity

        first = [picture for picture in wanted if picture.frame == wanted[0].frame]
        told = {picture.view.name: self._facts(picture) for picture in first}
        facts = {"cameras": told} if len(first) > 1 else next(iter(told.values()))
        print(json.dumps(without_infinity(facts), indent=2, default=jsonable))
        return 0

    def _facts(self, picture: Picture) -> dict[str, Any]:
        plan, session = picture.plan, self._session(picture)
        return {
            "scene": str(self.scene_path),
            "outputs": [str(path) for path in plan.files],
            "resolution": list(plan.resolution),
            "crop": list(session.crop),
            "samples": list(plan.wanted),
            "noise": plan.noise,
            "aovs": plan.aovs,
            "camera": session.metadata.get("camera"),
            "key": session.key,
        }

    def _scene_of(self, picture: Picture) -> Scene:
        """The scene at the time of a frame: the same one for all cameras of a rate."""
        camera = picture.view.of(self.scene, self.calibrations, self.changes)
        if not picture.frame:
            return self.scene
        when = self.scene.time + picture.frame / camera.fps
        if self._seen is None or self._seen.time != when:
            self._seen = self.scene.at(when)
        return self._seen

    def _session(self, picture: Picture) -> Session:
        from daguerre.analysis.camera_facts import camera_warnings, lit
        from daguerre.rendering.session import Session

        plan, view = picture.plan, picture.view
        scene = self._scene_of(picture)
        camera = view.of(scene, self.calibrations, self.changes)
        # Warnings come once, not for every frame.
        first, new = not self._warned, view.name not in self._warned
        self._warned.add(view.name)
        which = f"camera {view.name}: " if "camera" in picture.facts else ""
        if new:
            for warning in camera_warnings(camera):
                console.warn(which + warning)
        settings = dict(self.settings)
        if plan.overscan is not None:
            settings["overscan"] = plan.overscan
        session = Session(
            scene,
            camera,
            resolution=plan.resolution,
            aovs=bool(plan.aovs) or plan.denoise,
            gt_time=plan.gt_time,
            gt_lens=plan.gt_lens,
            gt_rays=plan.gt_rays,
            motion=plan.motion,
            crop=plan.crop,
            built=self._built,
            **settings,
        )
        self._built = session.built
        plan.photograph.check(session.metadata, plan.outputs)
        if "disparity" in plan.aovs:
            from daguerre.rendering.rig import check_straight

            check_straight(session.metadata)
        if plan.exposed:
            from daguerre.exposure.lux_seconds import luminance_exposure

            luminance_exposure(session.metadata)  # or an error that names what is missing
        if first and not lit(scene):
            console.warn(
                f"{self.scene_path}: the scene has no lights, so the picture will be black; "
                "add one or use --env"
            )
        for text in session.warnings:
            console.warn(f"{self.scene_path}: {text}")
        calibrated = self.calibrations.notes(camera, view.calibration) if new else []
        for text in (*calibrated, *session.notes):
            console.note(text)
        return session


def interrupted_between(done: int, wanted: int) -> int:
    """Says so between two pictures, and how to go on; the exit code."""
    console.say(f"daguerre: interrupted after {done} of {wanted} pictures; resume with:")
    console.say(console.command_line("--resume"))
    return INTERRUPTED


def interrupted_early() -> int:
    """Says so; the exit code."""
    console.say("daguerre: interrupted before the first sample; nothing was written")
    return INTERRUPTED
