"""How well lensfun's models fit the lenses of the library: residuals of their profiles.

    python bench/lensfun_fits.py [--json] [--lens NAME ...]

Pixels are of 24 MP. ``distortion``: RMS over the frame, at a zoom's worst focal length; ``largest``
is that of any height. ``red``, ``blue``: lateral colour left, RMS. ``vignetting``: EV, RMS of the
worst f-stop, focal length and distance.
"""

from __future__ import annotations

import argparse
import json
from typing import Any

from daguerre import lenses
from daguerre.errors import InputError
from daguerre.export import lensfun_profile

COLUMNS = ("distortion", "largest", "red", "blue", "vignetting")


def row(name: str) -> dict[str, Any]:
    """Residuals of a lens, or why it has none."""
    try:
        made = lensfun_profile(name)
    except InputError as error:
        return {"lens": name, "error": str(error)}
    return {
        "lens": name,
        "model": made.model,
        "fits": made.fits,
        "distortion": made.residual_px,
        "largest": max(fit.largest for fit in made.distortion),
        "red": max(one.red.rms for one in made.geometry),
        "blue": max(one.blue.rms for one in made.geometry),
        "vignetting": max(light.fit.rms for light in made.vignetting),
    }


def main() -> None:
    """Prints a line for each lens and the share that fits, or one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--lens", nargs="+", default=lenses.names(), metavar="NAME")
    arguments = parser.parse_args()
    rows = []
    for name in arguments.lens:
        rows.append(row(name))
        if not arguments.json:
            print(line(rows[-1]), flush=True)
    found = [one for one in rows if "error" not in one]
    fits = sum(one["fits"] for one in found)
    if arguments.json:
        print(json.dumps({"bench": "lensfun_fits", "fits": fits, "of": len(found), "rows": rows}))
    else:
        print(f"{fits} of {len(found)} lenses fit to 0.3 px RMS")


def line(one: dict[str, Any]) -> str:
    """A line of the table."""
    if "error" in one:
        return f"{one['lens']:36} {one['error']}"
    numbers = " ".join(f"{one[name]:6.2f}" for name in COLUMNS)
    return f"{one['lens']:36} {one['model']:7} {numbers}"


if __name__ == "__main__":
    main()
