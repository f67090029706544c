"""``daguerre render``: from a scene to a picture, with progress, checkpoints and passes."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from daguerre.cli import console
from daguerre.cli.flags.calibration import CalibrationFlags
from daguerre.cli.flags.camera import CameraFlags
from daguerre.cli.flags.groups import option, with_flags
from daguerre.cli.flags.map import MapFlags
from daguerre.cli.flags.scene import SceneFlags
from daguerre.cli.flags.shutter import ShutterFlags
from daguerre.errors import UsageError
from daguerre.rendering.light_paths import (
    check_highlights,
    check_light_paths,
    check_paths,
)

from .coco import coco_of
from .frames import check_names, frame_numbers
from .photograph import Photograph
from .pictures import Shoot, check_distinct, interrupted_early, pictures
from .plan import DEFAULT_RESOLUTION, check_outputs, make_plan
from .views import check_places, views_of

_OUTPUT = "Output"
_SAMPLING = "Sampling"


@with_flags(
    camera_flags=CameraFlags,
    calibration_flags=CalibrationFlags,
    shutter_flags=ShutterFlags,
    scene_flags=SceneFlags,
    map_flags=MapFlags,
)
def render(
    scene_path: Annotated[
        Path, typer.Argument(metavar="SCENE", help="Scene, a .glb or .gltf file.")
    ],
    camera_flags: CameraFlags,
    calibration_flags: CalibrationFlags,
    shutter_flags: ShutterFlags,
    scene_flags: SceneFlags,
    map_flags: MapFlags,
    output: Annotated[
        list[Path] | None,
        option(
            "-o",
            "--output",
            metavar="FILE",
            help="File to write: .exr, .png, .jpg, .tif or .dng; repeatable. Without it only maps "
            "are written.",
            panel=_OUTPUT,
        ),
    ] = None,
    res: Annotated[
        str | None,
        option(
            "--res", metavar="WxH|50%", help="Size of the picture, px [960x540].", panel=_OUTPUT
        ),
    ] = None,
    crop: Annotated[
        str | None,
        option("--crop", metavar="X0,X1,Y0,Y1", help="Draw only these pixels.", panel=_OUTPUT),
    ] = None,
    overscan: Annotated[
        str | None,
        option(
            "--overscan",
            metavar="PX|10%|L,T,R,B|undistort",
            help="Pixels beside the picture, in the data window of the .exr: for all sides, for "
            "left, top, right and bottom, or as many as undistorting needs.",
            panel=_OUTPUT,
        ),
    ] = None,
    aov: Annotated[
        list[str] | None,
        option(
            "--aov",
            metavar="LIST",
            help="Channels beside the picture: depth,P,N,albedo,object_id or all; "
            "distance,material_id,motion,motion_back,coverage of ground truth; disparity of "
            "--stereo; exposure,saturated of a photograph.",
            panel=_OUTPUT,
        ),
    ] = None,
    gt_time: Annotated[
        str | None,
        option(
            "--gt-time",
            metavar="open|mid|close",
            help="Exact depth, P, N and ids at that moment of the exposure, instead of means [mid "
            "with --aov motion].",
            panel=_OUTPUT,
        ),
    ] = None,
    gt_lens: Annotated[
        str,
        option(
            "--gt-lens",
            metavar="chief|mean",
            help="Ground truth by the chief ray of each pixel, or as means over the rays that "
            "expose it [chief].",
            panel=_OUTPUT,
        ),
    ] = "chief",
    gt_rays: Annotated[
        int | None,
        option(
            "--gt-rays",
            metavar="N",
            help="Rays per pixel for --gt-lens mean [64].",
            panel=_OUTPUT,
        ),
    ] = None,
    coco: Annotated[
        Path | None,
        option(
            "--coco",
            metavar="FILE.json",
            help="Write boxes, masks and categories of all things to one COCO file.",
            panel=_OUTPUT,
        ),
    ] = None,
    categories: Annotated[
        Path | None,
        option(
            "--categories",
            metavar="FILE.json",
            help="Categories of nodes for --coco, by patterns of their names [by names].",
            panel=_OUTPUT,
        ),
    ] = None,
    aovs: Annotated[
        bool, option("--aovs", help="Keep the channels of --aov all.", panel=_OUTPUT)
    ] = False,
    tone: Annotated[
        str,
        option(
            "--tone",
            metavar="srgb|soft",
            help="Tone curve of a picture that is not developed: 1 is white [srgb].",
            panel=_OUTPUT,
        ),
    ] = "srgb",
    exposure: Annotated[
        str | None,
        option(
            "--exposure",
            metavar="auto[:centre|spot|matrix]",
            help="Meter the ISO as a camera does [centre].",
            panel=_OUTPUT,
        ),
    ] = None,
    bracket: Annotated[
        str | None,
        option(
            "--bracket",
            metavar="EV,EV,...",
            help="Write a picture at each of these exposures, EV, such as -2,0,2.",
            panel=_OUTPUT,
        ),
    ] = None,
    look: Annotated[
        str | None,
        option(
            "--look",
            metavar="NAME",
            help="Tone curve of a photo: neutral, standard, film, filmic, ocio:VIEW [neutral].",
            panel=_OUTPUT,
        ),
    ] = None,
    denoise: Annotated[
        bool, option("--denoise", help="Denoise the picture. Extra `denoise`.", panel=_OUTPUT)
    ] = False,
    spp: Annotated[
        int | None, option("--spp", metavar="N", help="Samples per pixel [64].", panel=_SAMPLING)
    ] = None,
    noise: Annotated[
        float | None,
        option(
            "--noise",
            metavar="X",
            help="Draw until the relative error is X, such as 0.02, with at most --spp samples "
            "per pixel [16384].",
            panel=_SAMPLING,
        ),
    ] = None,
    samples: Annotated[
        str | None,
        option(
            "--samples",
            metavar="A:B",
            help="Draw samples A to B only, a pass for `merge`.",
            panel=_SAMPLING,
        ),
    ] = None,
    seed: Annotated[
        int, option("--seed", metavar="N", help="Seed of the random numbers [0].", panel=_SAMPLING)
    ] = 0,
    threads: Annotated[
        int,
        option(
            "--threads",
            metavar="N",
            help="Number of threads; 0 uses all cores [0].",
            panel=_SAMPLING,
        ),
    ] = 0,
    filter: Annotated[
        str,
        option(
            "--filter",
            metavar="NAME",
            help="Pixel filter: box, gaussian, mitchell or blackman_harris; NAME:PX sets its "
            "radius [blackman_harris].",
            panel=_SAMPLING,
        ),
    ] = "blackman_harris",
    max_depth: Annotated[
        int,
        option(
            "--max-depth",
            metavar="N",
            help="Largest number of surfaces along a path [16].",
            panel=_SAMPLING,
        ),
    ] = 16,
    light_paths: Annotated[
        str,
        option(
            "--light-paths",
            metavar="auto|off|M1[,M2]",
            help="Light followed from the emitters to the film, per sample index: straight to the "
            "lens, and with bounces [auto].",
            panel=_SAMPLING,
        ),
    ] = "auto",
    flare: Annotated[
        str,
        option(
            "--flare",
            metavar="auto|off|N",
            help="Draw ghosts of an exact lens; N paths per sample index [off].",
            panel=_SAMPLING,
        ),
    ] = "off",
    flare_order: Annotated[
        int,
        option(
            "--flare-order",
            metavar="2|4",
            help="Number of reflections of ghosts; 4 draws those of 2 and of 4 [2].",
            panel=_SAMPLING,
        ),
    ] = 2,
    flare_highlights: Annotated[
        str,
        option(
            "--flare-highlights",
            metavar="on|off",
            help="Draw ghosts of light that mirrors, glass and walls send to the lens, too [on].",
            panel=_SAMPLING,
        ),
    ] = "on",
    scatter: Annotated[
        str,
        option(
            "--scatter",
            metavar="auto|off|N",
            help="Draw light that barrel, iris and surfaces of an exact lens scatter; N paths per "
            "sample index [off].",
            panel=_SAMPLING,
        ),
    ] = "off",
    diffraction: Annotated[
        bool,
        option(
            "--diffraction",
            help="Treat light as a wave at the iris: stars, discs, softness at narrow stops.",
            panel=_SAMPLING,
        ),
    ] = False,
    diffraction_bands: Annotated[
        int,
        option(
            "--diffraction-bands",
            metavar="N",
            help="Number of wavelength bands for --diffraction [16].",
            panel=_SAMPLING,
        ),
    ] = 16,
    bands: Annotated[
        int,
        option(
            "--bands",
            metavar="N",
            help="Number of wavelength bands to keep, 3 to 64, from which any sensor's channels "
            "can be made later [0].",
            panel=_OUTPUT,
        ),
    ] = 0,
    diffraction_zones: Annotated[
        int,
        option(
            "--diffraction-zones",
            metavar="N",
            help="Points along each side of the frame with diffraction of their own [1].",
            panel=_SAMPLING,
        ),
    ] = 1,
    resume: Annotated[
        bool, option("--resume", help="Resume from OUT.checkpoint.exr.", panel=_SAMPLING)
    ] = False,
    checkpoint: Annotated[
        str,
        option(
            "--checkpoint", metavar="S", help="Time between checkpoints, s [60].", panel=_SAMPLING
        ),
    ] = "60",
    frames: Annotated[
        str | None,
        option(
            "--frames",
            metavar="A-BxS",
            help="Frames of a sequence: frame f is drawn at --time + f / fps, into -o "
            "NAME.####.exr; --resume skips complete ones.",
            panel=_OUTPUT,
        ),
    ] = None,
    stereo: Annotated[
        str | None,
        option(
            "--stereo",
            metavar="M",
            help="Distance of the cameras of a stereo pair, m; the camera stands in its middle.",
            panel="Camera",
        ),
    ] = None,
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False,
    json_progress: Annotated[
        bool, option("--json-progress", help="Print progress as JSON lines on stdout.")
    ] = False,
    stats: Annotated[bool, option("--stats", help="Print counts and times at the end.")] = False,
    dry_run: Annotated[bool, option("--dry-run", help="Check everything, draw nothing.")] = False,
) -> int:
    """Renders a scene to a picture, or a sequence of them, by one camera or by several.

    Ctrl-C stops: samples that were drawn are kept, and the command that resumes is printed.
    """
    console.quiet = quiet
    sampling = (spp, samples, noise)
    views = views_of(camera_flags.camera, calibration_flags.found, stereo)
    sizes = [calibration_flags.resolution(v.calibration, res, DEFAULT_RESOLUTION) for v in views]
    res = "{}x{}".format(*sizes[0])
    output = output or []
    if not output and not map_flags.files:
        raise UsageError("-o, --output: wanted a file, which only maps (--export-...) do without")
    plan = make_plan(output, res, crop, aov or [], aovs, tone, denoise, *sampling, checkpoint)
    plan = replace(plan, maps=map_flags)
    plan = plan.with_overscan(overscan)
    plan = plan.with_truth(gt_time, gt_lens, gt_rays)
    numbers = frame_numbers("--frames", frames) if frames is not None else None
    map_flags.check()
    check_names([*plan.outputs, *map_flags.files], numbers)
    check_places([*plan.outputs, *map_flags.files], views)
    _check_numbers(seed, threads, max_depth)
    wanted_light = check_light_paths(light_paths, "--light-paths")
    wanted_flare = check_paths(flare, "--flare")
    if flare_order not in (2, 4):
        raise UsageError(f"--flare-order: wanted 2 or 4, got {flare_order}")
    highlights = check_highlights(flare_highlights, "--flare-highlights")
    wanted_scatter = check_paths(scatter, "--scatter")
    changes = camera_flags.changes() | shutter_flags.changes()
    calibration_flags.check(changes)
    if wanted_scatter == 0 and "scatter" in changes:
        raise UsageError("--scatter-barrel, -blades, -surface-nm: wanted --scatter too")
    photograph = Photograph.of_flags(changes, exposure, bracket, look, seed)
    if photograph.develops and tone != "srgb":
        raise UsageError(f"--tone {tone}: these pictures are developed; wanted --look")
    plan = replace(plan, photograph=photograph)
    wanted = pictures(plan, views, sizes, numbers)
    for picture in wanted:
        check_outputs(picture.plan)
    check_distinct(wanted)
    labels = coco_of(coco, categories, wanted)
    launched = time.monotonic()
    try:
        scene = scene_flags.load(scene_path)
    except KeyboardInterrupt:
        return interrupted_early()
    for warning in scene.warnings:
        console.warn(f"{scene_path}: {warning}")
    settings: dict[str, Any] = {
        "seed": seed,
        "filter": filter,
        "threads": threads,
        "max_depth": max_depth,
    }
    if wanted_light is not None:
        settings["light_paths"] = wanted_light
    if wanted_flare != 0:
        settings["flare"] = "auto" if wanted_flare is None else wanted_flare
        settings["flare_order"] = flare_order
    if wanted_flare != 0 or wanted_scatter != 0:
        settings["flare_highlights"] = highlights
    if wanted_scatter != 0:
        settings["scatter"] = "auto" if wanted_scatter is None else wanted_scatter
    if bands:
        from daguerre.sensors.bands import check_bands

        settings["bands"] = check_bands(bands, "--bands")
        if diffraction_bands not in (16, bands):
            raise UsageError(
                f"--bands {bands} and --diffraction-bands {diffraction_bands}: wanted one number"
            )
    if diffraction:
        from daguerre.rendering.diffraction import Diffraction

        settings["diffraction"] = Diffraction(diffraction_bands, diffraction_zones)
    elif (diffraction_bands, diffraction_zones) != (16, 1):
        raise UsageError("--diffraction-bands, --diffraction-zones: wanted --diffraction too")
    shoot = Shoot(scene, scene_path, calibration_flags, changes, settings, tone, stats, *labels)
    if dry_run:
        return shoot.describe(wanted)
    return shoot.draw_all(wanted, launched, resume=resume, quiet=quiet, as_json=json_progress)


def _check_numbers(seed: int, threads: int, max_depth: int) -> None:
    for flag, value, low, high in (
        ("--seed", seed, 0, 2**64 - 1),
        ("--threads", threads, 0, 4096),
        ("--max-depth", max_depth, 1, 100000),
    ):
        if not low <= value <= high:
            raise UsageError(f"{flag}: wanted {low} to {high}, got {value}")
