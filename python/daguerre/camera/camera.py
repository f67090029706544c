"""A camera in a photographer's terms.

Units are those engraved on real equipment: mm for lens and sensor, m for distances, s for time,
degrees for angles.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import shown
from daguerre.errors import UsageError, suggest
from daguerre.files.value import Value, changed
from daguerre.motion.values import Composite, Dynamic, is_dynamic, moves

from .ideal import IDEAL, WITHOUT_IRIS
from .parameters import CAMERA, FULL_FRAME, MOVABLE
from .parameters.needs import OPENING

if TYPE_CHECKING:
    from daguerre.calibration.cameras import CalibratedCameras
    from daguerre.files.source import Source
    from daguerre.lenses import Lens
    from daguerre.sensors import Sensor

    from .lens_scatter import LensScatter
    from .projection import Projection
    from .rolling_shutter import RollingShutter, ShutterCurve


_default = CAMERA.default


#: (first, last), (x, y), (about x, about y): surfaces of a lens, moved by mm and turned by degrees
Decenter = tuple[tuple[int, int], tuple[float, float], tuple[float, float]]


@dataclass(frozen=True, eq=False)
class Camera(Value):
    """A camera in a photographer's terms; ``with_`` makes changed copies.

    Parameters in ``MOVABLE`` may be values over time (:func:`daguerre.keys`). ``motion`` keeps
    these, and the parameter itself holds the value at one moment, which ``evaluated_at`` chooses.
    A picture has the exposure and the shutter of its own time.

    Attributes:
        transform: World from camera, shape (4, 4), m; the camera looks along its -z, +y is up.
        lens: Library name, file, ``Lens``, ``"thin"`` or ``"pinhole"``; default: thin.
        lens_model: Optical model of the lens: exact, polynomial, thick, thin or pinhole; default:
            exact if ``lens`` has a prescription.
        projection: A calibration, or the formula of a fisheye or a panorama, instead of a lens. It
            combines with ``f_stop`` (None: everything is sharp), focus and the width of
            ``sensor_size``. Keys of one motion must share model and size.
        degree: Degree of a polynomial lens, odd, 1 to 13; default: 7.
        fit_tolerance: RMS error of a polynomial lens, px, above which the exact lens replaces it;
            default: 0.5.
        focal_length: Focal length of an ideal lens, mm; default: 50. A lens with a prescription has
            its own focal length; any other is an error.
        zoom: Focal length to set a zoom lens to, mm; default: as its lens file says. ``daguerre
            lenses`` shows the range.
        decenter: Elements of a prescription off their axis, as in a lens that was dropped. For
            each: index of its first and last surface, shift along x and y in mm, and tilt about x
            and y in degrees.
        sensor: ``Sensor``, library name, or file. The frame then also holds the sensor's channels.
            Its size is used unless ``sensor_size`` is given.
        sensor_size: Width and height of the sensor, mm; default: 36 x 24.
        sensor_fit: Side of the sensor that the picture spans: horizontal, vertical, auto or fill;
            default: horizontal.
        f_stop: F-number: focal length / entrance pupil diameter; default: 5.6, or the lens's widest
            if that is slower.
        aperture_diameter: Entrance pupil diameter of a thin lens, mm, instead of ``f_stop``.
        t_stop: F-number corrected for light lost in the glass, instead of ``f_stop``. It is f-stop
            / sqrt(transmittance): the f-number of a lossless lens that is as bright on the axis.
        focus_distance: Focus distance, m, or inf; default: autofocus on the center of the picture.
            ``focus_from`` sets where it is measured from.
        focus_at: Pixel (x, y) to focus on: the surface that it shows becomes sharp.
        focus_on: Name of a node to focus on: its nearest surface point becomes sharp.
        focus_from: Point that the focus distance is measured from: pupil or sensor; default: pupil.
        focus_by: Focus criterion (rays near the axis, or smallest spot on the axis): paraxial or
            best; default: paraxial.
        focus_breathing: Thin lens: narrow the field of view in close focus. The focal length stays
            fixed, as in a real lens that focuses by moving as a whole; without it the field of view
            stays fixed.
        blades: Number of iris blades; 0 is round; default: 0.
        blade_rotation: Rotation of the iris blades, degrees; default: 0.
        blade_curvature: Curvature of the iris blades, -1 to 1; 0 is straight, 1 round; default: 0.
        aperture_image: Grey picture (H, W) of the iris opening, instead of blades.
        front_mask: Grey picture (H, W) of dust and scratches on the front of an exact lens. It
            spans the clear diameter of the front; 1 lets all light through.
        iris_mask: Grey picture (H, W) of dust and scratches at the iris of an exact lens. It spans
            the iris at its widest.
        ripple: Grinding grooves in the aspheric surfaces of an exact lens, which show as onion
            rings: RMS height (nm), period (um), and optionally a seed.
        cover_glass: Cover glass in front of the sensor: thickness and gap to the sensor, mm, and
            optionally its index [1.5168]. It adds ghosts (``flare``) and nothing else.
        sensor_reflectance: Share of light that the sensor reflects back into the lens, 0 to 1; it
            adds ghosts to ``flare``; default: 0.
        scatter: Scatter by barrel, blades and surfaces of an exact lens, drawn if rendering has
            ``scatter`` on (``docs/scatter.md``); default: a well-made lens.
        natural_vignetting: Thin lens and pinhole: darken by cos^4 of the field angle.
        shift: Shift of the film, right and up, mm; default: 0,0.
        tilt: Tilt of the lens about x (up) and y (left), degrees; default: 0,0. The lens turns
            about its entrance pupil. The film stays perpendicular to the camera's axis, and the
            point straight ahead stays in the middle of the picture. The focus distance is measured
            along the lens's axis.
        shutter_time: Time for which each point of the film is exposed, s; 0 freezes motion.
            Default: from ``shutter_angle``.
        shutter_angle: Exposure time as a shutter angle, degrees; 360 is a whole frame; default:
            180. It equals 360 x ``fps`` x ``shutter_time``.
        fps: Frames per second, such as 24000/1001; default: 24. Shutter angles, shutter offsets and
            sequences use it.
        shutter_offset: Time at which the shutter opens, in frames from the scene's time; default:
            the exposure is centred on that time.
        shutter_type: Shutter type: box, leaf, focal_plane, rotary or electronic; default: box;
            electronic with ``rolling_shutter``.
        shutter_curve: Opening of the shutter over time: box, ("trapezoid", efficiency) or points
            (fraction of the time, opening); for a leaf shutter, the radius of the iris.
        rolling_shutter: Rolling shutter, which exposes lines of pixels in turn; default: by the
            shutter type.
        iso: ISO speed of developed pictures; in the exposure mode light it sets the noise alone;
            default: 100.
        exposure_compensation: Exposure compensation, EV; in every mode; default: 0.
        exposure_time: Exposure time that sets brightness, s; motion blur keeps ``shutter_time``;
            default: ``shutter_time``.
        exposure_f_stop: F-stop that sets brightness; depth of field keeps ``f_stop``; default:
            ``f_stop``; for a pinhole 8.
        responsivity: Factor that scales the exposure; default: 1.
        white_balance: White for development: colour temperature, K, or chromaticity (x, y).
        motion: Parameters that change over time, by name.
        near_clip: Distance of the near clipping plane along the axis, m; 0: no clipping; default:
            0. Clipped surfaces still cast shadows and are visible in mirrors. A lens that sees to
            the side has a sphere instead.
        dispersion: Whether glass bends colours differently; without it a lens has no colour
            fringes. Without it each glass has its index at 587.56 nm at all wavelengths. Its
            absorption and its coatings keep their colours.
        exposure: Exposure mode: ``light`` (1 is white), ``manual`` (ISO, time and f-stop count), or
            a meter sets the ISO (``auto``), the time (``A``), the f-stop (``S``) or both (``P``);
            default: light. No parameter of exposure changes the linear picture.
        meter: Metering pattern: centre, spot, matrix or highlight; spot:X,Y and spot:NODE read the
            spot at a pixel or a node; default: centre.
    """

    transform: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    lens: str | Lens | None = None
    lens_model: str | None = None
    projection: Projection | None = None
    degree: int | None = None
    fit_tolerance: float | None = None
    focal_length: float | None = None
    zoom: float | None = None
    decenter: tuple[Decenter, ...] = _default("decenter")
    sensor: str | Path | Sensor | None = None
    sensor_size: tuple[float, float] = _default("sensor_size")
    sensor_fit: str = _default("sensor_fit")
    f_stop: float | None = None
    aperture_diameter: float | None = None
    t_stop: float | None = None
    focus_distance: float | None = None
    focus_at: tuple[float, float] | None = None
    focus_on: str | None = None
    focus_from: str = _default("focus_from")
    focus_by: str = _default("focus_by")
    focus_breathing: bool = _default("focus_breathing")
    blades: int = _default("blades")
    blade_rotation: float = _default("blade_rotation")
    blade_curvature: float = _default("blade_curvature")
    aperture_image: NDArray[np.float32] | None = None
    front_mask: NDArray[np.float32] | None = None
    iris_mask: NDArray[np.float32] | None = None
    ripple: tuple[float, ...] | None = None
    cover_glass: tuple[float, ...] | None = None
    sensor_reflectance: float = _default("sensor_reflectance")
    scatter: LensScatter | None = None
    natural_vignetting: bool = _default("natural_vignetting")
    shift: tuple[float, float] = _default("shift")
    tilt: tuple[float, float] = _default("tilt")
    shutter_time: float | None = None
    shutter_angle: float | None = None
    fps: float = _default("fps")
    shutter_offset: float | None = None
    shutter_type: str | None = None
    shutter_curve: ShutterCurve | None = None
    rolling_shutter: RollingShutter | None = None
    iso: float = _default("iso")
    exposure_compensation: float = _default("exposure_compensation")
    exposure_time: float | None = None
    exposure_f_stop: float | None = None
    responsivity: float = _default("responsivity")
    white_balance: float | tuple[float, float] | None = None
    motion: dict[str, Dynamic] = field(default_factory=dict)
    near_clip: float = _default("near_clip")
    dispersion: bool = _default("dispersion")
    exposure: str = _default("exposure")
    meter: str = _default("meter")

    def __post_init__(self) -> None:
        if self.sensor is not None and self.sensor_size is FULL_FRAME:
            from daguerre.sensors import load

            object.__setattr__(self, "sensor_size", load(self.sensor).size)
        found: dict[str, Dynamic] = {}
        for name, value in vars(self).items():
            if is_dynamic(value):
                found[name] = value
            elif name in MOVABLE and moves(value):  # such as a shift of two numbers
                found[name] = Composite(value)
        if not isinstance(self.motion, Mapping):
            raise UsageError(f"camera: motion: wanted a dict, got {shown(self.motion)}")
        for name in {**self.motion, **found}:
            if name not in MOVABLE:
                raise UsageError(f"camera: {name}: cannot change over time")
        for name, value in found.items():
            object.__setattr__(self, name, value.at(0.0))
        object.__setattr__(self, "motion", {**self.motion, **found})

    def __getstate__(self) -> dict[str, Any]:
        # The identity of the default ``sensor_size`` shows that it was not given.
        unchosen = self.sensor_size is FULL_FRAME
        return super().__getstate__() | ({"sensor_size": None} if unchosen else {})

    def __setstate__(self, state: dict[str, Any]) -> None:
        unchosen = state.get("sensor_size") is None
        super().__setstate__(state | ({"sensor_size": FULL_FRAME} if unchosen else {}))

    def __repr__(self) -> str:
        """Lists the parameters that differ from their defaults."""
        told = [f"{name}={text}" for name, text in changed(self).items() if name != "motion"]
        moving = [f"moving: {', '.join(self.motion)}"] if self.motion else []
        return f"<Camera {', '.join(told + moving) or 'at the origin'}>"

    def _repr_html_(self) -> str:
        from daguerre.files.html_table import html_table, shown_numbers

        rows = {
            "stands at": f"{shown_numbers(self.transform[:3, 3])} m",
            "looks along": shown_numbers(-self.transform[:3, 2]),
        }
        for name, text in changed(self).items():
            if name not in ("transform", "motion"):
                number = isinstance(getattr(self, name), int | float | tuple)
                rows[name] = f"{text} {CAMERA[name].unit if number else ''}".rstrip()
        rows |= {"moving": ", ".join(self.motion)} if self.motion else {}
        return html_table("Camera", rows)

    @classmethod
    def from_opencv(
        cls,
        calibration: Source,
        name: str | None = None,
        *,
        model: str | None = None,
        size: tuple[int, int] | None = None,
        rectified: bool = False,
        unit_m: float = 1.0,
        camera: Camera | None = None,
        pixel_pitch: float | None = None,
    ) -> Camera:
        """Reads a camera that OpenCV calibrated.

        Args:
            calibration: YAML, XML or JSON by ``cv::FileStorage``, or a dict of the same names.
            name: left or right of a stereo pair; None: left.
            model: opencv or fisheye; default: the file's, else opencv.
            size: Picture size of the calibration, px, if the file does not state it.
            rectified: Whether to read a pair after rectification, by P1 and P2.
            unit_m: Length of the file's unit, for a pair, m.
            camera: Camera that gives all other parameters, and the pose of the left camera.
            pixel_pitch: Pixel pitch of the calibrated sensor, um; blur depends on it.

        Raises:
            InputError: The calibration cannot be used; the message names the place in the file.
        """
        found = cls._calibrated(camera, pixel_pitch)
        return found.from_opencv(
            calibration, name, model=model, size=size, rectified=rectified, unit_m=unit_m
        )

    @classmethod
    def from_ros(
        cls,
        calibration: Source,
        *,
        rectified: bool = False,
        camera: Camera | None = None,
        pixel_pitch: float | None = None,
    ) -> Camera:
        """Reads a camera from ROS ``camera_info``, with its place in a stereo rig.

        Args: as in :meth:`from_opencv`. ``camera`` has the pose of the first rectified camera of
            the rig. ``rectified`` takes the rectified picture (P) instead of the raw picture.
        """
        return cls._calibrated(camera, pixel_pitch).from_ros(calibration, rectified=rectified)

    @classmethod
    def from_kalibr(
        cls,
        calibration: Source,
        name: str | None = None,
        *,
        timeshift: bool = False,
        camera: Camera | None = None,
        pixel_pitch: float | None = None,
    ) -> Camera:
        """Reads a camera of a Kalibr camera chain, by default ``cam0``.

        Args: as in :meth:`from_opencv`. ``camera`` has the pose of the first camera of the chain.
            ``timeshift`` delays the shutter by ``timeshift_cam_imu`` relative to that camera.
        """
        found = cls._calibrated(camera, pixel_pitch)
        return found.from_kalibr(calibration, name, timeshift=timeshift)

    @classmethod
    def from_colmap(
        cls,
        folder: str | os.PathLike[str],
        name: str | None = None,
        *,
        unit_m: float = 1.0,
        camera: Camera | None = None,
        pixel_pitch: float | None = None,
    ) -> Camera:
        """Reads the camera of a picture of a COLMAP text model, with its pose in COLMAP's world.

        Args: as in :meth:`from_opencv`; ``name`` is the name of the picture. With # in place of a
        number (``IMG_####.jpg``) the camera moves: picture n is at n / fps, s.
        """
        return cls._calibrated(camera, pixel_pitch).from_colmap(folder, name, unit_m=unit_m)

    @classmethod
    def from_opentrackio(
        cls,
        calibration: Source | list[Source],
        *,
        size: tuple[int, int] | None = None,
        camera: Camera | None = None,
        pixel_pitch: float | None = None,
    ) -> Camera:
        """Reads a tracked camera: lens, f-stop, focus and pose of OpenTrackIO samples.

        Args: as in :meth:`from_opencv`. Several samples (a list, or a file with a list or one
        sample a line) make keys over time, the first at 0 s.
        """
        return cls._calibrated(camera, pixel_pitch).from_opentrackio(calibration, size=size)

    @staticmethod
    def _calibrated(camera: Camera | None, pixel_pitch: float | None) -> CalibratedCameras:
        """Makers of cameras; ``camera`` gives all other parameters."""
        from daguerre.calibration.cameras import CalibratedCameras

        return CalibratedCameras(camera, pixel_pitch)

    def frozen_at(self, time: float) -> Camera:
        """Returns the camera frozen at a time, s: a copy without motion."""
        return replace(self.evaluated_at(time), motion={}) if self.motion else self

    def evaluated_at(self, time: float) -> Camera:
        """Returns the camera with its parameters evaluated at a time, s; it keeps its motion."""
        if not self.motion:
            return self
        return replace(self, **{name: value.at(time) for name, value in self.motion.items()})

    def with_(self, **changes: object) -> Camera:
        """Returns a copy with some parameters changed.

        Values that the change makes obsolete are dropped: the focal length of an ideal lens if a
        prescription replaces it, the f-stop if an aperture diameter does, one way to focus if
        another does, the T-stop of a lens that becomes a pinhole.

        Raises:
            UsageError: Unknown name (the message suggests the nearest), or values that exclude
                each other.
        """
        for name in changes:
            if name not in self.__dataclass_fields__:
                raise UsageError(
                    f"camera: no parameter {name!r}{suggest(name, self.__dataclass_fields__)}"
                )
        given = {name for name, value in changes.items() if value is not None}
        asked = changes.get("lens"), changes.get("lens_model")
        if hole := next((name for name in WITHOUT_IRIS if name in asked), None):
            odd = sorted(name for name in given if OPENING in CAMERA[name].needs)
            if odd:
                raise UsageError(
                    f"camera: {odd[0]}: a {hole} has none; choose another lens, or leave it out"
                )
        replaced: dict[str, Any] = {"t_stop": None} if hole else {}
        if changes.get("lens") is not None:  # parameters of the replaced lens
            replaced |= {name: _default(name) for name in ("zoom", "decenter", "ripple")}
        if changes.get("lens_model") not in (None, "polynomial"):
            replaced |= {"degree": None, "fit_tolerance": None}
        if changes.get("sensor") is not None:
            replaced["sensor_size"] = FULL_FRAME  # until the new one says
        CAMERA.refuse_rivals(given, "camera")
        for rivals in CAMERA.rivals():
            replaced |= dict.fromkeys(rivals) if given & set(rivals) else {}
        if changes.get("lens") not in (None, *IDEAL):
            replaced |= {"focal_length": None, "aperture_diameter": None}
        values: dict[str, Any] = replaced | changes
        left = {name: value for name, value in self.motion.items() if name not in values}
        return replace(self, **({"motion": left} | values))
