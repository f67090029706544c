"""Auxiliary channels of a frame: names, units, and which render produces them."""

from __future__ import annotations

import daguerre._core as _core

ALPHA = "alpha"
#: Auxiliary channels of a film, in the names of the files; alpha is a member of the frame.
AOV_NAMES: tuple[str, ...] = tuple(name for name in _core.FILM_AOVS if name != ALPHA)


#: Channels of ground truth, in the names of the files.
PLANES: tuple[str, ...] = _core.TRUTH_PLANES


#: Channel of means alone: the share of the light whose rays meet a surface.
COVERAGE: str = _core.COVERAGE_PLANE


#: Where it is in the next frame and where it was in the last one: how many frames later.
MOTION = {"motion": 1, "motion_back": -1}


#: what may be asked for with --aov -> group of channels
AOVS = {
    "depth": "depth",
    "P": "P",
    "position": "P",
    "N": "N",
    "normal": "N",
    "albedo": "albedo",
    "object_id": "object_id",
    "id": "object_id",
}


#: the same that only ground truth has; they are not among "all"
TRUTH = {name: name for name in ("distance", "material_id", "motion", "motion_back", "coverage")}


#: what photographs are measured against: light of the exposure, in lux s, and where it saturates
EXPOSED = ("exposure", "saturated")


#: of a stereo pair, by its depth
DISPARITY = "disparity"


#: groups that every EXR has, so asking for them changes nothing
ALWAYS = ("variance", "samples")
