"""From a frame to a raw picture: light by channel, electrons, numbers.

The frame counts as the mean of the light, to which a render converges; photon noise is added here.
A pixel of the frame is one photosite of the sensor, whatever the frame's resolution, so noise looks
as in a crop at 100 %.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.checks import number, whole
from daguerre.color import illuminants
from daguerre.color.spectra import luminance_of_rgb
from daguerre.errors import InputError, UsageError
from daguerre.files.value import BriefRecord
from daguerre.frame.frame import Frame
from daguerre.frame.raw import Raw
from daguerre.frame.seen_by import seen_of
from daguerre.sensors.library import load
from daguerre.sensors.sensor import Sensor

from .lux_seconds import exposure_of_one, frame_iso

FloatArray = NDArray[np.float64]
#: Share of pixels with more render noise than photon noise above which a note says so.
NOISY_SHARE = 0.01
_STRIPE = 256  # rows


@dataclass(frozen=True, repr=False)
class Light(BriefRecord):
    """Light on a sensor, plane by plane.

    Attributes:
        planes: Shape (H, W, P).
        electrons: Electrons in each channel for a value of 1 in each plane, shape (C, P).
        source: Kind of the planes: "channels", "bands" or "xyz".
        lux_s: Luminance exposure of a value of 1, lux s.
    """

    planes: NDArray[np.float32]
    electrons: FloatArray
    source: str
    lux_s: float


@dataclass(frozen=True)
class BeforeSensor:
    """A frame before a sensor.

    Attributes:
        frame: The frame.
        body: The sensor.
        iso: ISO.
        ev: Exposure compensation, EV.
        notes: Remarks on these choices.
    """

    frame: Frame
    body: Sensor
    iso: float
    ev: float
    notes: tuple[str, ...] = ()

    def raw(self, seed: int, white_balance: Any, temperature: float | None) -> Raw:
        """Exposes the sensor; see :meth:`daguerre.Frame.expose`."""
        frame, body, speed = self.frame, self.body, self.iso
        white = white_balance if white_balance is not None else frame.metadata.get("white_balance")
        white_xy = illuminants.white_xy(white)
        light = light_of(frame, body, speed, self.ev)
        seconds = number(frame.metadata.get("expTime", 0.0), "frame: expTime", 0, error=InputError)
        shot = _shot(body, light, speed, dark_electrons(body, seconds, temperature))
        shot.seed = whole(seed, "seed", 0, 2**64 - 1)
        mosaic, saturated, negative, bad, place = _core.expose(light.planes, shot)
        if bad:
            raise InputError(
                f"frame: {light.source}: wanted finite numbers, got NaN or infinity at {bad} "
                f"photosites, the first at {place}"
            )
        return Raw(
            mosaic=mosaic,
            sensor=body,
            iso=speed,
            black_level=body.black_level,
            white_level=body.white_level(speed),
            gain=body.gain(speed),
            neutral=body.neutral(white),
            white_balance=white_xy,
            metadata=_facts(frame, body, speed, self.ev, seed, light.source, negative),
            clipped=saturated.view(np.bool_),
            luminance_exposure=exposure_map(frame, speed, self.ev),
            notes=(*self.notes, *_remarks(frame, body, light, negative / mosaic.size)),
        )

    def truth(self) -> dict[str, NDArray[np.float32]]:
        """Computes exposure without noise; see :meth:`daguerre.Frame.exposure_truth`."""
        frame, body = self.frame, self.body
        light = light_of(frame, body, self.iso, self.ev)
        highest = (body.highest_dn - body.black_level) / body.gain(self.iso)
        most = np.float32(min(body.full_well_at(self.iso), highest))
        weights = light.electrons.T.astype(np.float32)
        full = np.empty((frame.height, frame.width, len(body.channels)), np.float32)
        for rows in _stripes(frame.height):
            full[rows] = light.planes[rows] @ weights >= most
        truth = {"exposure.Y": exposure_map(frame, self.iso, self.ev)}
        return truth | {f"saturated.{name}": full[..., i] for i, name in enumerate(body.channels)}


def before_sensor(
    frame: Frame, sensor: str | Sensor | None, iso: float | None, ev: float | None
) -> BeforeSensor:
    """Puts a frame before a sensor; None: the frame's sensor, ISO and compensation."""
    body = chosen_sensor(frame, sensor)
    notes: list[str] = []
    speed = chosen_iso(frame, body, iso, notes)
    return BeforeSensor(frame, body, speed, chosen_ev(frame, ev), tuple(notes))


def chosen_sensor(frame: Frame, sensor: str | Sensor | None) -> Sensor:
    """Chooses the sensor: the given sensor, else the frame's, else the ideal sensor."""
    if sensor is not None:
        return load(sensor)
    name = frame.metadata.get("sensor") or "ideal"
    try:
        return load(name)
    except InputError as error:
        raise InputError(f"frame: {error}; give its file as sensor") from None


def chosen_iso(frame: Frame, sensor: Sensor, iso: float | None, notes: list[str]) -> float:
    """Chooses the ISO: ``iso``, else the camera's if the sensor has it, else the base ISO."""
    if iso is not None:
        sensor.check_iso(iso)
        return float(iso)
    camera = frame_iso(frame.metadata)
    low, high = sensor.iso_range
    if camera is not None and low <= camera <= high:
        return camera
    if camera is not None:
        notes.append(
            f"ISO {camera:g} is outside the range of {sensor.name}: exposed at ISO "
            f"{sensor.base_iso:g}"
        )
    return float(sensor.base_iso)


def chosen_ev(frame: Frame, ev: float | None) -> float:
    """Chooses the exposure compensation, EV: ``ev``, else the camera's."""
    given = frame.metadata.get("exposure_compensation") or 0.0 if ev is None else ev
    return number(given, "ev", -64, 64)


def dark_electrons(
    sensor: Sensor, seconds: float, temperature: float | None
) -> tuple[float, float]:
    """Mean electrons of the dark current per photosite, and the excess of hot photosites."""
    if temperature is not None:
        number(temperature, "temperature", -273.15, 200)
    factor = sensor.dark_current.factor(temperature) * seconds
    return sensor.dark_current.rate * factor, sensor.hot_pixels.rate * factor


def light_of(frame: Frame, sensor: Sensor, iso: float, ev: float = 0.0) -> Light:
    """Chooses the best planes of a frame for a sensor: its channels, else bands, else XYZ."""
    lux_s = exposure_of_one(frame.metadata, iso) * 2.0**ev
    electrons = sensor.electrons_per_lux_s()[:, None] * lux_s
    seen = seen_of(frame, sensor)
    planes = np.ascontiguousarray(seen.planes, np.float32)
    return Light(planes, electrons * seen.channels, seen.source, lux_s)


def _shot(sensor: Sensor, light: Light, iso: float, dark: tuple[float, float]) -> Any:
    with np.errstate(over="ignore"):  # infinite electrons are refused with the light
        electrons = np.ascontiguousarray(light.electrons, np.float32)
    shot = _core.Shot(electrons, sensor.pattern.cells)
    shot.low_pass_px = sensor.low_pass / sensor.pixel_pitch
    shot.crosstalk = sensor.crosstalk
    shot.prnu, shot.dsnu = sensor.prnu, sensor.dsnu
    shot.dark, shot.hot_dark = dark
    shot.hot_share = sensor.hot_pixels.share
    shot.full_well = sensor.full_well_at(iso)
    shot.read_noise = sensor.read_noise_at(iso)
    shot.gain = sensor.gain(iso)
    shot.black_dn, shot.highest_dn = sensor.black_level, sensor.highest_dn
    shot.serial = sensor.serial
    return shot


def _facts(
    frame: Frame, sensor: Sensor, iso: float, ev: float, seed: int, source: str, negative: int
) -> dict[str, Any]:
    return {
        **frame.metadata,
        "isoSpeed": iso,
        "exposure_compensation": ev or None,
        "sensor": sensor.name,
        "sensor_hash": sensor.hash,
        "sensor_channels": list(sensor.channels),
        "sensor_from": source,
        "cameraMake": sensor.make,
        "cameraModel": sensor.model,
        "sensor_serial": sensor.serial,
        "noise_seed": seed,
        "negative_photosites": negative,
    }


def _remarks(frame: Frame, sensor: Sensor, light: Light, negative: float) -> list[str]:
    """Notes on a shot; ``negative``: share of the photosites with light below 0."""
    clipped = f"light below 0 was clipped to 0 at {negative:.2%} of the photosites"
    return [
        *([clipped] if negative else []),
        *_source_note(frame, sensor, light),
        *_pitch_note(frame, sensor),
        *_noise_note(frame, sensor, light),
    ]


def _source_note(frame: Frame, sensor: Sensor, light: Light) -> list[str]:
    if frame.channels is None or light.source == "channels":
        return []
    return [
        f"the frame holds the channels of {frame.metadata.get('sensor')}; those of {sensor.name} "
        f"are made from its {'XYZ' if light.source == 'xyz' else light.source}"
    ]


def _pitch_note(frame: Frame, sensor: Sensor) -> list[str]:
    pitch = np.ravel(frame.metadata.get("sensorPhotositePitch") or [])
    if not pitch.size or abs(pitch[0] / sensor.pixel_pitch - 1) <= 0.01:
        return []
    return [
        f"a pixel of the picture is {pitch[0]:.3g} um wide on the film, a photosite of "
        f"{sensor.name} {sensor.pixel_pitch:.3g} um: each pixel has the noise of one photosite, as "
        "in a crop at 100 %"
    ]


def _noise_note(frame: Frame, sensor: Sensor, light: Light) -> list[str]:
    """Warns if the render's own noise exceeds photon noise in many pixels."""
    share = noisy_share(frame, sensor, light)
    if share <= NOISY_SHARE:
        return []
    return [
        f"the render's own noise is larger than photon noise in {share:.0%} of the "
        "pixels; more samples reduce it"
    ]


def noisy_share(frame: Frame, sensor: Sensor, light: Light) -> float:
    """Share of the pixels with a variance over samples above the variance of photon noise.

    The variance is of luminance, in the strongest channel. Red, green and blue of a sample vary
    together (a path is bright or dark), so their standard deviations add.
    """
    if frame.variance is None:
        return 0.0
    of_white = light.lux_s * float(sensor.electrons_per_lux_s().max())
    luma = luminance_of_rgb().astype(np.float32)
    noisy = 0
    for rows in _stripes(frame.height):
        mean = frame.rgb[rows] @ luma
        deviation = np.sqrt(np.maximum(frame.variance[rows], 0)) @ luma
        noisy += int(np.count_nonzero(of_white * deviation**2 > np.maximum(mean, 0)))
    return noisy / (frame.width * frame.height)


def _stripes(height: int) -> Iterator[slice]:
    return (slice(row, min(row + _STRIPE, height)) for row in range(0, height, _STRIPE))


# Truth ------------------------------------------------------------------------------------------


def exposure_map(frame: Frame, iso: float, ev: float) -> NDArray[np.float32]:
    """Luminance exposure of each pixel of a sensor at an ISO, lux s, shape (H, W)."""
    factor = np.float32(exposure_of_one(frame.metadata, iso) * 2.0**ev)
    if frame.xyz is not None:
        return np.asarray(frame.xyz[..., 1] * factor, np.float32)
    luma = luminance_of_rgb().astype(np.float32)
    return np.asarray((frame.rgb @ luma) * factor, np.float32)


def check_can_expose(sensor: str | Sensor, iso: float | None) -> None:
    """Checks, before a long render, that the sensor exists and has this ISO.

    Raises:
        DaguerreError: No such sensor, or an ISO beyond its range.
    """
    body = load(sensor)
    if iso is not None:
        try:
            body.check_iso(iso)
        except UsageError as error:
            raise UsageError(f"--iso: {error}") from None
