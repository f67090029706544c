"""``daguerre lens --flare``: the ghosts of one direction, brightest first."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.camera.parameters import CAMERA
from daguerre.errors import UsageError
from daguerre.units import angle_deg, numbers

if TYPE_CHECKING:
    from daguerre.analysis import Bench
    from daguerre.analysis.ghosts import Ghost, Ghosts

SHOWN = 20


class Flare:
    """The flags of ``--flare``, checked.

    Raises:
        UsageError: A value that is none, or a flag that wants ``--flare``.
    """

    def __init__(
        self,
        angle: str | None,
        ghost: str | None,
        cover_glass: str | None,
        reflectance: float | None,
        film: tuple[float, float] | None,
    ) -> None:
        self.wanted = angle is not None
        others = {
            "--ghost": ghost,
            "--cover-glass": cover_glass,
            "--sensor-reflectance": reflectance,
        }
        for flag, value in others.items():
            if value is not None and angle is None:
                raise UsageError(f"{flag}: needs --flare ANGLE")
        if angle is None:
            return
        self.angle = angle_deg("--flare", angle)
        if not (math.isfinite(self.angle) and abs(self.angle) < 90):
            raise UsageError(f"--flare: wanted an angle below 90 degrees, got {angle!r}")
        self.film = film
        self.ghost = None if ghost is None else _surfaces(ghost)
        self.glass = None
        if cover_glass is not None:
            self.glass = CAMERA["cover_glass"].from_text(cover_glass)
        self.reflectance = reflectance or 0.0

    def show(self, bench: Bench, *, plot: Path | None, drawing: Path | None, json: bool) -> int:
        """Prints and draws."""
        from daguerre.camera.camera import Camera
        from daguerre.setup.body import stack_of

        body = Camera(cover_glass=self.glass, sensor_reflectance=self.reflectance)
        files = {"plot": plot, "drawing": drawing}
        stack = stack_of(body)
        return show_flare(
            bench, self.angle, film=self.film, stack=stack, which=self.ghost, json=json, **files
        )


def _surfaces(text: str) -> tuple[int, int]:
    first, second = numbers("--ghost", text, 2, "4,1")
    if first != int(first) or second != int(second):
        raise UsageError(f"--ghost: wanted two indices of surfaces such as 4,1, got {text!r}")
    return int(first), int(second)


def show_flare(
    bench: Bench,
    angle_deg: float,
    *,
    film: tuple[float, float] | None,
    stack: Any,
    which: tuple[int, int] | None,
    plot: Path | None,
    drawing: Path | None,
    json: bool,
) -> int:
    """Prints the ghosts, and draws what is asked for.

    Args:
        bench: The lens.
        angle_deg: Angle of the source from the axis.
        film: Width and height of the film, mm; None: those of the lens's image circle.
        stack: Reflecting parts of the body.
        which: The ghost that is drawn; None: the brightest.
        plot: File of all ghosts on the film, or None.
        drawing: File of the section with rays of one ghost, or None.
        json: One JSON object rather than lines.
    """
    from daguerre.analysis.ghosts import Ghosts

    ghosts = Ghosts(bench, angle_deg, film=film, stack=stack)
    if drawing is not None:
        _write_drawing(ghosts, ghosts.find(which) if which else _brightest(ghosts), drawing)
    if plot is not None:
        from daguerre.files.atomic import write_bytes
        from daguerre.plots.ghost_plot import plot_ghosts

        write_bytes(plot, plot_ghosts(ghosts, plot.suffix.lower()[1:]))
    if json:
        from json import dumps

        facts = {
            "name": bench.lens.name,
            "f_stop": bench.f_stop,
            "film_z": bench.film_z,
            "film_mm": list(ghosts.film),
            "angle_deg": angle_deg,
            "ghosts": ghosts.facts(),
        }
        print(dumps(facts, indent=2))
    else:
        _print(ghosts)
    return 0


def _brightest(ghosts: Ghosts) -> Ghost:
    if not ghosts.all:
        raise UsageError(f"--flare: {ghosts.bench.lens.name} reflects nothing: there are no ghosts")
    return ghosts.all[0]


def _write_drawing(ghosts: Ghosts, ghost: Ghost, path: Path) -> None:
    from daguerre.files.atomic import write_bytes
    from daguerre.plots.ghost_section import ghost_section
    from daguerre.plots.lens_file import drawn

    write_bytes(path, drawn(ghost_section(ghosts, ghost), path.suffix.lower()))


def _print(ghosts: Ghosts) -> None:
    bench, width, height = ghosts.bench, *ghosts.film
    total = sum(g.light for g in ghosts.all)
    lit = sum(g.light > 0 for g in ghosts.all)
    print(
        f"{bench.lens.name}, f/{bench.f_stop:.3g}, light from {ghosts.angle_deg:g} deg off the "
        f"axis, film {width:.3g} x {height:.3g} mm"
    )
    print(
        f"{len(ghosts.all)} ghosts, {lit} reach the film, with {_share(total)} of the light of the "
        "picture of the same source straight ahead"
    )
    print("surfaces      of picture   of ghosts   centre x, y mm    RMS radius mm")
    for g in ghosts.all[:SHOWN]:
        if g.light <= 0:
            break
        x, y = g.center
        print(
            f"{'-'.join(str(i) for i in g.surfaces):12}  {_share(g.light):>10}   "
            f"{g.light / total:9.2%}   {x:7.2f} {y:7.2f}   {g.radius:13.3f}"
        )
    if lit > SHOWN:
        print(f"... and {lit - SHOWN} more (--json shows all)")


def _share(value: float) -> str:
    return f"{value:.3g}"
