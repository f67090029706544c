"""A frame: scene-linear light that a camera recorded, with auxiliary channels and metadata."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import short
from daguerre.color.display import _shoulder, _srgb, into_gamut
from daguerre.errors import UsageError, suggest
from daguerre.files import formats
from daguerre.files.array_value import ArrayValue
from daguerre.files.value import Value

from .aovs import channels_named
from .cryptomatte import Cryptomatte
from .shown import Shown

if TYPE_CHECKING:
    import os

    from daguerre.development.shown import OnScreen
    from daguerre.exposure.expose import BeforeSensor
    from daguerre.sensors.sensor import Sensor

    from .raw import Raw

TONES = ("srgb", "soft")
_STRIPE = 64  # rows


@guarded(init=True)
@dataclass(eq=False)
class Frame(Value, ArrayValue, Shown, array="rgb"):
    """A picture, rendered completely or in part.

    NumPy takes a frame for its ``rgb``: ``np.asarray(frame)``, ``np.mean(frame)``.

    Attributes:
        rgb: Scene-linear Rec.709, shape (H, W, 3), relative exposure H / H0: a white world of
            1 cd/m2 is 1.
        xyz: CIE 1931 XYZ of the same light, shape (H, W, 3).
        alpha: Share of each pixel that objects cover, through lens, shutter and filter, shape
            (H, W); default: 1. ``rgb`` is premultiplied by it.
        catcher: Light that objects add to catchers minus light that they take, shape (H, W, 3), if
            the scene has catchers. The picture over a plate P is ``rgb`` + (1 - ``alpha``) P +
            ``catcher``.
        catcher_ratio: The same as a factor: ``rgb`` + (1 - ``alpha``) P ``catcher_ratio``.
        catcher_channels: ``catcher`` in the channels of the sensor, shape (H, W, C).
        catcher_ratio_channels: ``catcher_ratio`` in the channels of the sensor.
        cryptomatte: Mattes by the names of objects, materials and assets, if requested:
            ``frame.cryptomatte["object"].mask("ball")``.
        variance: Variance of the mean of R, G, B, shape (H, W, 3).
        flare: Light that ghosts added to ``rgb``, shape (H, W, 3), if they were drawn.
        splats: Light that light paths added to ``rgb``, shape (H, W, 3), with ``aovs``.
        halves: Pictures of the samples of even and of odd index, each in two parts that add up:
            by camera paths, and by light paths; shape (H, W, 2, 2, 3), if requested.
        samples: Samples per pixel, shape (H, W).
        aovs: Auxiliary channels by name, each of shape (H, W); ``layer`` joins the channels of a
            layer. With ``aovs=True`` means over the samples: ``depth.Z`` (m along the camera's
            -z), ``P.X`` to ``P.Z`` (m, world), ``N.X`` to ``N.Z`` (shading normal, world),
            ``albedo.R`` to ``albedo.B``, ``object_id``. With ``gt_time`` these are exact, and there
            are ``distance.Z`` (m from the entrance pupil) and ``material_id``; with ``motion=True``
            ``motion.U``, ``motion.V``, ``motion_back.U`` and ``motion_back.V`` (px, +x right,
            +y down).
        metadata: Facts of camera and render; see ``daguerre.pictures.exr.write``.
        channels: Channels of the camera's sensor, shape (H, W, C), if the camera has a sensor: D65
            of luminance 1 is 1 in each; ``metadata["sensor_channels"]`` has their names.
        bands: Mean radiance in wavelength bands of equal width, 380 to 780 nm, shape (H, W, N), if
            requested: D65 of luminance 1 is about 1 in each.
        bad_samples: Number of samples that were NaN or Inf, and the first of them as
            (x, y, sample).
    """

    rgb: NDArray[np.float32]
    xyz: NDArray[np.float32] | None = None
    alpha: NDArray[np.float32] = field(default_factory=lambda: np.empty((0, 0), np.float32))
    variance: NDArray[np.float32] | None = None
    samples: NDArray[np.uint32] | None = None
    aovs: dict[str, NDArray[Any]] = field(default_factory=dict)
    metadata: dict[str, Any] = field(default_factory=dict)
    bad_samples: tuple[int, list[tuple[int, int, int]]] = (0, [])
    flare: NDArray[np.float32] | None = None
    channels: NDArray[np.float32] | None = None
    bands: NDArray[np.float32] | None = None
    splats: NDArray[np.float32] | None = None
    halves: NDArray[np.float32] | None = None
    catcher: NDArray[np.float32] | None = None
    catcher_ratio: NDArray[np.float32] | None = None
    catcher_channels: NDArray[np.float32] | None = None
    catcher_ratio_channels: NDArray[np.float32] | None = None
    cryptomatte: dict[str, Cryptomatte] = field(default_factory=dict)

    __hash__ = None  # type: ignore[assignment]  # it changes

    def __post_init__(self) -> None:
        if self.rgb.ndim != 3 or self.rgb.shape[2] != 3:
            raise UsageError(f"frame: rgb: wanted shape (H, W, 3), got {self.rgb.shape}")
        if self.alpha.size == 0:
            self.alpha = np.ones(self.rgb.shape[:2], np.float32)

    @property
    def width(self) -> int:
        """Columns, px."""
        return int(self.rgb.shape[1])

    @property
    def height(self) -> int:
        """Rows, px."""
        return int(self.rgb.shape[0])

    @property
    def motion(self) -> NDArray[np.float32] | None:
        """Motion of each pixel's surface to the next frame, px, +x right, +y down, (H, W, 2).

        None without ground truth; see ``daguerre.rendering.truth``.
        """
        return self._flow("motion")

    @property
    def motion_back(self) -> NDArray[np.float32] | None:
        """Motion of each pixel's surface back to the frame before, like ``motion``."""
        return self._flow("motion_back")

    def _flow(self, name: str) -> NDArray[np.float32] | None:
        return self.layer(name) if {f"{name}.U", f"{name}.V"} <= self.aovs.keys() else None

    def layer(self, name: str) -> NDArray[Any]:
        """Returns the channels of ``aovs`` with one name as one array.

        Args:
            name: ``depth``, ``P`` (or ``position``), ``N`` (or ``normal``), ``albedo``,
                ``object_id``, ``motion`` and so on (``docs/ground-truth.md``).

        Returns:
            Shape (H, W) of a single channel, else (H, W, C), in the order X, Y, Z; R, G, B; U, V.

        Raises:
            UsageError: The frame has no such layer; the message lists its layers.
        """
        found = channels_named(name, self.aovs)
        if not found:
            names = sorted({channel.partition(".")[0] for channel in self.aovs})
            there = ", ".join(names) or "no layers (render with aovs=True)"
            raise UsageError(
                f"frame: layer: wanted one of {there}, got {short(name)}{suggest(name, names)}"
            )
        planes = [self.aovs[channel] for channel in found]
        return planes[0] if len(planes) == 1 else np.stack(planes, axis=2)

    def without_overscan(self) -> Frame:
        """Crops the frame to the picture itself, which is the part that a sensor records.

        Raises:
            UsageError: The frame is a crop outside of the picture.
        """
        width, height = self.metadata.get("resolution") or (self.width, self.height)
        left, top = (self.metadata.get("crop") or (0, 0))[:2]
        x0, y0 = max(left, 0), max(top, 0)
        x1, y1 = min(left + self.width, width), min(top + self.height, height)
        if (x0, y0, x1, y1) == (left, top, left + self.width, top + self.height):
            return self
        if x0 >= x1 or y0 >= y1:
            raise UsageError("frame: it holds only overscan, no pixel of the picture")
        rows, columns = slice(y0 - top, y1 - top), slice(x0 - left, x1 - left)
        cut: dict[str, Any] = {
            f.name: value[rows, columns]
            for f in fields(self)
            if isinstance(value := getattr(self, f.name), np.ndarray)
        }
        aovs = {name: plane[rows, columns] for name, plane in self.aovs.items()}
        cut["cryptomatte"] = {
            name: replace(
                matte, ids=matte.ids[rows, columns], coverage=matte.coverage[rows, columns]
            )
            for name, matte in self.cryptomatte.items()
        }
        facts = {k: v for k, v in self.metadata.items() if k != "overscan"}
        return replace(self, **cut, aovs=aovs, metadata=facts | {"crop": (x0, y0, x1, y1)})

    def display(self, tone: str = "srgb") -> NDArray[np.uint8]:
        """Encodes the picture for a screen, shape (H, W, 3), by its exposure mode.

        In ``light``, and without a mode, a value of 2^-EV is the screen's white. In other modes, or
        with a white balance, the frame is developed with the neutral look.

        Args:
            tone: Tone curve of pictures that are not developed. "srgb" is the plain sRGB curve,
                clipped at 1. "soft" rolls off the highlights above 0.8, so that small bright lamps
                keep some shape and get whiter the brighter they are. Both move colours outside of
                sRGB toward the grey of the same luminance, and leave ``rgb`` as it is.
        """
        return self._on_screen(tone).bytes8()

    def encoded(self, tone: str = "srgb") -> NDArray[np.float32]:
        """Encodes values like ``display``, 0 to 1."""
        return self._on_screen(tone).values()

    def _on_screen(self, tone: str) -> OnScreen:
        """The picture for a screen, developed if its exposure mode says so."""
        from daguerre.development.shown import OnScreen

        return OnScreen(self, tone)

    def encoded_rows(
        self, tone: str, gain: float = 1.0
    ) -> Iterator[tuple[slice, NDArray[np.float32]]]:
        """Encodes ``gain`` times the picture in strips of rows, which needs little memory."""
        if tone not in TONES:
            raise UsageError(f"frame: unknown tone {short(tone)}{suggest(tone, TONES, few=True)}")
        for row in range(0, self.height, _STRIPE):
            rows = slice(row, row + _STRIPE)
            linear = np.nan_to_num(self.rgb[rows], nan=0.0, posinf=3e38)
            if gain != 1:
                linear = np.minimum(linear * np.float32(gain), np.float32(3e38))
            linear = into_gamut(linear)
            yield rows, _srgb(_shoulder(linear) if tone == "soft" else linear)

    def save(
        self, path: str | os.PathLike[str], *, tone: str = "srgb", colour_space: str | None = None
    ) -> None:
        """Writes the frame atomically; the suffix chooses the format.

        Args:
            path: ``.exr`` keeps everything, linear, with all channels and camera attributes.
                ``.png``, ``.jpg`` and ``.tif`` are encoded for display as :meth:`display` does,
                without overscan. For a photograph use ``expose`` and
                ``daguerre.development.develop``.
            tone: Tone curve of pictures for display; see :meth:`display`.
            colour_space: Colour space of an ``.exr``: ``lin_rec709``, ``acescg``, ``aces`` or
                ``xyz``; None: as in the file that the frame was read from, else ``lin_rec709``.
                See ``docs/colour.md``.

        Raises:
            UsageError: Unknown suffix or colour space.
            OutputError: The file cannot be written.
        """
        if colour_space is not None:
            in_space(self, path, colour_space).save(path, tone=tone)
            return
        formats.write("frame", path, self, tone=tone)

    def expose(
        self,
        sensor: str | Sensor | None = None,
        iso: float | None = None,
        *,
        seed: int = 0,
        ev: float | None = None,
        white_balance: object = None,
        temperature: float | None = None,
    ) -> Raw:
        """Exposes a sensor to the frame: returns a raw picture with photon and sensor noise.

        A pixel of the frame is a photosite at any resolution of the frame.

        Args:
            sensor: Library name (``dg.sensors.names()``), file, or sensor; default: the sensor of
                the frame's channels, else "ideal".
            iso: ISO; default: the camera's, if the sensor has it, else the sensor's base ISO.
            seed: Seed of the shot's noise. The serial number seeds the sensor's fixed pattern.
            ev: Exposure compensation, EV: multiplies the light by 2^ev; default: the camera's.
            white_balance: White balance that the raw file states as neutral, K or (x, y); default:
                the camera's, else D65.
            temperature: Temperature of the sensor, deg C; default: its temperature when measured.

        Raises:
            DaguerreError: No such sensor, an ISO beyond its range, or a frame without the metadata
                of its exposure; the message names the field.
        """
        before = self.without_overscan()._before_sensor(sensor, iso, ev)
        return before.raw(seed, white_balance, temperature)

    def exposure_truth(
        self,
        sensor: str | Sensor | None = None,
        iso: float | None = None,
        ev: float | None = None,
    ) -> dict[str, NDArray[np.float32]]:
        """Computes the true exposure and saturation, without noise, as channels for ``aovs``.

        Returns:
            ``exposure.Y``, luminance exposure in lux s; ``saturated.R`` and so on, 1 where the
            noiseless light saturates that channel's photosite; each of shape (H, W).
        """
        return self._before_sensor(sensor, iso, ev).truth()

    def _before_sensor(
        self, sensor: str | Sensor | None, iso: float | None, ev: float | None
    ) -> BeforeSensor:
        """The frame before a sensor, at an ISO and an exposure compensation."""
        from daguerre.exposure.expose import before_sensor

        return before_sensor(self, sensor, iso, ev)

    def __repr__(self) -> str:
        spp = self.metadata.get("samples")
        extra = f", {spp} samples" if spp is not None else ""
        names = sorted({name.split(".")[0] for name in self.aovs})
        aovs = f", aovs: {' '.join(names)}" if names else ""
        return f"<Frame {self.width}x{self.height}{extra}{aovs}>"

    def _repr_html_(self) -> str:
        from base64 import b64encode

        data = b64encode(self._repr_png_()).decode("ascii")
        import html

        caption = html.escape(self._caption())
        return (
            f'<figure><img src="data:image/png;base64,{data}" width="{self.width}" '
            f'height="{self.height}" alt="{caption}"><figcaption>{caption}</figcaption></figure>'
        )

    def _caption(self) -> str:
        facts = self.metadata
        words = [f"{self.width} × {self.height}"]
        if facts.get("lensModel"):
            words.append(str(facts["lensModel"]))
        if facts.get("nominalFocalLength"):
            words.append(f"{facts['nominalFocalLength']:.4g} mm")
        if facts.get("aperture"):
            words.append(f"f/{facts['aperture']:.3g}")
        if facts.get("focus"):
            words.append(f"focus {facts['focus']:.4g} m")
        if facts.get("samples") is not None:
            words.append(f"{facts['samples']} samples")
        return ", ".join(words)


def in_space(frame: Frame, path: str | os.PathLike[str], colour_space: str) -> Frame:
    """Returns a frame with another colour space of its file.

    Raises:
        UsageError: The space is not one of linear files, or the file is no ``.exr``.
    """
    from daguerre.color.spaces import check_linear

    if not str(path).lower().endswith(".exr"):
        raise UsageError(f"{path}: colour_space is for .exr; other pictures are sRGB")
    name = check_linear(colour_space, "frame: colour_space")
    return replace(frame, metadata={**frame.metadata, "colorspace": name})


def check_format(path: str | os.PathLike[str], more: tuple[str, ...] = ()) -> str:
    """Checks the suffix of an output and returns it in lower case; ``more``: further suffixes.

    Raises:
        UsageError: No format has this suffix; the message lists those that do.
    """
    return formats.check_written(path, (*formats.written("frame"), *more))
