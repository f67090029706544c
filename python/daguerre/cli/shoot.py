"""Frames of one scene that is loaded once: each gets its time, its camera and its files."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import console
from .calibration_flags import CalibrationFlags
from .job import INTERRUPTED, Job, core_errors

if TYPE_CHECKING:
    from daguerre.camera import Camera
    from daguerre.scene import Scene
    from daguerre.session import Session

    from .plan import Plan


@dataclass
class Shoot:
    """What all frames share.

    Attributes:
        scene: At the time of frame 0.
        scene_path: Its file.
        camera: Name of the camera; None: the scene's own.
        changes: What the command line changes of the camera.
        settings: Of the session.
        tone: Curve of a PNG.
        stats: Print counts and times.
        calibration: What stands in the place of a lens.
    """

    scene: Scene
    scene_path: Path
    camera: str | None
    changes: dict[str, Any]
    settings: dict[str, Any]
    tone: str
    stats: bool
    calibration: CalibrationFlags = field(default_factory=CalibrationFlags)
    _warned: bool = False

    def draw(
        self,
        frame: int | None,
        plan: Plan,
        launched: float,
        *,
        resume: bool,
        quiet: bool,
        as_json: bool,
    ) -> int:
        """Draws one frame into its files; the exit code."""
        complete = all(path.exists() for path in plan.files) and not plan.checkpoint.exists()
        if frame is not None and resume and complete:
            console.note(f"{plan.outputs[0]} is complete")
            return 0
        try:
            session = self._session(frame, plan)
        except KeyboardInterrupt:
            return interrupted_early()
        job = Job(session, plan, self.tone, time.monotonic() - launched, self.stats)
        return job.run(resume=resume, quiet=quiet, as_json=as_json)

    def describe(self, frame: int | None, plan: Plan) -> int:
        """What would be drawn, on stdout."""
        from daguerre.io.exr import jsonable, without_infinity

        session = self._session(frame, plan)
        facts = {
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
        print(json.dumps(without_infinity(facts), indent=2, default=jsonable))
        return 0

    def _camera(self, scene: Scene) -> Camera:
        camera: Camera = self.calibration.camera(scene.camera(self.camera), self.changes)
        return camera

    def _session(self, frame: int | None, plan: Plan) -> Session:
        from daguerre.info import camera_warnings, lit
        from daguerre.session import Session

        scene = self.scene
        camera = self._camera(scene)
        if frame:
            scene = scene.at(scene.time + frame / camera.fps)
            camera = self._camera(scene)
        first, self._warned = not self._warned, True  # warnings come once, not for every frame
        if first:
            for warning in camera_warnings(camera):
                console.warn(warning)
        with core_errors("render"):
            session = Session(
                scene,
                camera,
                resolution=plan.resolution,
                aovs=bool(plan.aovs) or plan.denoise,
                gt_time=plan.gt_time,
                motion=plan.motion,
                crop=plan.crop,
                **self.settings,
            )
        plan.photograph.check(session.metadata, plan.outputs)
        if plan.exposed:
            from daguerre.exposure import luminance_exposure

            luminance_exposure(session.metadata)  # or an error that names what is missing
        if first and not lit(scene):
            console.warn(
                f"{self.scene_path}: nothing shines, so the picture will be black; --env lights it"
            )
        for text in session.warnings:
            console.warn(f"{self.scene_path}: {text}")
        calibrated = self.calibration.notes(camera) if first else []
        for text in (*calibrated, *session.notes):
            console.note(text)
        return session


def interrupted_early() -> int:
    """Says so; the exit code."""
    console.say("daguerre: interrupted before the first sample; nothing was written")
    return INTERRUPTED
