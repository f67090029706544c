"""Reads lens files: JSON of the schema ``daguerre-lens/0.1``, lengths in mm."""

from __future__ import annotations

import itertools
from pathlib import Path

import daguerre._core as _core
from daguerre.errors import InputError, suggest
from daguerre.io.json_item import Item, clean
from daguerre.io.json_text import parse

from .lens import Lens, LensSurface, Nominal

SCHEMA = "daguerre-lens/0.1"
KINDS = ("spherical", "stop")
KNOWN_KINDS = (*KINDS, "aspheric", "cyl-x", "cyl-y")
COATINGS = ("uncoated", "mgf2", "perfect")
MAX_BYTES = 16_000_000


def read(path: str | Path, configuration: str | None = None) -> Lens:
    """Reads one lens.

    Args:
        path: The file.
        configuration: Zoom or focus position by name; the first one if None.

    Raises:
        InputError: With file and JSON path of what cannot be used.
    """
    root = _parse(Path(path))
    try:
        return _lens(root, Path(path), configuration)
    except InputError:
        raise
    except ValueError as error:  # the core's checks: lens and surface are in the message
        raise InputError(f"{path}: {error}") from None


def _parse(path: Path) -> Item:
    if path.suffix.lower() != ".json":
        raise InputError(
            f"{path}: lens file: wanted .json ({SCHEMA}), got {path.suffix or 'no suffix'}"
        )
    try:
        if path.exists() and not path.is_file():  # a pipe or a device would never end
            raise InputError(f"{path}: lens file: wanted an ordinary file")
        if path.stat().st_size > MAX_BYTES:
            raise InputError(f"{path}: lens file: wanted at most {MAX_BYTES} bytes")
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None
    return parse(data, str(path))


def _lens(root: Item, path: Path, configuration: str | None) -> Lens:
    schema = root.need("schema")
    if schema.text() != SCHEMA:
        schema.fail(f"wanted {SCHEMA!r}, got {schema.value!r}")
    items = root.list_of("surfaces")
    if not items:
        root.need("surfaces")
        root.fail("surfaces: wanted at least one surface, got none")
    chosen = _configuration(root, configuration)
    gaps = _gaps(chosen, len(items))
    surfaces = [_surface(item, gaps.get(i), i == len(items) - 1) for i, item in enumerate(items)]
    stops = [i for i, surface in enumerate(surfaces) if surface.stop]
    if len(stops) != 1:
        root.need("surfaces").fail(f"wanted exactly one stop, got {len(stops)}")
    override = _optional_number(chosen, "stop_semi_diameter", above=0) if chosen else None
    if override is not None:
        surfaces[stops[0]] = surfaces[stops[0]].replaced(semi_diameter=override)
    medium = root.get("object_medium")
    coating = root.get("coating")
    name = _text(root, "name") or path.stem
    nominal = _nominal(root, chosen)
    coating_name = "mgf2" if coating is None or coating.value is None else coating.choice(COATINGS)
    core = _core.Prescription(
        clean(name),
        [_core_surface(surface) for surface in surfaces],
        _core.Glass.constant(1.0) if medium is None or medium.value is None else _glass(medium)[0],
        coating_name,
        nominal.f_number or 0.0,
    )
    return Lens(
        name=clean(name),
        source=str(path),
        patent=_text(root, "patent"),
        note=_text(root, "note"),
        nominal=nominal,
        surfaces=tuple(surfaces),
        coating=coating_name,
        prescription=core,
        data=root.value,
    )


def _configuration(root: Item, name: str | None) -> Item | None:
    items = root.list_of("configurations")
    if name is None:
        return items[0] if items else None
    known = [item.need("name").text() for item in items]
    if name not in known:
        root.fail(f"configurations: no configuration named {name!r}{suggest(name, known)}")
    return items[known.index(name)]


def _gaps(configuration: Item | None, count: int) -> dict[int, float]:
    gaps = configuration.get("gaps") if configuration else None
    out: dict[int, float] = {}
    for item in gaps.members() if gaps and gaps.value is not None else []:
        key = str(item.key)
        if not key.isdecimal() or int(key) >= count:
            item.fail(f"wanted the index of a surface, 0 to {count - 1}, got {key!r}")
        out[int(key)] = item.number(-1e5, 1e5)
    return out


def _surface(item: Item, gap: float | None, last: bool) -> LensSurface:
    kind = item.need("kind")
    if kind.text() in KNOWN_KINDS and kind.value not in KINDS:
        kind.fail(f"wanted spherical or stop (this version traces no others), got {kind.value!r}")
    kind.choice(KINDS)
    for shape, harmless in (("conic", 0), ("asphere", {})):
        member = item.get(shape)
        if member is not None and member.value not in (None, harmless):
            member.fail("wanted a spherical surface (this version traces no aspheres)")
    radius = _optional_number(item, "radius")
    if radius == 0:
        item.need("radius").fail("wanted a signed radius in mm, or null for a plane, got 0")
    thickness = gap if gap is not None else _optional_number(item, "thickness")
    if not last and thickness is None:
        item.need("thickness").fail("wanted the distance to the next surface in mm, got null")
    if not last and thickness is not None and thickness < 0:
        item.need("thickness").fail(f"wanted at least 0 mm, got {thickness:g}")
    stop = item.get("stop")
    is_stop = kind.value == "stop" or (stop is not None and stop.value is not None and stop.flag())
    if kind.value == "stop" and radius is not None:
        item.need("radius").fail(f"wanted null (the stop is a plane), got {radius:g}")
    semi_diameter = _optional_number(item, "semi_diameter", above=0)
    if (
        semi_diameter is not None
        and radius is not None
        and semi_diameter > abs(radius) * (1 + 1e-9)
    ):
        item.need("semi_diameter").fail(
            f"wanted at most the radius, {abs(radius):g} mm, got {semi_diameter:g}"
        )
    glass = item.get("glass")
    core, label = (
        (_core.Glass.constant(1.0), "") if glass is None or glass.value is None else _glass(glass)
    )
    return LensSurface(
        kind=str(kind.value),
        radius=radius,
        thickness=thickness,
        semi_diameter=semi_diameter,
        glass=label,
        stop=is_stop,
        core_glass=core,
    )


def _glass(item: Item) -> tuple[_core.Glass, str]:
    """The glass and its label: its name, or nd/Vd."""
    label = _text(item, "name") or ""
    table = item.get("table")
    if table is not None:
        nodes = sorted(node.numbers(2, 0.5, 1e5) for node in table)
        if not nodes:
            table.fail("wanted [[nm, n], ...], got an empty list")
        if any(a[0] == b[0] for a, b in itertools.pairwise(nodes)):
            table.fail("wanted one index for each wavelength, got two")
        for node in table:
            Item(node.value[1], 1, node).number(1, 5)
        nm, n = zip(*nodes, strict=True)
        return _core.Glass.table(list(nm), list(n)), label or "table"
    nd = item.need("nd").number(1, 5)
    vd = _optional_number(item, "vd", above=0)
    if vd is None:
        return _core.Glass.constant(nd), label or f"{nd:.5g}"
    if vd < 5:
        item.need("vd").fail(f"wanted an Abbe number of at least 5, got {vd:g}")
    return _core.Glass.abbe(nd, vd), label or f"{nd:.5g}/{vd:.4g}"


def _core_surface(surface: LensSurface) -> _core.Surface:
    infinite = float("inf")
    return _core.Surface(
        0.0 if surface.radius is None else 1 / surface.radius,
        surface.thickness or 0.0,
        infinite if surface.semi_diameter is None else surface.semi_diameter,
        surface.core_glass,
        surface.stop,
        surface.kind,
    )


def _nominal(root: Item, configuration: Item | None) -> Nominal:
    nominal = root.get("nominal")

    def value(key: str) -> float | None:
        for item in (configuration, nominal):
            if item is not None and item.value is not None:
                number = _optional_number(item, key, above=0)
                if number is not None:
                    return number
        return None

    projection = None
    if nominal is not None and nominal.value is not None:
        projection = _text(nominal, "projection")
    return Nominal(
        efl_mm=value("efl_mm"),
        f_number=value("f_number"),
        full_field_deg=value("full_field_deg"),
        image_circle_mm=value("image_circle_mm"),
        projection=projection,
    )


def _optional_number(item: Item, key: str, *, above: float | None = None) -> float | None:
    member = item.get(key)
    return None if member is None or member.value is None else member.number(above=above)


def _text(item: Item, key: str) -> str | None:
    member = item.get(key)
    return None if member is None or member.value is None else clean(member.text())
