"""Flags of the camera, in a photographer's units, for every command that looks through one.

Annotations must be real objects here (see ``flags.py``), so no ``annotations`` future.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from daguerre import units as q
from daguerre.errors import UsageError, suggest
from daguerre.units import SENSORS, sensor_mm

from .groups import Text, option

_CAMERA = "Camera"


@dataclass(frozen=True)
class CameraFlags:
    """The camera in a photographer's units; what is not given stays as the file says."""

    camera: Annotated[
        Text,
        option(
            "-c", "--camera", metavar="NAME", help="Camera of the scene, by name.", panel=_CAMERA
        ),
    ] = None
    lens: Annotated[
        Text,
        option(
            "--lens",
            metavar="NAME|FILE|thin|pinhole",
            help="Lens of the library or a lens file; see `daguerre lenses`.",
            panel=_CAMERA,
        ),
    ] = None
    lens_model: Annotated[
        Text,
        option(
            "--lens-model",
            metavar="exact|polynomial|thick|thin|pinhole",
            help="How the lens is computed [exact if --lens names one].",
            panel=_CAMERA,
        ),
    ] = None
    degree: Annotated[
        int | None,
        option(
            "--degree",
            metavar="N",
            help="Degree of a polynomial lens, odd, 1 to 13 [7].",
            panel=_CAMERA,
        ),
    ] = None
    fit_tolerance: Annotated[
        float | None,
        option(
            "--fit-tolerance",
            metavar="PX",
            help="RMS error, px, above which the exact lens replaces a polynomial one [0.5].",
            panel=_CAMERA,
        ),
    ] = None
    focal_length: Annotated[
        Text,
        option(
            "--focal-length",
            metavar="MM",
            help="Focal length of an ideal lens, mm [50].",
            panel=_CAMERA,
        ),
    ] = None
    zoom: Annotated[
        Text,
        option(
            "--zoom",
            metavar="MM",
            help="Focal length at which a zoom lens stands, mm.",
            panel=_CAMERA,
        ),
    ] = None
    f_stop: Annotated[
        Text,
        option(
            "--f-stop",
            "--fstop",
            "--aperture",
            metavar="N",
            help="Focal length / entrance pupil diameter.",
            panel=_CAMERA,
        ),
    ] = None
    t_stop: Annotated[
        Text,
        option(
            "--t-stop",
            metavar="N",
            help="F-number corrected for light lost in the glass, instead of --f-stop.",
            panel=_CAMERA,
        ),
    ] = None
    aperture_diameter: Annotated[
        Text,
        option(
            "--aperture-diameter",
            metavar="MM",
            help="Entrance pupil diameter, mm, instead of --f-stop.",
            panel=_CAMERA,
        ),
    ] = None
    focus: Annotated[
        Text,
        option(
            "--focus",
            metavar="M",
            help="Focus distance, m, or inf [the file's, else autofocus].",
            panel=_CAMERA,
        ),
    ] = None
    focus_at: Annotated[
        Text,
        option(
            "--focus-at",
            metavar="X,Y",
            help="Focus on the surface that this pixel shows.",
            panel=_CAMERA,
        ),
    ] = None
    focus_on: Annotated[
        Text,
        option(
            "--focus-on",
            metavar="NODE",
            help="Focus on the nearest surface point of this node.",
            panel=_CAMERA,
        ),
    ] = None
    focus_from: Annotated[
        Text,
        option(
            "--focus-from",
            metavar="pupil|sensor",
            help="Where the focus distance starts [pupil].",
            panel=_CAMERA,
        ),
    ] = None
    focus_by: Annotated[
        Text,
        option(
            "--focus-by",
            metavar="paraxial|best",
            help="Focus of rays near the axis, or smallest spot on the axis [paraxial].",
            panel=_CAMERA,
        ),
    ] = None
    focus_breathing: Annotated[
        bool | None,
        option(
            "--focus-breathing/--no-focus-breathing",
            help="Thin lens: narrow the field in close focus.",
            panel=_CAMERA,
        ),
    ] = None
    blades: Annotated[
        int | None,
        option("--blades", metavar="N", help="Number of iris blades; 0 is round.", panel=_CAMERA),
    ] = None
    blade_rotation: Annotated[
        Text,
        option(
            "--blade-rotation",
            metavar="DEG",
            help="Rotation of the iris blades, degrees.",
            panel=_CAMERA,
        ),
    ] = None
    blade_curvature: Annotated[
        float | None,
        option(
            "--blade-curvature",
            metavar="C",
            help="Curvature of the iris blades, -1 to 1; 1 is round.",
            panel=_CAMERA,
        ),
    ] = None
    aperture_image: Annotated[
        Path | None,
        option(
            "--aperture-image",
            metavar="FILE",
            help="Grey picture that shapes the iris.",
            panel=_CAMERA,
        ),
    ] = None
    front_mask: Annotated[
        Path | None,
        option(
            "--front-mask",
            metavar="FILE",
            help="Grey picture of dust and scratches on the front of an exact lens.",
            panel=_CAMERA,
        ),
    ] = None
    iris_mask: Annotated[
        Path | None,
        option(
            "--iris-mask",
            metavar="FILE",
            help="Grey picture of dust and scratches at the iris of an exact lens.",
            panel=_CAMERA,
        ),
    ] = None
    ripple: Annotated[
        Text,
        option(
            "--ripple",
            metavar="NM,UM",
            help="Grooves in the aspheric surfaces: RMS height, nm, and period, um.",
            panel=_CAMERA,
        ),
    ] = None
    cover_glass: Annotated[
        Text,
        option(
            "--cover-glass",
            metavar="MM,GAP[,INDEX]",
            help="Cover glass before the sensor, and the gap behind it, mm; it makes ghosts.",
            panel=_CAMERA,
        ),
    ] = None
    sensor_reflectance: Annotated[
        float | None,
        option(
            "--sensor-reflectance",
            metavar="R",
            help="Share of light that the sensor sends back into the lens, 0 to 1 [0].",
            panel=_CAMERA,
        ),
    ] = None
    scatter_barrel: Annotated[
        float | None,
        option(
            "--scatter-barrel",
            metavar="SHARE",
            help="Share of light that barrel and glass edges scatter, for --scatter [0.03].",
            panel=_CAMERA,
        ),
    ] = None
    scatter_blades: Annotated[
        float | None,
        option(
            "--scatter-blades",
            metavar="SHARE",
            help="Share of light that the iris blades scatter, for --scatter [0.03].",
            panel=_CAMERA,
        ),
    ] = None
    scatter_surface_nm: Annotated[
        float | None,
        option(
            "--scatter-surface-nm",
            metavar="NM",
            help="RMS roughness of the polished surfaces, nm, for --scatter [1].",
            panel=_CAMERA,
        ),
    ] = None
    sensor: Annotated[
        Text,
        option(
            "--sensor",
            metavar="NAME|FILE|WxH|" + "|".join(q.SENSORS),
            help="Sensor of the library (`daguerre sensors`) or a file, whose channels the "
            "picture then has too; or a size, mm [36x24].",
            panel=_CAMERA,
        ),
    ] = None
    fit: Annotated[
        Text,
        option(
            "--fit",
            metavar="horizontal|vertical|auto|fill",
            help="Side of the sensor that the picture spans [horizontal].",
            panel=_CAMERA,
        ),
    ] = None
    shift: Annotated[
        Text,
        option(
            "--shift", metavar="X,Y", help="Shift of the film, right and up, mm.", panel=_CAMERA
        ),
    ] = None
    tilt: Annotated[
        Text,
        option(
            "--tilt",
            metavar="X,Y",
            help="Turn of the lens about x (up) and y (left), degrees.",
            panel=_CAMERA,
        ),
    ] = None
    decenter: Annotated[
        list[str] | None,
        option(
            "--decenter",
            metavar="FIRST-LAST:X,Y[,AX,AY]",
            help="Shift (mm) and tilt (degrees) of these surfaces of the lens; repeatable.",
            panel=_CAMERA,
        ),
    ] = None
    iso: Annotated[
        float | None,
        option(
            "--iso", metavar="N", help="Sensitivity of developed pictures [100].", panel=_CAMERA
        ),
    ] = None
    ev: Annotated[
        float | None,
        option(
            "--ev",
            metavar="EV",
            help="Exposure compensation of developed pictures, EV [0].",
            panel=_CAMERA,
        ),
    ] = None
    exposure_time: Annotated[
        Text,
        option(
            "--exposure-time",
            metavar="S",
            help="Exposure time that sets brightness, s; motion blur keeps --shutter [--shutter].",
            panel=_CAMERA,
        ),
    ] = None
    exposure_f_stop: Annotated[
        Text,
        option(
            "--exposure-f-stop",
            metavar="N",
            help="F-stop that sets brightness; blur keeps --f-stop [--f-stop; of a pinhole 8].",
            panel=_CAMERA,
        ),
    ] = None
    responsivity: Annotated[
        float | None,
        option("--responsivity", metavar="X", help="Factor on the exposure [1].", panel=_CAMERA),
    ] = None
    wb: Annotated[
        Text,
        option(
            "--wb",
            metavar="K|X,Y",
            help="White balance for development: kelvins such as 5600, or a chromaticity.",
            panel=_CAMERA,
        ),
    ] = None
    natural_vignetting: Annotated[
        bool | None,
        option(
            "--natural-vignetting/--no-natural-vignetting",
            help="Thin lens and pinhole: darken by cos^4 of the field angle.",
            panel=_CAMERA,
        ),
    ] = None

    def changes(self) -> dict[str, Any]:
        """The parameters of ``Camera.with_`` that were given."""
        parsers: dict[str, tuple[str, str, Callable[[str, str], Any]]] = {
            "focal_length": ("focal_length", "--focal-length", q.length_mm),
            "zoom": ("zoom", "--zoom", q.length_mm),
            "f_stop": ("f_stop", "--f-stop", q.f_number),
            "t_stop": ("t_stop", "--t-stop", q.t_number),
            "aperture_diameter": ("aperture_diameter", "--aperture-diameter", q.length_mm),
            "focus": ("focus_distance", "--focus", q.distance_m),
            "focus_at": ("focus_at", "--focus-at", lambda f, t: q.numbers(f, t, 2, "480,270")),
            "blade_rotation": ("blade_rotation", "--blade-rotation", q.angle_deg),
            "shift": ("shift", "--shift", lambda f, t: q.numbers(f, t, 2, "0,8.5")),
            "ripple": ("ripple", "--ripple", lambda f, t: q.numbers(f, t, 2, "2,100")),
            "cover_glass": ("cover_glass", "--cover-glass", _cover_glass),
            "exposure_time": ("exposure_time", "--exposure-time", q.time_s),
            "exposure_f_stop": ("exposure_f_stop", "--exposure-f-stop", q.f_number),
            "wb": ("white_balance", "--wb", q.white),
            "tilt": ("tilt", "--tilt", lambda f, t: q.numbers(f, t, 2, "0,6")),
        }
        plain = {
            "lens": "lens",
            "lens_model": "lens_model",
            "degree": "degree",
            "fit_tolerance": "fit_tolerance",
            "focus_on": "focus_on",
            "focus_from": "focus_from",
            "focus_by": "focus_by",
            "focus_breathing": "focus_breathing",
            "blades": "blades",
            "blade_curvature": "blade_curvature",
            "fit": "sensor_fit",
            "iso": "iso",
            "ev": "exposure_compensation",
            "responsivity": "responsivity",
            "sensor_reflectance": "sensor_reflectance",
            "natural_vignetting": "natural_vignetting",
        }
        out: dict[str, Any] = {}
        for name, (parameter, flag, parse) in parsers.items():
            text = getattr(self, name)
            if text is not None:
                out[parameter] = parse(flag, text)
        for name, parameter in plain.items():
            if getattr(self, name) is not None:
                out[parameter] = getattr(self, name)
        if self.sensor is not None:
            out |= sensor("--sensor", self.sensor)
        if self.decenter:
            out["decenter"] = tuple(q.decenter("--decenter", text) for text in self.decenter)
        for name in ("aperture_image", "front_mask", "iris_mask"):
            path = getattr(self, name)
            if path is not None:
                from daguerre.io.iris import read_grey

                out[name] = read_grey(path)
        if parts := self._scatter():
            from daguerre.camera.lens_scatter import LensScatter

            out["scatter"] = LensScatter(**parts)
        return _refuse_rivals(out)

    def _scatter(self) -> dict[str, Any]:
        given = {
            "barrel": self.scatter_barrel,
            "blades": self.scatter_blades,
            "surface_rms_nm": self.scatter_surface_nm,
        }
        return {name: value for name, value in given.items() if value is not None}


def _cover_glass(flag: str, text: str) -> tuple[float, ...]:
    return q.numbers(flag, text, 3 if text.count(",") > 1 else 2, "2,1")


def _refuse_rivals(changes: dict[str, Any]) -> dict[str, Any]:
    """One way to focus and one to open the iris may be given."""
    from daguerre.errors import UsageError

    for rivals in (
        {"focus_distance": "--focus", "focus_at": "--focus-at", "focus_on": "--focus-on"},
        {"f_stop": "--f-stop", "t_stop": "--t-stop", "aperture_diameter": "--aperture-diameter"},
    ):
        given = [name for name in rivals if name in changes]
        if len(given) > 1:
            flags = " and ".join(rivals[name] for name in given)
            raise UsageError(f"{flags}: wanted one of them, got {len(given)}")
    return changes


def sensor(flag: str, text: str) -> dict[str, Any]:
    """Parameters of a camera: a size (``sensor_mm``), or a sensor of the library or a file."""
    name = text.strip().lower()
    if name in SENSORS or (name[:1].isdigit() and "x" in name):
        return {"sensor_size": sensor_mm(flag, text)}
    from daguerre import sensors

    known = sensors.names()
    if text not in known and Path(text).suffix.lower() != ".json":
        raise UsageError(
            f"{flag}: wanted a sensor ({', '.join(known)}, or a .json file), a size in mm such as "
            f"36x24, or one of {', '.join(SENSORS)}; got {text!r}"
            f"{suggest(name, [*known, *SENSORS])}"
        )
    return {"sensor": sensors.load(text)}
