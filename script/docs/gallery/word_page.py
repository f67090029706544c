"""The page of imperfections: a sheet and commands for each word; and the record of its figures."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable
from pathlib import Path

from agreement import Figures, agreement
from rays import DIAGRAMS, draw
from sheet import compose, write
from ways import OUT, Panel, Word
from words import WORDS

ROOT = Path(__file__).resolve().parents[3]
PAGES = ROOT / "docs" / "gallery"
RECORD = ROOT / "bench" / "records" / "imperfections.md"
FIGURES = PAGES / "agreement.json"

INTRODUCTION = """# Imperfections, three ways

This page compares three ways to render each imperfection of lenses. There is one sheet for each
topic that lectures on cameras list: spherical aberration, coma, chromatic aberration, astigmatism,
radial distortion, vignetting, lens flares, bloom, halos and stars; and one for field curvature.
Each sheet shows, from left to right:

- **traced**: exact rays through every surface of a lens;
- **polynomial**: polynomials fitted to those rays ([Polynomial optics](../polynomial.md));
- **2D**: the picture of a pinhole with effects of the darkroom added
  ([The darkroom](../darkroom.md), [Diffraction](../diffraction.md)).

The bench draws the rays behind most sheets: `python script/docs/gallery/rays.py NAME out/rays.svg`,
with the name of the picture, such as `coma`. Nothing is denoised. Everything in the scenes emits
light (`--max-depth 1`), so that only the lens differs; all panels of a sheet have the same
exposure. To make the scenes:

```
python scenes/imperfections.py
python scenes/lens_scenes.py --only lamps
```

The commands write OpenEXR pictures. `python script/docs/gallery/make.py --only NAME` runs them and
composes the sheet (`--tone soft`).

Polynomials agree with the traced pictures: their details are within 0.06 px of the right place,
but for ghosts (1 px) and the corner under lateral colour (1.8 px). The error of 2D, as relMSE, is
4 to 25,000 times larger ([figures of each picture](../../bench/records/imperfections.md)).
"""

RECORD_INTRODUCTION = """# Imperfections, three ways: measured

Each picture of [Imperfections](../../docs/gallery/imperfections.md), compared with the traced one
of its row by `python script/docs/gallery/make.py --only NAME`, which writes this page, too:

| figure | |
|---|---|
| light | total light of the picture, divided by that of the traced one |
| moved | displacement of details from the traced picture, px: the largest of 6 x 4 blocks |
| relMSE | mean of (difference)^2 / (traced^2 + 0.01), with the noise of both |
| noise | the relMSE caused by the traced picture's own noise |
| red, blue | displacement of red and blue from green, px |

Polynomials use the same random numbers as the lens, so most of their noise is the same. If shapes
differ, such as those of discs and ghosts, the displacement means little.
"""


def make(word: Word, run: Callable[[str], None]) -> None:
    """Renders a word's pictures, composes the sheet and keeps its figures."""
    (ROOT / OUT).mkdir(parents=True, exist_ok=True)
    for panel in panels(word):
        for command in panel.commands:
            run(command)
    if word.name in DIAGRAMS:
        draw(word.name, PAGES / f"rays_{word.name}.svg")
    write(compose(word, ROOT / OUT), PAGES / f"{word.name}.jpg", word.quality)
    known = json.loads(FIGURES.read_text()) if FIGURES.exists() else {}
    known[word.name] = [_rounded(figures) for figures in agreement(word, ROOT / OUT)]
    FIGURES.write_text(json.dumps(known, indent=1, sort_keys=True) + "\n")


def panels(word: Word) -> Iterable[Panel]:
    """All pictures of a word."""
    return (panel for row in word.rows for panel in row)


def page() -> str:
    """The text of the page, of words whose sheets have been made."""
    made = [word for word in WORDS if (PAGES / f"{word.name}.jpg").exists()]
    return "\n".join([INTRODUCTION, *map(section, made)])


def record() -> str:
    """The text of the record: the figures of all words that have some."""
    known = json.loads(FIGURES.read_text()) if FIGURES.exists() else {}
    measured = [word for word in WORDS if word.name in known]
    tables = (f"## {w.heading}\n\n" + "\n".join(table(known[w.name])) for w in measured)
    return "\n".join([RECORD_INTRODUCTION, *tables])


def section(word: Word) -> str:
    """A sheet with its text and commands."""
    parts = [f"## {word.heading}\n", f"![{word.heading}]({word.name}.jpg)\n", f"{word.text}\n"]
    if word.name in DIAGRAMS:
        alt, file = DIAGRAMS[word.name][0], f"rays_{word.name}.svg"
        parts.append(f"![Its rays]({file})\n\n{alt}.\n")
    before = ""
    for panel in panels(word):
        if panel.commands:
            parts.append(f"{panel.caption[0].upper()}{panel.caption[1:]}{typed(panel, before)}")
            before = panel.commands[-1]
    return "\n".join(parts)


def typed(panel: Panel, before: str) -> str:
    """The commands of a picture; where one only adds flags to the command before, these flags."""
    flags, end = panel.commands[0].rsplit(" -o ", 1)
    begin = before.rsplit(" -o ", 1)[0]
    if len(panel.commands) == 1 and before and flags.startswith(f"{begin} "):
        return f": the same with `{flags[len(begin) + 1 :]} -o {end}`.\n"
    return ":\n\n```\n" + "\n".join(panel.commands) + "\n```\n"


def table(figures: list[Figures]) -> list[str]:
    """The figures, a line each."""
    names = [n for n in ("light", "moved", "relmse", "noise", "red", "blue")
             if any(n in line for line in figures)]  # fmt: skip
    shown = {"relmse": "relMSE", "moved": "moved, px", "red": "red, px", "blue": "blue, px"}
    lines = ["| | " + " | ".join(shown.get(n, n) for n in names) + " |", "|---" * (len(names) + 1)]
    lines[1] += "|"
    for line in figures:
        values = [_number(line.get(n)) for n in names]
        lines.append(f"| {line['picture']} | " + " | ".join(values) + " |")
    return [*lines, ""]


def _number(value: float | str | None) -> str:
    return f"{value:.3g}" if isinstance(value, float | int) else ""


def _rounded(figures: Figures) -> Figures:
    """Three digits, and nothing where there is no number."""
    return {
        name: float(f"{value:.3g}") if isinstance(value, float) else value
        for name, value in figures.items()
        if not (isinstance(value, float) and math.isnan(value))
    }
