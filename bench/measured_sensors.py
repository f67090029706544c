"""Bodies of the sensor library against measured ones: daylight, and noise by ISO.

    python bench/measured_sensors.py [--json] [--data FOLDER] [--sensor NAME ...]

Data: cameras.json in ../shared/data/reality or in --data.

``daylight``: red and blue multiplier of D65, EV, less those of Adobe's matrix.
``noise``: a smooth ramp is exposed at each whole stop, written as DNG, balanced and demosaiced by
    LibRaw (PPG; Markesteijn for X-Trans). The variance of green's HH Haar band,
    (x00 - x01 - x10 + x11) / 4, is a x + b, with x = 1 at white. ``slope`` is our a over the
    measured one; ``flat`` is how far it strays from its mean over ISO, relative.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre import sensors
from daguerre.color import illuminants
from daguerre.development.channels import Demosaic, of_raw
from daguerre.errors import DaguerreError, InputError
from daguerre.frame.frame import Frame
from daguerre.sensors import Sensor

Floats = NDArray[np.float64]
Row = dict[str, Any]
SHARED = Path(__file__).parents[2] / "shared" / "data" / "reality"
CAMERAS = "cameras.json"
GREEN = 1
#: Noise of a normal distribution over the median of its absolute values.
SIGMA_OVER_MEDIAN = 1 / 0.6745
RAMP = (960, 1440)  # rows, columns
BINS, DARKEST, BRIGHTEST = 300, 0.01, 0.9  # levels of x
#: ISO range of the measurements that are of one kind: beyond it the body or the person who measured
#: changed the raw files, so that the noise steps without a step of the gain.
COMPARED = {
    "canon-eos-1d-x-mark-ii": (200, 12800),
    "hasselblad-l1d-20c": (100, 1600),
    "nikon-d5300": (400, 12800),
    "nikon-d810": (1600, 12800),
}
HIGHEST_ISO = 12800  # bodies smooth their raw files at the highest settings


def cameras(folder: Path | None) -> list[Row]:
    """Measured bodies."""
    path = (folder or SHARED) / CAMERAS
    if not path.is_file():
        raise InputError(f"--data: wanted a folder with {CAMERAS}, got {path.parent}")
    return list(json.loads(path.read_text())["cameras"])


def measurements(sensor: Sensor, known: list[Row]) -> Row | None:
    """Measurements of one body, if there are any; some of its names lack the series."""
    make, model = sensor.make.lower(), sensor.model.lower()
    same = (one for one in known if one["make"].lower() == make)
    return next((one for one in same if model.endswith(one["model"].lower())), None)


def measured_bodies(folder: Path | None, names: Sequence[str]) -> list[tuple[Sensor, Row]]:
    """Sensors with their measurements; without names, all of the library that have some."""
    known, found = cameras(folder), []
    for name in names or sensors.names():
        sensor = sensors.load(name)
        measured = measurements(sensor, known)
        if measured:
            found.append((sensor, measured))
        elif names:
            raise InputError(f"--sensor: wanted a body with measurements, got {name}")
    return found


def daylight(sensor: Sensor, matrix: list[float]) -> dict[str, float]:
    """Multipliers of red and blue, EV, less those of a matrix from XYZ to the camera."""
    white = np.reshape(matrix, (3, 3)) @ illuminants.xyz_of_xy(illuminants.D65_XY)
    ours = sensor.neutral()
    off = np.log2((white / white[GREEN]) / (ours / ours[GREEN]))
    return {"red_ev": float(off[0]), "blue_ev": float(off[2])}


def ramp(sensor: Sensor, iso: float) -> Frame:
    """D65 light from black to a little above white."""
    rows, columns = RAMP
    grey = np.linspace(0, 1.1, columns, dtype=np.float32)
    white = illuminants.observer().T @ illuminants.d65()
    xyz = np.broadcast_to(grey[None, :, None] * white, (rows, columns, 3)).astype(np.float32)
    electrons = (sensor.white_level(iso) - sensor.black_level) / sensor.gain(iso)
    lux_s = electrons / float(sensor.white_electrons().max())
    rgb = np.repeat(np.broadcast_to(grey, (rows, columns))[:, :, None], 3, axis=2)
    return Frame(rgb=rgb, xyz=xyz, metadata={"luminance_exposure": lux_s, "expTime": 0.01})


def noise(sensor: Sensor, iso: float) -> tuple[float, float]:
    """Slope and intercept of the noise's variance over the light, in green."""
    raw = ramp(sensor, iso).expose(sensor, iso, seed=1)
    picture = of_raw(raw, Demosaic("ppg", clip=True))
    green = picture.pixels[:, :, GREEN] / picture.full.min()
    return line_of(*variances(green))


def variances(green: Floats) -> tuple[Floats, Floats]:
    """Level and variance of the HH Haar band in bins of equal level."""
    a, b, c, d = (green[y::2, x::2] for y in (0, 1) for x in (0, 1))
    level, band = (a + b + c + d) / 4, abs(a - b - c + d) / 4
    bins = (level * BINS).astype(int)
    used = np.arange(int(DARKEST * BINS), int(BRIGHTEST * BINS))
    found = [np.median(band[bins == k]) * SIGMA_OVER_MEDIAN for k in used]
    return (used + 0.5) / BINS, np.square(found)


def line_of(levels: Floats, found: Floats) -> tuple[float, float]:
    """Line through variances: their errors are proportional to them."""
    slope, intercept = np.polyfit(levels, found, 1, w=1 / found)
    return float(slope), float(intercept)


def slopes(sensor: Sensor, measured: list[list[float]]) -> dict[str, float]:
    """Our slope over the measured one, by ISO, at whole stops."""
    low, high = COMPARED.get(sensor.name, (sensor.base_iso, HIGHEST_ISO))
    by_iso: dict[float, list[float]] = {}
    for iso, _, green, *_ in measured:
        stops = np.log2(iso / 100)
        if low <= iso <= high and abs(stops - round(stops)) < 0.02:
            by_iso.setdefault(iso, []).append(green)
    return {f"{iso:g}": noise(sensor, iso)[0] / float(np.mean(by_iso[iso])) for iso in by_iso}


def row(sensor: Sensor, measured: Row) -> Row:
    """Everything about one body."""
    made: Row = {"sensor": sensor.name, "daylight": None, "slope": None, "flat": None}
    if measured["xyz_to_camera_d65"]:
        made["daylight"] = daylight(sensor, measured["xyz_to_camera_d65"])
    if measured["noise"]:
        made["slope"] = slopes(sensor, measured["noise"])
        found = np.array(list(made["slope"].values()))
        made["flat"] = float(abs(found / found.mean() - 1).max())
    return made


def line(one: Row) -> str:
    """A line of the table."""
    light = one["daylight"] or {}
    shown = "".join(f"{light.get(k, np.nan):8.2f}" for k in ("red_ev", "blue_ev"))
    ratios = one["slope"] or {}
    flat = np.nan if one["flat"] is None else one["flat"]
    steps = " ".join(f"{iso}: {ratio:.2f}" for iso, ratio in ratios.items())
    return f"{one['sensor']:26}{shown}{flat:8.2f}  {steps}"


def main() -> None:
    """Prints a table, or one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--data", type=Path, metavar="FOLDER")
    parser.add_argument("--sensor", nargs="+", default=(), metavar="NAME")
    arguments = parser.parse_args()
    try:
        bodies = measured_bodies(arguments.data, arguments.sensor)
    except DaguerreError as error:
        print(f"measured_sensors: {error}", file=sys.stderr)
        sys.exit(error.exit_code)
    rows = []
    if not arguments.json:
        print(f"{'sensor':26}{'red EV':>8}{'blue EV':>8}{'flat':>8}  slope over measured, by ISO")
    for sensor, measured in bodies:
        rows.append(row(sensor, measured))
        if not arguments.json:
            print(line(rows[-1]), flush=True)
    if arguments.json:
        print(json.dumps({"bench": "measured_sensors", "bodies": rows}))


if __name__ == "__main__":
    main()
