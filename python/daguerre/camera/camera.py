"""A camera in a photographer's terms.

Units are the ones read on the object: mm for lens and sensor, m for distances, s for time, degrees
for angles.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import UsageError, suggest
from daguerre.files.value import Value, changed
from daguerre.motion.values import Composite, Dynamic, is_dynamic, moves

if TYPE_CHECKING:
    from daguerre.files.source import Source
    from daguerre.lenses import Lens
    from daguerre.sensors import Sensor

    from .lens_scatter import LensScatter
    from .projection import Projection
    from .rolling_shutter import RollingShutter, ShutterCurve


#: lenses without a prescription
IDEAL = ("thin", "pinhole")


#: smallest and largest values, far beyond any camera: what lies outside is a mistake, and single
#: precision would overflow on the way
LIMITS = {
    "focal_length": (1e-3, 1e6),  # mm
    "zoom": (1e-3, 1e6),  # mm
    "f_stop": (1e-2, 1e9),
    "t_stop": (1e-2, 1e9),
    "aperture_diameter": (1e-9, 1e6),  # mm
    "sensor_size": (1e-3, 1e5),  # mm
    "focus_distance": (1e-6, 1e12),  # m, or infinite
    "shift": (-1e5, 1e5),  # mm
    "tilt": (-45, 45),  # degrees
}
#: what may change while the shutter is open
MOVABLE = (
    *("transform", "focal_length", "sensor_size", "f_stop", "aperture_diameter", "focus_distance"),
    *("blades", "blade_rotation", "blade_curvature", "shift", "tilt", "zoom", "projection"),
)


#: (first, last), (x, y), (about x, about y): surfaces of a lens, moved by mm and turned by degrees
Decenter = tuple[tuple[int, int], tuple[float, float], tuple[float, float]]


#: mm; of a camera for which no other is said
FULL_FRAME = (36.0, 24.0)
#: ways to say the same, of which one may be given
RIVALS = (
    ("f_stop", "aperture_diameter", "t_stop"),
    ("focus_distance", "focus_at", "focus_on"),
    ("shutter_time", "shutter_angle"),
)


@dataclass(frozen=True, eq=False)
class Camera(Value):
    """A camera; ``with_`` makes changed copies.

    Parameters in ``MOVABLE`` may be given as values over time (:func:`daguerre.keys`). They are
    kept in ``motion``, and the parameter itself has the value of one moment; ``at`` chooses it.

    Attributes:
        transform: World from camera, shape (4, 4), m; the camera looks along its -z, +y is up.
        lens: Library name, file, ``Lens``, ``"thin"`` or ``"pinhole"``; None: thin.
        lens_model: exact, polynomial, thick, thin or pinhole; None: exact if a prescription is
            named.
        projection: Instead of a lens: a calibration, or the formula of a fisheye or a panorama. It
            takes f_stop (none: all is sharp) and focus; the width of ``sensor_size`` counts. Keys
            are of one model and size.
        degree: Of a polynomial lens, odd, 1 to 13; None: 7.
        fit_tolerance: RMS error (px) of a polynomial lens on the film, above which the exact lens
            takes its place; None: 0.5.
        focal_length: mm, of an ideal lens; None: 50. A prescription has its own and takes no other.
        zoom: Focal length at which a zoom stands, mm; None: as its file has it.
        decenter: Elements that stand off the axis of a prescription, as lenses that were dropped
            have them: for each the indices of its first and last surface, millimetres along x and
            y, and degrees about x and y.
        sensor: Name of the library, file, or ``Sensor``: the frame holds its channels, too, and
            the sensor has its size unless another is given.
        sensor_size: Width and height, mm.
        sensor_fit: horizontal, vertical, auto or fill: which side of the sensor the picture spans.
        f_stop: Focal length / entrance pupil diameter; None: the file's, else 5.6, or the widest of
            the lens if that is slower.
        aperture_diameter: mm; the lecture's parameter, instead of ``f_stop`` (thin lens only).
        t_stop: As ``f_stop``, of the light that comes through the glass on the axis.
        focus_distance: m from the entrance pupil along the axis; None: autofocus.
        focus_at: Pixel (x, y) whose surface is to be sharp.
        focus_on: Node whose nearest surface point is to be sharp.
        focus_from: pupil or sensor.
        focus_by: paraxial, or best: the film stands where a point on the axis is the smallest spot.
        focus_breathing: Thin lens: keep the focal length, so that the field narrows when it focuses
            close, as a real lens does that moves as a whole; False keeps the field.
        blades: Number of straight or curved iris blades; 0: round.
        blade_rotation: Degrees.
        blade_curvature: -1 .. 1; 1 is round, 0 straight.
        aperture_image: Grey picture (H, W) of the iris opening; None: by blades.
        front_mask: Grey picture (H, W) of dust and scratches on the front of an exact lens, as
            wide as it is clear: 1 lets all light through.
        iris_mask: The same at the iris, as wide as it opens.
        ripple: Grooves that grinding left in the aspheric surfaces of an exact lens, which show as
            onion rings: RMS height (nm), period (um), and a seed if wanted.
        cover_glass: Of the body, before its sensor: thickness and gap to the sensor (mm), and its
            index if wanted [1.5168]. It has ghosts (``flare``); the picture is that without it.
        sensor_reflectance: How much light the sensor sends back into the lens, 0 .. 1.
        scatter: How barrel, blades and surfaces of an exact lens scatter, where that is drawn
            (``docs/scatter.md``); None: as a well-made lens does.
        natural_vignetting: Thin lens and pinhole: darken by cos^4 of the field angle.
        shift: Film shift, mm.
        tilt: The lens is turned about its entrance pupil: degrees about the camera's x (up is
            positive), then about its y (left). The film stays across the camera's axis and keeps
            what is straight ahead in its middle; the focus distance runs along the lens's axis.
        shutter_time: How long a point of the film is exposed, s; 0 freezes. Or
        shutter_angle: the same in degrees of a frame, 360 fps shutter_time. None of both: the
            file's, else 180 degrees.
        fps: Frames per second, for angles, offsets and sequences.
        shutter_offset: When it opens, in frames from the scene's time; None: the exposure stands
            around that time.
        shutter_type: box, leaf, focal_plane, rotary or electronic; None: electronic with a
            rolling shutter, else box.
        shutter_curve: Opening over the time: box, ("trapezoid", efficiency) or points (fraction
            of the time, opening); of a leaf the radius of the iris.
        rolling_shutter: Lines of pixels that are exposed in turn; None: as the type has it.
        iso, exposure_compensation: For development; they never change ``frame.rgb``. Nor do
        exposure_time: Of the light, s, where that is another than the motion blur's shutter.
        exposure_f_stop: Of the light, where that is another than the blur's; of a pinhole [8].
        responsivity: Factor on the exposure.
        white_balance: For development: colour temperature, K, or chromaticity (x, y).
        motion: Parameters that change over time.
    """

    transform: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    lens: str | Lens | None = None
    lens_model: str | None = None
    projection: Projection | None = None
    degree: int | None = None
    fit_tolerance: float | None = None
    focal_length: float | None = None
    zoom: float | None = None
    decenter: tuple[Decenter, ...] = ()
    sensor: str | Path | Sensor | None = None
    sensor_size: tuple[float, float] = FULL_FRAME
    sensor_fit: str = "horizontal"
    f_stop: float | None = None
    aperture_diameter: float | None = None
    t_stop: float | None = None
    focus_distance: float | None = None
    focus_at: tuple[float, float] | None = None
    focus_on: str | None = None
    focus_from: str = "pupil"
    focus_by: str = "paraxial"
    focus_breathing: bool = False
    blades: int = 0
    blade_rotation: float = 0.0
    blade_curvature: float = 0.0
    aperture_image: NDArray[np.float32] | None = None
    front_mask: NDArray[np.float32] | None = None
    iris_mask: NDArray[np.float32] | None = None
    ripple: tuple[float, ...] | None = None
    cover_glass: tuple[float, ...] | None = None
    sensor_reflectance: float = 0.0
    scatter: LensScatter | None = None
    natural_vignetting: bool = False
    shift: tuple[float, float] = (0.0, 0.0)
    tilt: tuple[float, float] = (0.0, 0.0)
    shutter_time: float | None = None
    shutter_angle: float | None = None
    fps: float = 24.0
    shutter_offset: float | None = None
    shutter_type: str | None = None
    shutter_curve: ShutterCurve | None = None
    rolling_shutter: RollingShutter | None = None
    iso: float = 100.0
    exposure_compensation: float = 0.0
    exposure_time: float | None = None
    exposure_f_stop: float | None = None
    responsivity: float = 1.0
    white_balance: float | tuple[float, float] | None = None
    motion: dict[str, Dynamic] = field(default_factory=dict)

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
        for name in {**self.motion, **found}:
            if name not in MOVABLE:
                raise UsageError(f"camera: {name}: wanted a value that stays, got one over time")
        for name, value in found.items():
            object.__setattr__(self, name, value.at(0.0))
        object.__setattr__(self, "motion", {**self.motion, **found})

    def __getstate__(self) -> dict[str, Any]:
        # ``sensor_size`` tells by its identity that nobody chose it.
        unchosen = self.sensor_size is FULL_FRAME
        return super().__getstate__() | ({"sensor_size": None} if unchosen else {})

    def __setstate__(self, state: dict[str, Any]) -> None:
        unchosen = state["sensor_size"] is None
        super().__setstate__(state | ({"sensor_size": FULL_FRAME} if unchosen else {}))

    def __repr__(self) -> str:
        """Names what is not as a camera has it without being told."""
        told = [text for text in changed(self) if not text.startswith("motion=")]
        moving = [f"moving: {', '.join(self.motion)}"] if self.motion else []
        return f"<Camera {', '.join(told + moving) or 'at the origin'}>"

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
        """A camera as OpenCV calibrated it.

        Args:
            calibration: YAML, XML or JSON by ``cv::FileStorage``, or a dict of the same names.
            name: left or right of a stereo pair; None: left.
            model: opencv or fisheye; None: as the file says, else opencv.
            size: Of the calibrated picture, px, if the file does not say it.
            rectified: Of a pair: as after rectification, by P1 and P2.
            unit_m: Of a pair: what a length of 1 in the file is, m.
            camera: Gives all that a calibration does not say, and where the left one stands.
            pixel_pitch: um; the size of blur depends on it.

        Raises:
            InputError: The calibration cannot be used; the message names the place.
        """
        from daguerre.calibration.cameras import from_opencv

        return from_opencv(
            *(calibration, name, camera, pixel_pitch),
            model=model,
            size=size,
            rectified=rectified,
            unit_m=unit_m,
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
        """A camera by its ROS ``camera_info``: the raw picture, in its place of a stereo rig.

        Args: as of :meth:`from_opencv`; ``camera`` stands where the rig's first, rectified, does.
            ``rectified`` draws that picture, by P.
        """
        from daguerre.calibration.cameras import from_ros

        return from_ros(calibration, rectified, camera, pixel_pitch)

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
        """A camera of Kalibr's chain, ``cam0`` or of another name.

        Args: as of :meth:`from_opencv`; ``camera`` stands where the chain's first does.
            ``timeshift`` opens the shutter as much later as its ``timeshift_cam_imu`` is larger.
        """
        from daguerre.calibration.cameras import from_kalibr

        return from_kalibr(calibration, name, timeshift, camera, pixel_pitch)

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
        """The camera of a picture of a COLMAP model as text, where it stood in COLMAP's world.

        Args: as of :meth:`from_opencv`; ``name`` is that of the picture.
        """
        from daguerre.calibration.cameras import from_colmap

        return from_colmap(folder, name, unit_m, camera, pixel_pitch)

    @classmethod
    def from_opentrackio(
        cls,
        calibration: Source | list[Source],
        *,
        size: tuple[int, int] | None = None,
        camera: Camera | None = None,
        pixel_pitch: float | None = None,
    ) -> Camera:
        """A tracked camera: lens, f-stop, focus and pose of an OpenTrackIO sample, or of several.

        Args: as of :meth:`from_opencv`; a list of samples makes keys, the first at 0 s.
        """
        from daguerre.calibration.cameras import from_opentrackio

        return from_opentrackio(calibration, size, camera, pixel_pitch)

    def at(self, time: float) -> Camera:
        """The camera as it is at a time in s; nothing in it moves."""
        return replace(self.moved_to(time), motion={}) if self.motion else self

    def moved_to(self, time: float) -> Camera:
        """The same camera, whose parameters show their values of another time, s."""
        if not self.motion:
            return self
        return replace(self, **{name: value.at(time) for name, value in self.motion.items()})

    def with_(self, **changes: Any) -> Camera:
        """A copy with some parameters changed.

        What the change makes obsolete goes: the focal length of an ideal lens when a prescription
        takes its place, the f-stop for an aperture diameter, one way to focus for another.

        Raises:
            UsageError: An unknown name (the nearest is suggested), or values that exclude others.
        """
        for name in changes:
            if name not in self.__dataclass_fields__:
                raise UsageError(
                    f"camera: no parameter {name!r}{suggest(name, self.__dataclass_fields__)}"
                )
        given = {name for name, value in changes.items() if value is not None}
        if "pinhole" in (changes.get("lens"), changes.get("lens_model")):
            odd = sorted(given & {"f_stop", "t_stop", "aperture_diameter", "aperture_image"})
            if odd:
                raise UsageError(f"camera: a pinhole has no {odd[0]}")
        replaced: dict[str, Any] = {}
        if changes.get("lens") is not None:  # of the lens that goes
            replaced |= {"zoom": None, "decenter": (), "ripple": None}
        if changes.get("lens_model") not in (None, "polynomial"):
            replaced |= {"degree": None, "fit_tolerance": None}
        if changes.get("sensor") is not None:
            replaced["sensor_size"] = FULL_FRAME  # until the new one says
        for rivals in RIVALS:
            both = sorted(given & set(rivals))
            if len(both) > 1:
                raise UsageError(f"camera: wanted either {both[0]} or {both[1]}, got both")
            replaced |= dict.fromkeys(rivals) if both else {}
        if changes.get("lens") not in (None, *IDEAL):
            replaced |= {"focal_length": None, "aperture_diameter": None}
        values: dict[str, Any] = replaced | changes
        left = {name: value for name, value in self.motion.items() if name not in values}
        return replace(self, **({"motion": left} | values))
