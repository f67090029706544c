# SPDX-License-Identifier: GPL-3.0-or-later
"""Daguerre in Blender: the render engine, its panels and its operators."""

from . import engine, metering, operators, osl_panel, panels, properties

_PARTS = (properties, metering, engine, panels, operators, osl_panel)


def register() -> None:
    """Adds all parts to Blender."""
    for part in _PARTS:
        part.register()


def unregister() -> None:
    """Removes all parts from Blender, the last one first."""
    for part in reversed(_PARTS):
        part.unregister()
