"""Writes the camera shader of Cycles (Blender 5 manual, "Custom Camera").

Blender's camera frame has +z along the view. The shader returns the derivatives of a pinhole, so
that Cycles does not differentiate all polynomials.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from .aim import focal_length
from .languages import definitions, identifier
from .plan import LensPlan
from .printers import Printer

#: Wavelengths of R, G, B: near the middle of the daylight that sRGB's primaries see.
RGB_NM = (611.0, 549.0, 464.0)

USE = """\
Blender: set the camera's lens type to Custom, choose this file, and press the button that compiles
it. The film is the camera's sensor (mm); parts that the lens does not cover are black. The camera's
focal length, focus and depth of field have no effect; the lens has the focus stated above.
Two random numbers choose a point of the iris and one of three wavelengths. Its channel gets three
times the weight, so that the mean is right."""

SHADER = """\
shader {name}(
    float f_stop = {f_stop:.6g} [[ string label = "F-Stop", float min = {f_stop:.6g}, 
        float max = 64.0,
        string help = "Not below the f-stop of the fit" ]],
    int chromatic = 1 [[ string label = "Chromatic Aberration", string widget = "checkBox",
        string help = "One wavelength for each channel; off: green light for all" ]],
    float metres = 1.0 [[ string label = "Metres per Unit", float min = 0.000001,
        string help = "Length of a scene unit, m" ]],
    output point position = 0,
    output vector direction = 0,
    output color throughput = 0,
    output point dPdx = 0,
    output point dPdy = 0,
    output vector dDdx = 0,
    output vector dDdy = 0)
{{
    vector sensor = vector(36.0, 24.0, 0.0);
    getattribute("cam:sensor_size", sensor);
    point raster = camera_shader_raster_position();
    vector chance = camera_shader_random_sample();
    float film_x = (raster[0] - 0.5) * sensor[0];
    float film_y = (raster[1] - 0.5) * sensor[1];
    float u1 = chance[0];
    float nm = {green:g};
    color share = color(1.0, 1.0, 1.0);
    if (chromatic) {{
        float third = min(floor(u1 * 3.0), 2.0);
        u1 = u1 * 3.0 - third;
        nm = {red:g};
        share = color(3.0, 0.0, 0.0);
        if (third > 0.5) {{
            nm = {green:g};
            share = color(0.0, 3.0, 0.0);
        }}
        if (third > 1.5) {{
            nm = {blue:g};
            share = color(0.0, 0.0, 3.0);
        }}
    }}
    float x, y, z, dx, dy, dz, weight;
    {name}_sample(
        film_x, film_y, u1, chance[1], nm, max(f_stop, {f_stop:.6g}), x, y, z, dx, dy, dz, weight);
    position = point(x, y, -z) / metres;
    direction = vector(dx, dy, -dz);
    throughput = weight * share;
    vector across = Dx(raster), up = Dy(raster);
    dDdx = vector(across[0] * sensor[0] / {focal:.6g}, 0.0, 0.0);
    dDdy = vector(0.0, up[1] * sensor[1] / {focal:.6g}, 0.0);
}}
"""


class Osl(Printer):
    """OSL functions."""

    functions: ClassVar[dict[str, str]] = {**Printer.functions, "abs": "fabs"}

    def output(self, name: str) -> str:
        """Declares an output in OSL."""
        return f"output float {name}"


def osl_file(plan: LensPlan, facts: Sequence[str]) -> str:
    """Makes a camera shader for Blender."""
    head = "\n".join(f"// {line}".rstrip() for line in [*facts, "", *USE.splitlines()])
    red, green, blue = RGB_NM
    shader = SHADER.format(
        name=identifier(plan.name),
        f_stop=plan.f_stop,
        red=red,
        green=green,
        blue=blue,
        focal=focal_length(plan),
    )
    return f"{head}\n\n{definitions(plan, Osl())}\n\n{shader}"
