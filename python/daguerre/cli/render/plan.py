"""Plan of a render: everything that its flags ask for, checked before anything heavy is loaded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace

from daguerre import units as q
from daguerre.cli.flags.job import JobFlags
from daguerre.cli.flags.map import MapFlags
from daguerre.cli.flags.settings import SettingsFlags
from daguerre.errors import UsageError
from daguerre.rendering.output import DISPARITY, Output
from daguerre.rendering.picture import Picture, in_order, path_of
from daguerre.rendering.settings import RenderSettings
from daguerre.scene.scene import Scene

from . import checks
from .frames import check_names, frame_numbers
from .photograph import photograph_of
from .views import Cameras, View, check_places


@dataclass(frozen=True)
class Plan:
    """Pictures of a call, and how they are made.

    Attributes:
        pictures: Frame after frame, of each all cameras.
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
        """The maps of a picture, in files of their own."""
        several = "camera" in picture.facts
        name, frame = picture.view.name, picture.frame
        return self.maps.renamed(lambda path: path_of(path, name, frame, several=several))


def plan_of(flags: JobFlags, rows: SettingsFlags, maps: MapFlags, cameras: Cameras) -> Plan:
    """Checks what the flags of a render ask for.

    Raises:
        UsageError: Some value is wrong or does not go with another; the message names the flag.
    """
    views = cameras.views(flags.stereo)
    groups = checks.check_files(flags, rows, maps)
    samples = checks.check_samples(flags, rows, groups)
    settings = [checks.settings_of(flags, rows, groups, cameras.size(v, flags.res)) for v in views]
    checks.check_overscan(flags, settings[0])
    checks.check_truth(groups, rows, maps)
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
    """Files of the pictures, and how they are photographed."""
    cameras.flags.check(cameras.changes)
    if settings.light.scatter in ("off", 0) and "scatter" in cameras.changes:
        raise UsageError("--scatter-barrel, -blades, -surface-nm: wanted --scatter too")
    asked = (flags.exposure, flags.bracket, flags.look)
    photograph = photograph_of(cameras.changes, *asked, settings.sampling.seed, cameras.plate)
    if photograph.develops and flags.tone != "srgb":
        raise UsageError(f"--tone {flags.tone}: wanted --look, as these pictures are developed")
    is_pass = flags.samples is not None
    noisy = tuple(flags.noisy or ())
    return Output(flags.paths, tuple(groups), flags.denoise, noisy, flags.tone, photograph, is_pass)


def _output_of(output: Output, view: View, settings: RenderSettings) -> Output:
    """The same for one camera, whose picture may have a size of its own."""
    checks.check_crop(settings.film)
    if DISPARITY in output.aovs and not view.shift:
        raise UsageError("--aov disparity: wanted --stereo, got no pair")
    return replace(output, baseline=2 * abs(view.shift))


def _check_distinct(plan: Plan) -> None:
    """Each picture has files of its own, which can be written.

    Raises:
        UsageError: Two would share one, such as of cameras whose names differ by a slash.
    """
    for picture in plan.pictures:
        checks.check_writable(picture.output)
    paths = [path for picture in plan.pictures for path in picture.output.written]
    if twice := [path for path, count in Counter(paths).items() if count > 1]:
        raise UsageError(f"-o {twice[0]}: wanted a file for each picture, got one for several")
