"""Kinds of cameras, and parameters' conditions on them."""

from __future__ import annotations

from daguerre.parameters.need import Need

#: ways to compute a lens
MODELS = ("exact", "polynomial", "thick", "thin", "pinhole")
#: those that have a prescription's elements
TRACED = ("exact", "polynomial")

#: It stands in the place of a lens: a projection takes no other (``setup/checks.py``).
LENS_ITSELF = Need(MODELS, "wanted without a projection, got both")
#: A projection leaves it aside: a flag that says it is refused, a scene file's value is not.
OF_LENSES = Need(MODELS, "")
#: An opening of some size: to make a lens a pinhole, and give it at once, is refused.
OPENING = Need((*TRACED, "thick", "thin", "projection"), "")

WITHOUT_PRESCRIPTION = Need(
    ("ideal",),
    "a lens with a prescription has its own; "
    "wanted none with it (of a zoom: zoom), or an ideal lens (lens='thin' or 'pinhole')",
)
PRESCRIPTION = Need(("prescription",), "wanted a lens with a prescription for it, got {kind}")
ZOOM = Need(PRESCRIPTION.kinds, PRESCRIPTION.refusal + "; its focal_length may be any")
ELEMENTS = Need(TRACED, "wanted lens_model exact, got {kind}, which has no elements")
ROUGH = Need(
    ("exact", "thick", "thin", "pinhole", "projection"),
    "wanted lens_model exact, got {kind}, which is smooth",
)
_SURFACES = "wanted a lens with surfaces (lens_model exact), got {kind}: it is for "
GHOSTS = Need(TRACED, _SURFACES + "ghosts")
SCATTER = Need(TRACED, _SURFACES + "scattered light")
FITTED = Need(("polynomial",), "wanted lens_model polynomial with it, got {kind}")
THIN = Need(("thin",), "this {kind} lens takes f_stop instead")
IDEAL = Need(("ideal",), THIN.refusal)
T_STOP = Need(OPENING.kinds, "a pinhole has no t_stop")
EVEN = Need(("thin", "pinhole"), "the {kind} lens has its own vignetting")
