"""Reads sequential Zemax lens files (.zmx): records by keyword, surfaces in blocks.

The format has no current public description. Sources: chapter 29 of the ZEMAX user's guide of 2000
(keywords and their arguments), the OpticStudio help (surface types; tilts are right-handed, first
about x, then y, then z) and published files. docs/lens-import.md lists the records that are read.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from .assemble import lens_file
from .draft import Draft
from .pupil import Pupil
from .text import Line, Unread, lines_of, words
from .zmx_positions import Positions
from .zmx_surface import Block, draft_of

_WORDS = re.compile(r'"[^"]*"|\S+')
#: Units of length, mm.
_UNITS = {"MM": 1.0, "CM": 10.0, "IN": 25.4, "METER": 1000.0, "M": 1000.0}
#: Units of fields by FTYP's number, after conversion to mm.
_FIELDS = {
    0: "degrees",
    1: "mm at the object",
    2: "mm on the film",
    3: "mm on the film",
    4: "degrees (theodolite)",
}
_VIGNETTING = ("VDXN", "VDYN", "VCXN", "VCYN", "VANN")
#: Records that do not change the rays: display, analysis, tolerances, catalogue data.
_HARMLESS = words(
    "VERS PFIL LANG GFAC RAIM PUSH SDMA OMMA ROPD HYPR PICB FWGN WAVM WAVL WWGT PWAV POLS "
    "GLRS GSTD NSCD COFN LUID EERA DBDT AUTH IWDP ZVDX ZVDY ZVCX ZVCY ZVAN TOL BLNK XFLD YFLD "
    "MOFF PRIM"
)


def parse(text: str, where: str) -> tuple[dict[str, Any], list[str]]:
    """Converts a Zemax file to ``daguerre-lens/0.1``, with notes on ignored content.

    Raises:
        LensError: The file cannot be read; the message has the line, and the surface if any.
    """
    reader = _ZmxReader(where)
    for i, content in enumerate(lines_of(text, where), 1):
        words = tuple(_WORDS.findall(content))
        if words:
            reader.take(Line(where, i, words), content.strip(), content[0].isspace())
    return reader.lens()


class _ZmxReader:
    """Builds a lens from the records, in their order."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.unread = Unread()
        self.blocks: list[Block] = []
        self.name = ""
        self.notes: list[str] = []
        self.makers: tuple[str, ...] = ()
        self.unit = 1.0
        self.pupil: tuple[str, Line] | None = None
        self.fields: dict[str, Line] = {}
        self.positions: Positions | None = None
        self.in_surfaces = False

    def take(self, line: Line, content: str, indented: bool) -> None:
        """Applies a record; records after the surfaces that are not indented belong to analyses."""
        keyword = line.words[0].upper()
        if keyword == "SURF":
            self._begin_surface(line)
        elif keyword == "MNUM":
            self.positions = Positions(line, self.unread)
            self.in_surfaces = False
        elif (self.positions is not None and self.positions.take(line)) or (
            self.in_surfaces and self.blocks[-1].take(line)
        ):
            pass
        elif keyword in _HEADER:
            _HEADER[keyword](self, line, content)
        elif keyword in _VIGNETTING:
            if any(line.to_number(w, "factor") for w in line.words[1:]):
                self.unread.add("vignetting factors are ignored; clear diameters apply", keyword)
        elif keyword not in _HARMLESS and (indented or not self.blocks):
            place = f"surface {self.blocks[-1].number}" if self.in_surfaces else ""
            self.unread.add(f"record {keyword[:20]} is ignored", place)

    def _begin_surface(self, line: Line) -> None:
        number = line.whole_at(1, "number", 0, 10_000)
        wanted = self.blocks[-1].number + 1 if self.blocks else 0
        if number < wanted or (not self.blocks and number):
            line.fail(f"SURF: wanted surface {wanted} next, got {number}")
        self.blocks.append(Block(line, number))
        self.in_surfaces = True

    def _mode(self, line: Line, content: str) -> None:
        del content
        if line.word(1, "mode").upper() != "SEQ":
            line.fail("MODE: wanted SEQ (surfaces in sequence), got " + line.words[1][:20])

    def _name(self, line: Line, content: str) -> None:
        del line
        self.name = content[4:].strip()

    def _note(self, line: Line, content: str) -> None:
        del content
        self.notes.extend(line.words[2:])

    def _unit(self, line: Line, content: str) -> None:
        del content
        unit = line.word(1, "unit").upper()
        if unit not in _UNITS:
            line.fail(f"UNIT: wanted one of {', '.join(_UNITS)}, got {unit[:20]!r}")
        self.unit = _UNITS[unit]

    def _aperture(self, line: Line, content: str) -> None:
        del content
        self.pupil = (line.words[0].upper(), line)

    def _catalogues(self, line: Line, content: str) -> None:
        del content
        self.makers = line.words[1:]

    def _field(self, line: Line, content: str) -> None:
        del content
        self.fields[line.words[0].upper()] = line

    def _environment(self, line: Line, content: str) -> None:
        del content
        if line.number_at(1, "temperature", default=20) != 20:
            self.unread.add(f"temperature {line.words[1]} C is ignored; indices are those at 20 C")
        if line.number_at(2, "pressure", default=1) != 1:
            self.unread.add(f"pressure {line.words[2]} is ignored; indices are those in air")

    def lens(self) -> tuple[dict[str, Any], list[str]]:
        """Returns the lens file's value, and notes."""
        if len(self.blocks) < 3:
            Line(self.file, 1, ()).fail(
                f"SURF: wanted an object, surfaces and an image, got {len(self.blocks)} surfaces"
            )
        drafts: list[Draft] = []
        for block in self.blocks:
            draft = draft_of(block, self.unit, self.makers, self.unread)
            if block.kind == "COORDBRK" and drafts:  # a coordinate break bounds no medium
                draft.glass = drafts[-1].glass
            drafts.append(draft)
        positions = self.positions or Positions(None, self.unread)
        configurations = positions.configurations(self.blocks, self.unit, self._pupil)
        nominal = self._nominal()
        note = {"note": " ".join(self.notes)[:1000]} if self.notes else {}
        name = self.name or "Zemax lens"
        data = lens_file(self.file, name, drafts, configurations, self.unread, nominal, **note)
        return data, self.unread.notes()

    def _pupil(self, value: float | None) -> Pupil | None:
        """Aperture of the beam; ``value`` is a configuration's, None: the file's."""
        if self.pupil is None or self.pupil[0] == "FLOA":
            return None
        keyword, line = self.pupil
        number = line.number_at(1, "aperture") if value is None else value
        if not 0 < number <= 1e6:
            line.fail(f"{keyword}: wanted an aperture above 0, got {number:g}", "lens-f-stop")
        if keyword == "ENPD":
            return Pupil("diameter", number * self.unit)
        if keyword == "FNUM":
            working = line.number_at(2, "kind", default=0) == 1
            return Pupil("working" if working else "f-number", number)
        return Pupil("aperture", number)

    def _nominal(self) -> dict[str, float]:
        out: dict[str, float] = {}
        if self.pupil is not None and self.pupil[0] == "FNUM":
            out["f_number"] = self.pupil[1].number_at(1, "f-number", 1e-3, 1e6)
        kind = self.fields.get("FTYP")
        if kind is None:
            return out
        count = int(kind.number_at(3, "fields", 0, 1000, default=12)) or 12
        size = 0.0
        for name in ("XFLN", "YFLN"):
            line = self.fields.get(name)
            for word in line.words[1 : 1 + count] if line else []:
                size = max(size, abs(line.to_number(word, "field")) if line else 0)
        what = kind.whole_at(1, "kind of field", 0, 20)
        scale = 1.0 if what in (0, 4) else self.unit
        self.unread.add_fields(size * scale, _FIELDS.get(what, "of an unknown kind"))
        if what == 0 and 0 < size < 180:
            out["full_field_deg"] = 2 * size
        elif what in (2, 3) and size > 0:
            out["image_circle_mm"] = 2 * size * self.unit
        return out


_HEADER: dict[str, Callable[[_ZmxReader, Line, str], None]] = {
    "MODE": _ZmxReader._mode,
    "NAME": _ZmxReader._name,
    "NOTE": _ZmxReader._note,
    "UNIT": _ZmxReader._unit,
    "GCAT": _ZmxReader._catalogues,
    "ENVD": _ZmxReader._environment,
    **dict.fromkeys(("ENPD", "FNUM", "OBNA", "FLOA"), _ZmxReader._aperture),
    **dict.fromkeys(("FTYP", "XFLN", "YFLN"), _ZmxReader._field),
}
