"""Lists the supported extensions of glTF, and checks the extensions of a file."""

from __future__ import annotations

from typing import Any

from daguerre.files import extras
from daguerre.files.json_item import Item, clean, short
from daguerre.files.notes import Notes

KNOWN = frozenset(
    {
        "EXT_camera_physical",
        "EXT_mesh_gpu_instancing",
        "EXT_meshopt_compression",
        "EXT_texture_webp",
        "KHR_animation_pointer",
        "KHR_draco_mesh_compression",
        "KHR_lights_punctual",
        "KHR_materials_anisotropy",
        "KHR_materials_clearcoat",
        "KHR_materials_diffuse_transmission",
        "KHR_materials_dispersion",
        "KHR_materials_emissive_strength",
        "KHR_materials_ior",
        "KHR_materials_iridescence",
        "KHR_materials_pbrSpecularGlossiness",
        "KHR_materials_sheen",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_materials_volume",
        "KHR_mesh_quantization",
        "KHR_meshopt_compression",
        "KHR_node_visibility",
        "KHR_texture_basisu",
        "KHR_texture_transform",
    }
)


def check_extensions(root: Item, notes: Notes) -> None:
    """Checks required extensions, and notes unknown optional ones with their counts.

    Raises:
        InputError: A required extension is unknown, or needs a package that is not installed.
    """
    for item in root.list_of("extensionsRequired"):
        if item.text() not in KNOWN:
            item.fail(
                f"unknown extension: wanted one of {', '.join(sorted(KNOWN))}, "
                f"got {short(item.text())}"
            )
        if package := extras.missing_for(item.text()):
            item.fail(f"{item.text()} {extras.lack(package)}")
    listed = [item.text() for item in root.list_of("extensionsUsed")]
    counts = _count_uses(root.value)
    for name in dict.fromkeys([*listed, *counts]):
        if name not in KNOWN:
            # Listed but unused extensions are noted too, with a count of 0.
            notes.add(f"extension {short(clean(name))} is not supported", counts.get(name, 0))


def _count_uses(document: object) -> dict[str, int]:
    """Counts uses of each extension without recursion, in the order of the file."""
    counts: dict[str, int] = {}
    stack: list[Any] = [document]
    while stack:
        value = stack.pop()
        if isinstance(value, dict):
            extensions = value.get("extensions")
            if isinstance(extensions, dict):
                for name in extensions:
                    counts[name] = counts.get(name, 0) + 1
            stack.extend(
                child
                for key, child in reversed(value.items())
                if key != "extras" and isinstance(child, (dict, list))
            )
        elif isinstance(value, list):
            stack.extend(child for child in reversed(value) if isinstance(child, (dict, list)))
    return counts
