"""Reads text files of the Optical Bench (photonstophotos.net): sections of tab-separated rows.

``[lens data]`` has id, radius (or AS stop, FS field stop, CG cover glass, Infinity), thickness (or
the name of a variable distance), nd, diameter, Vd, glass, maker. ``[variable distances]`` has one
column for each position. ``[aspherical data]`` has id, radius, k, and the coefficients of r^4, r^6
...; with ``AsphericalA2`` they begin at r^2; with ``AsphericalOddCount n`` the first n odd powers
from r^3 on are between the even powers. Source: the site's published files.
"""

from __future__ import annotations

import itertools
from typing import Any

from .assemble import Configuration, lens_file
from .catalogue import find
from .draft import Draft
from .glass import model, named
from .pupil import Pupil
from .text import Line, Unread, lines_of, number

#: Largest number of zoom positions that is accepted.
MAX_POSITIONS = 64
_KNOWN = ("descriptive data", "constants", "variable distances", "lens data", "aspherical data")
_REMARKS = ("figure", "notes", "metadata", "group data", "patent info", "report data")
_PLANES = ("as", "fs", "cg", "infinity", "-infinity", "inf", "")
_FACTS = {"Focal Length": "efl_mm", "F-Number": "f_number"}
_CLAIMS = {"Angle of View": "full_field_deg", "Image Height": "image_circle_mm"}

Sections = dict[str, list[Line]]


def parse(text: str, where: str) -> tuple[dict[str, Any], list[str]]:
    """Converts an Optical Bench file to ``daguerre-lens/0.1``, with notes on ignored content.

    Raises:
        LensError: The file cannot be read; the message has the line, and the surface if any.
    """
    sections = _sections(text, where)
    unread = Unread()
    for name in sections:
        if name not in (*_KNOWN, *_REMARKS) and not name.startswith("!"):
            if name == "diffractive data":
                Line(where, sections[name][0].number if sections[name] else 1, ()).fail(
                    "diffractive data: diffractive surfaces are not supported",
                    "lens-surface",
                )
            unread.add(f"section [{name[:40]}] is ignored")
    rows = sections.get("lens data", [])
    if not rows:
        Line(where, 1, ()).fail("[lens data]: no surfaces")
    variables = {row.words[0]: row for row in sections.get("variable distances", [])}
    constants = {row.words[0]: row for row in sections.get("constants", [])}
    for name in constants:
        if name not in ("AsphericalOddCount", "AsphericalA2", "ObjectGlass", "Scaled"):
            unread.add(f"constant {name[:40]} is ignored")
    table = _Table(variables, unread)
    drafts = [Draft(0, thickness=float("inf"), glass=_object_glass(constants))]
    drafts += [table.surface(row, i) for i, row in enumerate(rows, 1)]
    ids = {row.words[0]: i for i, row in enumerate(rows, 1)}
    if len(ids) < len(rows):
        names = [row.words[0] for row in rows]
        twice = next(row for row in rows if names.count(row.words[0]) > 1)
        twice.fail(f"surface {twice.name!r} appears twice")
    for row in sections.get("aspherical data", []):
        _asphere(row, drafts, ids, constants, unread)
    drafts.append(Draft(len(rows) + 1))
    positions = [table.configuration(i) for i in range(table.positions)]
    title = [row for row in sections.get("descriptive data", []) if row.words[0] == "title"]
    name = " ".join(title[0].words[1:]) if title else ""
    notes = "; ".join(" ".join(row.words) for row in sections.get("notes", []))[:1000]
    facts = {"patent": name or None, **({"note": notes} if notes else {})}
    claims = table.claims()
    data = lens_file(where, name, drafts, positions, unread, claims, **facts)
    return data, unread.notes()


def _sections(text: str, where: str) -> Sections:
    out: Sections = {}
    rows: list[Line] | None = None
    for i, content in enumerate(lines_of(text, where), 1):
        stripped = content.strip()
        if not stripped or stripped.startswith("#"):
            continue
        if stripped.startswith("[") and stripped.endswith("]"):
            name = stripped[1:-1].strip().lower()
            if name in _KNOWN and name in out:
                Line(where, i, ()).fail(f"[{name}]: appears twice")
            rows = out.setdefault(name, [])
        elif rows is None:
            Line(where, i, ()).fail("wanted a section such as [lens data] first")
        else:
            words = tuple(word.strip() for word in content.split("\t//")[0].split("\t"))
            if words[0]:
                rows.append(Line(where, i, words))
    return out


class _Table:
    """Rows of ``[lens data]``, and the distances that vary."""

    def __init__(self, variables: dict[str, Line], unread: Unread) -> None:
        self.variables = variables
        self.unread = unread
        self.named_gaps: dict[int, Line] = {}
        self.stop_is_known = False
        used = [row for name, row in variables.items() if name in _FACTS or _is_distance(name)]
        self.positions = max((_count(row) for row in used), default=1) or 1
        if self.positions > MAX_POSITIONS:
            next(r for r in used if _count(r) > MAX_POSITIONS).fail(
                f"wanted at most {MAX_POSITIONS} positions, got {self.positions}"
            )

    def surface(self, row: Line, index: int) -> Draft:
        words = (*row.words, "", "", "", "", "", "", "")
        if not words[1]:
            row.word(len(row.words), "radius")
        kind = words[1].lower()
        radius = 0.0 if kind in _PLANES else row.to_number(words[1], "radius")
        nd = row.to_number(words[3], "nd") if words[3] else 1.0
        vd = row.to_number(words[5], "Vd") if words[5] else 0.0
        diameter = row.to_number(words[4], "diameter", 0) if number(words[4]) is not None else 0.0
        if words[4] and words[4].lower() not in ("infinity", "undefined") and not diameter:
            diameter = row.to_number(words[4], "diameter", 0)
        glass = model(row, index, nd, vd, words[6], words[7])
        if glass is None and words[6]:
            if find(words[6]) is None:
                self.unread.add(f"remark {words[6][:40]} is ignored", f"surface {index}")
            else:
                glass = named(row, index, words[6], self.unread, makers=(words[7],))
        self.stop_is_known |= kind == "as" and diameter > 0
        return Draft(
            index,
            thickness=self._thickness(row, words[2], index),
            curvature=1 / radius if radius else 0.0,
            glass=glass,
            semi_diameter=diameter / 2 or None,
            stop=kind == "as",
            clips=kind == "fs",
        )

    def _thickness(self, row: Line, word: str, index: int) -> float:
        if not word:
            row.word(len(row.words), "thickness")
        if number(word) is not None:
            return row.to_number(word, "thickness")
        variable = self.variables.get(word)
        if variable is None:
            row.fail(
                f"thickness: wanted a number or a variable distance, got {word[:40]!r}",
                surface=index,
            )
        self.named_gaps[index] = variable
        return self._distance(variable, 0)

    def _distance(self, row: Line, position: int) -> float:
        words = row.words[1:]
        if not any(words):
            row.fail("a distance is missing")
        word = words[position] if position < len(words) and words[position] else words[0]
        if word.lower() == "undefined" and row.words[0].lower().startswith("bf"):
            return 0.0
        return row.to_number(word, "distance")

    def _value(self, name: str, position: int) -> float | None:
        row = self.variables.get(name)
        if row is None:
            return None
        words = row.words[1:]
        word = words[position] if position < len(words) else words[0] if words else ""
        if not word or word.lower() in ("undefined", "infinity", "afocal"):
            return None
        return row.to_number(word, "value")

    def configuration(self, position: int) -> Configuration:
        """Makes the configuration of one column of the variable distances."""
        gaps = {i: self._distance(row, position) for i, row in self.named_gaps.items()}
        facts = {}
        for name, key in _FACTS.items():
            value = self._value(name, position)
            if value is not None and value > 0:
                facts[key] = value
        away = self._value("d0", position)
        if away is not None and away > 0:
            gaps[0] = away
        title = f"{facts['efl_mm']:g} mm" if "efl_mm" in facts else f"position {position + 1}"
        if away is not None:
            title += f", object at {away:g} mm"
        diameter = self._value("Aperture Diameter", position)
        stop = diameter / 2 if diameter else None
        pupil = None
        if stop is None and not self.stop_is_known and "f_number" in facts:
            pupil = Pupil("f-number", facts["f_number"])
        return Configuration(title, gaps, pupil, stop, facts)

    def claims(self) -> dict[str, float]:
        out = {}
        for name, key in itertools.chain(_FACTS.items(), _CLAIMS.items()):
            value = self._value(name, 0)
            if value is not None and value > 0:
                out[key] = value
        return out


def _count(row: Line) -> int:
    return len([word for word in row.words[1:] if word])


def _is_distance(name: str) -> bool:
    return name == "Bf" or (name[:1] == "d" and name[1:].isdecimal())


def _object_glass(constants: dict[str, Line]) -> dict[str, Any] | None:
    row = constants.get("ObjectGlass")
    if row is None:
        return None
    nd, vd = row.number_at(1, "nd", 1, 5), row.number_at(2, "Vd", 0, 1000, default=0)
    return model(row, 0, nd, vd)


def _asphere(
    row: Line,
    drafts: list[Draft],
    ids: dict[str, int],
    constants: dict[str, Line],
    unread: Unread,
) -> None:
    index = ids.get(row.words[0])
    if index is None and row.words[0].split("(")[0] in ids:  # for a variant: 23(WX)
        unread.add(f"aspherical data of the variant {row.name} are ignored")
        return
    if index is None:
        row.fail(f"aspherical data: wanted the id of a surface, got {row.name!r}")
    draft = drafts[index]
    radius = row.word(1, "radius")
    c = 0.0 if radius.lower() in _PLANES else _curvature(row.to_number(radius, "radius"))
    if abs(c - draft.curvature) > 1e-3 * max(abs(c), abs(draft.curvature)):
        unread.add(
            "the radius in [aspherical data] differs and is ignored",
            f"surface {index}",
        )
    draft.conic = row.number_at(2, "k") if row.word(2, "k") else 0.0
    values = [row.to_number(word, "coefficient") if word else 0.0 for word in row.words[3:]]
    powers = _powers(constants)
    draft.asphere = {p: a for p, a in zip(powers, values, strict=False) if a}


def _curvature(radius: float) -> float:
    return 1 / radius if radius else 0.0


def _powers(constants: dict[str, Line]) -> Any:
    odd = 0
    if "AsphericalOddCount" in constants:
        row = constants["AsphericalOddCount"]
        odd = row.whole_at(1, "count of odd powers", 0, 100)
    if odd:
        return itertools.chain(range(3, 3 + 2 * odd), itertools.count(4 + 2 * odd, 2))
    return itertools.count(2 if "AsphericalA2" in constants else 4, 2)
