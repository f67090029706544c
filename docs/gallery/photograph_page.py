"""The page of photographs: what a sensor or a film made of a frame's light."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from numpy.typing import NDArray
from photographs import OUT, SHEETS, Sheet
from sheet import captioned, grid

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent

INTRODUCTION = """# From exposure to photograph

What bodies and films make of the light that a frame holds: [exposure](../exposure.md),
[sensors](../sensors.md), [developing](../developing.md), [film](../film-stocks.md). Begin with

```
python examples/night_table.py out/night_table.glb
python examples/exposure.py
mkdir -p out/gallery
```

`--denoise` (extra of that name) takes away the noise of rendering, so that what is left is the
sensor's. A pixel of these pictures is a photosite: they are as a crop of the body's at 100 %.
"""


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
    pixels = oiio.ImageBuf(np.ascontiguousarray(grid(rows)))
    pixels.specmod().attribute("Compression", "jpeg:90")
    if not pixels.write(str(HERE / f"{sheet.name}.jpg")):
        raise SystemExit(pixels.geterror())


def _pixels(file: Path) -> NDArray[np.uint8]:
    picture = oiio.ImageBuf(str(file))
    if picture.has_error:
        raise SystemExit(f"{file}: {picture.geterror()}")
    return np.asarray(picture.get_pixels(oiio.UINT8)[..., :3])


def page() -> str:
    """The text of the page, of sheets that have been made."""
    made = [sheet for sheet in SHEETS if (HERE / f"{sheet.name}.jpg").exists()]
    return "\n".join([INTRODUCTION, *map(_section, made)])


def _section(sheet: Sheet) -> str:
    commands = [*sheet.first, *(c for shot in sheet.photographs for c in shot.commands)]
    typed = "\n".join(command.replace(f"{OUT}/", "out/") for command in commands)
    shown = f"## {sheet.title}\n\n![{sheet.title}]({sheet.name}.jpg)"
    return f"{shown}\n\n{sheet.text}\n\n```\n{typed}\n```\n"
