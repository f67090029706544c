"""Lists the names in a layer: other layers, classes, value clips, files inside of packages."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from pxr import Ar, Sdf, Vt

from daguerre.errors import InputError

from .bound_collections import BINDING

#: Largest depth of prims.
DEEPEST = 2000
#: Most arcs of a layer: references, payloads, inherited and specialized classes.
_MAX_ARCS = 2_000_000
_ASSETS = ("asset", "asset[]")


@dataclass(frozen=True)
class Arc:
    """Reference from a prim to another prim.

    Attributes:
        asset: File as authored; empty: the layer itself.
        path: Path of the prim; empty: the default prim.
        of_class: Whether the prim is inherited or specialized.
    """

    asset: str
    path: Sdf.Path
    of_class: bool = False


@dataclass
class LayerNames:
    """Names in a layer.

    Attributes:
        below: Prims and variants directly below a prim or variant.
        arcs: Arcs of a prim or variant.
        clips: Prim, and its sets of value clips.
        assets: Attribute, and each asset that is an expression or inside of a package.
        binds_collections: Whether a material is bound to a collection.
    """

    below: dict[Sdf.Path, dict[Sdf.Path, None]] = field(default_factory=dict)
    arcs: dict[Sdf.Path, list[Arc]] = field(default_factory=dict)
    clips: list[tuple[Sdf.Path, dict[str, Any]]] = field(default_factory=list)
    assets: list[tuple[Sdf.Path, str]] = field(default_factory=list)
    binds_collections: bool = False

    def files(self) -> set[str]:
        """Files of all arcs, as authored."""
        return {arc.asset for arcs in self.arcs.values() for arc in arcs if arc.asset}


def names_of(layer: Sdf.Layer, odd_assets: bool) -> LayerNames:
    """Lists the names of a layer.

    Args:
        layer: The layer.
        odd_assets: Whether to look for assets that are expressions or inside of packages.

    Raises:
        InputError: A prim that the layer names does not exist, for which USD would end the process;
            or paths are too deep.
    """
    found = LayerNames()
    paths: list[Sdf.Path] = []
    layer.Traverse(Sdf.Path.absoluteRootPath, paths.append)
    arcs = 0
    for path in paths:
        if path.isEmpty:
            raise _missing(layer)
        if path.pathElementCount > DEEPEST:
            raise InputError(
                f"{layer.realPath}: prims are nested too deeply: the limit is {DEEPEST}"
            )
        if path.IsPrimPath() or path.IsPrimVariantSelectionPath():
            spec = layer.GetPrimAtPath(path)
            if spec:
                arcs += _add_prim(found, spec, path)
            elif path.IsPrimPath():
                raise _missing(layer)
            if arcs > _MAX_ARCS:
                raise InputError(f"{layer.realPath}: too many references: the limit is {_MAX_ARCS}")
        elif path.IsPropertyPath():
            if path.name.startswith(BINDING):
                found.binds_collections = True
            if odd_assets:
                found.assets += ((path, name) for name in _odd_assets(layer, path))
    return found


def _missing(layer: Sdf.Layer) -> InputError:
    return InputError(f"{layer.realPath}: damaged layer: it refers to a missing prim")


def _add_prim(found: LayerNames, spec: Sdf.PrimSpec, path: Sdf.Path) -> int:
    found.below.setdefault(path.GetParentPath(), {})[path] = None
    arcs = [
        Arc(item.assetPath, item.primPath)
        for key, listed in (("references", "referenceList"), ("payload", "payloadList"))
        if spec.HasInfo(key)
        for item in getattr(spec, listed).GetAddedOrExplicitItems()
    ]
    arcs += (
        Arc("", item, True)
        for key, listed in (("inheritPaths", "inheritPathList"), ("specializes", "specializesList"))
        if spec.HasInfo(key)
        for item in getattr(spec, listed).GetAddedOrExplicitItems()
    )
    if arcs:
        found.arcs[path] = arcs
    if spec.HasInfo("clips"):
        found.clips.append((path, dict(spec.GetInfo("clips"))))
    return len(arcs)


def _odd_assets(layer: Sdf.Layer, path: Sdf.Path) -> Iterator[str]:
    attribute = layer.GetAttributeAtPath(path)
    if attribute and str(attribute.typeName) in _ASSETS:
        values = [attribute.default] if attribute.HasDefaultValue() else []
        values += (layer.QueryTimeSample(path, time) for time in layer.ListTimeSamplesForPath(path))
        for value in values:
            for name in asset_names(value):
                if Ar.IsPackageRelativePath(name) or Sdf.VariableExpression.IsExpression(name):
                    yield name


def asset_names(value: object) -> list[str]:
    """Names of files in a value, which is an asset or an array of them; other values have none."""
    if isinstance(value, Sdf.AssetPath):
        return [value.path]
    if isinstance(value, Sdf.AssetPathArray | list | tuple | Vt.StringArray):
        return [path.path for path in value if isinstance(path, Sdf.AssetPath)]
    return []
