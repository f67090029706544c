"""``daguerre chart``: test charts as scenes, with their true values."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from daguerre import units as q
from daguerre.errors import UsageError

from . import console
from .flags.groups import option


def chart(
    name: Annotated[
        str | None, typer.Argument(metavar="CHART", help="Kind of chart; see --list.")
    ] = None,
    output: Annotated[
        Path | None,
        option(
            "-o",
            "--output",
            metavar="FILE.glb",
            help="Scene to write; the chart's true values go beside it, as .json.",
        ),
    ] = None,
    parameter: Annotated[
        list[str] | None,
        option("--set", metavar="KEY=VALUE", help="Chart parameter; repeatable; see --list."),
    ] = None,
    luminance: Annotated[
        float,
        option("--luminance", metavar="X", help="Luminance of the chart's white, cd/m2 [100]."),
    ] = 100.0,
    paint: Annotated[
        bool,
        option(
            "--paint",
            help="Make the chart of matt paint, to be lit by your own lights, instead of emissive.",
        ),
    ] = False,
    focal_length: Annotated[
        str, option("--focal-length", metavar="MM", help="Focal length of the camera, mm [50].")
    ] = "50",
    sensor_width: Annotated[
        str, option("--sensor-width", metavar="MM", help="Sensor width of the camera, mm [36].")
    ] = "36",
    list_charts: Annotated[
        bool, option("--list", help="List every chart with its parameters.")
    ] = False,
) -> int:
    """Writes a test chart as a scene, with its true values.

    The chart fills the frame of the scene's camera.
    """
    from daguerre import charts

    if list_charts:
        for known, make in charts.KINDS.items():
            console.show(f"{known}: {(inspect.getdoc(make) or '').splitlines()[0]}")
            for p in inspect.signature(make).parameters.values():
                console.show(f"    {p.name}: {_about(make, p.name)} [{p.default}]")
        return 0
    if name is None or output is None:
        raise UsageError("chart: wanted CHART -o FILE.glb (see `daguerre chart --list`)")
    made = charts.make(name, **_parameters(parameter or []))
    made.save(
        output,
        luminance=None if paint else luminance,
        focal_length=q.length_mm("--focal-length", focal_length),
        sensor_width=q.length_mm("--sensor-width", sensor_width),
    )
    console.note(f"wrote {output} and {output.with_suffix('.json').name}")
    return 0


def _about(make: Callable[..., Any], parameter: str) -> str:
    """Meaning of a parameter with its unit, from the docstring."""
    for line in (inspect.getdoc(make) or "").splitlines():
        name, colon, text = line.strip().partition(": ")
        if colon and name == parameter:
            return text.rstrip(".")
    return ""


def _parameters(words: list[str]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for word in words:
        key, equals, value = word.partition("=")
        if not (key and equals):
            raise UsageError(f"--set: wanted KEY=VALUE, got {word!r}")
        found[key] = _value(value)
    return found


def _value(text: str) -> int | float | str:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
