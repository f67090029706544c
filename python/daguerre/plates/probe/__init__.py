"""Light probes: environments from photographs of balls, and from panoramas."""

from .probe import LightProbe, light_probe
from .sun import Sun

__all__ = ["LightProbe", "Sun", "light_probe"]
