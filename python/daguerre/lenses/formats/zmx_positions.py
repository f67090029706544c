"""Reads multi-configuration operands of a Zemax file: zoom and focus positions."""

from __future__ import annotations

from collections.abc import Callable

from daguerre.files.json_item import clean

from .assemble import Configuration
from .pupil import Pupil
from .text import Line, Unread, number, words
from .zmx_surface import Block

MAX_POSITIONS = 64
#: Operands that do not change the rays: fields, wavelengths, vignetting, weights, titles.
_HARMLESS = words(
    "MOFF MCOM WAVE WLWT YFIE XFIE FLTP FLWT FVCX FVCY FVDX FVDY FVAN PRWV CWGT LTTL MCSD"
)
_DIFFERENT = words(
    "CRVT CONN COTN GLSS PRAM PAR1 PAR2 PAR3 PAR4 PAR5 PAR6 PAR7 PAR8 SDIA CSP1 CSP2 STPS "
    "IGNR MIND MABB MDPG GCRS TEMP PRES EDVA HOLD PSHX PSHY SATP NPOS NPAR IGNM APMN APMX "
    "APMT APDX APDY APTP RAAM SRTS SLTN TELE UDAF AFOC LTTL MCHI"
)


class Positions:
    """Configurations of a file: ``MNUM`` and the operands that follow it."""

    def __init__(self, line: Line | None, unread: Unread) -> None:
        self.count, self.current, self.unread = 1, 1, unread
        self.gaps: dict[int, dict[int, tuple[float, Line]]] = {}
        self.apertures: dict[int, float] = {}
        self.titles: dict[int, str] = {}
        self.others: dict[tuple[str, str], set[str]] = {}
        if line is not None:
            self.count = line.whole_at(1, "configurations", 1, MAX_POSITIONS)
            self.current = int(line.number_at(2, "configuration", default=1))
            if not 1 <= self.current <= self.count:
                line.fail(f"MNUM: wanted a configuration of 1 .. {self.count}")

    def take(self, line: Line) -> bool:
        """Applies an operand; returns false if the line is not an operand."""
        keyword = line.words[0].upper()
        if keyword == "THIC":
            surface = line.whole_at(1, "surface", 0, 10_000)
            word = line.word(3, "thickness")
            far = word.upper() in ("INFINITY", "INF") and surface == 0
            value = float("inf") if far else line.to_number(word, "thickness")
            self.gaps.setdefault(self._position(line), {})[surface] = (value, line)
        elif keyword == "APER":
            self.apertures[self._position(line)] = line.number_at(3, "aperture")
        elif keyword == "LTTL":
            self.titles[self._position(line)] = clean(line.word(3, "title").strip('"'))
        elif keyword in _DIFFERENT:
            where = (keyword, line.word(1, "surface"))
            self.others.setdefault(where, set()).add(line.word(3, "value"))
        else:
            return keyword in _HARMLESS
        return True

    def _position(self, line: Line) -> int:
        return line.whole_at(2, "configuration", 1, self.count)

    def configurations(
        self, blocks: list[Block], unit: float, pupil: Callable[[float | None], Pupil | None]
    ) -> list[Configuration]:
        """All configurations, the file's current one first."""
        for (keyword, surface), values in self.others.items():
            if len({number(v) if number(v) is not None else v for v in values}) > 1:
                place = f"surface {surface[:8]}"
                self.unread.add(
                    f"configurations differ in {keyword}; all take the current one's value", place
                )
        if self.count > 1:
            for block in blocks[1:]:
                for solve in block.solves:
                    place = f"surface {block.number}"
                    self.unread.add(
                        f"solve {solve} is ignored; all positions take the stored thickness", place
                    )
        order = [self.current, *(i for i in range(1, self.count + 1) if i != self.current)]
        return [self._configuration(i, blocks, unit, pupil) for i in order]

    def _configuration(
        self,
        position: int,
        blocks: list[Block],
        unit: float,
        pupil: Callable[[float | None], Pupil | None],
    ) -> Configuration:
        gaps = {block.number: block.thickness() for block in blocks}
        for surface, (value, line) in self.gaps.get(position, {}).items():
            if surface not in gaps:
                line.fail(f"THIC: wanted a surface of 0 .. {len(blocks) - 1}, got {surface}")
            gaps[surface] = value
        if self.count > 1:
            _solve(blocks, gaps)
        title = self.titles.get(position) or f"configuration {position}"
        scaled = {i: t * unit for i, t in gaps.items()}
        return Configuration(title, scaled, pupil(self.apertures.get(position)))


def _solve(blocks: list[Block], gaps: dict[int, float]) -> None:
    """Solves thicknesses that depend on others: TCOM i sum: t = sum - t_i; TOLE: from i to here."""
    for block in blocks:
        for keyword in ("TCOM", "TOLE"):
            line = block.records.get(keyword)
            if line is None:
                continue
            first = line.whole_at(1, "surface", 0, 10_000)
            if not 0 < first < block.number:
                line.fail(f"{keyword}: wanted a surface before {block.number}, got {first}")
            total = line.number_at(2, "length")
            between = (first,) if keyword == "TCOM" else range(first, block.number)
            gaps[block.number] = total - sum(gaps[i] for i in between)
