"""ISO 12232: exposures that the ISO of a camera stands for.

The exposure that just saturates is 78 / ISO lux s, half a stop above a white surface.
Middle grey of a developed picture has 10 / ISO lux s.
"""

from __future__ import annotations

SATURATION_LX_S, GREY_LX_S = 78.0, 10.0
#: Developed value of middle grey.
GREY = 0.18


def white_lx_s(iso: float) -> float:
    """Exposure that develops to white, 1, lux s."""
    return GREY_LX_S / GREY / iso
