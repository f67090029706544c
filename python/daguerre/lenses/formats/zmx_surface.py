"""Reads one surface block of a Zemax file."""

from __future__ import annotations

import math
from typing import Any

from .draft import Draft, moved
from .glass import Glass, model, named
from .text import Line, Unread, words

#: Records that do not change the rays: names, drawing, mechanics, hints for solvers.
_HARMLESS = words("COMM HIDE MIRR SLAB POPS FIMP SSID MEMA OEMA BLNK LOCK CFSR")
#: Records that a surface has once.
_SINGLE = words("TYPE CURV DISZ GLAS DIAM CONI STOP TCOM TOLE COAT OBDC")
_APERTURES = words("CLAP OBSC FLAP SQAP SQOB ELAP ELOB SPID USAP UOBS")
_FORMS = ("STANDARD", "EVENASPH", "ODDASPHE", "XASPHERE", "XOSPHERE", "BICONICX", "TOROIDAL")
_FORMS_OF_AIR = ("COORDBRK",)


class Block:
    """The records of one surface."""

    def __init__(self, line: Line, number: int) -> None:
        self.line = line
        self.number = number
        self.records: dict[str, Line] = {}
        self.parameters: dict[int, Line] = {}
        self.extra: dict[int, Line] = {}
        self.apertures: list[Line] = []
        self.solves: list[str] = []

    def take(self, line: Line) -> bool:
        """Adds a record; returns false if it is not one of a surface."""
        keyword = line.words[0].upper()
        if keyword in _SINGLE:
            self.records[keyword] = line
        elif keyword in ("PARM", "XDAT"):
            rows = self.parameters if keyword == "PARM" else self.extra
            rows[line.whole_at(1, "number", 0, 1000)] = line
        elif keyword in _APERTURES:
            self.apertures.append(line)
        elif keyword in ("PZUP", "CHZH", "EDGE", "OPDZ", "CCUR", "MAZH"):
            self.solves.append(keyword)
        elif keyword not in _HARMLESS and keyword != "PPAR":
            return False
        return True

    @property
    def kind(self) -> str:
        """Type of the surface, such as STANDARD."""
        line = self.records.get("TYPE")
        return "STANDARD" if line is None else line.word(1, "type").upper()

    def value(self, keyword: str, index: int, default: float) -> float:
        """A number of a record, or the default where it is absent."""
        line = self.records.get(keyword)
        return default if line is None else line.number_at(index, "value", default=default)

    def parameter(self, number: int) -> float:
        """Value of a ``PARM`` record; 0 if absent."""
        line = self.parameters.get(number)
        return 0.0 if line is None else line.number_at(2, "value", default=0)

    def extra_value(self, number: int) -> float:
        """Value of an ``XDAT`` record; 0 if absent."""
        line = self.extra.get(number)
        return 0.0 if line is None else line.number_at(2, "value", default=0)

    def thickness(self) -> float:
        """Thickness in the file's unit; infinite is allowed for the object."""
        line = self.records.get("DISZ")
        if line is None:
            return 0.0
        word = line.word(1, "thickness")
        if word.upper() in ("INFINITY", "INF", "1.#INF"):
            if self.number:
                line.fail(f"surface {self.number}: DISZ: wanted a finite thickness, got {word}")
            return math.inf
        return line.to_number(word, "thickness")


def draft_of(block: Block, unit: float, makers: tuple[str, ...], unread: Unread) -> Draft:
    """Converts a block to a draft in mm."""
    kind, place = block.kind, f"surface {block.number}"
    if kind not in (*_FORMS, *_FORMS_OF_AIR):
        block.records["TYPE"].fail(
            f"TYPE: wanted one of {', '.join((*_FORMS, *_FORMS_OF_AIR))}, got {kind[:20]!r}",
            "lens-surface",
            block.number,
        )
    draft = Draft(block.number, thickness=block.thickness() * unit)
    if kind == "COORDBRK":
        tilt = [block.parameter(i) for i in (3, 4, 5)]
        decenter = [block.parameter(i) * unit for i in (1, 2)]
        draft.before = moved([*decenter, 0.0], tilt, block.parameter(6) != 0)
        draft.glass = None
        return draft
    draft.stop = "STOP" in block.records
    draft.curvature = block.value("CURV", 1, 0.0) / unit
    draft.conic = block.value("CONI", 1, 0.0)
    _form(block, draft, kind, unit)
    draft.glass = _glass(block, makers, unread)
    _aperture(block, draft, unit, unread)
    if "COAT" in block.records:
        unread.add("coatings are ignored; the lens's coating applies", place)
    return draft


def _form(block: Block, draft: Draft, kind: str, unit: float) -> None:
    if kind == "EVENASPH":
        terms = {2 * i: block.parameter(i) for i in range(1, 9)}
    elif kind == "ODDASPHE":
        terms = {i: block.parameter(i) for i in range(1, 9)}
    elif kind in ("XASPHERE", "XOSPHERE"):
        step = 2 if kind == "XASPHERE" else 1
        count, norm = int(block.extra_value(1)), block.extra_value(2) or 1.0
        line = block.extra.get(1, block.line)
        if not 0 <= count <= 60 or not 1e-6 <= abs(norm) <= 1e6:
            line.fail("XDAT: wanted 0 .. 60 terms and a radius", "lens-surface", block.number)
        terms = {
            step * i: block.extra_value(i + 2) / norm ** (step * i) for i in range(1, count + 1)
        }
    else:
        terms = {}
    draft.asphere = {p: a * unit ** (1 - p) for p, a in terms.items() if a}
    if kind == "BICONICX":
        draft.form = "biconic"
        radius = block.parameter(1) * unit
        draft.curvature_x, draft.conic_x = 1 / radius if radius else 0.0, block.parameter(2)
    elif kind == "TOROIDAL":
        draft.form = "toroid"
        radius = block.parameter(1) * unit
        draft.curvature_x = 1 / radius if radius else 0.0
        if any(block.parameter(i) for i in range(2, 9)) or block.extra_value(1) > 0:
            block.line.fail(
                "TOROIDAL: terms in y (PARM 2-8, XDAT) are not supported",
                "lens-surface",
                block.number,
            )


def _glass(block: Block, makers: tuple[str, ...], unread: Unread) -> Glass | None:
    line = block.records.get("GLAS")
    if line is None:
        return None
    name = line.word(1, "glass")
    if name.upper() == "MIRROR":
        line.fail(
            "GLAS: mirrors are not supported (the light turns back)",
            "lens-mirror",
            block.number,
        )
    how = line.number_at(2, "solve", default=0)
    nd, vd = line.number_at(4, "nd", default=0), line.number_at(5, "Vd", default=0)
    place = f"surface {block.number}"
    if how == 1 or name == "___BLANK":
        deviation = line.number_at(6, "dPgF", default=0)
        return model(line, block.number, nd, vd, deviation=deviation)
    if how == 4 and any(line.number_at(i, "offset", default=0) for i in (10, 11)):
        unread.add("offsets of nd and Vd are ignored", place)
    # Zemax writes 1.5 and 40 when it has no values.
    said = nd > 1 and (nd, vd) != (1.5, 40.0)
    return named(line, block.number, name, unread, (nd, vd) if said else None, makers)


def _aperture(block: Block, draft: Draft, unit: float, unread: Unread) -> None:
    place = f"surface {block.number}"
    semi = block.value("DIAM", 1, 0.0) * unit
    if semi < 0:
        block.records["DIAM"].fail(f"DIAM: wanted at least 0, got {semi:g}", surface=block.number)
    draft.semi_diameter = semi or None
    if any(block.value("OBDC", i, 0.0) for i in (1, 2)):
        unread.add("a decentred aperture is ignored", place)
        return
    for line in block.apertures:
        _cut(line, line.words[0].upper(), block, draft, unit, unread)


def _cut(line: Line, keyword: str, block: Block, draft: Draft, unit: float, unread: Unread) -> Any:
    place = f"surface {block.number}"
    if keyword not in ("CLAP", "OBSC", "FLAP"):
        unread.add(f"aperture {keyword} is ignored; the clear diameter stays round", place)
        return
    inner, outer = (line.number_at(i, "radius", 0, default=0) * unit for i in (1, 2))
    if keyword == "OBSC":
        if inner:
            unread.add("an obscuration ring is ignored", place)
        elif outer:
            draft.inner, draft.clips = outer, True
        return
    if keyword == "FLAP":
        draft.clips = draft.semi_diameter is not None
        return
    if outer:
        draft.semi_diameter, draft.clips = outer, True
        draft.inner = inner
