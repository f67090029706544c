"""Builds the lens catalogue: drawings, photographs, data sheets, and the page that shows them.

    script/docs/make-lens-catalogue [--out DIR] [--only NAME ...] [--page [FILE]] [--no-sheets]

Pictures that are there and still true are left alone, so the command may be interrupted and typed
again. Data sheets of all lenses go to DIR (out/lenses) as PDF.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from pathlib import Path

import drawings
import page
import photographs
import sheets
from place import place

import daguerre as dg
from daguerre import lenses
from daguerre.lenses import library
from daguerre.plots.lens_section import section

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "docs" / "lens-library.md"
PICTURES = ROOT / "docs" / "lenses"


def draw(entry: library.Entry) -> None:
    """The section of one lens, at its first configuration."""
    path = PICTURES / "drawings" / f"{entry.name}.svg"
    path.parent.mkdir(exist_ok=True)
    path.write_text(drawings.small(section(lenses.load(entry.name))), encoding="utf-8")


def photograph_all(wanted: list[library.Entry], out: Path) -> None:
    """A photograph through each lens."""
    file = out / "arcade.glb"
    make = ["scenes/lens_scenes.py", "-o", str(out), "--only", "arcade"]
    subprocess.run([sys.executable, *make], check=True, cwd=ROOT)
    scene, key = dg.load(file), photographs.scene_key(file)
    for entry in wanted:
        started = time.process_time()
        target = library.PHOTOGRAPHS / f"{entry.name}.webp"
        if photographs.take(place(entry, lenses.load(entry.name)), scene, key, target):
            print(
                f"{entry.name}: photograph, {time.process_time() - started:.1f} CPU s", flush=True
            )


def main() -> None:
    """Makes what was asked for, then the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "lenses")
    parser.add_argument("--only", nargs="+", choices=library.names(), metavar="NAME")
    parser.add_argument(
        "--page", type=Path, nargs="?", const=PAGE, metavar="FILE", help="the page alone"
    )
    parser.add_argument("--no-sheets", action="store_true", help="no data sheets")
    given = parser.parse_args()
    out = given.out.resolve()
    wanted = [e for e in library.entries() if not given.only or e.name in given.only]
    if not given.page:
        for entry in wanted:
            draw(entry)
        photograph_all(wanted, out)
        if not given.no_sheets:
            for entry in wanted:
                sheets.make(entry, out, PICTURES / "sheets")
    file = given.page or PAGE
    file.write_text(page.text(library.entries()), encoding="utf-8")
    print(file)


if __name__ == "__main__":
    main()
