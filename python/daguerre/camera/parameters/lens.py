"""Parameters of the lens and of its optical model."""

from __future__ import annotations

from functools import partial

from daguerre.camera.ideal import IDEAL
from daguerre.parameters.parameter import Parameter

from . import needs

_QUOTED = " or ".join(f'``"{name}"``' for name in IDEAL)
LensRow = partial(Parameter, panel="Lens")

#: Camera of a scene; no parameter of the camera itself.
CHOICE = Parameter(
    "camera",
    "Camera of the scene to use, by name",
    kind="text",
    default_words="the scene's default camera",
    panel="Camera",
    flags=("-c", "--camera"),
    metavar="NAME",
    more="Commas separate several",
    explained=("cli.md#several-cameras",),
)

LENS = (
    LensRow(
        "lens",
        "Lens: a library name (see `daguerre lenses`), a lens file, thin or pinhole",
        kind="text",
        flags=("--lens",),
        metavar="|".join(("LENS", *IDEAL)),
        default_words="the scene's, else thin",
        in_python=f"Library name, file, ``Lens``, {_QUOTED}; default: thin.",
        explained=("lens-format.md", "lens-import.md"),
        needs=(needs.LENS_ITSELF,),
    ),
    LensRow(
        "lens_model",
        "Optical model of the lens",
        kind="choice",
        choices=needs.MODELS,
        flags=("--lens-model",),
        default_words="exact if {lens} has a prescription",
        explained=("lens-models.md",),
        needs=(needs.LENS_ITSELF,),
    ),
    LensRow(
        "projection",
        "A calibration, or the formula of a fisheye or a panorama, instead of a lens",
        kind="value",
        more="It combines with {f_stop} (None: everything is sharp), focus and the width of "
        "{sensor_size}. Keys of one motion must share model and size",
        movable=True,
    ),
    LensRow(
        "degree",
        "Degree of a polynomial lens, odd, 1 to 13",
        kind="whole",
        low=1,
        high=13,
        odd=True,
        wants="an odd number from 1 to 13",
        flags=("--degree",),
        metavar="N",
        usual=7,
        tells_default=True,
        explained=("polynomial.md",),
        needs=(needs.OF_LENSES, needs.FITTED),
    ),
    LensRow(
        "fit_tolerance",
        "RMS error of a polynomial lens, px, above which the exact lens replaces it",
        "px",
        above=0,
        flags=("--fit-tolerance",),
        metavar="PX",
        usual=0.5,
        tells_default=True,
        needs=(needs.OF_LENSES, needs.FITTED),
    ),
    LensRow(
        "focal_length",
        "Focal length of an ideal lens, mm",
        "mm",
        low=1e-3,
        high=1e6,
        above=0,
        flags=("--focal-length",),
        metavar="MM",
        usual=50.0,
        tells_default=True,
        more="A lens with a prescription has its own focal length; any other is an error",
        needs=(needs.LENS_ITSELF, needs.WITHOUT_PRESCRIPTION),
        movable=True,
    ),
    LensRow(
        "zoom",
        "Focal length to set a zoom lens to, mm",
        "mm",
        low=1e-3,
        high=1e6,
        above=0,
        flags=("--zoom",),
        metavar="MM",
        default_words="as its lens file says",
        more="`daguerre lenses` shows the range",
        needs=(needs.OF_LENSES, needs.ZOOM),
        movable=True,
    ),
    LensRow(
        "dispersion",
        "Whether glass bends colours differently; without it a lens has no colour fringes",
        default=True,
        kind="flag",
        flags=("--dispersion/--no-dispersion",),
        more="Without it each glass has its index at 587.56 nm at all wavelengths. Its absorption "
        "and its coatings keep their colours",
        explained=("lens-models.md#dispersion",),
        needs=(needs.OF_LENSES, needs.PRESCRIPTION),
    ),
)
