"""Finds the library's sensor for a photograph's camera."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from daguerre import sensors
from daguerre.sensors import Sensor


def library_sensor(facts: Mapping[str, Any]) -> Sensor | None:
    """Finds a sensor by make and model; None: the library has none.

    Args:
        facts: ``cameraMake`` and ``cameraModel``; DNG files of Daguerre have both in the model.
    """
    make, model = str(facts.get("cameraMake") or ""), str(facts.get("cameraModel") or "")
    names = {_plain(model), _plain(f"{make} {model}")} - {""}
    for name in sensors.names():
        known = sensors.load(name)
        if {_plain(known.model), _plain(f"{known.make} {known.model}")} & names:
            return known
    return None


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())
