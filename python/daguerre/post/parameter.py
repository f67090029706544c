"""Parameters of effects: physical, each with its unit, from a command line or from JSON."""

from daguerre.parameters.parameter import REQUIRED, Kind, Parameter

__all__ = ["REQUIRED", "Kind", "Parameter"]
