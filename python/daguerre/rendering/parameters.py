"""Parameters of a render: one row each, from which record, checks, flags and documentation come.

A row says what a parameter is called, what it may be, its default, and what is told about it. The
flag of the command line has the name with dashes and the same check, so limits stand once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from daguerre.checks import MAX_SAMPLES, number, short, whole
from daguerre.errors import UsageError, suggest
from daguerre.sensors.bands import LEAST_BANDS, MOST_BANDS, check_bands

from .adaptive import MAX_SPP
from .diffraction import MOST_ZONES, Diffraction, check_diffraction
from .light_paths import TECHNIQUES, check_highlights, check_light_paths, check_paths
from .pixels import check_crop, check_filter, check_resolution
from .truth import GT_LENSES, GT_RAYS, GT_TIMES, MAX_RAYS

Check = Callable[[Any, str], Any]
OUTPUT, SAMPLING = "Output", "Sampling"


@dataclass(frozen=True)
class Setting:
    """A parameter of a render.

    Attributes:
        name: In Python, JSON, and with dashes as a flag.
        default: Its value if it is not given.
        check: Gives the value in one form, or refuses it; called with the value and its name.
        meaning: Description for Python.
        help: Description for the flag; empty: the command line has no such flag, or one of its own.
        metavar: How the flag's value is written.
        panel: Where the flag stands in the help.
        kind: Type that a flag's text is read as: str, int, float, or bool for a switch.
    """

    name: str
    default: Any
    check: Check
    meaning: str
    help: str = ""
    metavar: str = "N"
    panel: str = SAMPLING
    kind: type = str

    @property
    def flag(self) -> str:
        """Name on the command line."""
        return "--" + self.name.replace("_", "-")


def _whole(low: int, high: int, bounds: str | None = None) -> Check:
    return lambda value, where: whole(value, where, low, high, bounds)


def _optional(check: Check) -> Check:
    return lambda value, where: None if value is None else check(value, where)


def _choice(*known: Any) -> Check:
    wanted = " or ".join(map(str, known)) if len(known) == 2 else ", ".join(map(str, known))

    def check(value: Any, where: str) -> Any:
        if value not in known or isinstance(value, bool):
            near = suggest(str(value), [str(one) for one in known])
            raise UsageError(f"{where}: wanted {wanted}, got {short(value)}{near}")
        return value

    return check


def _switch(words: str = "True or False") -> Check:
    def check(value: Any, where: str) -> bool:
        if not isinstance(value, bool | np.bool_):
            raise UsageError(f"{where}: wanted {words}, got {short(value)}")
        return bool(value)

    return check


def _noise(value: Any, where: str) -> float:
    return number(value, where, high=1.0, above=0.0)


def _paths(value: Any, where: str) -> str | float:
    found = check_paths(value, where)
    return value if isinstance(value, str) and value in ("auto", "off") else float(found or 0)


def _light_paths(value: Any, where: str) -> str | tuple[float, float]:
    found = check_light_paths(value, where)
    return "auto" if found is None else "off" if value == "off" else found


def _as_it_is(value: Any, where: str) -> Any:
    return value


# fmt: off
SAMPLING_ROWS = (
    Setting(
        "spp", None, _optional(_whole(1, MAX_SAMPLES, "1 .. 2^31")),
        "Samples per pixel; default: 64; with ``noise`` the most that a pixel may get, default: "
        f"{MAX_SPP}.",
        "Samples per pixel [64].", kind=int,
    ),
    Setting(
        "noise", None, _optional(_noise),
        "Relative error to reach (0.05 is grainy, 0.01 clean): the root mean square over pixels "
        "and channels of standard error / sqrt(value^2 + 0.01). Pixels then get as many samples "
        "as each needs.",
        "Draw until the relative error is X, such as 0.02, with at most --spp samples per pixel "
        f"[{MAX_SPP}].", "X", kind=float,
    ),
    Setting(
        "seed", 0, _whole(0, (1 << 64) - 1, "0 .. 2^64 - 1"),
        "Seed of all random numbers.", "Seed of the random numbers [0].", kind=int,
    ),
    Setting(
        "filter", "blackman_harris", check_filter,
        "box, gaussian, blackman_harris or mitchell; ``\"name:radius\"`` sets the radius in px.",
        "Pixel filter: box, gaussian, mitchell or blackman_harris; NAME:PX sets its radius "
        "[blackman_harris].", "NAME",
    ),
)
FILM_ROWS = (
    Setting(
        "resolution", (960, 540), check_resolution, "Width and height of the picture, px.",
    ),
    Setting(
        "crop", None, _optional(check_crop),
        "Pixel region (x0, y0, x1, y1) to draw, end exclusive; default: all.",
        "Draw only these pixels.", "X0,X1,Y0,Y1", OUTPUT,
    ),
    Setting(
        "overscan", None, _as_it_is,
        "Pixels to draw beside the picture (``docs/plates.md``): a number for all sides, "
        "``\"10%\"``, (left, top, right, bottom), or ``\"undistort\"``: as many as a later "
        "undistortion needs. The picture keeps its bits.",
        "Pixels beside the picture, in the data window of the .exr: for all sides, for left, top, "
        "right and bottom, or as many as undistorting needs.", "PX|10%|L,T,R,B|undistort", OUTPUT,
    ),
    Setting(
        "aovs", False, _switch("True or False (all of them or none)"),
        "Whether to keep depth, normal, position, albedo and object id.",
    ),
    Setting(
        "bands", 0, check_bands,
        "Number of wavelength bands that the frame keeps (``frame.bands``), from which any "
        "sensor's channels can be made later; 0: none.",
        "Number of wavelength bands to keep, 3 to 64, from which any sensor's channels can be "
        "made later [0].", panel=OUTPUT, kind=int,
    ),
)
LIGHT_ROWS = (
    Setting(
        "max_depth", 16, _whole(1, 4096),
        "Largest number of surfaces at which a path scatters.",
        "Largest number of surfaces along a path [16].", kind=int,
    ),
    Setting(
        "light_paths", "auto", _light_paths,
        "Light followed from the emitters to the film, beside the paths from the lens "
        "(``docs/light-paths.md``): auto, off, or paths per sample index, straight to the lens "
        "and with bounces, as (M1, M2).",
        "Light followed from the emitters to the film, per sample index: straight to the lens, "
        "and with bounces [auto].", "auto|off|M1[,M2]",
    ),
    Setting(
        "flare", "off", _paths,
        "Ghosts of an exact lens (``docs/flare.md``): off, auto, or paths per sample index.",
        "Draw ghosts of an exact lens; N paths per sample index [off].", "auto|off|N",
    ),
    Setting(
        "flare_order", 2, _choice(2, 4),
        "Number of reflections of ghosts: 2, or 4 for both 2 and 4.",
        "Number of reflections of ghosts; 4 draws those of 2 and of 4 [2].", "2|4", kind=int,
    ),
    Setting(
        "flare_highlights", True, check_highlights,
        "Whether light that mirrors, glass and walls send to the lens has ghosts, too: on or off.",
        "Draw ghosts of light that mirrors, glass and walls send to the lens, too [on].", "on|off",
    ),
    Setting(
        "scatter", "off", _paths,
        "Light that barrel, blades and surfaces of an exact lens scatter (``docs/scatter.md``): "
        "off, auto, or paths per sample index.",
        "Draw light that barrel, iris and surfaces of an exact lens scatter; N paths per sample "
        "index [off].", "auto|off|N",
    ),
    Setting(
        "diffraction", False, lambda value, where: check_diffraction(value) or False,
        "Whether light is a wave at the iris (``docs/diffraction.md``): True, or a "
        "``Diffraction`` with the number of bands and zones.",
        "Treat light as a wave at the iris: stars, discs, softness at narrow stops.", kind=bool,
    ),
)
TRUTH_ROWS = (
    Setting(
        "gt_time", None, _optional(_choice(*GT_TIMES)),
        "open, mid or close: depth, distance, P, N, object_id and material_id are exact values at "
        "that moment of each pixel's exposure (``docs/ground-truth.md``), instead of means over "
        "the samples.",
        "Exact depth, P, N and ids at that moment of the exposure, instead of means [mid with "
        "--aov motion].", "open|mid|close", OUTPUT,
    ),
    Setting(
        "gt_lens", "chief", _choice(*GT_LENSES),
        "Rays for ground truth: chief, the one of the pixel's centre; mean: means over those that "
        "expose the pixel then, with their share that meets a surface as ``coverage.Y``.",
        "Ground truth by the chief ray of each pixel, or as means over the rays that expose it "
        "[chief].", "chief|mean", OUTPUT,
    ),
    Setting(
        "gt_rays", None, _optional(_whole(1, MAX_RAYS)),
        f"Rays per pixel for ``gt_lens=\"mean\"``; default: {GT_RAYS}, the same ones each time.",
        f"Rays per pixel for --gt-lens mean [{GT_RAYS}].", panel=OUTPUT, kind=int,
    ),
    Setting(
        "motion", False, _switch(),
        "Whether to add ``motion`` and ``motion_back``, where things go and come from, px; at mid "
        "unless ``gt_time`` is given.",
    ),
)
REFERENCE_ROWS = (
    Setting(
        "strategy", "mis", _choice("mis", "light", "bsdf"),
        "mis, or light or bsdf alone (to check one against the other).",
    ),
    Setting(
        "technique", "both", _choice(*TECHNIQUES),
        "Technique for light that both could find: both, or camera or light alone (to check one "
        "against the other).",
    ),
    Setting(
        "dispersion", "reproject", _choice("reproject", "end_secondary"),
        "Treatment of a path's other wavelengths by an exact lens: reproject, or end_secondary "
        "(the plain reference; noisier).",
    ),
)
THREADS = Setting(
    "threads", 0, _whole(0, 1024, "0 (all) .. 1024"),
    "Number of threads; 0: all cores.", "Number of threads; 0 uses all cores [0].", kind=int,
)
#: Flags alone: they make the record that ``diffraction`` takes.
DIFFRACTION_ROWS = (
    Setting(
        "diffraction_bands", Diffraction.bands, _whole(LEAST_BANDS, MOST_BANDS),
        "Number of wavelength bands.", "Number of wavelength bands for --diffraction [16].",
        kind=int,
    ),
    Setting(
        "diffraction_zones", Diffraction.zones, _whole(1, MOST_ZONES),
        "Points along each side of the frame with kernels of their own.",
        "Points along each side of the frame with diffraction of their own [1].", kind=int,
    ),
)
# fmt: on
TABLE = {
    row.name: row
    for row in (
        *SAMPLING_ROWS,
        *FILM_ROWS,
        *LIGHT_ROWS,
        *TRUTH_ROWS,
        *REFERENCE_ROWS,
        THREADS,
    )
}  # fmt: skip

#: Defaults, for the fields of the record.
DEFAULT: dict[str, Any] = {name: row.default for name, row in TABLE.items()}
