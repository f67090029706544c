"""Plan of a render: makes and checks the pictures of all flags, before the scene is loaded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

from daguerre import units as q
from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.cli import console
from daguerre.cli.flags.job import JobFlags
from daguerre.cli.flags.map import MapFlags
from daguerre.cli.flags.settings import SettingsFlags
from daguerre.errors import UsageError
from daguerre.rendering.output import DISPARITY, Output
from daguerre.rendering.photograph import shows_exposure
from daguerre.rendering.picture import Picture, in_order, path_of
from daguerre.rendering.settings import RenderSettings
from daguerre.scene.scene import Scene

from . import checks
from .frames import check_names, frame_numbers
from .photograph import mode_notes, photograph_of
from .views import CallView, Cameras, check_places

#: Frames before and after the exposures that motion vectors need, and a little more.
_NEXT = 1.5
#: Frames before and after that are read before the exposures are known.
_AROUND = 3.0


@dataclass(frozen=True)
class Plan:
    """Pictures of a call, and data to render them.

    Attributes:
        pictures: Pictures, frame by frame, with all cameras of each.
        maps: Maps of each camera.
        flags: Flags of the job.
        interval_s: Time between checkpoints, s.
        stage: Called with a frame's number and its scene, before it is drawn.
    """

    pictures: list[Picture]
    maps: MapFlags
    flags: JobFlags
    interval_s: float
    stage: Callable[[int, Scene], None] = lambda frame, scene: None

    def maps_of(self, picture: Picture) -> MapFlags:
        """Maps of a picture, with its own file names."""
        several = "camera" in picture.facts
        name, frame = picture.view.name, picture.frame
        return self.maps.renamed(lambda path: path_of(path, name, frame, several=several))


def plan_of(
    flags: JobFlags,
    rows: SettingsFlags,
    maps: MapFlags,
    cameras: Cameras,
    scene: Scene | None = None,
) -> Plan:
    """Makes the plan from the flags of a render.

    Args:
        flags: Flags of the job.
        rows: Flags of the settings.
        maps: Flags of the maps.
        cameras: Flags of the cameras.
        scene: The scene; its file may name the size of a picture. None: it is not read yet.

    Raises:
        UsageError: A value is wrong, or excludes another; the message names the flag.
    """
    views = cameras.views(flags.stereo)
    groups = checks.check_files(flags, rows, maps)
    samples = checks.check_samples(flags, rows, groups)
    sizes = [cameras.size(view, flags.res, scene) for view in views]
    settings = [checks.settings_of(flags, rows, groups, size) for size in sizes]
    checks.check_overscan(flags, settings[0])
    checks.check_truth(groups, rows, maps)
    if scene is not None or flags.res:  # else its size is not known
        checks.check_crop(settings)
    numbers = frame_numbers("--frames", flags.frames) if flags.frames is not None else None
    maps.check()
    files = [*flags.paths, *(flags.noisy or ()), *maps.files]
    check_names(files, numbers)
    check_places(files, views)
    output = replace(_output(flags, groups, settings[0], cameras), beside=tuple(maps.files))
    made = [
        Picture(view.view(cameras), how, _output_of(output, view, how), samples)
        for view, how in zip(views, settings, strict=True)
    ]
    interval_s = q.time_s("--checkpoint", flags.checkpoint)
    plan = Plan(in_order(made, numbers), maps, flags, interval_s)
    _check_distinct(plan)
    return plan


def _output(
    flags: JobFlags, groups: list[str], settings: RenderSettings, cameras: Cameras
) -> Output:
    """Makes the output: files of the pictures, exposure and development."""
    cameras.flags.check(cameras.changes)
    if settings.light.scatter in ("off", 0) and "scatter" in cameras.changes:
        raise UsageError(
            "--scatter-barrel, --scatter-blades and --scatter-surface-nm need --scatter"
        )
    photograph = photograph_of(
        cameras.changes, flags.bracket, flags.look, settings.sampling.seed, cameras.plate
    )
    is_pass = flags.samples is not None
    noisy = tuple(flags.noisy or ())
    photograph = replace(photograph, colorspace=flags.colorspace)
    return Output(flags.paths, tuple(groups), flags.denoise, noisy, flags.tone, photograph, is_pass)


def _output_of(output: Output, view: CallView, settings: RenderSettings) -> Output:
    """Makes the output of a camera, which may have another picture size."""
    if DISPARITY in output.aovs and not view.shift:
        raise UsageError("--aov disparity needs --stereo")
    return replace(output, baseline=2 * abs(view.shift))


def expected_moments(frames: Iterable[int | None], changes: dict[str, Any]) -> tuple[float, float]:
    """Begin and end of the time that pictures most likely show, s after frame 0.

    Args:
        frames: Numbers of their frames; None: not a sequence.
        changes: Parameters of all cameras that the command line changes.
    """
    fps = float(changes.get("fps") or Camera().fps)
    numbers = [frame or 0 for frame in frames]
    return (min(0, *numbers) - _AROUND) / fps, (max(0, *numbers) + _AROUND) / fps


def missing_moments(pictures: Iterable[Picture], scene: Scene) -> tuple[float, float] | None:
    """Begin and end of the time that a scene must be read for, s after frame 0.

    Args:
        pictures: The pictures to draw, with cameras of the scene.
        scene: The scene at the time of frame 0.

    Returns:
        The time; None: the scene has it all.

    Raises:
        UsageError: A shutter is wrong.
    """
    if scene.moments is None:
        return None
    first, last = (time - scene.time for time in scene.moments)
    begin = end = 0.0
    for picture in pictures:
        camera = picture.view.camera(scene)
        when = scene.time + (picture.frame or 0) / camera.fps
        opens, closes = shutter.interval(camera, when, picture.settings.film.resolution)
        begin = min(begin, opens - scene.time - _NEXT / camera.fps)
        end = max(end, closes - scene.time + _NEXT / camera.fps)
    return None if first <= begin <= end <= last else (min(begin, first), max(end, last))


def tell_mode(plan: Plan, cameras: Cameras, flags: JobFlags, scene: Scene) -> None:
    """Reports flags that exposed pictures before version 1.0 and do not now."""
    if not any(shows_exposure(path) for path in flags.paths):
        return
    camera = plan.pictures[0].view.camera(scene)
    told = {"looks": flags.look is not None, "brackets": flags.bracket is not None}
    for text in mode_notes(camera, cameras.changes, **told):
        console.note(text)


def _check_distinct(plan: Plan) -> None:
    """Checks that each picture has its own files, which can be written.

    Raises:
        UsageError: Two share a file, for example because camera names differ by a slash only.
    """
    for picture in plan.pictures:
        checks.check_writable(picture.output)
    paths = [path for picture in plan.pictures for path in picture.output.written]
    if twice := [path for path, count in Counter(paths).items() if count > 1]:
        raise UsageError(
            f"-o {twice[0]}: several pictures would have this name; give their cameras other names"
        )
