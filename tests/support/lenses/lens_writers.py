"""Writers of other programs' lens files, from a ``daguerre-lens/0.1`` value: for round trips.

Glasses need nd and vd (pbrt: nd). A writer knows what the tests' lenses have, and no more.
"""

from __future__ import annotations

from typing import Any

Data = dict[str, Any]


def _gaps(data: Data) -> list[dict[int, float]]:
    """Thicknesses of each configuration, by surface."""
    base = {i: s["thickness"] or 0.0 for i, s in enumerate(data["surfaces"])}
    configurations = data.get("configurations") or [{"gaps": {}}]
    return [base | {int(i): gap for i, gap in c.get("gaps", {}).items()} for c in configurations]


def _is_stop(surface: Data) -> bool:
    return surface["kind"] == "stop" or bool(surface.get("stop"))


def _moves(surface: Data) -> tuple[list[float], list[float]] | None:
    shift, tilt = surface.get("decenter", [0, 0, 0]), surface.get("tilt", [0, 0, 0])
    return (shift, tilt) if any(shift) or any(tilt) else None


# Zemax -----------------------------------------------------------------------------------------


def zmx(data: Data, unit: str = "MM") -> str:
    """A Zemax file. A moved surface (by a tilt about x only) stands between coordinate breaks."""
    per = {"MM": 1.0, "IN": 25.4, "CM": 10.0}[unit]
    numbers: dict[int, int] = {}
    blocks: list[str] = [_block(0, ["TYPE STANDARD", "CURV 0", "DISZ INFINITY"])]
    for i, s in enumerate(data["surfaces"]):
        move = _moves(s)
        if move:
            blocks.append(_break(len(blocks), *move, per))
        numbers[i] = len(blocks)
        rows = _zmx_rows(s, per)
        thickness = 0.0 if move else (s["thickness"] or 0.0)
        blocks.append(_block(len(blocks), [*rows, f"DISZ {thickness / per!r}"]))
        if move:
            back = _break(len(blocks), *([-v for v in part] for part in move), per, True)
            blocks.append(back.replace("DISZ 0", f"DISZ {(s['thickness'] or 0.0) / per!r}"))
    blocks.append(_block(len(blocks), ["TYPE STANDARD", "CURV 0", "DISZ 0"]))
    lines = ["VERS 1", "MODE SEQ", f"NAME {data['name']}", f"UNIT {unit} X W X CM MR CPMM", "FLOA"]
    lines += ["ENVD 20 1 0", "GCAT SCHOTT", *blocks, *_operands(data, numbers, per)]
    return "\n".join(lines) + "\n"


def _block(number: int, rows: list[str]) -> str:
    return "\n".join([f"SURF {number}", *(f"  {row}" for row in rows)])


def _break(
    number: int, shift: list[float], tilt: list[float], per: float, tilt_first: bool = False
) -> str:
    values = [shift[0] / per, shift[1] / per, *tilt, int(tilt_first)]
    rows = [f"PARM {i} {v!r}" for i, v in enumerate(values, 1)]
    return _block(number, ["TYPE COORDBRK", *rows, "DISZ 0"])


def _zmx_rows(s: Data, per: float) -> list[str]:
    kinds = {"biconic": "BICONICX", "toroid": "TOROIDAL"}
    powers = {int(name[1:]): a for name, a in s.get("asphere", {}).items()}
    odd = any(p % 2 for p in powers)
    kind = kinds.get(s["kind"], ("ODDASPHE" if odd else "EVENASPH") if powers else "STANDARD")
    rows = [f"TYPE {kind}", f"CURV {per / s['radius'] if s['radius'] else 0.0!r} 0 0 0 0"]
    if _is_stop(s):
        rows.append("STOP")
    for power, a in powers.items():
        rows.append(f"PARM {power if odd else power // 2} {a * per ** (power - 1)!r}")
    if s["kind"] in kinds:
        rows.append(f"PARM 1 {(s.get('radius_x') or 0.0) / per!r}")
    if s["kind"] == "biconic":
        rows.append(f"PARM 2 {s.get('conic_x', 0.0)!r}")
    if s.get("conic"):
        rows.append(f"CONI {s['conic']!r}")
    if s["glass"]:
        rows.append(f"GLAS ___BLANK 1 0 {s['glass']['nd']!r} {s['glass'].get('vd', 0)!r} 0")
    if s["semi_diameter"]:
        rows.append(f"DIAM {s['semi_diameter'] / per!r} 1 0 0 1")
    return rows


def _operands(data: Data, numbers: dict[int, int], per: float) -> list[str]:
    gaps = _gaps(data)
    rows = [f"MNUM {len(gaps)} 1"]
    for i, number in numbers.items():
        if len({g[i] for g in gaps}) > 1:
            rows += [f"THIC {number} {c} {g[i] / per!r} 0 0 0" for c, g in enumerate(gaps, 1)]
    for c, configuration in enumerate(data.get("configurations") or [], 1):
        rows.append(f'LTTL 0 {c} "{configuration["name"]}"')
    return rows if len(gaps) > 1 else []


# CODE V ----------------------------------------------------------------------------------------


def seq(data: Data, radius_mode: bool = True) -> str:
    """A CODE V sequence. A moved surface is decentred and returns (DAR)."""
    lines = [f"RDM{'' if radius_mode else ' N'}; LEN", f"TITLE '{data['name']}'", "DIM M"]
    lines += ["WL 656.3 587.6 486.1", "REF 2", "SO 0.0 0.1e14"]
    for s in data["surfaces"]:
        form = s["radius"] or 0.0
        if not radius_mode:
            form = 1 / form if form else 0.0
        glass = ""
        if s["glass"]:
            glass = f"{s['glass']['nd']!r}:{s['glass'].get('vd', 0)!r}"
        lines.append(f"S {form!r} {s['thickness'] or 0.0!r} {glass} ! {s['kind']}")
        lines += [f"  {row}" for row in _seq_rows(s)]
    lines.append("SI 0.0 0.0")
    gaps = _gaps(data)
    if len(gaps) > 1:
        lines.append(f"ZOOM {len(gaps)}")
        for i in gaps[0]:
            if len({g[i] for g in gaps}) > 1:
                values = [repr(g[i]) for g in gaps]
                lines.append(f"ZOO THI S{i + 1} {values[0]} &\n {' '.join(values[1:])}")
    return "\n".join([*lines, "GO", ""])


def _seq_rows(s: Data) -> list[str]:
    rows = ["STO"] if _is_stop(s) else []
    if s["semi_diameter"]:
        rows.append(f"CIR {s['semi_diameter']!r}; CIR EDG {2 * s['semi_diameter']!r}")
    if s["kind"] == "toroid":
        rows.append(f"YTO; RDX {s.get('radius_x') or 0.0!r}; K {s.get('conic', 0.0)!r}")
    elif s["kind"] == "biconic":
        rows.append(f"AAS; RDX {s.get('radius_x') or 0.0!r}; KY {s.get('conic', 0.0)!r}")
        rows.append(f"KX {s.get('conic_x', 0.0)!r}")
    elif s.get("conic") or s.get("asphere"):
        rows += ["ASP", f"K {s.get('conic', 0.0)!r}"]
        for name, a in s.get("asphere", {}).items():
            rows.append(f"{'ABCDEFGHJ'[int(name[1:]) // 2 - 2]} {a!r}")
    move = _moves(s)
    if move:
        (x, y, _), (a, b, c) = move
        rows.append(f"XDE {x!r}; YDE {y!r}; ADE {-a!r}; BDE {-b!r}; CDE {c!r}; DAR")
    return rows


# Optical Bench ---------------------------------------------------------------------------------


def optical_bench(data: Data) -> str:
    """Text of the Optical Bench."""
    gaps = _gaps(data)
    moving = [i for i in gaps[0] if len({g[i] for g in gaps}) > 1]
    configurations = data.get("configurations") or [{}]
    rows = ["[descriptive data]", f"title\t{data['name']}", "[constants]", "[variable distances]"]
    rows.append(_row("Focal Length", *(c.get("efl_mm") or "undefined" for c in configurations)))
    rows.append(_row("d0", *("Infinity" for _ in configurations)))
    if any(c.get("stop_semi_diameter") for c in configurations):
        stops = [2 * c["stop_semi_diameter"] for c in configurations]
        rows.append(_row("Aperture Diameter", *stops))
    rows += [_row(f"d{i + 1}", *(g[i] for g in gaps)) for i in moving]
    rows.append("[lens data]")
    aspheres = ["[aspherical data]"]
    for i, s in enumerate(data["surfaces"]):
        glass = s["glass"] or {}
        radius = "AS" if s["kind"] == "stop" else s["radius"] or "Infinity"
        gap = f"d{i + 1}" if i in moving else s["thickness"] or 0.0
        diameter = 2 * s["semi_diameter"] if s["semi_diameter"] else ""
        cells = (i + 1, radius, gap, glass.get("nd", ""), diameter, glass.get("vd", ""))
        rows.append(_row(*cells))
        if s.get("conic") or s.get("asphere"):
            terms = {int(name[1:]): a for name, a in s.get("asphere", {}).items()}
            powers = range(4, max(terms, default=2) + 1, 2)
            values = (terms.get(p, 0.0) for p in powers)
            aspheres.append(_row(i + 1, radius, s.get("conic", 0.0), *values))
    return "\n".join([*rows, *(aspheres if len(aspheres) > 1 else []), "[notes]", "made here", ""])


def _row(*cells: Any) -> str:
    return "\t".join(cell if isinstance(cell, str) else repr(cell) for cell in cells)


# pbrt ------------------------------------------------------------------------------------------


def pbrt(data: Data, thickness_first: bool = False) -> str:
    """A lens file of pbrt, or of the older layout with thicknesses before their surfaces."""
    surfaces = data["surfaces"]
    gaps = [s["thickness"] or 0.0 for s in surfaces[:-1]]
    gaps = [0.0, *gaps] if thickness_first else [*gaps, 0.0]
    rows = [f"# {data['name']}", "# radius axpos N aperture"]
    for s, gap in zip(surfaces, gaps, strict=True):
        index = s["glass"]["nd"] if s["glass"] else 0 if _is_stop(s) else 1
        rows.append(f"{s['radius'] or 0.0!r}\t{gap!r} {index!r} {2 * s['semi_diameter']!r}")
    return "\n".join(rows)
