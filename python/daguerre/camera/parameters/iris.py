"""Parameters of the iris, and of dust and grooves in the glass."""

from __future__ import annotations

from functools import partial

from daguerre.parameters.parameter import Parameter

from . import needs, typed

_Row = partial(Parameter, panel="Aperture")
_LensRow = partial(Parameter, panel="Lens")
_Mask = partial(_LensRow, kind="picture", metavar="FILE", needs=(needs.ELEMENTS,))

IRIS = (
    _Row(
        "blades",
        "Number of iris blades; 0 is round",
        default=0,
        tells_default=True,
        kind="whole",
        low=0,
        high=64,
        wants="0 (round) or 3 .. 64",
        flags=("--blades",),
        metavar="N",
        movable=True,
    ),
    _Row(
        "blade_rotation",
        "Rotation of the iris blades, degrees",
        "deg",
        default=0.0,
        tells_default=True,
        flags=("--blade-rotation",),
        metavar="DEG",
        movable=True,
    ),
    _Row(
        "blade_curvature",
        "Curvature of the iris blades, -1 to 1; 0 is straight, 1 round",
        default=0.0,
        tells_default=True,
        low=-1,
        high=1,
        flags=("--blade-curvature",),
        metavar="C",
        movable=True,
    ),
    _Row(
        "aperture_image",
        "Grey picture of the iris opening, instead of {blades}",
        kind="picture",
        flags=("--aperture-image",),
        metavar="FILE",
        in_python="Grey picture (H, W) of the iris opening, instead of blades.",
        needs=(needs.OPENING,),
    ),
    _Mask(
        "front_mask",
        "Grey picture of dust and scratches on the front of an exact lens",
        flags=("--front-mask",),
        more="It spans the clear diameter of the front; white lets all light through",
        in_python="Grey picture (H, W) of dust and scratches on the front of an exact lens. It "
        "spans the clear diameter of the front; 1 lets all light through.",
    ),
    _Mask(
        "iris_mask",
        "Grey picture of dust and scratches at the iris of an exact lens",
        flags=("--iris-mask",),
        more="It spans the iris at its widest",
        in_python="Grey picture (H, W) of dust and scratches at the iris of an exact lens. It "
        "spans the iris at its widest.",
    ),
    _LensRow(
        "ripple",
        "Grinding grooves in the aspheric surfaces: RMS height, nm, and period, um",
        "nm, um",
        kind="value",
        flags=("--ripple",),
        metavar="NM,UM",
        parse=typed.pair("2,100"),
        more="They show as onion rings",
        in_python="Grinding grooves in the aspheric surfaces of an exact lens, which show as onion "
        "rings: RMS height (nm), period (um), and optionally a seed.",
        needs=(needs.OF_LENSES, needs.ELEMENTS, needs.ROUGH),
    ),
)
