"""Writes a fitted lens as a source file: header, functions, and the frame of each language."""

from __future__ import annotations

import re
from collections.abc import Sequence

from .expression import Function
from .lens_code import evaluate_function, sample_function
from .plan import LensPlan
from .printers import VISIBLE, C, Glsl, NumPy, Printer

USE_SAMPLE = """\
{name}_sample(film_x, film_y, u1, u2, nm, f_stop) -> x, y, z, dx, dy, dz, weight
    samples a ray from a film point. film_x, film_y: mm, (0, 0) on the axis, in the upright picture,
    x to the right, y up. u1, u2: random numbers in [0, 1). nm: wavelength. f_stop: {f_stop:.4g}
    or more. The ray is in the camera's frame: metres, origin at the centre of the entrance pupil,
    -z along the view, x to the right, y up. A white world of luminance 1 has a mean weight of 1 on
    the axis, at every f-stop. Weight 0: the ray is stopped."""
USE_EVALUATE = """\
{name}_evaluate(film_x, film_y, slope_x, slope_y, nm, f_stop)
        -> x, y, z, dx, dy, dz, iris_x, iris_y, transmittance, stopped
    traces a film ray to the scene. All is in the lens's frame: mm, z from the scene to the film,
    0 at the first vertex; the image is upside down on the film, at z = {film_z:.6g}. slope: dx/dz
    and dy/dz of the ray behind the lens. The ray to the scene passes through (x, y, z). stopped: 1
    or 0. transmittance: 0 if stopped."""

C_NOTE = """\
Outputs are pointers, after the inputs. Needs -lm. Compile this file by itself, or include it. If
several files of a program include it, define DAGUERRE_API as static first."""


def identifier(name: str) -> str:
    """Converts a lens's name to an identifier of all languages."""
    text = re.sub(r"[^0-9a-z]+", "_", name.lower()).strip("_") or "lens"
    return text if text[0].isalpha() else f"lens_{text}"


def functions(plan: LensPlan, name: str) -> list[Function]:
    """All functions; each comes after those that it calls."""
    evaluate = evaluate_function(plan, name)
    return [*evaluate, sample_function(plan, evaluate[-1], name)]


def c_file(plan: LensPlan, facts: Sequence[str]) -> str:
    """Makes a file of C99, to compile or to include."""
    guard = f"DAGUERRE_{identifier(plan.name).upper()}"
    parts = [*_start(plan, facts), *C_NOTE.splitlines()]
    head = "\n".join(f"// {line}".rstrip() for line in parts)
    body = definitions(plan, C())
    guards = f"#ifndef {guard}\n#define {guard}\n#ifndef {VISIBLE}\n#define {VISIBLE}\n#endif"
    return f"{head}\n{guards}\n#include <math.h>\n\n{body}\n\n#endif\n"


def glsl_file(plan: LensPlan, facts: Sequence[str]) -> str:
    """Makes functions for a shader, GLSL 3.30 or GLSL ES 3.00 (with highp float)."""
    parts = [*_start(plan, facts), "Outputs are out parameters, after the inputs."]
    head = "\n".join(f"// {line}".rstrip() for line in parts)
    return f"{head}\n\n{definitions(plan, Glsl())}\n"


def numpy_file(plan: LensPlan, facts: Sequence[str]) -> str:
    """Makes a module that needs only numpy; inputs are numbers or arrays that broadcast."""
    head = "\n".join([*_start(plan, facts), "Inputs are numbers or arrays that broadcast."])
    # A lens's name is untrusted: it must not end the docstring and become code.
    head = head.replace("\\", "\\\\").replace('"', '\\"')
    one_of = '''
def _one_of(conditions, functions, *arguments):
    """Outputs of the first function whose condition holds, or of the last, per element."""
    results = [function(*arguments) for function in functions]
    return [np.select(conditions, case[:-1], case[-1]) for case in zip(*results)]
'''
    return f'"""{head}\n"""\n\nimport numpy as np\n\n{one_of}\n\n{definitions(plan, NumPy(), 2)}\n'


def _start(plan: LensPlan, facts: Sequence[str]) -> list[str]:
    values = {"name": identifier(plan.name), "f_stop": plan.f_stop, "film_z": plan.film_z_mm}
    lines = [USE_SAMPLE.format(**values), "", USE_EVALUATE.format(**values), ""]
    return [*facts, "", *"\n".join(lines).splitlines()]


def definitions(plan: LensPlan, printer: Printer, gap: int = 1) -> str:
    """All functions in one language, separated by ``gap`` empty lines."""
    made = functions(plan, identifier(plan.name))
    return ("\n" * (gap + 1)).join(printer.define(f) for f in made)
