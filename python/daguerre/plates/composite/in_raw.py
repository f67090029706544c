"""Composites objects into a raw picture: in electrons of the mosaic, with matching noise.

A photosite of the plate has N electrons, Poisson distributed with mean L, plus read noise of
standard deviation r. Objects leave the share k of its light and add E electrons on average. A real
shot of plate and objects has mean k L + E and read noise once. The plate's value is converted to

    k (N + read) + noise of variance k (1 - k) L + (1 - k^2) r^2 + a Poisson number of mean E,

with N in place of L. Mean and variance are as in a real shot (thinning of a Poisson process;
Kingman 1993, Poisson Processes, 5.1). Where nothing changes, the plate keeps its values exactly.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.checks import short, whole
from daguerre.errors import InputError, UsageError
from daguerre.exposure.expose import Light, chosen_ev, light_of
from daguerre.frame.frame import Frame
from daguerre.frame.over import AUTO, RATIO, Change, change_of
from daguerre.frame.raw import Raw
from daguerre.sensors.sensor import Sensor

Mosaic = NDArray[np.float32]
#: Change below which a photosite keeps its value, as a share of its light or in electrons.
NOTHING = 1e-4


def composite_raw(plate: Raw, frame: Frame, *, form: str = AUTO, seed: int = 0) -> Raw:
    """Composites objects into a raw picture.

    Args:
        plate: Raw picture of a known sensor.
        frame: Objects, rendered with the plate's camera and sensor (``sensor=``).
        form: How catchers change the plate, ``auto`` or ``ratio``; see ``over``.
        seed: Seed of the noise of added objects.

    Returns:
        The plate with new values where the objects change it.

    Raises:
        InputError: The sizes differ, or the frame lacks its exposure or catcher channels of the
            plate's sensor.
        UsageError: Another ``form``: electrons can be removed only as a share.
    """
    if form not in (AUTO, RATIO):
        raise UsageError(f"form: wanted {AUTO} or {RATIO} for a raw plate, got {short(form)}")
    shown = frame.without_overscan()
    if (shown.width, shown.height) != (plate.width, plate.height):
        raise InputError(
            f"composite: size: wanted the plate's {plate.width} x {plate.height} px, "
            f"got {shown.width} x {shown.height} px"
        )
    kept, added = kept_and_added(plate, shown, form)
    rng = np.random.Generator(np.random.Philox(whole(seed, "seed", 0, 2**64 - 1)))
    read = plate.sensor.read_noise_at(plate.iso)
    electrons = mixed(plate.electrons(), kept, added, read, rng)
    full = plate.sensor.full_well_at(plate.iso)
    number = np.rint(np.minimum(electrons, full) * plate.gain + plate.black_level)
    changed = (np.abs(1 - kept) > NOTHING) | (added > NOTHING)
    highest = plate.sensor.highest_dn
    mosaic = np.where(changed, np.clip(number, 0, highest), plate.mosaic).astype(np.uint16)
    clipped = np.where(changed, (electrons >= full) | (number >= highest), plate.saturated)
    return replace(plate, mosaic=mosaic, clipped=clipped, luminance_exposure=None)


def mixed(
    plate: Mosaic, kept: Mosaic, added: Mosaic, read: float, rng: np.random.Generator
) -> Mosaic:
    """Electrons of a shot with the share ``kept`` of the plate's light, and ``added`` electrons.

    Args:
        plate: Electrons of the plate, with noise, shape (H, W).
        kept: Share of the plate's light that remains, 0 .. 1.
        added: Mean number of added electrons.
        read: Standard deviation of read noise, electrons.
        rng: Random number generator.
    """
    light = np.maximum(plate, 0)
    variance = kept * (1 - kept) * light + (1 - kept**2) * read**2
    noise = rng.standard_normal(plate.shape, np.float32) * np.sqrt(np.maximum(variance, 0))
    return np.asarray(kept * plate + noise + rng.poisson(np.maximum(added, 0)), np.float32)


def kept_and_added(plate: Raw, frame: Frame, form: str) -> tuple[Mosaic, Mosaic]:
    """Kept share and added electrons of each photosite, after the sensor's filters."""
    body = plate.sensor
    light = light_of(frame, body, plate.iso, chosen_ev(frame, None))
    change = _change(frame, body, light, form)
    one = np.eye(len(body.channels), dtype=np.float32)
    kept = _core.expected_electrons(_planes(np.clip(change.factor, 0, 1)), _shot(body, one, 0.0))
    # A kept share above 1 (only a ratio has it) becomes added light.
    more = np.maximum(change.factor - 1, 0)
    added = _core.expected_electrons(_planes(change.light), _shot(body, one, body.prnu))
    if more.any():
        times = _core.expected_electrons(_planes(more), _shot(body, one, 0.0))
        added = added + times * np.maximum(plate.electrons(), 0)
    return np.asarray(kept), np.asarray(added)


def _change(frame: Frame, body: Sensor, light: Light, form: str) -> Change:
    """Change in electrons of each channel of the sensor.

    The light of objects may be fitted from colours. Catchers need channels of the sensor itself,
    which denoising does not change.
    """
    added = np.asarray(light.planes @ light.electrons.T.astype(np.float32))
    if frame.catcher is None:
        return change_of(added, frame.alpha, None, None, form)
    if frame.catcher_channels is not None and frame.metadata.get("sensor_hash") == body.hash:
        per_one = (body.electrons_per_lux_s() * light.lux_s).astype(np.float32)
        caught = frame.catcher_channels * per_one
        return change_of(added, frame.alpha, caught, frame.catcher_ratio_channels, form)
    raise InputError(
        "composite: a raw plate needs catcher channels of its own sensor: render with "
        f"--sensor {body.name}"
    )


def _planes(values: Mosaic) -> Mosaic:
    return np.ascontiguousarray(values, np.float32)


def _shot(body: Sensor, electrons: Mosaic, prnu: float) -> _core.Shot:
    shot = _core.Shot(electrons, body.pattern.cells)
    shot.low_pass_px = body.low_pass / body.pixel_pitch
    shot.crosstalk, shot.prnu, shot.serial = body.crosstalk, prnu, body.serial
    return shot
