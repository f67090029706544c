"""Turns render settings of Blender into ours, and states how light is converted.

One rule for light, for lamps, glowing surfaces and worlds alike: a watt is 683 lumens
(``LUMENS_PER_WATT``), so a value of 1 of Blender's scene-linear pictures and colours is a luminance
of 683 cd/m2. A frame of ours counts cd/m2, so :func:`combined` divides by the same number: both
pictures of a scene have equal values, up to the exposure of Cycles' film, which multiplies.
"""

from __future__ import annotations

#: Luminous efficacy, lm/W; equally cd/m2 for a value of 1 of Blender. Source: the maximum by the
#: definition of the candela (SI Brochure, 2019), as the lights of Blender's glTF exporter have it.
LUMENS_PER_WATT = 683.0
