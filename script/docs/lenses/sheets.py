"""Data sheets: of all lenses into a folder, of one lens of each family into the docs."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import OpenImageIO as oiio

from daguerre.lenses.library import FOLDER, Entry

#: Whose sheets are in the repository.
FEATURED = (
    *("canon-50mm-f0.95", "canon-ef-600mm-f4", "double-gauss-50mm-f2", "heliar-100mm-f4"),
    *("minolta-varisoft-85mm-f2.8", "nikon-af-s-70-200mm-f2.8", "nikon-z-50mm-f1.8"),
    *("olympus-zuiko-fisheye-8mm-f2.8", "petzval-100mm-f2.2", "schneider-anamorphic-60mm"),
    *("sonnar-50mm-f2", "tessar-50mm-f2.8", "zeiss-biotar-50mm-f1.4", "zeiss-distagon-28mm-f2"),
    *("zeiss-hologon-15mm-f8", "zeiss-jena-biogon-35mm-f2.8"),
)
WIDTH, WEBP = 1000, "webp:50"


def make(entry: Entry, out: Path, docs: Path) -> None:
    """The sheets of one lens, unless they are younger than its file."""
    source = FOLDER / f"{entry.name}.json"
    pdf, page = out / f"{entry.name}.pdf", docs / f"{entry.name}.webp"
    if _older(pdf, source):
        _draw(entry.name, pdf)
    if entry.name in FEATURED and _older(page, source):
        png = out / f"{entry.name}.png"
        _draw(entry.name, png)
        docs.mkdir(exist_ok=True)
        _shrink(png, page)


def _older(made: Path, source: Path) -> bool:
    return not made.exists() or made.stat().st_mtime < source.stat().st_mtime


def _draw(name: str, path: Path) -> None:
    command = [sys.executable, "-m", "daguerre.cli", "lens", name, "--plot", str(path)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    print(path, flush=True)


def _shrink(png: Path, path: Path) -> None:
    page = oiio.ImageBuf(str(png))
    roi = oiio.ROI(0, WIDTH, 0, round(WIDTH * page.spec().height / page.spec().width), 0, 1, 0, 3)
    small = oiio.ImageBufAlgo.resize(page, roi=roi)
    small.specmod().attribute("Compression", WEBP)
    if not small.write(str(path)):
        raise SystemExit(small.geterror())
