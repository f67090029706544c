"""``daguerre render``: from a scene to a picture, with progress, checkpoints and passes."""

from __future__ import annotations

import time
from dataclasses import replace

from daguerre import memory, units
from daguerre.cli import console
from daguerre.cli.flags.calibration import CalibrationFlags
from daguerre.cli.flags.camera import CameraFlags
from daguerre.cli.flags.groups import with_flags
from daguerre.cli.flags.job import JobFlags
from daguerre.cli.flags.map import MapFlags
from daguerre.cli.flags.scene import SceneFlags
from daguerre.cli.flags.scene_file import ScenePath
from daguerre.cli.flags.settings import SettingsFlags
from daguerre.cli.flags.shutter import ShutterFlags

from .coco import coco_of
from .plan import expected_moments, missing_moments, plan_of, tell_mode
from .plate import over_plate, read_plate
from .run import describe, interrupted_early, run
from .views import Cameras


@with_flags(
    camera_flags=CameraFlags,
    calibration_flags=CalibrationFlags,
    shutter_flags=ShutterFlags,
    scene_flags=SceneFlags,
    map_flags=MapFlags,
    settings_flags=SettingsFlags,
    job_flags=JobFlags,
)
def render(
    scene_path: ScenePath,
    camera_flags: CameraFlags,
    calibration_flags: CalibrationFlags,
    shutter_flags: ShutterFlags,
    scene_flags: SceneFlags,
    map_flags: MapFlags,
    settings_flags: SettingsFlags,
    job_flags: JobFlags,
) -> int:
    """Renders a scene to a picture or a sequence of pictures.

    One camera takes them, or several. Ctrl-C stops the render, keeps the samples drawn so far, and
    prints the command that resumes it.
    """
    console.quiet = job_flags.quiet
    memory.set_limit(
        None if job_flags.memory is None else units.memory_bytes("--memory", job_flags.memory)
    )
    plate = read_plate(job_flags.like_plate)
    given = camera_flags.changes() | shutter_flags.changes()
    changes = over_plate(plate, given, calibrated=bool(calibration_flags.found))
    start = scene_flags.start(scene_path)
    place = camera_flags.placement
    cameras = Cameras(camera_flags.camera, calibration_flags, changes, place, plate, start)
    plan = plan_of(job_flags, settings_flags, map_flags, cameras)
    scene_flags.check_plates(picture.frame for picture in plan.pictures)
    labels = coco_of(job_flags.coco, job_flags.categories, plan)
    launched = time.monotonic()
    try:
        taken = None if plate is None else plate.camera
        moves = any(picture.frame for picture in plan.pictures)
        span = expected_moments((picture.frame for picture in plan.pictures), changes)
        scene = scene_flags.load(scene_path, taken, animated=moves, moments=span)
        for warning in scene.warnings:
            console.warn(f"{scene_path}: {warning}")
        plan = plan_of(job_flags, settings_flags, map_flags, cameras, scene)
        if (more := missing_moments(plan.pictures, scene)) is not None:
            scene = scene_flags.load(scene_path, taken, animated=moves, moments=more)
    except KeyboardInterrupt:
        return interrupted_early()
    cameras.check_frames(plan.pictures, job_flags.stereo, scene)
    tell_mode(plan, cameras, job_flags, scene)
    if scene_flags.plate_moves:
        plan = replace(plan, stage=lambda n, now: scene_flags.throw_plate(now, taken, n))
    if job_flags.dry_run:
        return describe(plan, scene, scene_path)
    with job_flags.worker_pool(console.warn) as pool:
        return run(plan, scene, scene_path, labels, launched, pool)
