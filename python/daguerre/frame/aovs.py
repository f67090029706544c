"""Auxiliary channels of a frame: names, units, and which render produces them."""

from __future__ import annotations

#: Auxiliary channels of a film, in the names of the files.
AOV_NAMES = (
    "depth.Z",
    "P.X",
    "P.Y",
    "P.Z",
    "N.X",
    "N.Y",
    "N.Z",
    "albedo.R",
    "albedo.G",
    "albedo.B",
)


#: Channels of what is seen, in the names of the files.
PLANES = (
    "depth.Z", "distance.Z", "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z", "object_id", "material_id",
)  # fmt: skip


#: Channel of means alone: the share of the light whose rays meet a surface.
COVERAGE = "coverage.Y"


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
