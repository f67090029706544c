"""Finds materials in MaterialX documents that a stage refers to.

The common build of USD has no plugin for ``.mtlx``, so that such a reference brings no prims; its
place remains in the list of references.
"""

from __future__ import annotations

from collections.abc import Iterator

from pxr import Sdf, Usd, UsdShade

from daguerre.importers.usd.anchored import anchored


def material_in_document(stage: Usd.Stage, path: Sdf.Path) -> tuple[str, str] | None:
    """Path of the document that has the material of a prim, and its name there; None: no such.

    Args:
        stage: The stage.
        path: Path of the material, whether a prim is there or not.
    """
    place = path
    while place != Sdf.Path.absoluteRootPath and not place.isEmpty:
        prim = stage.GetPrimAtPath(place)
        for layer, reference in _references(prim) if prim else ():
            if reference.assetPath.lower().split(":SDF_FORMAT_ARGS:")[0].endswith(".mtlx"):
                name = path.name if place != path else reference.primPath.name or path.name
                return anchored(layer, reference.assetPath), name
        place = place.GetParentPath()
    return None


def bound_path(prim: Usd.Prim) -> Sdf.Path | None:
    """Target of the nearest direct binding of a prim or its ancestors, even if it does not exist.

    USD's search skips targets that are no prims, such as materials of ``.mtlx`` without the plugin.
    """
    while prim and not prim.IsPseudoRoot():
        binding = UsdShade.MaterialBindingAPI(prim).GetDirectBinding()
        if not binding.GetMaterialPath().isEmpty:
            return binding.GetMaterialPath()
        prim = prim.GetParent()
    return None


def _references(prim: Usd.Prim) -> Iterator[tuple[Sdf.Layer, Sdf.Reference | Sdf.Payload]]:
    """References and payloads in all layers, with the layer of each."""
    for spec in prim.GetPrimStack():
        for listed in (spec.referenceList, spec.payloadList):
            for reference in listed.GetAddedOrExplicitItems():
                yield spec.layer, reference
