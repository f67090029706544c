"""ISO 12232: exposures that the ISO of a camera stands for.

The exposure that just saturates is 78 / ISO lux s, half a stop above that of a white surface.
Middle grey of a developed picture has 10 / ISO lux s.
"""

SATURATION_LX_S, GREY_LX_S = 78.0, 10.0
