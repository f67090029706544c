"""Table of a render's parameters: the source of record, checks, flags and documentation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import KW_ONLY, dataclass
from typing import Any

import numpy as np

from daguerre import units
from daguerre.checks import DEFAULT_RESOLUTION, MAX_SAMPLES, number, short, whole
from daguerre.errors import UsageError
from daguerre.frame.cryptomatte import MAX_RANKS, check_layers
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table
from daguerre.sensors.bands import LEAST_BANDS, MOST_BANDS, check_bands

from .adaptive import MAX_SPP
from .diffraction import MOST_ZONES, Diffraction, check_diffraction
from .light_paths import TECHNIQUES, check_highlights, check_light_paths, check_paths
from .pixels import check_crop, check_filter, check_resolution
from .truth import GT_LENSES, GT_RAYS, GT_TIMES, MAX_RAYS

#: Samples per pixel if neither ``spp`` nor ``noise`` is given.
DEFAULT_SPP = 64
MAX_SEED = (1 << 64) - 1
PICTURE, TRUTH, SAMPLING, FILES = "Picture", "Ground truth", "Sampling", "Files"
ENVIRONMENT, TRANSPARENT, PLATE = BACKGROUNDS = ("environment", "transparent", "plate")


@dataclass(frozen=True)
class Setting(Parameter):
    """A parameter of a render.

    Attributes:
        normal: Function that checks and normalizes a value; called with the value and its name.
    """

    _: KW_ONLY
    normal: Callable[[Any, str], Any] | None = None

    def check(self, value: object, where: str) -> Any:
        """Checks a value and returns it in the form that settings keep; None: not given.

        Raises:
            UsageError: The message says where, the wanted and the given value.
        """
        if value is None and self.default is None:
            return None
        if self.normal is not None:
            return self.normal(value, where)
        self.check_given(value, where)
        kinds: dict[str, Callable[[Any], Any]] = {"whole": int, "number": float}
        return kinds.get(self.kind, lambda value: value)(value)


def _switch(words: str) -> Callable[[Any, str], bool]:
    def check(value: object, where: str) -> bool:
        if not isinstance(value, bool | np.bool_):
            raise UsageError(f"{where}: wanted {words}, got {short(value)}")
        return bool(value)

    return check


def _seed(value: object, where: str) -> int:
    return whole(value, where, 0, MAX_SEED, "0 .. 2^64 - 1")  # a float cannot hold the limit


def _order(value: object, where: str) -> int:
    if not isinstance(value, int | np.integer) or value not in (2, 4):
        raise UsageError(f"{where}: wanted 2 or 4, got {short(value)}")
    return int(value)


def _paths(value: object, where: str) -> str | float:
    found = check_paths(value, where)
    return "auto" if found is None else "off" if value == "off" else found


def _light_paths(value: object, where: str) -> str | tuple[float, float]:
    found = check_light_paths(value, where)
    return "auto" if found is None else "off" if value == "off" else found


# fmt: off
SAMPLING_ROWS = (
    Setting(
        "spp", "Samples per pixel", kind="whole", low=1, high=MAX_SAMPLES, wants="1 .. 2^31",
        flags=("--spp",), metavar="N", panel=SAMPLING, usual=DEFAULT_SPP, tells_default=True,
        more="With {noise} it is the maximum for a pixel",
    ),
    Setting(
        "noise", "Target relative error, such as 0.02; each pixel gets the samples that it needs, "
        f"at most {{spp}}, by default {MAX_SPP}",
        normal=lambda value, where: number(value, where, high=1.0, above=0.0),
        flags=("--noise",), metavar="X", panel=SAMPLING,
        more="0.05 is grainy, 0.01 clean. The error is the root mean square, over pixels and "
        "channels, of standard error / sqrt(value^2 + 0.01); for a denoised picture, the error "
        "that is left",
    ),
    Setting(
        "seed", "Seed of the random numbers", default=0, kind="whole", low=0, high=MAX_SEED,
        wants="0 .. 2^64 - 1", normal=_seed,
        flags=("--seed",), metavar="N", panel=SAMPLING, tells_default=True,
    ),
    Setting(
        "filter", "Pixel filter: box, tent, gaussian, mitchell or blackman_harris; PX sets its "
        "radius", default="blackman_harris", kind="value", normal=check_filter,
        flags=("--filter",), metavar="FILTER[:PX]", panel=SAMPLING, tells_default=True,
        in_python="Pixel filter: box, tent, gaussian, blackman_harris (default) or mitchell; "
        "``\"name:radius\"`` sets the radius in px.",
    ),
)
FILM_ROWS = (
    Setting(
        "resolution", "Width and height of the picture, px", "px", default=DEFAULT_RESOLUTION,
        kind="value", normal=check_resolution,
    ),
    Setting(
        "crop", "Draw only the pixels between edges such as left=100,top=50,right=400,bottom=300, "
        "or 100,50,400,300 in this order; right and bottom are exclusive, edges left out are those "
        "of the picture", "px", kind="value", normal=check_crop, parse=units.edges,
        flags=("--crop",), metavar="EDGES", panel=PICTURE,
        in_python="Pixels to draw: edges (left, top, right, bottom), right and bottom exclusive, "
        "or by name: ``{\"left\": 100, \"right\": 400}``; edges left out are those of the picture.",
    ),
    Setting(
        "overscan", "Extra pixels around the picture, in the data window of the .exr: for all "
        "sides, for left, top, right and bottom, or as many as undistortion needs", "px",
        kind="value",
        flags=("--overscan",), metavar="PX|10%|L,T,R,B|undistort", panel=PICTURE,
        in_python="Extra pixels to draw around the picture (``docs/plates.md``): a number for all "
        "sides, ``\"10%\"``, (left, top, right, bottom), or ``\"undistort\"``: as many as a later "
        "undistortion needs. The picture itself stays bit-identical.",
        explained=("plates.md#overscan",),
    ),
    Setting(
        "aovs", "Whether to keep depth, normal, position, albedo and object id", default=False,
        kind="flag", normal=_switch("True or False (all of them or none)"),
    ),
    Setting(
        "halves", "Whether to keep a picture of every other sample beside that of all samples; the "
        "denoiser estimates its error from the two", default=False, kind="flag",
        normal=_switch("True or False"),
    ),
    Setting(
        "cryptomatte", "Cryptomatte layers to keep: mattes by the names of objects, materials or "
        "assets", default=(), kind="value", normal=check_layers,
        flags=("--cryptomatte",), metavar="object,material,asset", panel=TRUTH,
        default_words="none", explained=("plates.md#cryptomatte",),
    ),
    Setting(
        "cryptomatte_ranks", "Number of names that {cryptomatte} keeps for each pixel", default=6,
        kind="whole", low=1, high=MAX_RANKS, flags=("--cryptomatte-ranks",), metavar="N",
        panel=TRUTH, tells_default=True,
    ),
    Setting(
        "bands", f"Number of wavelength bands to keep, {LEAST_BANDS} to {MOST_BANDS}, from which "
        "any sensor's channels can be made later", default=0, kind="whole", normal=check_bands,
        flags=("--bands",), metavar="N", panel=TRUTH, tells_default=True,
        in_python="Number of wavelength bands that the frame keeps (``frame.bands``), from which "
        "any sensor's channels can be made later; default: 0, none.",
    ),
)
LIGHT_ROWS = (
    Setting(
        "max_depth", "Maximum number of surfaces along a light path", default=16, kind="whole",
        low=1, high=4096, flags=("--max-depth",), metavar="N", panel=SAMPLING, tells_default=True,
    ),
    Setting(
        "light_paths", "Number of paths traced from the lights to the film for each sample of "
        "{spp}: M1 straight to the lens, M2 with bounces", default="auto", kind="value",
        normal=_light_paths,
        flags=("--light-paths",), metavar="auto|off|M1[,M2]", panel=SAMPLING, tells_default=True,
        explained=("light-paths.md",),
        in_python="Paths traced from the lights to the film, beside the paths from the lens "
        "(``docs/light-paths.md``): auto (default), off, or their numbers (M1, M2) per sample "
        "index, straight to the lens and with bounces.",
    ),
    Setting(
        "flare", "Draw lens flare: ghosts of an exact lens, by N paths for each sample of {spp}",
        default="off",
        kind="value", normal=_paths,
        flags=("--flare",), metavar="auto|off|N", panel=SAMPLING, tells_default=True,
        explained=("flare.md",),
        in_python="Ghosts of an exact lens (``docs/flare.md``): off (default), auto, or paths per "
        "sample index.",
    ),
    Setting(
        "flare_order", "Number of reflections in a ghost; 4 draws ghosts of 2 and of 4", default=2,
        kind="whole", normal=_order,
        flags=("--flare-order",), metavar="2|4", panel=SAMPLING, tells_default=True,
    ),
    Setting(
        "flare_highlights", "Draw ghosts also of light that reaches the lens by mirrors, glass and "
        "walls", default=True, kind="value", normal=check_highlights,
        flags=("--flare-highlights",), metavar="on|off", panel=SAMPLING, default_words="on",
        in_python="Whether to draw ghosts also of light that reaches the lens by mirrors, glass "
        "and walls: True or on (default), False or off.",
    ),
    Setting(
        "scatter", "Draw light scattered by barrel, iris and surfaces of an exact lens, by N paths "
        "for each sample of {spp}", default="off", kind="value", normal=_paths,
        flags=("--scatter",), metavar="auto|off|N", panel=SAMPLING, tells_default=True,
        explained=("scatter.md",),
        in_python="Light scattered by barrel, blades and surfaces of an exact lens "
        "(``docs/scatter.md``): off (default), auto, or paths per sample index.",
    ),
    Setting(
        "diffraction", "Draw diffraction at the iris: stars, discs, softness at narrow stops",
        default=False, kind="flag", normal=lambda value, where: check_diffraction(value) or False,
        flags=("--diffraction",), panel=SAMPLING, explained=("diffraction.md",),
        in_python="Whether to draw diffraction at the iris (``docs/diffraction.md``): True, or a "
        "``Diffraction`` with the number of bands and zones; default: False.",
    ),
)
PLATE_ROWS = (
    Setting(
        "background", "Background of the picture: the environment as the lens sees it, nothing, or "
        "the photograph of the set; the environment lights the scene in any case",
        default="environment", kind="choice", choices=BACKGROUNDS,
        in_python="Background of the picture: environment (default; as the lens sees it), "
        "transparent, or plate, the photograph of the set. The environment lights the scene in "
        "any case.",
        flags=("--background",), metavar="environment|transparent|plate", panel=PICTURE,
        tells_default=True, explained=("plates.md#alpha",),
    ),
    Setting(
        "see_through", "Keep alpha open at smooth glass, for the background straight behind it; "
        "without it, the glass covers the background", default=False, kind="flag",
        normal=_switch("True or False"), flags=("--see-through",), panel=PICTURE,
        explained=("plates.md#alpha",),
    ),
)
TRUTH_ROWS = (
    Setting(
        "gt_time", "Moment of the exposure at which depth, P, N and ids are exact, instead of "
        "means over it",
        kind="choice", choices=tuple(GT_TIMES),
        flags=("--gt-time",), metavar="open|mid|close", panel=TRUTH,
        default_words="mid with motion", explained=("ground-truth.md",),
        more="`--aov motion,motion_back` adds where things go and come from, px",
        in_python="open, mid or close: depth, distance, P, N, object_id and material_id are exact "
        "values at that moment of each pixel's exposure (``docs/ground-truth.md``), instead of "
        "means over the samples; default: mid with motion or ``gt_lens=\"mean\"``, else none.",
    ),
    Setting(
        "gt_lens", "Rays for ground truth: the chief ray of each pixel, or means over the rays "
        "that expose it", default="chief", kind="choice", choices=GT_LENSES,
        flags=("--gt-lens",), metavar="chief|mean", panel=TRUTH, tells_default=True,
        explained=("ground-truth.md#means",),
        more="`--aov coverage` is the share of a pixel's light that meets a surface",
        in_python="Rays for ground truth: chief (default), the chief ray of the pixel's centre; "
        "mean: means over the rays that expose the pixel at that moment, with the share of them "
        "that meets a surface as ``coverage.Y``.",
    ),
    Setting(
        "gt_rays", "Rays per pixel for {gt_lens} mean", kind="whole", low=1, high=MAX_RAYS,
        flags=("--gt-rays",), metavar="N", panel=TRUTH, usual=GT_RAYS, tells_default=True,
        more="Each render uses the same rays",
    ),
    Setting(
        "motion",
        "Whether to add ``motion`` and ``motion_back``, where things go and come from, px", "px",
        default=False, kind="flag", normal=_switch("True or False"),
        more="They refer to mid-exposure unless {gt_time} is given",
    ),
)
REFERENCE_ROWS = (
    Setting(
        "strategy", "Sampling of light at a surface, to check one way against the other",
        default="mis", kind="choice", choices=("mis", "light", "bsdf"), tells_default=True,
    ),
    Setting(
        "technique", "Technique for light that both can find, to check one against the other",
        default="both", kind="choice", choices=TECHNIQUES, tells_default=True,
    ),
    Setting(
        "dispersion", "Treatment of a path's secondary wavelengths by an exact lens (end_secondary "
        "is the plain reference, and noisier)", default="reproject", kind="choice",
        choices=("reproject", "end_secondary"), tells_default=True,
    ),
)
THREADS = Setting(
    "threads", "Number of threads; 0 uses all cores", default=0, kind="whole", low=0, high=1024,
    wants="0 (all) .. 1024", flags=("--threads",), metavar="N", panel=SAMPLING, tells_default=True,
)
#: Rows for flags only, from which the ``Diffraction`` record is made.
DIFFRACTION_ROWS = (
    Setting(
        "diffraction_bands", "Number of wavelength bands for {diffraction}",
        default=Diffraction.bands, kind="whole", low=LEAST_BANDS, high=MOST_BANDS,
        flags=("--diffraction-bands",), metavar="N", panel=SAMPLING,
        tells_default=True,
    ),
    Setting(
        "diffraction_zones", "Number of diffraction kernels along each side of the frame",
        default=Diffraction.zones, kind="whole", low=1, high=MOST_ZONES,
        flags=("--diffraction-zones",), metavar="N", panel=SAMPLING,
        tells_default=True,
    ),
)
# fmt: on
ROWS = (*SAMPLING_ROWS, *FILM_ROWS, *LIGHT_ROWS, *PLATE_ROWS, *TRUTH_ROWS, *REFERENCE_ROWS, THREADS)
#: All parameters by name, for the record.
TABLE = {row.name: row for row in ROWS}
#: Defaults, for the fields of the record.
DEFAULT: dict[str, Any] = {row.name: row.default for row in ROWS}
#: Those with flags, in the order of the help.
FLAGS = Table(row for row in (*ROWS, *DIFFRACTION_ROWS) if row.flags)


def of_flags(given: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters from values of flags: ``Diffraction`` from its switch, its bands and its zones.

    Raises:
        UsageError: There are bands or zones without diffraction.
    """
    found = dict(given)
    waves = {
        row.name: row.check(found.pop(row.name, row.default), row.flag) for row in DIFFRACTION_ROWS
    }
    if found.get("diffraction"):
        found["diffraction"] = Diffraction(*waves.values())
    elif any(waves[row.name] != row.default for row in DIFFRACTION_ROWS):
        raise UsageError("--diffraction-bands and --diffraction-zones need --diffraction")
    return found
