"""Parameters of the body: glass and sensor behind the lens, scatter, and how the lens stands."""

from __future__ import annotations

from functools import partial

from daguerre import units
from daguerre.camera.lens_scatter import LensScatter
from daguerre.parameters.parameter import Parameter

from . import needs, typed

_Row = partial(Parameter, panel="Film and sensor")
_LensRow = partial(Parameter, panel="Lens")
#: mm; of a camera for which no other is said
FULL_FRAME = (36.0, 24.0)

_Part = partial(
    _LensRow, explained=("scatter.md#the-parts",), needs=(needs.SCATTER,), tells_default=True
)
GHOSTS = (
    _LensRow(
        "cover_glass",
        "Cover glass in front of the sensor: thickness and gap to the sensor, mm, and index "
        "(1.5168 if left out); it adds ghosts to {flare}",
        "mm",
        kind="value",
        flags=("--cover-glass",),
        metavar="MM,GAP[,INDEX]",
        parse=typed.cover_glass,
        in_python="Cover glass in front of the sensor: thickness and gap to the sensor, mm, and "
        "optionally its index [1.5168]. It adds ghosts (``flare``) and nothing else.",
        explained=("flare.md#the-body",),
        needs=(needs.GHOSTS,),
    ),
    _LensRow(
        "sensor_reflectance",
        "Share of light that the sensor reflects back into the lens, 0 to 1; it adds ghosts to "
        "{flare}",
        default=0.0,
        low=0,
        high=1,
        wants="0 .. 1 (no surface reflects more light than arrives)",
        flags=("--sensor-reflectance",),
        metavar="R",
        tells_default=True,
        explained=("flare.md#the-body",),
        needs=(needs.GHOSTS,),
    ),
)

#: parts of a ``LensScatter``, which checks them
PARTS = (
    _Part(
        "scatter.barrel",
        "Share of light that the barrel and the edges of the glass scatter, for --scatter",
        default=LensScatter.barrel,
        flags=("--scatter-barrel",),
        metavar="SHARE",
    ),
    _Part(
        "scatter.blades",
        "Share of light that the iris blades scatter, for --scatter",
        default=LensScatter.blades,
        flags=("--scatter-blades",),
        metavar="SHARE",
    ),
    _Part(
        "scatter.surface_rms_nm",
        "RMS roughness of the polished surfaces, nm, for --scatter",
        "nm",
        default=LensScatter.surface_rms_nm,
        flags=("--scatter-surface-nm",),
        metavar="NM",
    ),
)

SENSOR = (
    _LensRow(
        "scatter",
        "Scatter of an exact lens",
        kind="value",
        in_python="Scatter by barrel, blades and surfaces of an exact lens, drawn if rendering has "
        "``scatter`` on (``docs/scatter.md``); default: a well-made lens.",
        needs=(needs.SCATTER,),
    ),
    _Row(
        "sensor",
        "Sensor: a library name (see `daguerre sensors`) or a file, which adds its channels to the "
        "picture; or a size, mm",
        "mm",
        kind="value",
        flags=("--sensor",),
        metavar="SENSOR|WxH|" + "|".join(units.SENSORS),
        parse=typed.sensor,
        default_words=f"{FULL_FRAME[0]:g}x{FULL_FRAME[1]:g}",
        in_python="``Sensor``, library name, or file. The frame then also holds the sensor's "
        "channels. Its size is used unless ``sensor_size`` is given.",
        explained=("exposure.md", "sensors.md"),
    ),
    _Row(
        "sensor_size",
        "Width and height of the sensor, mm",
        "mm",
        FULL_FRAME,
        "size",
        low=1e-3,
        high=1e5,
        wants="two positive mm",
        tells_default=True,
        movable=True,
    ),
    _Row(
        "sensor_fit",
        "Side of the sensor that the picture spans",
        default="horizontal",
        kind="choice",
        choices=("horizontal", "vertical", "auto", "fill"),
        flags=("--fit",),
        tells_default=True,
        needs=(needs.OF_LENSES,),
    ),
)

STANDING = (
    _Row(
        "shift",
        "Shift of the film, right and up, mm",
        "mm",
        (0.0, 0.0),
        "numbers",
        low=-1e5,
        high=1e5,
        wants="two finite numbers (mm)",
        flags=("--shift",),
        metavar="X,Y",
        parse=typed.pair("0,8.5"),
        default_words="0,0",
        needs=(needs.OF_LENSES,),
        movable=True,
    ),
    _Row(
        "tilt",
        "Tilt of the lens about x (up) and y (left), degrees",
        "deg",
        (0.0, 0.0),
        "numbers",
        low=-45,
        high=45,
        wants="two finite angles (degrees)",
        flags=("--tilt",),
        metavar="X,Y",
        parse=typed.pair("0,6"),
        default_words="0,0",
        more="The lens turns about its entrance pupil. The film stays perpendicular to the "
        "camera's axis, and the point straight ahead stays in the middle of the picture. The focus "
        "distance is measured along the lens's axis",
        needs=(needs.LENS_ITSELF,),
        movable=True,
    ),
    Parameter(
        "near_clip",
        "Distance of the near clipping plane along the axis, m; 0: no clipping",
        "m",
        default=0.0,
        low=0,
        high=1e9,
        flags=("--near-clip",),
        metavar="M",
        panel="Camera",
        tells_default=True,
        more="Clipped surfaces still cast shadows and are visible in mirrors. A lens that sees to "
        "the side has a sphere instead",
        explained=("lens-models.md#the-near-clipping-plane",),
    ),
    _LensRow(
        "decenter",
        "Shift X,Y (mm) and tilt AX,AY (degrees) of the lens surfaces FIRST to LAST; repeatable",
        "mm, deg",
        (),
        "value",
        flags=("--decenter",),
        metavar="FIRST-LAST:X,Y[,AX,AY]",
        parse=units.decenter,
        repeated=True,
        more="Surface 0 is the front",
        in_python="Elements of a prescription off their axis, as in a lens that was dropped. For "
        "each: index of its first and last surface, shift along x and y in mm, and tilt about x "
        "and y in degrees.",
        needs=(needs.OF_LENSES, needs.PRESCRIPTION, needs.ELEMENTS),
    ),
)
