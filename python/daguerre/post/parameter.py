"""Parameters of effects, each with its unit; values come from a command line or from JSON."""

from daguerre.parameters.parameter import REQUIRED, Kind, Parameter

__all__ = ["REQUIRED", "Kind", "Parameter"]
