"""Flags of a job: which pictures are made, into which files, and how the command runs.

Annotations must be real objects here (see ``groups.py``), so no ``annotations`` future.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from daguerre.camera.parameters.exposure import EXPOSURE_PANEL
from daguerre.rendering.parameters import DEFAULT, FILES, PICTURE, SAMPLING, TRUTH

from .groups import Text, option

_WIDTH, _HEIGHT = DEFAULT["resolution"]


@dataclass(frozen=True)
class JobFlags:
    """Pictures, files, and how the command runs."""

    output: Annotated[
        list[Path] | None,
        option(
            "-o",
            "--output",
            metavar="FILE",
            help="File to write: .exr, .png, .jpg, .tif or .dng; repeatable. Without it only maps "
            "are written.",
            panel=FILES,
        ),
    ] = None
    res: Annotated[
        Text,
        option(
            "--res",
            metavar="WxH|50%",
            help=f"Size of the picture, px [{_WIDTH}x{_HEIGHT}].",
            panel=PICTURE,
        ),
    ] = None
    aov: Annotated[
        list[str] | None,
        option(
            "--aov",
            metavar="LIST",
            help="Channels beside the picture: depth,P,N,albedo,object_id or all; "
            "distance,material_id,motion,motion_back,coverage of ground truth; disparity of "
            "--stereo; exposure,saturated of a photograph.",
            panel=TRUTH,
        ),
    ] = None
    aovs: Annotated[bool, option("--aovs", help="Keep the channels of --aov all.", panel=TRUTH)] = (
        False
    )
    coco: Annotated[
        Path | None,
        option(
            "--coco",
            metavar="FILE.json",
            help="Write boxes, masks and categories of all things to one COCO file.",
            panel=TRUTH,
        ),
    ] = None
    categories: Annotated[
        Path | None,
        option(
            "--categories",
            metavar="FILE.json",
            help="Categories of nodes for --coco, by patterns of their names [by names].",
            panel=TRUTH,
        ),
    ] = None
    tone: Annotated[
        str,
        option(
            "--tone",
            metavar="srgb|soft",
            help="Tone curve of a picture that is not developed: 1 is white [srgb].",
            panel=PICTURE,
        ),
    ] = "srgb"
    exposure: Annotated[
        Text,
        option(
            "--exposure",
            metavar="auto[:centre|spot|matrix]",
            help="Meter the ISO as a camera does [centre].",
            panel=EXPOSURE_PANEL,
        ),
    ] = None
    bracket: Annotated[
        Text,
        option(
            "--bracket",
            metavar="EV,EV,...",
            help="Write a picture at each of these exposures, EV, such as -2,0,2.",
            panel=EXPOSURE_PANEL,
        ),
    ] = None
    like_plate: Annotated[
        Path | None,
        option(
            "--like-plate",
            metavar="CAMERA.json",
            help="Camera of a photo by `match-plate`: its lens, exposure, sensor and size; "
            "pictures get its blur, noise and development.",
            panel=PICTURE,
        ),
    ] = None
    look: Annotated[
        Text,
        option(
            "--look",
            metavar="NAME",
            help="Tone curve of a photo: neutral, standard, film, filmic, ocio:VIEW [neutral].",
            panel=PICTURE,
        ),
    ] = None
    denoise: Annotated[
        bool, option("--denoise", help="Denoise the picture. Extra `denoise`.", panel=PICTURE)
    ] = False
    noisy: Annotated[
        list[Path] | None,
        option(
            "--noisy",
            metavar="FILE",
            help="File for the picture before --denoise; repeatable.",
            panel=FILES,
        ),
    ] = None
    frames: Annotated[
        Text,
        option(
            "--frames",
            metavar="A-BxS",
            help="Frames of a sequence: frame f is drawn at --time + f / fps, into -o "
            "NAME.####.exr; --resume skips complete ones.",
            panel=FILES,
        ),
    ] = None
    stereo: Annotated[
        Text,
        option(
            "--stereo",
            metavar="M",
            help="Distance of the cameras of a stereo pair, m; the camera stands in its middle.",
            panel="Camera",
        ),
    ] = None
    samples: Annotated[
        Text,
        option(
            "--samples",
            metavar="A:B",
            help="Draw samples A to B only, a pass for `merge`.",
            panel=FILES,
        ),
    ] = None
    resume: Annotated[
        bool, option("--resume", help="Resume from OUT.checkpoint.exr.", panel=FILES)
    ] = False
    memory: Annotated[
        Text,
        option(
            "--memory",
            metavar="8GB|50%",
            help="Memory that the render may take, or share of what the machine or its control "
            "group gives; what needs more is refused before it begins [80%].",
            panel=SAMPLING,
        ),
    ] = None
    checkpoint: Annotated[
        str,
        option("--checkpoint", metavar="S", help="Time between checkpoints, s [60].", panel=FILES),
    ] = "60"
    preview: Annotated[
        bool,
        option(
            "--preview",
            help="Show the picture as it grows: in terminals that can (Kitty, iTerm2, Sixel), "
            "else in OUT.preview.png.",
        ),
    ] = False
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False
    json_progress: Annotated[
        bool, option("--json-progress", help="Print progress as JSON lines on stdout.")
    ] = False
    stats: Annotated[bool, option("--stats", help="Print counts and times at the end.")] = False
    dry_run: Annotated[bool, option("--dry-run", help="Check everything, draw nothing.")] = False

    @property
    def paths(self) -> tuple[Path, ...]:
        """Files to write."""
        return tuple(self.output or ())
