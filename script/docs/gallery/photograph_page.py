"""Pages of sheets: photographs by sensors and films, and by calibrated cameras."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from numpy.typing import NDArray
from photographs import OUT, Sheet
from sheet import GAP, captioned, grid

ROOT = Path(__file__).resolve().parents[3]
PAGES = ROOT / "docs" / "gallery"


def make(sheet: Sheet, run: Callable[[str], None]) -> None:
    """Runs the commands of a sheet and composes it."""
    (ROOT / OUT).mkdir(parents=True, exist_ok=True)
    for command in sheet.first:
        run(command)
    panels = []
    for photograph in sheet.photographs:
        for command in photograph.commands:
            run(command)
        panels.append(captioned(_pixels(ROOT / OUT / photograph.file), photograph.caption))
    rows = [panels[k : k + sheet.columns] for k in range(0, len(panels), sheet.columns)]
    _write(grid(rows), sheet.name)


def overview(name: str, rows: Sequence[Sequence[str]], wide: int = 960) -> None:
    """Pictures of sheets that have been made, each row as wide as the others."""
    made = []
    for files in rows:
        panels = [_pixels(ROOT / OUT / file) for file in files]
        high = round((wide - GAP) / sum(p.shape[1] / p.shape[0] for p in panels))
        made.append([_smaller(panel, high) for panel in panels])
    _write(grid(made), name)


def _smaller(pixels: NDArray[np.uint8], high: int) -> NDArray[np.uint8]:
    wide = round(pixels.shape[1] * high / pixels.shape[0])
    found = oiio.ImageBuf(np.ascontiguousarray(pixels))
    resized = oiio.ImageBufAlgo.resize(found, roi=oiio.ROI(0, wide, 0, high))
    return np.asarray(resized.get_pixels(oiio.UINT8))


def _write(sheet: NDArray[np.uint8], name: str) -> None:
    pixels = oiio.ImageBuf(np.ascontiguousarray(sheet))
    pixels.specmod().attribute("Compression", "jpeg:90")
    if not pixels.write(str(PAGES / f"{name}.jpg")):
        raise SystemExit(pixels.geterror())


def _pixels(file: Path) -> NDArray[np.uint8]:
    picture = oiio.ImageBuf(str(file))
    if picture.has_error:
        raise SystemExit(f"{file}: {picture.geterror()}")
    return np.asarray(picture.get_pixels(oiio.UINT8)[..., :3])


def page(introduction: str, sheets: Sequence[Sheet]) -> str:
    """The text of a page, with those sheets that have been made."""
    made = [sheet for sheet in sheets if (PAGES / f"{sheet.name}.jpg").exists()]
    return "\n".join([introduction, *map(_section, made)])


def _section(sheet: Sheet) -> str:
    commands = [*sheet.first, *(c for shot in sheet.photographs for c in shot.commands)]
    typed = "\n".join(command.replace(f"{OUT}/", "out/") for command in commands)
    shown = f"## {sheet.title}\n\n![{sheet.title}]({sheet.name}.jpg)"
    return f"{shown}\n\n{sheet.text}\n\n```\n{typed}\n```\n"
