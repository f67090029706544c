"""Kinds of cameras, and parameters' conditions on them."""

from __future__ import annotations

from daguerre.camera.ideal import IDEAL as KINDS
from daguerre.camera.ideal import WITH_IRIS
from daguerre.parameters.need import Need

#: Models with the elements of a prescription.
TRACED = ("exact", "polynomial")
#: Optical models of a lens.
MODELS = (*TRACED, "thick", *KINDS)

#: For parameters that choose the lens: a projection replaces the lens (``setup/checks.py``).
LENS_ITSELF = Need(MODELS, "cannot be combined with a projection")
#: For parameters that a projection ignores: their flags are refused, values of scene files are not.
OF_LENSES = Need(MODELS, "")
#: For parameters of the aperture, which a pinhole does not have.
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
