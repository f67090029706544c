"""Material of the renderer from a surface: values become factors and textures."""

from __future__ import annotations

import math
from typing import Any

from daguerre.scene.materials import Gltf, Material, TextureSlot

from .arithmetic import Arithmetic
from .bake import Baker
from .channels import Texel, Value, broadcast, fit
from .surface import GltfInputs
from .textures import Packed, Packer

Fields = dict[str, Any]
#: Channel of the texture that glTF reads for a number.
_CHANNELS = {
    "specular": 3,
    "transmission": 0,
    "clearcoat": 0,
    "clearcoat_roughness": 1,
    "sheen_roughness": 3,
    "iridescence": 0,
    "diffuse_transmission": 3,
}
#: Colours, and the largest factor of each.
_COLORS = {
    "specular_color": math.inf,
    "sheen_color": 1.0,
    "emissive": math.inf,
    "diffuse_transmission_color": 1.0,
}
#: Parameters of layers by the weight of each.
LAYERS = {
    "clearcoat": ("clearcoat_roughness", "clearcoat_normal"),
    "sheen_color": ("sheen_roughness",),
    "iridescence": ("iridescence_ior", "iridescence_thickness_nm"),
    "diffuse_transmission": ("diffuse_transmission_color",),
    "anisotropy": ("anisotropy_rotation",),
}


class Assembler:
    """Makes materials.

    Args:
        packer: Makes textures.
        baker: Computes pictures.
    """

    def __init__(self, packer: Packer, baker: Baker) -> None:
        self._packer = packer
        self._math = Arithmetic(baker)

    def material(self, surface: GltfInputs, name: str, *, whole: bool = False) -> Material:
        """Material of a surface; ``whole``: with the parameters of layers that have no weight."""
        if not whole:
            _drop_weightless(surface)
        fields: Fields = {
            "alpha_mode": surface.alpha_mode,
            "alpha_cutoff": surface.alpha_cutoff,
            "double_sided": surface.double_sided,
            "ior": surface.ior,
            "thickness": 1.0 if surface.volume else 0.0,
            "attenuation_distance": surface.attenuation_distance,
            "attenuation_color": tuple(
                min(max(_number(c), 0.0), 1.0) for c in surface.attenuation_color
            ),
            "dispersion": surface.dispersion,
            "iridescence_ior": surface.iridescence_ior,
            "anisotropy_rotation": surface.anisotropy_rotation,
        }
        self._base(surface, fields)
        self._metallic_roughness(surface, fields)
        self._normal(surface.normal, "normal", fields)
        self._normal(surface.clearcoat_normal, "clearcoat_normal", fields)
        for key, place in _CHANNELS.items():
            self._one(key, getattr(surface, key), place, fields)
        for key, most in _COLORS.items():
            self._color(key, getattr(surface, key), most, fields)
        self._anisotropy(surface.anisotropy, fields)
        self._film(surface.iridescence_thickness_nm, fields)
        return Material(Gltf(**fields), name=name)

    def _base(self, surface: GltfInputs, fields: Fields) -> None:
        """Colour and opacity share a texture."""
        color = broadcast(surface.base_color, 3)
        if surface.alpha_mode == "opaque":
            packed = self._packer.packed(color, by_vertices=True)
        else:
            channels = (*color, *surface.alpha[:1])
            packed = self._packer.packed(channels, by_vertices=True)
            fields["base_alpha"] = packed.factors[3]
        fields["base_color"] = packed.factors[:3]
        fields["base_color_texture"] = packed.slot

    def _metallic_roughness(self, surface: GltfInputs, fields: Fields) -> None:
        packed = self._packer.packed((*surface.roughness[:1], *surface.metallic[:1]), places=(1, 2))
        fields["roughness"], fields["metallic"] = packed.factors
        fields["metallic_roughness_texture"] = packed.slot

    def _normal(self, normal: Value | None, key: str, fields: Fields) -> None:
        """Normal map: 2 x texel - 1, its slopes times a scale."""
        if normal is None:
            return
        x, y, z = fit(normal, 3)
        scale = 1.0
        if isinstance(x, Texel) and isinstance(y, Texel) and x.scale == y.scale == -2 * x.bias:
            scale = x.scale / 2 if x.bias == y.bias and x.scale else 1.0
        slopes = self._math.multiply((x, y), (1 / scale,))
        encoded = self._math.multiply(self._math.add((*slopes, z), (1.0,)), (0.5,))
        if any(isinstance(c, Texel) and (c.scale, c.bias) != (1.0, 0.0) for c in encoded):
            encoded = self._math.each(lambda v: v + 0.0, encoded)  # a map takes no factors
        packed = self._packer.packed(encoded)
        if packed.slot is not None:
            fields[f"{key}_scale"], fields[f"{key}_texture"] = scale, packed.slot

    def _one(self, key: str, value: Value, place: int, fields: Fields) -> None:
        packed = self._packer.packed(value[:1], places=(place,))
        fields[key], fields[f"{key}_texture"] = packed.factors[0], packed.slot

    def _color(self, key: str, value: Value, most: float, fields: Fields) -> None:
        packed = self._packer.packed(broadcast(value, 3), most=most)
        fields[key], fields[f"{key}_texture"] = packed.factors, packed.slot

    def _anisotropy(self, strength: Value, fields: Fields) -> None:
        """Strength in blue; the direction along the tangent is (1, 1/2) in red and green."""
        packed = self._packer.packed(strength[:1], places=(0,))
        if packed.slot is not None:
            packed = self._packer.packed(
                (1.0, *self._halves(strength), *strength[:1]), places=(0, 1, 2)
            )
            fields["anisotropy"] = packed.factors[2]
        else:
            fields["anisotropy"] = packed.factors[0]
        fields["anisotropy_texture"] = packed.slot

    def _halves(self, like: Value) -> Value:
        """Constant picture of 0.5 with the mapping of another picture."""
        return self._math.each(lambda v: v * 0 + 0.5, like[:1])

    def _film(self, thickness: Value, fields: Fields) -> None:
        """Thickness in nm: a share between a minimum of 0 and a maximum."""
        share = thickness[0]
        if not isinstance(share, Texel):
            fields["iridescence_thickness_min_nm"] = min(max(_number(share), 0.0), 1e6)
            fields["iridescence_thickness_max_nm"] = fields["iridescence_thickness_min_nm"]
            return
        most = min(max(float(share.values().max()), 1e-3), 1e6)
        packed: Packed = self._packer.packed(
            self._math.multiply((share,), (1 / most,)), places=(1,)
        )
        slot: TextureSlot | None = packed.slot
        fields["iridescence_thickness_min_nm"] = 0.0
        fields["iridescence_thickness_max_nm"] = most * packed.factors[0]
        fields["iridescence_thickness_texture"] = slot


def _drop_weightless(surface: GltfInputs) -> None:
    """Resets the parameters of layers that have no weight."""
    plain = GltfInputs()
    for weight, parameters in LAYERS.items():
        if getattr(surface, weight) == getattr(plain, weight):
            for name in parameters:
                setattr(surface, name, getattr(plain, name))


def _number(channel: object) -> float:
    return channel if isinstance(channel, float) else 0.0
