"""Reads sensor files: JSON of the schema ``daguerre-sensor/0.1``; see docs/sensor-format.md."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from daguerre.argument_checks import guarded
from daguerre.files.json_file import checked_json, read_json_file
from daguerre.files.json_item import MAX_NAME, Item

from .curve import Curve
from .data import DarkCurrent, DualGain, HotPixels
from .mosaic import Mosaic
from .sensor import Sensor

SCHEMA = "daguerre-sensor/0.1"
MEMBERS = (
    *("schema", "name", "make", "model", "source", "licence"),
    *("measured", "fitted", "assumed", "note"),
    *("pixel_pitch_um", "resolution", "size_mm", "fill_factor", "pattern", "wavelengths_nm"),
    *("quantum_efficiency", "infrared_cut", "cover_glass", "full_well_e", "dual_gain"),
    *("read_noise_e", "dark_current", "prnu", "dsnu_e", "hot_pixels", "black_level_dn"),
    *("bit_depth", "iso_range", "base_iso", "crosstalk", "low_pass_um"),
)


@guarded
def read(path: str | Path) -> Sensor:
    """Reads a sensor file.

    Raises:
        InputError: The file cannot be used; the message has the file and JSON path.
    """
    return read_json_file(path, SCHEMA, MEMBERS, _sensor)


def read_text(text: str, source: str) -> Sensor:
    """Reads the text of a sensor file.

    Args:
        text: JSON.
        source: Name of the file, for messages.

    Raises:
        InputError: It cannot be used; the message has the JSON path.
    """
    data = text.encode("utf-8", "surrogatepass")
    return checked_json(data, source, SCHEMA, MEMBERS, _sensor)


def _sensor(root: Item) -> Sensor:
    curves = root.need("quantum_efficiency").members()
    channels = tuple(str(curve.key) for curve in curves)
    name = root.need("name").text(MAX_NAME)
    size = root.get("size_mm")
    columns, rows = root.need("resolution").numbers(2, 1, 65536)
    low, high = root.need("iso_range").numbers(2)
    return Sensor(
        name=name,
        make=root.need("make").text(),
        model=root.need("model").text(),
        source=root.need("source").text(),
        licence=root.need("licence").text(),
        measured=_texts(root, "measured"),
        fitted=_texts(root, "fitted"),
        assumed=_texts(root, "assumed"),
        note=_text(root, "note"),
        pixel_pitch=root.need("pixel_pitch_um").number(),
        resolution=(int(columns), int(rows)),
        size=(0.0, 0.0) if size is None else _pair(size.numbers(2)),
        fill_factor=root.number_of("fill_factor", 1.0),
        pattern=Mosaic.of(root.need("pattern").text(), channels, f"sensor {name}"),
        channels=channels,
        wavelengths=_list(root.need("wavelengths_nm")),
        quantum_efficiency=_rows(root, curves),
        infrared_cut=_curve(root.get("infrared_cut")),
        cover_glass=_curve(root.get("cover_glass")),
        full_well=root.need("full_well_e").number(),
        read_noise=tuple(_pair(row.numbers(2)) for row in root.need("read_noise_e")),
        dual_gain=_dual_gain(root.get("dual_gain")),
        dark_current=_dark_current(root.get("dark_current")),
        prnu=root.number_of("prnu", 0.0),
        dsnu=root.number_of("dsnu_e", 0.0),
        hot_pixels=_hot_pixels(root.get("hot_pixels")),
        black_level=root.need("black_level_dn").integer(0, 65535),
        bit_depth=root.need("bit_depth").integer(1, 16),
        iso_range=(low, high),
        base_iso=root.need("base_iso").number(),
        crosstalk=root.number_of("crosstalk", 0.0),
        low_pass=root.number_of("low_pass_um", 0.0),
    )


def _text(root: Item, key: str) -> str:
    item = root.get(key)
    return "" if item is None else item.text()


def _texts(root: Item, key: str) -> tuple[str, ...]:
    return tuple(item.text() for item in root.list_of(key))


def _pair(values: tuple[float, ...]) -> tuple[float, float]:
    return values[0], values[1]


def _list(item: Item) -> Any:
    return [element.number() for element in item]


def _rows(root: Item, curves: list[Item]) -> Any:
    count = len(list(root.need("wavelengths_nm")))
    for curve in curves:
        if len(list(curve)) != count:
            curve.fail(
                f"wrong length: wanted {count} numbers, one for each wavelength, "
                f"got {len(list(curve))}"
            )
    return [[element.number(0, 1) for element in curve] for curve in curves]


def _curve(item: Item | None) -> Curve | None:
    if item is None or item.value is None:
        return None
    return Curve(_list(item.need("wavelengths_nm")), _list(item.need("transmittance")))


def _dual_gain(item: Item | None) -> DualGain | None:
    if item is None or item.value is None:
        return None
    return DualGain(item.need("iso").number(), item.need("full_well_e").number())


def _dark_current(item: Item | None) -> DarkCurrent:
    if item is None:
        return DarkCurrent()
    return DarkCurrent(
        item.need("rate_e_per_s").number(),
        item.need("temperature_c").number(),
        item.need("doubling_k").number(),
    )


def _hot_pixels(item: Item | None) -> HotPixels:
    if item is None:
        return HotPixels()
    return HotPixels(item.need("share").number(), item.need("rate_e_per_s").number())
