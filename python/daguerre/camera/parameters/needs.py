"""Kinds of cameras, and parameters' conditions on them."""

from __future__ import annotations

from daguerre.camera.ideal import IDEAL as KINDS
from daguerre.camera.ideal import WITH_IRIS
from daguerre.parameters.need import Need

#: those that have a prescription's elements
TRACED = ("exact", "polynomial")
#: ways to compute a lens
MODELS = (*TRACED, "thick", *KINDS)

#: It stands in the place of a lens: a projection takes no other (``setup/checks.py``).
LENS_ITSELF = Need(MODELS, "cannot be combined with a projection")
#: A projection leaves it aside: a flag that says it is refused, a scene file's value is not.
OF_LENSES = Need(MODELS, "")
#: An opening of some size: to make a lens a pinhole, and give it at once, is refused.
OPENING = Need((*TRACED, "thick", *WITH_IRIS, "projection"), "")

_QUOTED = " or ".join(map(repr, KINDS))
WITHOUT_PRESCRIPTION = Need(
    ("ideal",),
    "a lens with a prescription has its own focal length; leave it out (zoom lenses take zoom) "
    f"or choose an ideal lens (lens={_QUOTED})",
)
PRESCRIPTION = Need(("prescription",), "wanted a lens with a prescription, got {kind}")
ZOOM = Need(PRESCRIPTION.kinds, PRESCRIPTION.refusal + "; its focal_length may be any")
ELEMENTS = Need(TRACED, "wanted lens_model exact, got {kind}, which has no elements")
ROUGH = Need(
    tuple(name for name in (*MODELS, "projection") if name != "polynomial"),
    "wanted lens_model exact, got {kind}, which is smooth",
)
_SURFACES = "wanted a lens with surfaces (lens_model exact), got {kind}: it is for "
GHOSTS = Need(TRACED, _SURFACES + "ghosts")
SCATTER = Need(TRACED, _SURFACES + "scattered light")
FITTED = Need(("polynomial",), "wanted lens_model polynomial, got {kind}")
APERTURE = Need(WITH_IRIS, "this {kind} lens takes f_stop instead")
IDEAL = Need(("ideal",), APERTURE.refusal)
T_STOP = Need(OPENING.kinds, "a pinhole has none; choose another lens, or leave it out")
EVEN = Need(tuple(KINDS), "the {kind} lens has its own vignetting")
