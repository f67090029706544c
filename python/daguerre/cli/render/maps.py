"""Maps of cameras without pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.cli import console
from daguerre.rendering.job import Job
from daguerre.rendering.picture import Picture

if TYPE_CHECKING:
    from .plan import Plan


def write_maps(plan: Plan, job: Job) -> bool:
    """Writes the maps of all pictures; True: complete."""
    for view in {picture.view.name: picture.view for picture in plan.pictures}.values():
        view.camera(job.scene)
    for i, picture in enumerate(plan.pictures):
        if picture.words:
            console.note(f"{picture.words} ({i + 1} of {len(plan.pictures)})")
        _write(plan, job, picture)
        job.done = i + 1
    return True


def _write(plan: Plan, job: Job, picture: Picture) -> None:
    """Writes the maps of a camera, and finds its focus if needed."""
    from daguerre.camera.overscan import check_overscan
    from daguerre.distortion.overscan import note, to_undistort
    from daguerre.distortion.rectified import RectifiedView, built
    from daguerre.rendering.truth import focused
    from daguerre.setup.camera import set_up

    scene, camera = job.scene_of(picture), job.camera_of(picture)
    size = picture.settings.film.resolution
    setup = set_up(scene, camera, size, built(scene, camera, size))
    camera = focused(camera, setup.lens.focus_distance_m)
    overscan = check_overscan(picture.settings.film.overscan, size, "--overscan")
    if overscan is None:
        view = RectifiedView(camera, size, scene=scene)
        overscan = to_undistort(view, "--overscan undistort")
        console.note(note(overscan))
    moment = picture.settings.truth.moment
    plan.maps_of(picture).write(scene, camera, size, overscan, moment)
