"""Light from the set: photographs of balls, and panoramas, as environments."""

from .probe import LightProbe, light_probe
from .sun import Sun

__all__ = ["LightProbe", "Sun", "light_probe"]
