"""Flags of a job: pictures, files, and how the command runs.

Annotations must be real objects here (see ``groups.py``), so no ``annotations`` future.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from daguerre.camera.parameters.exposure import EXPOSURE_PANEL
from daguerre.color.spaces import LINEAR, WORKING
from daguerre.rendering.parameters import DEFAULT, FILES, PICTURE, SAMPLING, TRUTH

from .cluster import ClusterFlags
from .groups import Text, option

_WIDTH, _HEIGHT = DEFAULT["resolution"]


@dataclass(frozen=True)
class JobFlags(ClusterFlags):
    """Pictures, files, and how the command runs."""

    output: Annotated[
        list[Path] | None,
        option(
            "-o",
            "--output",
            metavar="FILE.exr|png|jpg|tif|dng",
            help="Picture to write; repeatable. Needed unless only maps (--export-...) are "
            "written.",
            panel=FILES,
        ),
    ] = None
    res: Annotated[
        Text,
        option(
            "--res",
            metavar="WxH|50%",
            help="Picture size, px, or percentage of the default [from the calibration, "
            f"--like-plate or the scene file, else {_WIDTH}x{_HEIGHT}].",
            panel=PICTURE,
        ),
    ] = None
    aov: Annotated[
        list[str] | None,
        option(
            "--aov",
            metavar="AOV,...",
            help="Channels to write beside the picture, with commas between: depth, P, N, albedo, "
            "object_id, or all (these five); ground truth: distance, material_id, motion, "
            "motion_back, coverage; with --stereo: disparity; of a photograph: exposure, "
            "saturated.",
            panel=TRUTH,
        ),
    ] = None
    coco: Annotated[
        Path | None,
        option(
            "--coco",
            metavar="FILE.json",
            help="Write boxes, masks and categories of all objects to this COCO file.",
            panel=TRUTH,
        ),
    ] = None
    categories: Annotated[
        Path | None,
        option(
            "--categories",
            metavar="FILE.json",
            help="Categories for --coco, by patterns of node names [the names themselves].",
            panel=TRUTH,
        ),
    ] = None
    tone: Annotated[
        str,
        option(
            "--tone",
            metavar="srgb|soft",
            help="Tone curve of pictures that are not developed; 1 is white [srgb].",
            panel=PICTURE,
        ),
    ] = "srgb"
    colorspace: Annotated[
        Text,
        option(
            "--colorspace",
            metavar="|".join(LINEAR),
            help=f"Color space of an .exr [{WORKING}].",
            panel=FILES,
        ),
    ] = None
    bracket: Annotated[
        Text,
        option(
            "--bracket",
            metavar="EV,EV,...",
            help="Write a bracket: a picture at each exposure compensation, EV, such as -2,0,2.",
            panel=EXPOSURE_PANEL,
        ),
    ] = None
    like_plate: Annotated[
        Path | None,
        option(
            "--like-plate",
            metavar="CAMERA.json",
            help="Camera file of `match-plate`: sets lens, exposure, sensor and size, and gives "
            "pictures the blur, noise and development of the photo.",
            panel=PICTURE,
        ),
    ] = None
    look: Annotated[
        Text,
        option(
            "--look",
            metavar="LOOK",
            help="Tone curve of developed pictures: neutral, standard, film, filmic or ocio:VIEW "
            "[neutral].",
            panel=PICTURE,
        ),
    ] = None
    denoise: Annotated[
        bool,
        option("--denoise", help="Denoise the picture (needs extra `denoise`).", panel=PICTURE),
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
            help="Frames to draw, such as 1-48 or 1-48x2, into -o NAME.####.exr. Frame f shows "
            "the time --time + f / --fps. --resume skips complete frames.",
            panel=FILES,
        ),
    ] = None
    stereo: Annotated[
        Text,
        option(
            "--stereo",
            metavar="M",
            help="Draw a stereo pair with this distance between its cameras, m; the scene's camera "
            "is the middle of the two.",
            panel="Camera",
        ),
    ] = None
    samples: Annotated[
        Text,
        option(
            "--samples",
            metavar="A:B",
            help="Draw only the samples A to B - 1, as a pass for `merge`.",
            panel=FILES,
        ),
    ] = None
    resume: Annotated[
        bool,
        option("--resume", help="Resume a render from its OUT.checkpoint.exr.", panel=FILES),
    ] = False
    memory: Annotated[
        Text,
        option(
            "--memory",
            metavar="8GB|50%",
            help="Memory limit of the render, or share of the memory of the machine or its control "
            "group; a render that needs more does not start [80%].",
            panel=SAMPLING,
        ),
    ] = None
    checkpoint: Annotated[
        str,
        option(
            "--checkpoint",
            metavar="S",
            help="Time between checkpoints, s [60]; "
            "longer where a checkpoint would take more than 5 % of it.",
            panel=FILES,
        ),
    ] = "60"
    preview: Annotated[
        bool,
        option("--preview", help="Show the picture in OUT.preview.png while it is drawn."),
    ] = False
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False
    json_progress: Annotated[
        bool, option("--json-progress", help="Print progress as JSON lines on stdout.")
    ] = False
    stats: Annotated[bool, option("--stats", help="Print counts and times at the end.")] = False
    dry_run: Annotated[
        bool, option("--dry-run", help="Check everything and describe the render; draw nothing.")
    ] = False

    @property
    def paths(self) -> tuple[Path, ...]:
        """Files to write."""
        return tuple(self.output or ())
