"""``daguerre light-probe``: environment maps from photographs, for ``render --env``."""

from __future__ import annotations

import json as json_text
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from daguerre.plates.probe.parameters import LIGHT_PROBE

from . import console
from .flags.from_table import TableFlags, made_of
from .flags.groups import option, with_flags

if TYPE_CHECKING:
    from daguerre.plates.probe import LightProbe


@made_of(LIGHT_PROBE)
class ProbeFlags(TableFlags):
    """Flags of a light probe."""


@with_flags(probe=ProbeFlags)
def light_probe(
    photographs: Annotated[
        list[Path],
        typer.Argument(metavar="PHOTO...", help="Photographs: JPEG, PNG, TIFF, EXR, HDR or raw."),
    ],
    output: Annotated[
        Path, option("-o", "--output", metavar="ENV.exr|hdr", help="Environment map to write.")
    ],
    probe: ProbeFlags,
    sun_out: Annotated[
        Path | None,
        option(
            "--sun-out",
            metavar="SUN.glb",
            help="Write the sun to this file as a directional light, and leave it out of the "
            "environment map.",
        ),
    ] = None,
    json: Annotated[bool, option("--json", help="Print the results as one JSON object.")] = False,
    quiet: Annotated[bool, option("--quiet", "-q", help="Print errors only.")] = False,
) -> int:
    """Makes an environment map from photographs.

    The photographs show a mirror ball or a grey ball, or are a panorama.
    """
    from daguerre.plates.probe import light_probe as make

    console.quiet = quiet
    _check(photographs, output, sun_out)
    made = make(photographs, **probe.given())
    made.save(output, with_sun=sun_out is None)
    if sun_out is not None:
        made.save_sun(sun_out)
    if json:
        console.show(json_text.dumps(made.facts, indent=2))
    elif not quiet:
        console.show("\n".join(f"{name:20} {text}" for name, text in _rows(made).items()))
    for remark in made.notes:
        console.note(remark)
    for remark in made.warnings:
        console.warn(remark)
    console.note(f"wrote {output}" + (f" and {sun_out}" if sun_out is not None else ""))
    return 0


def _check(photographs: list[Path], output: Path, sun_out: Path | None) -> None:
    """Checks the outputs before anything is read."""
    from daguerre.files.atomic import check_writable
    from daguerre.files.formats import check_written
    from daguerre.files.in_use import note_read
    from daguerre.plates.probe.save import ENVIRONMENTS, SUNS

    check_written(output, ENVIRONMENTS)
    if sun_out is not None:
        check_written(sun_out, SUNS)
        check_writable(sun_out)
    check_writable(output)
    note_read(photographs)


def _rows(made: LightProbe) -> dict[str, str]:
    """Rows of the table, with units."""
    facts = made.facts
    unit = "lux" if made.absolute else "(unit unknown)"
    stops = ", ".join(f"{one['exposure_ev']:g}" for one in facts["photographs"])
    rows = {"photographs": f"{len(facts['photographs'])}, {stops} EV", "curve": facts["response"]}
    for ball in facts.get("balls", []):
        rows |= _ball_rows(ball)
    if facts.get("unseen_share"):
        rows["hidden by the ball"] = f"{facts['unseen_share']:.2%} of the sphere"
    if "fit_error" in facts:
        rows["left unexplained"] = f"{facts['fit_error']:.2%} of the ball's brightness"
    if facts["clipped"]:
        rows["clipped"] = f"{facts['clipped']['share']:.3%} of the sphere"
    rows["map"] = "{}x{} px".format(*facts["resolution"])
    rows["on the ground"] = f"{facts['illuminance']:.5g} {unit}"
    return rows | _sun_rows(facts["sun"], unit)


def _ball_rows(ball: dict[str, Any]) -> dict[str, str]:
    x, y, radius = ball["circle_px"]
    text = f"middle {x:.1f},{y:.1f} px, radius {radius:.1f} px"
    if ball["found"]:
        text += f" (found, {ball['rim_seen']:.0%} of its rim, +-{ball['rim_spread_px']:.2f} px)"
    return {f"ball, yaw {ball['camera_yaw_deg']:g}": text}


def _sun_rows(sun: dict[str, Any] | None, unit: str) -> dict[str, str]:
    if sun is None:
        return {"sun": "none: no small source brings 5% of the light"}
    red, green, blue = sun["illuminance_rgb"]
    how = f", by --{sun['solved']}" if sun["solved"] else ", clipped" if sun["clipped"] else ""
    return {
        "sun": f"azimuth {sun['azimuth_deg']:.2f}, elevation {sun['elevation_deg']:.2f} degrees",
        "facing it": f"{sun['illuminance']:.5g} {unit}, {sun['share']:.1%} of all light{how}",
        "its colour": f"R {red:.4g}, G {green:.4g}, B {blue:.4g} {unit}",
        "its diameter": f"{sun['diameter_deg']:.3g} degrees",
    }
