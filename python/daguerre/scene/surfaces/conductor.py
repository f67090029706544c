"""Metals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from daguerre.errors import UsageError
from daguerre.files.value import BriefRecord
from daguerre.scene.spectrum import Spectrum

from .diffuse import Color
from .facets import Distribution
from .texture_slot import TextureSlot


@dataclass(frozen=True, repr=False)
class Conductor(BriefRecord):
    """Metal: microfacets, both sides; ``alpha`` < 1e-3: a mirror.

    Without ``eta`` and ``k`` the facets reflect the same share at every angle. With them they
    have the Fresnel reflectance of the index eta + i k (Born and Wolf, Principles of Optics,
    14.2). Light that bounces from facet to facet is left out.

    Attributes:
        reflectance: Share of light that facets reflect; with ``eta`` and ``k``, a factor on it.
        alpha: Roughness, of slopes along u where ``alpha_v`` is given.
        reflectance_texture: RGB, a factor on ``reflectance``.
        alpha_v: Roughness along v; None: ``alpha``.
        alpha_texture: Factors: R on ``alpha``, G on ``alpha_v``.
        eta: Real part of the index of refraction; a colour is one value for red, green and blue.
        k: Imaginary part, the extinction coefficient; given if ``eta`` is.
        distribution: Distribution of the facets' normals: "ggx", or "beckmann", without the long
            tails.
    """

    reflectance: Color | Spectrum = (1.0, 1.0, 1.0)
    alpha: float = 0.1
    reflectance_texture: TextureSlot | None = None
    alpha_v: float | None = None
    alpha_texture: TextureSlot | None = None
    eta: Color | Spectrum | None = None
    k: Color | Spectrum | None = None
    distribution: Distribution = "ggx"

    @classmethod
    def of_metal(cls, name: str, **fields: object) -> Conductor:
        """A metal by its measured index of refraction.

        Args:
            name: Chemical symbol, or a name of ``daguerre.scene.metals.names()``.
            **fields: Other fields, such as ``alpha``.

        Raises:
            UsageError: No such metal, or ``eta`` or ``k`` is given too.
        """
        from daguerre.scene import metals

        twice = sorted(fields.keys() & {"eta", "k"})
        if twice:
            raise UsageError(
                f"metal: {twice[0]}: comes from the table of metals; leave it out, "
                f"or use dg.Conductor"
            )
        eta, k = metals.load(name)
        return cls(**dict[str, Any](fields), eta=eta, k=k)
