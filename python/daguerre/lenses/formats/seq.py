"""Reads CODE V sequence files (.seq): a stream of commands that builds the lens.

Sources: public files and readers, and pages of the reference manual ("Sign conventions",
"Coordinates": the tilts alpha and beta are left-handed, gamma right-handed, in this order, each
about the new axis). docs/lens-import.md lists the commands that are read.
"""

from __future__ import annotations

import re
from typing import Any

from daguerre.files.json_item import clean

from .assemble import Configuration, lens_file
from .draft import Draft
from .pupil import Pupil
from .seq_commands import commands
from .seq_mode import fitting
from .seq_surface import SeqSurface
from .text import Line, Unread, number, words

MAX_POSITIONS = 64
_UNITS = {"M": 1.0, "MM": 1.0, "C": 10.0, "CM": 10.0, "I": 25.4, "IN": 25.4}
#: Commands that do not change the rays: titles, analysis, drawing, optimization.
_HARMLESS = words(
    "LEN INI WTW WTF WL REF DOR GO DER CA PIM POL UID TOL SLB CCY THC KC AC BC CC DC EC FC GC "
    "HC JC CUF CWL DOM AFI ECH OUT VER CMP DSX DSY BTX BTY RIM VIE SUR GLC WID ACC "
    "XDC YDC ZDC ADC BDC CDC CRX PFR TIL NEW"
)
_FIELDS = {"XAN": "angle", "YAN": "angle", "XIM": "height", "YIM": "height"}
_FIELDS |= {"XRI": "height", "YRI": "height", "XOB": "object", "YOB": "object"}
_PUPILS = {"EPD": "diameter", "FNO": "working", "NAO": "aperture"}
_SURFACE_WORD = re.compile(r"S(\d+|[OI])", re.IGNORECASE)


def parse(text: str, where: str) -> tuple[dict[str, Any], list[str]]:
    """Converts a CODE V sequence to ``daguerre-lens/0.1``, with notes on ignored content.

    Raises:
        LensError: The file cannot be read; the message has the line, and the surface if any.
    """
    reader = _run(text, where, True)
    if reader.says_mode or not any(surface.numbered for surface in reader.surfaces):
        return reader.lens()
    return fitting(reader.lens, _run(text, where, False).lens, where)


def _run(text: str, where: str, radius_mode: bool) -> _SeqReader:
    """Takes all commands; ``radius_mode`` holds until the file says RDM."""
    reader = _SeqReader(where, radius_mode)
    for command in commands(text, where):
        if not reader.take(command):
            break
    return reader


class _SeqReader:
    """Builds a lens from the commands, in their order."""

    def __init__(self, file: str, radius_mode: bool) -> None:
        self.file = file
        self.unread = Unread()
        self.surfaces: list[SeqSurface] = []
        self.radius_mode = radius_mode
        self.says_mode = False
        self.unit = 1.0
        self.title = ""
        self.pupil: tuple[str, Line] | None = None
        self.fields: dict[str, float] = {}
        self.private: dict[str, dict[str, Any] | None] = {}
        self.private_nm: list[float] | None = None
        self.count = 1
        self.zoomed: dict[int, Line] = {}
        self.pupils: Line | None = None
        self.titles: dict[int, str] = {}

    def take(self, line: Line) -> bool:
        """Takes a command; false at the end of the lens."""
        if self.private_nm is not None:
            self._private_glass(line)
            return True
        keyword = line.words[0]
        if keyword.isalpha() and len(keyword) > 3:  # TITLE is TIT: three letters count
            keyword = keyword[:3]
            line = Line(line.file, line.number, (keyword, *line.words[1:]))
        if _SURFACE_WORD.fullmatch(keyword) or keyword == "S":
            self._surface(line)
        elif keyword == "GO":
            return not self.surfaces
        elif keyword == "ZOO":
            self._zoom(line)
        elif not self._system(line):
            self._of_surface(line)
        return True

    def _surface(self, line: Line) -> None:
        number = len(self.surfaces)
        match = _SURFACE_WORD.fullmatch(line.words[0])
        if match and match[1].isdigit() and int(match[1]) != number:
            line.fail(f"wanted surface {number} next, got {line.name}")
        if number == 0 and line.words[0] not in ("SO", "S0"):
            line.fail(f"wanted the object SO first, got {line.name}")
        if self.surfaces and self.surfaces[-1].is_image:
            line.fail(f"no surface may follow the image SI, got {line.name}")
        self.surfaces.append(SeqSurface(line, number, self.radius_mode, self.private, self.unread))

    def _system(self, line: Line) -> bool:
        keyword = line.words[0]
        if keyword == "RDM":
            self.says_mode = True
            self.radius_mode = len(line.words) < 2 or line.words[1][:1].upper() != "N"
        elif keyword == "TIT":
            self._titled(line)
        elif keyword == "DIM":
            unit = line.word(1, "unit").upper()
            if unit not in _UNITS:
                line.fail(f"DIM: wanted M, C or I, got {unit[:20]!r}")
            self.unit = _UNITS[unit]
        elif keyword in _PUPILS or keyword == "NA":
            self.pupil = (keyword, line)
        elif keyword in _FIELDS:
            kind = _FIELDS[keyword]
            sizes = [abs(line.to_number(word, "field")) for word in line.words[1:]]
            self.fields[kind] = max([self.fields.get(kind, 0.0), *sizes])
        elif keyword in ("VUX", "VLX", "VUY", "VLY"):
            if any(line.to_number(word, "factor") for word in line.words[1:]):
                self.unread.add("vignetting factors are ignored; clear diameters apply", keyword)
        elif keyword == "PRV":
            self.private_nm = []
        elif keyword in ("TEM", "PRE"):
            if line.number_at(1, "value") not in (20, 760, 1):
                self.unread.add(
                    f"{keyword} {line.words[1]} is ignored; indices are those at 20 C in air"
                )
        else:
            return keyword in _HARMLESS
        return True

    def _titled(self, line: Line) -> None:
        words = line.words[1:]
        match = re.fullmatch(r"[zZ](\d{1,3})", words[0]) if words else None
        text = clean(" ".join(words[1:] if match else words)).strip("'\" ")
        if match:
            self.titles[int(match[1])] = text
        else:
            self.title = text

    def _private_glass(self, line: Line) -> None:
        """Inside PRV ... END: PWL gives wavelengths (nm), other rows a name and its indices."""
        assert self.private_nm is not None
        name = clean(line.words[0].strip("'\" ")).upper()
        if name == "END":
            self.private_nm = None
        elif name == "PWL":
            self.private_nm = [line.to_number(w, "wavelength", 50, 1e5) for w in line.words[1:]]
        else:
            if any(number(w) is None for w in line.words[1:]):  # LAU, SEL: a formula
                self.private[name] = None
                return
            values = [line.to_number(w, "index", 1, 5) for w in line.words[1:]]
            if not values or len(values) != len(self.private_nm):
                line.fail(f"PRV: wanted {len(self.private_nm)} indices, got {len(values)}")
            if len(set(self.private_nm)) < len(values):
                line.fail("PRV: PWL: wavelengths must differ")
            nodes = sorted(zip(self.private_nm, values, strict=True))
            self.private[name] = {"table": [list(node) for node in nodes], "name": name}

    def _of_surface(self, line: Line) -> None:
        words = list(line.words)
        match = _SURFACE_WORD.fullmatch(words[1]) if len(words) > 1 else None
        if match and words[0] not in ("GLB", "RET", "PIK"):  # THI S3 5
            del words[1]
            surface = self._at(match[1], line)
        elif not self.surfaces:
            self.unread.add(f"command {line.name} is ignored")
            return
        else:
            surface = self.surfaces[-1]
        surface.take(Line(line.file, line.number, tuple(words)))

    def _at(self, word: str, line: Line) -> SeqSurface:
        index = {"O": 0, "I": len(self.surfaces) - 1}.get(word.upper())
        index = int(word) if index is None else index
        if not 0 <= index < len(self.surfaces):
            line.fail(f"{line.name}: wanted a surface of 0 .. {len(self.surfaces) - 1}")
        return self.surfaces[index]

    def _zoom(self, line: Line) -> None:
        """``ZOO n``, then ``ZOO THI Sk v1 .. vn``, ``ZOO FNO v1 .. vn``."""
        what = line.word(1, "number of positions").upper()
        if what.isdigit():
            self.count = line.whole_at(1, "positions", 1, MAX_POSITIONS)
        elif what == "THI":
            match = _SURFACE_WORD.fullmatch(line.word(2, "surface"))
            if match is None:
                line.fail(f"ZOO THI: wanted a surface, got {clean(line.words[2])[:20]!r}")
            self.zoomed[self._at(match[1], line).number] = line
        elif what in _PUPILS:
            self.pupils = line
        elif what not in _HARMLESS and what not in ("TIT", "VUX", "VUY", "VLX", "VLY", *_FIELDS):
            self.unread.add(
                f"positions differ in {clean(what)[:20]}; all take the first one's value"
            )

    def lens(self) -> tuple[dict[str, Any], list[str]]:
        """Returns the lens file's value, and notes."""
        if len(self.surfaces) < 3 or not self.surfaces[-1].is_image:
            Line(self.file, 1, ()).fail(
                f"wanted SO, surfaces S and the image SI, got {len(self.surfaces)} surfaces"
                + ("" if self.surfaces and self.surfaces[-1].is_image else " and no SI")
            )
        drafts: list[Draft] = []
        for surface in self.surfaces:
            drafts.append(surface.draft(self.unit))
        drafts[-2].thickness += drafts[-1].thickness  # the image surface's thickness is a defocus
        nominal: dict[str, float] = {}
        self.unread.add_fields(self.fields.get("angle", 0.0), "degrees")
        self.unread.add_fields(self.fields.get("height", 0.0) * self.unit, "mm on the film")
        self.unread.add_fields(self.fields.get("object", 0.0) * self.unit, "mm at the object")
        if 0 < self.fields.get("angle", 0) < 180:
            nominal["full_field_deg"] = 2 * self.fields["angle"]
        elif self.fields.get("height", 0) > 0:
            nominal["image_circle_mm"] = 2 * self.fields["height"] * self.unit
        if self.pupil is not None and self.pupil[0] == "FNO":
            nominal["f_number"] = self.pupil[1].number_at(1, "f-number", 1e-3, 1e6)
        positions = [self._position(i, drafts[-1].thickness) for i in range(self.count)]
        name = self.title or "CODE V lens"
        data = lens_file(self.file, name, drafts, positions, self.unread, nominal)
        return data, self.unread.notes()

    def _position(self, index: int, defocus: float) -> Configuration:
        gaps = {}
        for surface, line in self.zoomed.items():
            value = line.number_at(3 + index, "thickness", default=line.number_at(3, "thickness"))
            gaps[surface] = value * self.unit
            if surface == len(self.surfaces) - 2:
                gaps[surface] += defocus
        title = self.titles.get(index + 1) or (
            "infinity" if self.count == 1 else f"position {index + 1}"
        )
        return Configuration(title, gaps, self._pupil(index))

    def _pupil(self, index: int) -> Pupil | None:
        if self.pupil is None and self.pupils is None:
            self.unread.add(
                "no EPD, FNO, NA or NAO: the f-number follows from the stop's clear diameter"
            )
            return None
        keyword, line = self.pupil or ("", self.pupils)
        assert line is not None
        value = line.number_at(1, "aperture") if self.pupil else 0.0
        if self.pupils is not None:
            keyword, line = self.pupils.words[1].upper(), self.pupils
            value = line.number_at(2 + index, "aperture", default=line.number_at(2, "aperture"))
        if not 0 < value <= 1e6:
            line.fail(f"{keyword}: wanted an aperture above 0, got {value:g}", "lens-f-stop")
        if keyword == "NA":  # of the image, in air: f-number 1 / (2 NA)
            return Pupil("working", 1 / (2 * value))
        return Pupil(_PUPILS[keyword], value * (self.unit if keyword == "EPD" else 1.0))
