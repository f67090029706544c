"""Parameters of stop and focus."""

from __future__ import annotations

from functools import partial

from daguerre import units
from daguerre.parameters.parameter import Parameter

from . import needs, typed

_Row = partial(Parameter, panel="Aperture")
_FocusRow = partial(Parameter, panel="Focus")
_F_STOP = 5.6
_NO_PINHOLE = "; for a pinhole, set lens to pinhole"

STOP = (
    _Row(
        "f_stop",
        "F-number: focal length / entrance pupil diameter",
        low=1e-2,
        high=1e9,
        above=0,
        hint=_NO_PINHOLE,
        flags=("--f-stop", "--fstop", "--aperture"),
        metavar="N",
        parse=units.f_number,
        usual=_F_STOP,
        default_words=f"the scene's, else {_F_STOP:g} or the lens's widest if that is slower",
        in_python="F-number: focal length / entrance pupil diameter; default: "
        f"{_F_STOP:g}, or the lens's widest if that is slower.",
        needs=(needs.OPENING,),
        rivals="stop",
        movable=True,
    ),
    _Row(
        "t_stop",
        "F-number corrected for light lost in the glass, instead of {f_stop}",
        low=1e-2,
        high=1e9,
        above=0,
        hint=_NO_PINHOLE,
        flags=("--t-stop",),
        metavar="N",
        parse=units.t_number,
        more="It is f-stop / sqrt(transmittance): the f-number of a lossless lens that is as "
        "bright on the axis",
        needs=(needs.LENS_ITSELF, needs.OPENING, needs.T_STOP),
        rivals="stop",
    ),
    _Row(
        "aperture_diameter",
        "Entrance pupil diameter of a thin lens, mm, instead of {f_stop}",
        "mm",
        low=1e-9,
        high=1e6,
        above=0,
        hint=_NO_PINHOLE,
        flags=("--aperture-diameter",),
        metavar="MM",
        needs=(needs.LENS_ITSELF, needs.OPENING, needs.APERTURE, needs.IDEAL),
        rivals="stop",
        movable=True,
    ),
)

FOCUS = (
    _FocusRow(
        "focus_distance",
        "Focus distance, m, or inf",
        "m",
        low=1e-6,
        high=1e12,
        above=0,
        infinite=True,
        flags=("--focus",),
        metavar="M",
        default_words="the scene's, else autofocus",
        more="{focus_from} sets where it is measured from. Autofocus uses the center of the "
        "picture",
        in_python="Focus distance, m, or inf; default: autofocus on the center of the picture. "
        "``focus_from`` sets where it is measured from.",
        rivals="focus",
        movable=True,
    ),
    _FocusRow(
        "focus_at",
        "Focus on the surface that the pixel X,Y shows",
        "px",
        kind="numbers",
        wants="a pixel (x, y)",
        flags=("--focus-at",),
        metavar="X,Y",
        parse=typed.pair("480,270"),
        in_python="Pixel (x, y) to focus on: the surface that it shows becomes sharp.",
        rivals="focus",
    ),
    _FocusRow(
        "focus_on",
        "Focus on the nearest surface point of the node NODE; `daguerre info` lists names",
        kind="text",
        flags=("--focus-on",),
        metavar="NODE",
        in_python="Name of a node to focus on: its nearest surface point becomes sharp.",
        rivals="focus",
    ),
    _FocusRow(
        "focus_from",
        "Point that the focus distance is measured from",
        default="pupil",
        kind="choice",
        choices=("pupil", "sensor"),
        flags=("--focus-from",),
        tells_default=True,
    ),
    _FocusRow(
        "focus_by",
        "Focus criterion (rays near the axis, or smallest spot on the axis)",
        default="paraxial",
        kind="choice",
        choices=("paraxial", "best"),
        flags=("--focus-by",),
        tells_default=True,
        needs=(needs.OF_LENSES,),
    ),
    _FocusRow(
        "focus_breathing",
        "Thin lens: narrow the field of view in close focus",
        default=False,
        kind="flag",
        flags=("--focus-breathing/--no-focus-breathing",),
        more="The focal length stays fixed, as in a real lens that focuses by moving as a whole; "
        "without it the field of view stays fixed",
        needs=(needs.OF_LENSES,),
    ),
)
