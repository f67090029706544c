"""Reads one surface of a CODE V sequence, and the commands that follow it."""

from __future__ import annotations

import math
from typing import Any

from daguerre.files.json_item import clean

from .draft import FAR, Draft, moved, undone
from .glass import Glass, coded, model, named
from .text import Line, Unread, number, words

#: Coefficients of r^4, r^6, ...
_POWERS = {name: 4 + 2 * i for i, name in enumerate("ABCDEFGHJ")}
_FORMS = ("SPH", "CON", "ASP", "CYL", "XTO", "YTO", "AAS")
_PLACES = ("XDE", "YDE", "ZDE", "ADE", "BDE", "CDE")
_NUMBERS = ("RDX", "CUX", "RDY", "CUY", "K", "KX", "KY", "THI", *_POWERS, *_PLACES)
_TERMS = ("AR", "BR", "CR", "DR")
#: Commands that do not change the rays: tolerances, drawing, optimization.
_HARMLESS = words(
    "SLB CCY CCX THC KC AC BC CC DC EC FC GC HC JC CUF GLC XDC YDC ZDC ADC BDC CDC MAT COM "
    "UID CRT PIM IND"
)
_REFUSED = {
    "BEN": "lens-mirror",
    "REFL": "lens-mirror",
    "SPS": "lens-surface",
    "DIF": "lens-surface",
    "GRT": "lens-surface",
    "HOE": "lens-surface",
    "GRS": "lens-surface",
    "UDS": "lens-surface",
    "SPL": "lens-surface",
    "ZRN": "lens-surface",
    "RET": "lens-surface",
    "GLB": "lens-surface",
    "NSS": "lens-surface",
    "THM": "lens-surface",
    "MOD": "lens-surface",
}


class SeqSurface:
    """A surface: ``S radius thickness glass``, and the commands that follow."""

    def __init__(
        self,
        line: Line,
        number_: int,
        radius_mode: bool,
        private: dict[str, dict[str, Any] | None],
        unread: Unread,
    ) -> None:
        self.line, self.number, self.unread = line, number_, unread
        self.is_image = line.words[0] == "SI"
        first = line.number_at(1, "radius" if radius_mode else "curvature", default=0)
        self.numbered = first != 0  # whether a radius or a curvature follows, by RDM
        self.curvature = (1 / first if first else 0.0) if radius_mode else first
        far = number_ == 0 and line.word(2, "thickness").upper() in ("INF", "INFINITY")
        self.thickness = math.inf if far else line.number_at(2, "thickness", default=0)
        self.private = private  # PRV may come after the surfaces
        self.form = "SPH"
        self.values: dict[str, float] = {}
        self.how = ""  # how the frame continues behind the surface: DAR, REV
        self.stop = False
        self.circle: float | None = None
        self.inner = 0.0
        self.edge: float | None = None

    @property
    def place(self) -> str:
        """Name of the surface, for notes."""
        return f"surface {self.number}"

    def _glass(self) -> Glass | None:
        line, words = self.line, self.line.words[3:]
        for word in words:
            if word.upper() in ("REFL", "REFO", "TIRO"):
                line.fail(
                    "mirrors are not supported (the light turns back)",
                    "lens-mirror",
                    self.number,
                )
        if not words or words[0].upper() == "AIR":
            return None
        word = clean(words[0].strip("'\" "))
        if word.upper() in self.private:
            table = self.private[word.upper()]
            if table is None:
                line.fail(
                    f"glass: wanted a table of indices in PRV, got a formula for {word!r}",
                    "lens-glass",
                    self.number,
                )
            return table
        nd, _, vd = word.partition(":")
        values = number(nd), number(vd) if vd else 0.0
        if values[0] is not None and values[1] is not None and (vd or 1 <= values[0] <= 5):
            if not vd and len(words) > 1 and number(words[1]) is not None:
                return model(line, self.number, values[0], number(words[1]) or 0.0)
            return model(line, self.number, values[0], values[1])
        numbers = coded(word)
        if numbers is not None:
            return model(line, self.number, *numbers)
        name, _, maker = word.partition("_")
        return named(line, self.number, name, self.unread, makers=(maker,) if maker else ())

    def take(self, line: Line) -> None:
        """Applies a command to this surface."""
        keyword = line.words[0]
        if keyword in _FORMS:
            self.form = keyword
        elif keyword == "STO":
            self.stop = True
        elif keyword in _NUMBERS or keyword in _TERMS:
            self._number(line, keyword)
        elif keyword in ("DAR", "REV"):
            self.how = keyword
        elif keyword == "CIR":
            self._circle(line)
        elif keyword in ("REX", "REY", "ELX", "ELY", "ADX", "ADY", "ARO", "CIX", "CIY"):
            self.unread.add(
                f"aperture {keyword} is ignored; the clear diameter stays round", self.place
            )
        elif keyword in ("PIK", "PKC"):
            self.unread.add("pickups are ignored; stored values apply", self.place)
        elif keyword in _REFUSED:
            line.fail(
                f"{keyword}: wanted a surface of {', '.join(_FORMS)}",
                _REFUSED[keyword],
                self.number,
            )
        elif keyword not in _HARMLESS:
            self.unread.add(f"command {clean(keyword)[:20]} is ignored", self.place)

    def _number(self, line: Line, keyword: str) -> None:
        if len(line.words) < 2 or number(line.words[1]) is None:
            word = line.words[1].upper() if len(line.words) > 1 else ""
            if keyword == "THI" and word[:1].isalpha():  # THI S3 OAL S1..4 45: a solve
                self.unread.add(
                    f"solve THI {clean(word)[:20]} is ignored; stored values apply", self.place
                )
                return
            if keyword in ("CUY", "RDY") and word[:1].isalpha():
                self.unread.add(
                    f"solve {keyword} {clean(word)[:20]} is ignored; the stored value applies"
                )
                return
        value = line.number_at(1, "value")
        if keyword == "THI":
            self.thickness = value
        elif keyword in ("CUY", "RDY"):
            self.curvature = value if keyword == "CUY" else (1 / value if value else 0.0)
        elif keyword in ("CUX", "RDX"):
            self.values["CUX"] = value if keyword == "CUX" else (1 / value if value else 0.0)
        else:
            self.values[keyword] = value

    def _circle(self, line: Line) -> None:
        words = [w for w in line.words[1:] if not w.startswith(("L'", "'", '"'))]
        kinds = {w.upper() for w in words if number(w) is None}
        sizes = [w for w in words if number(w) is not None]
        if not sizes:
            line.fail("CIR: the radius is missing", surface=self.number)
        size = line.to_number(sizes[0], "radius", 0)
        if "EDG" in kinds:
            self.edge = size
        elif "OBS" in kinds:
            self.inner = max(self.inner, size)
        elif "HOL" not in kinds:
            self.circle = size if self.circle is None else min(self.circle, size)

    def draft(self, unit: float) -> Draft:
        """Converts the surface to a draft in mm."""
        v = self.values
        semi = self.circle if self.circle is not None else self.edge
        draft = Draft(
            self.number,
            thickness=self.thickness * unit,
            curvature=self.curvature / unit,
            glass=self._glass(),
            semi_diameter=(semi * unit) or None if semi is not None else None,
            inner=self.inner * unit,
            stop=self.stop,
            clips=self.circle is not None or self.inner > 0,
        )
        if self.number == 0 and draft.thickness >= FAR:
            draft.thickness = math.inf
        terms = {p: v.get(name, 0.0) * unit ** (1 - p) for name, p in _POWERS.items()}
        turn = self._form(draft, v, {p: a for p, a in terms.items() if a}, unit)
        self._place(draft, v, unit, turn)
        return draft

    def _form(
        self, draft: Draft, v: dict[str, float], terms: dict[int, float], unit: float
    ) -> bool:
        """Sets the form; returns whether the surface must be turned by 90 degrees about z."""
        across = v.get("CUX", 0.0) / unit
        if self.form in ("CON", "ASP"):
            draft.conic = v.get("K", 0.0)
            draft.asphere = terms if self.form == "ASP" else {}
            return False
        if self.form == "SPH":
            return False
        if self.form == "AAS":
            extra = [name for name in _TERMS if v.get(name)]
            if extra or terms:
                self._refuse("AAS: only the terms KX and KY are supported")
            draft.form, draft.curvature_x = "biconic", across
            draft.conic, draft.conic_x = v.get("KY", 0.0), v.get("KX", 0.0)
            return False
        if terms:
            self._refuse(f"{self.form}: asphere terms are not supported")
        draft.conic = v.get("K", 0.0)
        if self.form == "CYL" and across and draft.curvature:
            self._refuse("CYL: wanted one curvature, got two")
        draft.form = "biconic" if self.form == "CYL" else "toroid"
        draft.curvature_x = across
        if self.form != "XTO":
            return False
        draft.curvature, draft.curvature_x = across, draft.curvature
        return True

    def _refuse(self, message: str) -> None:
        self.line.fail(message, "lens-surface", self.number)

    def _place(self, draft: Draft, v: dict[str, float], unit: float, turned: bool) -> None:
        decenter = [v.get(name, 0.0) * unit for name in _PLACES[:3]]
        tilt = [-v.get("ADE", 0.0), -v.get("BDE", 0.0), v.get("CDE", 0.0)]
        move = moved(decenter, tilt) if any(decenter) or any(tilt) else None
        if move is not None and self.how == "REV":
            draft.after = undone(move)
        elif move is not None:
            draft.before = move
            if self.how == "DAR":
                draft.after = undone(move)
        if turned:  # an x toroid is a y toroid on its side
            turn = moved([0, 0, 0], [0, 0, 90])
            back = undone(turn)
            draft.before = turn if draft.before is None else draft.before @ turn
            draft.after = back if draft.after is None else back @ draft.after
