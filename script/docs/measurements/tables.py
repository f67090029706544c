"""The tables of docs/measured.md and its record, and the sentence of README.md."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from textwrap import fill
from typing import Any

import measured
from kept import fitted

Row = dict[str, Any]
#: Names of the bench's quantities, with their units.
QUANTITIES = {
    "distortion_px": "shape of distortion, px RMS",
    "red_px": "lateral colour of red, px RMS",
    "blue_px": "lateral colour of blue, px RMS",
    "open_ev": "light wide open, EV RMS",
    "stopped_corner_ev": "light at the corner, stopped down, EV",
    "magnification_off": "magnification at closest focus, relative",
}
VALUES = ("measured", "predicted", "difference")


def texts(rows: Row) -> dict[str, str]:
    """Texts by the names of their marks."""
    return {
        "summary": summary(rows),
        "distortion": distortion(rows),
        "colour": colour(rows),
        "light": light(rows),
        "magnification": magnification(rows),
    }


def sentence(rows: Row) -> str:
    """The claim of README.md."""
    made = measured.summary(rows)
    products = len({(r["lens"], r["product"]) for r in rows["distortion"]})
    median = {name: one["median"] for name, one in made.items() if isinstance(one, dict)}
    text = (
        f"**Predicted against measured**: for {products} real lenses, distortion traced through "
        f"the patent is within {median['distortion_px']:.1f} px of that in photographs, lateral "
        f"colour within {median['red_px']:.1f} px (red) and {median['blue_px']:.1f} px (blue), and "
        f"the light at the corner, stopped down, within {median['stopped_corner_ev']:.2f} EV "
        "(medians, pixels of 24 MP): [every lens](docs/measured.md)."
    )
    return fill(text, 120)


def summary(rows: Row) -> str:
    """Figures of the bench over all settings."""
    made = measured.summary(rows)
    body = [
        (name, one["count"], *(f"{one[k]:.2f}" for k in measured.FIGURES))
        for key, name in QUANTITIES.items()
        if (one := made[key]) is not None
    ]
    return table(("difference", "settings", *measured.FIGURES), body)


def distortion(rows: Row) -> str:
    """Percent at the corner, and RMS of the difference."""
    body = [
        (*named(row), product(row), *corner(row["curve"]), f"{row['px']:.2f}")
        for row in ends(rows["distortion"])
    ]
    return table(("lens", "mm", "product", "measured, %", "predicted, %", "difference, px"), body)


def colour(rows: Row) -> str:
    """Red and blue at the corner, px, and RMS of the differences."""
    body = []
    for row in ends(rows["colour"]):
        cells = [
            (*corner(row[f"{name}_curve"]), f"{row[f'{name}_px']:.2f}") for name in ("red", "blue")
        ]
        body.append((*named(row), *cells[0], *cells[1]))
    heads = [f"{name} {value}" for name in ("red", "blue") for value in VALUES]
    return table(("lens", "mm", *heads), body)


def light(rows: Row) -> str:
    """Light at the corner wide open, and where the stopped-down lens is farthest off, EV."""
    body = []
    for row in ends([r for r in rows["vignetting"] if r.get("kind") == "open"]):
        same = [r for r in rows["vignetting"] if at(r) == at(row) and r.get("kind") == "stopped"]
        worst = max(same, key=lambda r: abs(r["corner_ev"]), default=None)
        lens, mm = named(row)
        if "vignetting" in fitted(row["lens"]):
            lens += ", mount fitted"
        body.append((lens, mm, *shade(row, row["ev"]), *shade(worst, None)))
    return table(("lens", "mm", "open, f/", *VALUES, "stopped, f/", *VALUES), body)


def shade(row: Row | None, difference: float | None) -> tuple[str, ...]:
    """Cells of one f-stop; by default the difference is the corner's."""
    if row is None:
        return ("",) * 4
    off = f"{row['corner_ev']:+z.2f}" if difference is None else f"{difference:.2f}"
    return (f"{row['f_stop']:g}", *corner(row["curve"]), off)


def magnification(rows: Row) -> str:
    """Magnification at the product's closest focus, or at the lens's own."""
    body = []
    for row in sorted((r for r in rows["magnification"] if "error" not in r), key=key):
        stated, predicted, at_m = row["magnification"], row["predicted"], row["at_m"]
        how = "" if at_m < 1.01 * row["closest_focus_m"] else f"at {at_m:.2f} m, its nearest"
        how = "travel fitted" if "magnification" in fitted(row["lens"]) else how
        cells = f"{row['closest_focus_m']:g}", f"{stated:.2f}", f"{predicted:.2f}"
        body.append((f"`{row['lens']}`", *cells, f"{100 * (predicted / stated - 1):+z.0f} %", how))
    return table(("lens", "closest focus, m", "maker", "predicted", "difference", ""), body)


def ends(found: Iterable[Row]) -> list[Row]:
    """Rows at the shortest and longest focal lengths of each product."""
    seen = [row for row in found if "error" not in row]
    lengths: dict[tuple[str, str], list[float]] = {}
    for row in seen:
        lengths.setdefault(key(row), []).append(row["focal_mm"])
    chosen = [r for r in seen if r["focal_mm"] in (min(lengths[key(r)]), max(lengths[key(r)]))]
    return sorted(chosen, key=lambda r: (r["lens"], r["match"], r["product"], r["focal_mm"]))


def key(row: Row) -> tuple[str, str]:
    """Lens and product."""
    return row["lens"], row.get("product", "")


def at(row: Row) -> tuple[str, str, float]:
    """Lens, product and focal length."""
    return *key(row), row["focal_mm"]


def named(row: Row) -> tuple[str, str]:
    """Cells of lens and focal length."""
    return f"`{row['lens']}`{mark(row)}", f"{row['focal_mm']:g}"


def product(row: Row) -> str:
    """The product's name; the database repeats the maker's."""
    words = row["product"].replace("|", "\\|").split()
    return " ".join(words[1:] if words[0] == words[1] else words)


def mark(row: Row) -> str:
    """Sign of a product that is a relative."""
    return " (B)" if row["match"] == "B" else ""


def corner(curve: Row) -> tuple[str, str]:
    """Cells of the measured and the predicted value at the greatest height."""
    return f"{curve['measured'][-1]:+z.2f}", f"{curve['predicted'][-1]:+z.2f}"


def table(heads: Sequence[str], body: Iterable[Sequence[object]]) -> str:
    """A table of markdown."""
    lines = [heads, ["---"] * len(heads), *body]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)
