"""``daguerre lens --flare``: the ghosts of one direction, brightest first."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from daguerre.camera.parameters import CAMERA
from daguerre.cli import console
from daguerre.cli.drawings import write_drawing
from daguerre.cli.flags.from_table import TableFlags, made_of
from daguerre.cli.flags.setting import BENCH
from daguerre.errors import UsageError
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table
from daguerre.units import angle_deg, numbers

if TYPE_CHECKING:
    from daguerre.analysis import Bench
    from daguerre.analysis.ghosts import Ghost, Ghosts

    from .export import FileFlags
    from .polynomial_ghosts import PolynomialReport

SHOWN = 20
MAX_DEGREE = 15  # as in polynomial.elements, which takes long to import


def _angle(flag: str, text: str) -> float:
    angle = angle_deg(flag, text)
    if not (math.isfinite(angle) and abs(angle) < 90):
        raise UsageError(f"{flag}: wanted an angle below 90 degrees, got {text!r}")
    return angle


def _surfaces(flag: str, text: str) -> tuple[int, int]:
    first, second = numbers(flag, text, 2, "4,1")
    if first != int(first) or second != int(second):
        raise UsageError(f"{flag}: wanted two indices of surfaces such as 4,1, got {text!r}")
    return int(first), int(second)


# fmt: off
_BODY = (
    replace(
        CAMERA["cover_glass"],
        meaning="Cover glass in front of the sensor, for --flare: thickness and gap to the sensor, "
        "mm, and index (1.5168 if left out)",
    ),
    replace(
        CAMERA["sensor_reflectance"],
        meaning="Reflectance of the sensor, 0 to 1, for --flare",
    ),
)
_FLARE = Table(
    Parameter(
        "angle", "List the ghosts of light from this angle (deg), brightest first; --drawing draws "
        "one, --plot all of them on the film", flags=("--flare",), metavar="ANGLE", parse=_angle,
    ),
    Parameter(
        "ghost", "Reflecting surfaces of the ghost to draw", default_words="the brightest",
        flags=("--ghost",), metavar="I,J", parse=_surfaces,
    ),
    Parameter(
        "polynomial", "Expand each ghost of --flare as a Taylor polynomial of this degree, 1 to "
        "15, and print its error against exact rays; --plot draws both", kind="whole", low=1,
        high=MAX_DEGREE, flags=("--polynomial",), metavar="DEGREE",
        explained=("flare.md#ghosts-as-polynomials",),
    ),
    _BODY,
)
# fmt: on


@made_of(_FLARE, panel=BENCH)
class FlareFlags(TableFlags):
    """Flags of ``--flare``."""

    flare: str | None

    @property
    def wanted(self) -> bool:
        """Whether ``--flare`` is given."""
        return self.flare is not None

    def check(self) -> None:
        """Checks the values, and that no flag is given that needs ``--flare``.

        Raises:
            UsageError: The message names the flag.
        """
        for row in _FLARE:
            if getattr(self, row.field) is not None and not self.wanted:
                raise UsageError(f"{row.flag} needs --flare ANGLE")
        given = self.given()
        degree = given.get("polynomial")
        _FLARE["polynomial"].check(degree, "--polynomial")
        for row in _BODY:
            if degree is not None and row.name in given:
                raise UsageError(f"--polynomial expands the lens alone: leave out {row.flag}")

    def show(self, bench: Bench, files: FileFlags, *, json: bool) -> int:
        """Prints the ghosts, and writes the requested drawings."""
        from daguerre.analysis.ghosts import Ghosts
        from daguerre.camera.camera import Camera
        from daguerre.setup.body import stack_of

        given = self.given()
        angle, which = given.pop("angle"), given.pop("ghost", None)
        degree = given.pop("polynomial", None)
        ghosts = Ghosts(bench, angle, film=files.film, stack=stack_of(Camera(**given)))
        shown = ghosts.find(which) if which else None
        expanded = _expanded(ghosts, degree, drawn=files.plot is not None)
        if files.drawing is not None:
            _write_drawing(ghosts, shown or _brightest(ghosts), files.drawing)
        if files.plot is not None:
            from daguerre.plots.ghost_plot import plot_ghosts

            panels = expanded.panels() if expanded else None
            write_drawing(files.plot, plot_ghosts(ghosts, files.plot.suffix.lower()[1:], panels))
        if not json:
            _print(ghosts, expanded)
            return 0
        from json import dumps

        facts = {
            "name": bench.lens.name,
            "f_stop": bench.f_stop,
            "film_z": bench.film_z,
            "film_mm": list(ghosts.film),
            "angle_deg": angle,
            "ghosts": ghosts.facts(),
        }
        console.show(dumps(expanded.added_to(facts) if expanded else facts, indent=2))
        return 0


def _expanded(ghosts: Ghosts, degree: int | None, *, drawn: bool) -> PolynomialReport | None:
    if degree is None:
        return None
    from .polynomial_ghosts import PolynomialReport

    return PolynomialReport(ghosts, degree, drawn=drawn)


def _brightest(ghosts: Ghosts) -> Ghost:
    if not ghosts.all:
        raise UsageError(f"--flare: {ghosts.bench.lens.name} reflects nothing: there are no ghosts")
    return ghosts.all[0]


def _write_drawing(ghosts: Ghosts, ghost: Ghost, path: Path) -> None:
    from daguerre.plots.ghost_section import ghost_section
    from daguerre.plots.lens_file import drawn

    write_drawing(path, drawn(ghost_section(ghosts, ghost), path.suffix.lower()))


def _print(ghosts: Ghosts, expanded: PolynomialReport | None) -> None:
    bench, width, height = ghosts.bench, *ghosts.film
    total = sum(g.light for g in ghosts.all)
    lit = sum(g.light > 0 for g in ghosts.all)
    console.show(
        f"{bench.lens.name}, f/{bench.f_stop:.3g}, light from {ghosts.angle_deg:g} deg off the "
        f"axis, film {width:.3g} x {height:.3g} mm"
    )
    console.show(
        f"{len(ghosts.all)} ghosts, {lit} reach the film, with {_share(total)} of the light of the "
        "picture of the same source straight ahead"
    )
    head = "surfaces      of picture   of ghosts   centre x, y mm    RMS radius mm"
    console.show(head + (expanded.head if expanded else ""))
    for g in ghosts.all[:SHOWN]:
        if g.light <= 0:
            break
        x, y = g.center
        console.show(
            f"{'-'.join(str(i) for i in g.surfaces):12}  {_share(g.light):>10}   "
            f"{g.light / total:9.2%}   {x:7.2f} {y:7.2f}   {g.radius:13.3f}"
            + (expanded.columns(g) if expanded else "")
        )
    if lit > SHOWN:
        console.show(f"... and {lit - SHOWN} more (--json shows all)")
    for line in expanded.summary() if expanded else ():
        console.show(line)


def _share(value: float) -> str:
    return f"{value:.3g}"
