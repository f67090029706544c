"""A colour chart of known reflectances before a sensor, and how far two colours look apart."""

import dataclasses
import json
from pathlib import Path

import numpy as np

from daguerre.color import illuminants
from daguerre.color.adaptation import adaptation
from daguerre.color.spectra import rgb_from_xyz
from daguerre.frame.raw import Raw
from daguerre.sensors import load

_DATA = json.loads((Path(__file__).parents[2] / "data" / "colour_chart.json").read_text())
ROWS, COLUMNS, PATCH = 4, 6, 24
WHITE_LX_S = 10 / 0.18  # of ISO 1; a white surface has a developed value of 1


def reflectances():
    """At ``illuminants.NM``, shape (4, 6, L)."""
    nm = np.linspace(_DATA["first_nm"], _DATA["last_nm"], len(_DATA["reflectance"][0]))
    rows = [np.interp(illuminants.NM, nm, row) for row in _DATA["reflectance"]]
    return np.array(rows).reshape(ROWS, COLUMNS, -1)


def greys(*values):
    """Grey patches of these reflectances, shape (1, n, L)."""
    return np.ones(illuminants.NM.size) * np.array(values)[None, :, None]


def raw_of(sensor, surfaces, *, iso=None, ev=0.0, white=None):
    """Reading of patches by a sensor without noise, in a light exposed so that white is 1."""
    sensor = load(sensor) if isinstance(sensor, str) else sensor
    iso = iso or sensor.base_iso
    light = illuminants.d65() if white is None else illuminants.planck(white)
    photons = illuminants.photons_per_lux_s(light) * WHITE_LX_S / iso * 2.0**ev
    curves = sensor.mixing @ sensor.efficiency(illuminants.NM)
    electrons = (surfaces * photons) @ curves.T * sensor.photosite_area * illuminants.STEP
    wide = electrons.repeat(PATCH, axis=0).repeat(PATCH, axis=1)
    of = sensor.pattern.channel_map(*wide.shape[:2])
    numbers = np.take_along_axis(wide, of[:, :, None].astype(int), 2)[:, :, 0] * sensor.gain(iso)
    level = sensor.white_level(iso)
    facts = {"expTime": float(np.float32(1 / 125)), "aperture": 2.8, "lensModel": "Biotar 58 mm"}
    facts |= {"nominalFocalLength": 58.0, "sensorOverallDimensions": sensor.size, "version": "x"}
    return Raw(
        mosaic=np.clip(np.rint(numbers) + sensor.black_level, 0, level).astype(np.uint16),
        sensor=sensor,
        iso=iso,
        black_level=sensor.black_level,
        white_level=level,
        gain=sensor.gain(iso),
        neutral=sensor.neutral(white),
        white_balance=illuminants.white_xy(white),
        metadata=facts,
    )


def saved_large(raw, path):
    """Writes it again and again side by side: LibRaw refuses small pictures of X-Trans."""
    dataclasses.replace(raw, mosaic=np.tile(raw.mosaic, (6, 4)), clipped=None).save(path)


def truth(surfaces, white=None):
    """Linear Rec.709 of the patches, white adapted to D65, shape (rows, columns, 3)."""
    light = illuminants.d65() if white is None else illuminants.planck(white)
    xyz = (surfaces * light) @ illuminants.observer()
    adapted = adaptation(illuminants.white_xy(white), illuminants.D65_XY)
    return xyz @ adapted.T @ rgb_from_xyz().T


def patch_means(pixels, rows=ROWS, columns=COLUMNS):
    """Means of the middles of patches, shape (rows, columns, 3)."""
    height, width = pixels.shape[0] // rows, pixels.shape[1] // columns
    cells = pixels.reshape(rows, height, columns, width, 3)
    inner_y = slice(height // 3, height - height // 3)
    inner_x = slice(width // 3, width - width // 3)
    return cells[:, inner_y, :, inner_x].mean(axis=(1, 3))


def lab(rgb):
    """CIE L*a*b* of linear Rec.709, white D65."""
    white = np.linalg.inv(rgb_from_xyz()).sum(axis=1)
    t = (rgb @ np.linalg.inv(rgb_from_xyz()).T) / white
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    x, y, z = np.moveaxis(f, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def delta_e(one, other):
    """CIEDE2000. Source: Sharma, Wu and Dalal 2005, equations 2 to 22."""
    (l1, a1, b1), (l2, a2, b2) = np.moveaxis(one, -1, 0), np.moveaxis(other, -1, 0)
    mean7 = ((np.hypot(a1, b1) + np.hypot(a2, b2)) / 2) ** 7
    g = 0.5 * (1 - np.sqrt(mean7 / (mean7 + 25.0**7)))
    c1, c2 = np.hypot((1 + g) * a1, b1), np.hypot((1 + g) * a2, b2)
    h1 = np.degrees(np.arctan2(b1, (1 + g) * a1)) % 360
    h2 = np.degrees(np.arctan2(b2, (1 + g) * a2)) % 360
    turn = (h2 - h1 + 180) % 360 - 180
    turn = np.where(c1 * c2 == 0, 0, turn)
    hue = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(turn) / 2)
    h = np.where(c1 * c2 == 0, h1 + h2, (h1 + turn / 2) % 360)
    lightness, c = (l1 + l2) / 2, (c1 + c2) / 2
    cos = lambda degrees: np.cos(np.radians(degrees))  # noqa: E731
    t = 1 - 0.17 * cos(h - 30) + 0.24 * cos(2 * h) + 0.32 * cos(3 * h + 6) - 0.2 * cos(4 * h - 63)
    rotation = 2 * np.sqrt(c**7 / (c**7 + 25.0**7))
    rotation *= -np.sin(np.radians(60 * np.exp(-(((h - 275) / 25) ** 2))))
    sl = 1 + 0.015 * (lightness - 50) ** 2 / np.sqrt(20 + (lightness - 50) ** 2)
    dl, dc, dh = (l2 - l1) / sl, (c2 - c1) / (1 + 0.045 * c), hue / (1 + 0.015 * c * t)
    return np.sqrt(dl**2 + dc**2 + dh**2 + rotation * dc * dh)
