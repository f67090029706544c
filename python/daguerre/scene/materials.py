"""Materials of surfaces. Colours are linear Rec.709 triples; emission is in cd/m2."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from daguerre.checks import short, shown
from daguerre.errors import InputError
from daguerre.files.value import BriefRecord

from .media import Medium, check_media
from .spectrum import Spectrum
from .surfaces.boundary import Boundary
from .surfaces.checks import check_fields, check_surface
from .surfaces.coated import Coated
from .surfaces.conductor import Conductor
from .surfaces.dielectric import Dielectric
from .surfaces.diffuse import Color, Diffuse
from .surfaces.gltf import Gltf
from .surfaces.mix import Mix
from .surfaces.texture_slot import TextureSlot

if TYPE_CHECKING:
    from .light_profile import LightProfile

__all__ = [
    "Boundary",
    "Coated",
    "Color",
    "Conductor",
    "Dielectric",
    "Diffuse",
    "Gltf",
    "Kind",
    "Material",
    "Mix",
    "Spectrum",
    "TextureSlot",
    "bounds_media",
    "check_material",
    "check_parts",
]

#: Kinds of nesting that are no priority.
CONTAINED, LITERAL = "contained", "literal"
#: Largest priority of a solid.
MAX_PRIORITY = 1000

Kind = Diffuse | Conductor | Dielectric | Coated | Mix | Boundary | Gltf
#: Names of the kinds, for messages.
KINDS = "Diffuse, Conductor, Dielectric, Coated, Mix, Boundary or Gltf"


@dataclass(frozen=True, repr=False)
class Material(BriefRecord):
    """A named material: a kind of surface, and emission added to it.

    Attributes:
        kind: Diffuse, Conductor, Dielectric, Coated, Mix, Boundary or Gltf.
        emission: Luminance that the front side emits, cd/m2.
        two_sided_emission: Whether the back emits too.
        profile: Factor on all emission, including the emission of the kind, by its direction in the
            frame of the instance, which shines along -z.
        opacity: Share of the surface that is opaque, 0 to 1; rays pass through the rest.
        opacity_texture: R, a factor on ``opacity``.
        normal_texture: Normal map in tangent space, as glTF has it: R along u, G along -v. A
            ``Gltf`` has its own.
        normal_scale: Factor on R and G of the normal map.
        two_sided: Whether the kind is seen from behind too; otherwise the back is black, emission
            aside.
        emission_texture: RGB, a factor on ``emission``.
        interior: Medium inside a closed mesh, instead of the kind's absorption; None: no medium.
        exterior: Medium outside of the mesh, such as the interior of a mesh around it; None: the
            scene's fog.
        nesting: How overlapping solids replace each other: ``"contained"``, the inner replaces the
            outer, else the later in the scene; a whole number, the higher priority (contained: 0);
            ``"literal"``, none: the surface is an interface between both sides as given, for files
            of pbrt and Mitsuba.
    """

    kind: Kind = field(default_factory=Diffuse)
    name: str = ""
    emission: Color = (0.0, 0.0, 0.0)
    two_sided_emission: bool = False
    profile: LightProfile | None = None
    opacity: float = 1.0
    opacity_texture: TextureSlot | None = None
    normal_texture: TextureSlot | None = None
    normal_scale: float = 1.0
    two_sided: bool = True
    emission_texture: TextureSlot | None = None
    interior: Medium | None = None
    exterior: Medium | None = None
    nesting: str | int = CONTAINED


def check_material(material: Material, where: str) -> None:
    """Checks a material and the shapes of its values; the core checks their ranges.

    Raises:
        InputError: The message names the field.
    """
    if not isinstance(material, Material):
        raise InputError(f"{where}: wanted a Material, got {short(material)}")
    kind = material.kind
    if not isinstance(kind, Kind):
        raise InputError(f"{where}: kind: wanted {KINDS}, got {short(kind)}")
    if not isinstance(material.name, str):
        raise InputError(f"material: name: wanted a string, got {shown(material.name)}")
    check_fields(material, where)
    if material.profile is not None:
        from .light_profile import check_profile

        check_profile(material.profile, where)
    check_surface(kind, where)
    check_media(material.interior, material.exterior, where)
    _check_nesting(material.nesting, where)
    if isinstance(kind, Boundary) and any(material.emission):
        raise InputError(
            f"{where}: emission: a boundary cannot emit light, got {short(material.emission)}"
        )
    if isinstance(kind, Gltf | Mix | Boundary) and material.normal_texture is not None:
        owner = {
            Gltf: "set it on Gltf instead",
            Mix: "set it on the parts instead",
            Boundary: "a boundary has none",
        }[type(kind)]
        raise InputError(f"{where}: normal_texture: {owner}")


def _check_nesting(nesting: object, where: str) -> None:
    """Checks how solids of a material nest."""
    whole = isinstance(nesting, int) and not isinstance(nesting, bool)
    if not (whole and abs(nesting) <= MAX_PRIORITY) and nesting not in (CONTAINED, LITERAL):  # type: ignore[arg-type]
        raise InputError(
            f"{where}: nesting: wanted {CONTAINED!r}, {LITERAL!r} or a whole number within "
            f"{MAX_PRIORITY}, got {short(nesting)}"
        )


def bounds_media(material: Material) -> bool:
    """Whether another medium may begin at the material's surfaces."""
    media = (material.interior, material.exterior)
    return isinstance(material.kind, Boundary) or media != (None, None)


def check_parts(material: Material, known: int, where: str) -> None:
    """Checks that the parts of a mixture are among the materials that were added before it.

    Args:
        material: Any material, checked by :func:`check_material`.
        known: Number of those materials.
        where: For messages.

    Raises:
        InputError: A part is not among them.
    """
    if not isinstance(material.kind, Mix):
        return
    for name in ("first", "second"):
        part = getattr(material.kind, name)
        if part >= known:
            raise InputError(
                f"{where}: {name}: wanted one of the {known} materials before it, got {part}"
            )
