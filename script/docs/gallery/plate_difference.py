#!/usr/bin/env python3
"""Compares a composite in raw with a shot of the whole scene, photosite by photosite.

python script/docs/gallery/plate_difference.py SHOT.dng TRUTH.dng OBJECT.exr SCENE.glb CAMERA.json
    SENSOR OUT.png

OBJECT.exr needs `--aov object_id`: figures of glass and steel stand apart, as they show the plate.

Above: composite less truth as they are developed, twice what it is, around middle grey. Below:
means of squares of 8 px, in which noise is less and an error is not, eight times what they are.
Figures are in units of the noise that both shots have by the sensor that drew them, in OUT.json.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from plate_layers import Floats, write

import daguerre as dg
from daguerre.frame.raw import Raw
from daguerre.plates.files import read
from daguerre.plates.match.plate_raw import raw_of

Figures = dict[str, float]
BLOCK = 8  # px
TIMES, TIMES_OF_MEANS = 2, 8
#: Objects in which the photograph is seen.
SHOWING = "glass", "steel"


def main() -> None:
    """Reads the command line, compares, writes."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    for name in ("shot", "truth", "objects", "scene", "camera"):
        parser.add_argument(name, type=Path)
    parser.add_argument("sensor")
    parser.add_argument("output", type=Path)
    given = parser.parse_args()
    camera = dg.read_plate_camera(given.camera)
    body = dg.sensors.load(given.sensor)
    shot, truth = (
        replace(raw, sensor=body, gain=body.gain(raw.iso))
        for raw in (raw_of(read(path), camera) for path in (given.shot, given.truth))
    )
    write(given.output, picture(shot, truth))
    found = figures(shot, truth, regions(dg.load_frame(given.objects), dg.load(given.scene)))
    given.output.with_suffix(".json").write_text(json.dumps(found, indent=1) + "\n")


def picture(shot: Raw, truth: Raw) -> Floats:
    """Both comparisons, one above the other, display values."""
    less = np.asarray(shot.develop().pixels - truth.develop().pixels, np.float32)
    height, width = (side // BLOCK * BLOCK for side in less.shape[:2])
    means = blocks(less).repeat(BLOCK, axis=0).repeat(BLOCK, axis=1)
    gap = np.ones((6, width, 3), np.float32)
    shown = (0.5 + TIMES * less[:height, :width], gap, 0.5 + TIMES_OF_MEANS * means)
    return np.concatenate(shown).astype(np.float32)


def regions(frame: dg.Frame, scene: dg.Scene) -> dict[str, NDArray[np.bool_]]:
    """Pixels of objects, of the set that they change by a percent or more, and the rest."""
    if frame.catcher_ratio is None or "object_id" not in frame.aovs:
        raise SystemExit("wanted a render with catchers and --aov object_id, got one without")
    objects = np.asarray(frame.alpha) > 0.5
    ids = [k + 1 for k, thing in enumerate(scene.instances) if thing.name in SHOWING]
    showing = objects & np.isin(np.rint(frame.aovs["object_id"]), ids)
    changed = (np.abs(frame.catcher_ratio - 1) > 0.01).any(axis=2) & ~objects
    return {
        "painted pawns": objects & ~showing,
        "glass and steel": showing,
        "the set, where pawns change it": changed,
        "the rest": ~(objects | changed),
    }


def figures(shot: Raw, truth: Raw, where: dict[str, NDArray[np.bool_]]) -> dict[str, Figures]:
    """Composite less truth in each region; photosites that are clipped are left out."""
    one, two = shot.electrons().astype(float), truth.electrons().astype(float)
    read_noise = truth.sensor.read_noise_at(truth.iso)
    variance = np.maximum(one, 0) + np.maximum(two, 0) + 2 * read_noise**2
    told = ~(clipped(shot) | clipped(truth))
    return {name: of_region(one, two, variance, told & region) for name, region in where.items()}


def of_region(
    one: NDArray[np.float64],
    two: NDArray[np.float64],
    variance: NDArray[np.float64],
    region: NDArray[np.bool_],
) -> Figures:
    """Share of the picture, ratio of light, and the difference over its noise.

    A variance of few electrons that is taken from the electrons themselves is off where they are;
    so mean and spread are those of sums over squares, and of the whole region.
    """
    less, noise = np.where(region, one - two, 0), np.where(region, variance, 0)
    deviation = np.sqrt(smoothed(variance))
    each = (less / deviation)[region]
    of_squares = blocks(less[..., None])[..., 0] / np.sqrt(
        np.maximum(blocks(noise[..., None])[..., 0], 1e-9)
    )
    many = blocks(region[..., None].astype(float))[..., 0] > 0.5
    return {
        "share": round(float(region.mean()), 4),
        "light": round(float(one[region].sum() / two[region].sum()), 4),
        "mean": round(float(each.mean()), 4),
        "rms": round(float(np.sqrt((each**2).mean())), 4),
        "rms_of_squares": round(float(np.sqrt((of_squares[many] ** 2).mean()) * BLOCK), 4),
    }


def smoothed(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Means of photosites of one colour, 3 x 3, around the edges."""
    moved = [np.roll(values, (y, x), (0, 1)) for y in (-2, 0, 2) for x in (-2, 0, 2)]
    return np.asarray(np.mean(moved, axis=0))


def clipped(raw: Raw) -> NDArray[np.bool_]:
    """Photosites at the end of their numbers."""
    return np.asarray(raw.mosaic >= min(raw.white_level, raw.sensor.highest_dn) - 1)


def blocks(image: NDArray[np.floating]) -> NDArray[np.floating]:
    """Means over squares of pixels, shape (H / 8, W / 8, C)."""
    rows, columns = (side // BLOCK for side in image.shape[:2])
    cut = image[: rows * BLOCK, : columns * BLOCK]
    return np.asarray(cut.reshape(rows, BLOCK, columns, BLOCK, -1).mean((1, 3)))


if __name__ == "__main__":
    main()
