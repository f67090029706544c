"""Writes what docs, records, README and package say about measured products.

    script/docs/make-measured [--data FOLDER] [--rows FILE]

Rows come from bench/measured.py, with the settings that the page shows; --rows has those that
``bench/measured.py --json`` printed before.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "bench"))

import kept  # noqa: E402
import measured  # noqa: E402
import plots  # noqa: E402
import tables  # noqa: E402
from measured_products import Calibration, calibrations  # noqa: E402

from daguerre import lenses  # noqa: E402
from daguerre.errors import DaguerreError  # noqa: E402
from daguerre.lenses.agreement import FILE  # noqa: E402

DOCS = ROOT / "docs"
RECORD = ROOT / "bench" / "records" / "measured.md"
#: Text between a pair of comments is ours.
BLOCK = r"(<!-- measured {name}: by script/docs/make-measured -->\n).*?(<!-- end of measured -->)"


def computed(folder: Path | None) -> dict[str, Any]:
    """Rows of the bench, with their source."""
    found, source = calibrations(folder)
    return {"source": source, **measured.rows([*map(ends, found)], stated(), ())}


def stated() -> list[dict[str, Any]]:
    """Closest focus and magnification of products, from the lens files that have both."""
    products = {name: lenses.load(name).product for name in lenses.names()}
    return [
        {"lens": name, "closest_focus_m": one.closest_focus_m, "magnification": one.magnification}
        for name, one in products.items()
        if one is not None and one.closest_focus_m and one.magnification
    ]


def ends(one: Calibration) -> Calibration:
    """A calibration without the stops between wide open and stopped down: half of the time."""
    vignetting = tuple(t for t in one.vignetting if measured.kind(one, t) != "between")
    return replace(one, vignetting=vignetting)


def written(path: Path, texts: dict[str, str]) -> None:
    """Puts texts between the marks of a page."""
    page = path.read_text(encoding="utf-8")
    for name, text in texts.items():
        block = re.compile(BLOCK.format(name=name), re.DOTALL)
        page, count = block.subn(lambda m, text=text: f"{m[1]}\n{text}\n\n{m[2]}", page)
        assert count == 1, f"{path.name}: wanted one block of measured {name}, got {count}"
    path.write_text(page, encoding="utf-8")


def main() -> None:
    """Computes the rows, or reads them; then writes."""
    parser = argparse.ArgumentParser(description=__doc__, prog="make-measured")
    parser.add_argument("--data", type=Path, metavar="FOLDER")
    parser.add_argument("--rows", type=Path, metavar="FILE")
    given = parser.parse_args()
    try:
        rows = json.loads(given.rows.read_text()) if given.rows else computed(given.data)
    except DaguerreError as error:
        print(f"make-measured: {error}", file=sys.stderr)
        sys.exit(error.exit_code)
    FILE.write_text(kept.text(rows), encoding="utf-8")
    for name, drawing in plots.drawings(rows).items():
        (DOCS / f"{name}.svg").write_bytes(drawing)
    texts = tables.texts(rows)
    written(DOCS / "measured.md", {"summary": texts.pop("summary")})
    written(RECORD, texts)
    written(ROOT / "README.md", {"sentence": tables.sentence(rows)})


if __name__ == "__main__":
    main()
