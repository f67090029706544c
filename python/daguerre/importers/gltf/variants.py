"""Reads KHR_materials_variants: named choices of materials, of which one may be active.

All mappings are checked, chosen or not. Source: the extension's specification and schema.
"""

from __future__ import annotations

from daguerre.errors import InputError, suggest
from daguerre.files.json_item import Item, clean

_EXTENSION = "KHR_materials_variants"


class Variants:
    """Variants of a file, and the active variant.

    Args:
        root: The JSON object of the file.
        chosen: Name of the active variant; None: the default materials.

    Attributes:
        names: Names of all variants, in the order of the file.

    Raises:
        InputError: The file has no variant of this name.
    """

    def __init__(self, root: Item, chosen: str | None) -> None:
        extension = root.extension(_EXTENSION)
        items = [] if extension is None else list(extension.need("variants"))
        self.names = [clean(item.need("name").text()) for item in items]
        self._materials = len(root.list_of("materials"))
        if chosen is not None and chosen not in self.names:
            hint = suggest(chosen, self.names, few=True) if self.names else ": the file has none"
            raise InputError(f"{root.file}: no variant named {chosen!r}{hint}")
        self._chosen = None if chosen is None else self.names.index(chosen)

    def material(self, primitive: Item) -> int | None:
        """Index of a primitive's material in the chosen variant; None: glTF's default material."""
        plain, extension = primitive.get("material"), primitive.extension(_EXTENSION)
        used = None if plain is None else plain.index(self._materials, "materials")
        seen: set[int] = set()
        for mapping in [] if extension is None else extension.need("mappings"):
            material = mapping.need("material").index(self._materials, "materials")
            for item in mapping.need("variants"):
                variant = item.index(len(self.names), "variants")
                if variant in seen:
                    item.fail(f"variant {variant} appears twice")
                seen.add(variant)
                if variant == self._chosen:
                    used = material
        return used
