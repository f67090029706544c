"""Opens all layers that a stage may use, each after a check of its place and its file.

USD opens the files that layers name. Here every name is followed first: sublayers, references and
payloads of all variants, value clips, and packages that values point into. Names may be expressions
of variables, which a referring layer may override.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from itertools import chain
from pathlib import Path

from pxr import Ar, Sdf

from daguerre.errors import InputError
from daguerre.files.in_use import note_read

from .anchored import anchored
from .assets import Assets, package_of
from .clips import Clips, clips_of_template, named_clips, templates
from .expressions import Variables
from .layer_files import check_file
from .layer_names import LayerNames, names_of

#: Maximum number of layers of a stage; with each set of variables, they count again.
_MAX_LAYERS = 100_000


def read_anew(name: str) -> Sdf.Layer | None:
    """Opens a layer with its file's present content; None: USD cannot open it.

    USD keeps a layer while any stage of this process uses it, and compares times of files only, so
    another file of the same time would count as the old one.
    """
    before = Sdf.Layer.Find(name)
    layer = Sdf.Layer.FindOrOpen(name)
    if before:
        before.Reload(force=True)
    return layer


class Stack:
    """A layer and its sublayers, with the values of variables that hold there.

    Attributes:
        root: The layer.
        variables: The values.
        layers: All layers, strongest first, as names, each with the stacks that it refers to, by
            authored name.
    """

    def __init__(self, root: Sdf.Layer, variables: Variables) -> None:
        self.root, self.variables = root, variables
        self.layers: list[tuple[LayerNames, dict[str, Stack]]] = []


class Layers:
    """Opens the layers of a stage.

    Args:
        path: File of the stage.
        assets: Files that it may read.

    Attributes:
        root: The stack of the stage's root layer.
        stacks: All stacks.

    Raises:
        InputError: A layer is not allowed, or damaged, or there are too many.
    """

    def __init__(self, path: Path, assets: Assets) -> None:
        self._file, self._assets = str(path), assets
        self._checked: dict[str, bool] = {}
        self._names: dict[str, LayerNames] = {}
        self._kept: dict[str, Sdf.Layer | None] = {}
        self._opened_anew: set[str] = set()
        self._clips = Clips(self._file)
        real = os.path.realpath(path)
        self._folder = Path(real).parent
        context = Ar.GetResolver().CreateDefaultContextForAsset(real)
        with Ar.ResolverContextBinder(context):
            first = self._opened(real, real)
            if first is None:
                raise InputError(f"{path}: not a stage that USD can open")
            self.stacks: dict[tuple[str, str], Stack] = {}
            self._waiting: list[Stack] = []
            self.root = self._stack(first, Variables(self._file, {}))
            while self._waiting:
                self._follow(self._waiting.pop())
        self._clips.check()

    @property
    def bind_collections(self) -> bool:
        """Whether any layer binds a material to a collection."""
        return any(names.binds_collections for names in self._names.values())

    def _stack(self, layer: Sdf.Layer, outer: Variables) -> Stack:
        """Stack of a layer that is referred to from a layer with variables ``outer``."""
        variables = outer.below(layer)
        key = layer.identifier, variables.key
        if key not in self.stacks:
            if len(self.stacks) >= _MAX_LAYERS:
                raise self._too_many()
            self.stacks[key] = Stack(layer, variables)
            self._waiting.append(self.stacks[key])
        return self.stacks[key]

    def _too_many(self) -> InputError:
        return InputError(f"{self._file}: too many layers: the limit is {_MAX_LAYERS}")

    def _follow(self, stack: Stack) -> None:
        """Opens the layers that a stack names."""
        visited, waiting = {stack.root.identifier}, [stack.root]
        while waiting:
            layer = waiting.pop()
            names = self._names[layer.identifier]
            for name in layer.subLayerPaths:
                found = self._named(layer, name, stack.variables)
                if found is not None and found.identifier not in visited:
                    visited.add(found.identifier)
                    waiting.append(found)
            below = {}
            for name in names.files():
                found = self._named(layer, name, stack.variables)
                if found is not None:
                    below[name] = self._stack(found, stack.variables)
            stack.layers.append((names, below))
            self._check_clips(layer, names, stack.variables)
            self._check_assets(layer, names.assets, stack.variables)

    def _named(self, layer: Sdf.Layer, name: str, variables: Variables) -> Sdf.Layer | None:
        """Layer that another layer names; None: USD can open no such layer."""
        absolute = self._absolute(layer, name, variables)
        if not absolute:
            return None
        if absolute not in self._kept:
            if len(self._kept) >= _MAX_LAYERS:
                raise self._too_many()
            real = self._assets.check(f"layer {layer.GetDisplayName()}", absolute)
            self._kept[absolute] = self._opened(absolute, real)
        return self._kept[absolute]

    def _absolute(self, layer: Sdf.Layer, name: str, variables: Variables) -> str:
        """Absolute path of a name; empty: an expression without a value."""
        evaluated = variables.evaluated(name)
        return anchored(layer, evaluated) if evaluated else ""

    def _opened(self, name: str, real: str) -> Sdf.Layer | None:
        """Opens a layer; None: no such layer.

        Args:
            name: Name of the layer for USD.
            real: File of the layer, or a path inside of a package.
        """
        if not self._check_file(real):
            return None
        if Sdf.FileFormat.FindByExtension(name) is None or not Ar.GetResolver().Resolve(name):
            return None
        return self._known(name, real)

    def _known(self, name: str, real: str) -> Sdf.Layer | None:
        layer = self._anew(name)
        if layer is not None and layer.identifier not in self._names:
            odd = self._checked[package_of(real)]
            self._names[layer.identifier] = names_of(layer, odd)
        return layer

    def _anew(self, name: str) -> Sdf.Layer | None:
        """Opens a layer, the first time with its file's present content."""
        if name in self._opened_anew:
            return Sdf.Layer.FindOrOpen(name)
        self._opened_anew.add(name)
        return read_anew(name)

    def _check_file(self, real: str) -> bool:
        """Checks the file of a layer, or the package that it is in; returns whether it exists."""
        file = package_of(real)
        if file not in self._checked:
            if not os.path.lexists(file):
                note_read([file])  # it may come
                return False
            self._checked[file] = check_file(Path(file), file)
        return True

    def _check_clips(self, layer: Sdf.Layer, names: LayerNames, variables: Variables) -> None:
        for path, sets in names.clips:
            self._clips.add(sets)
            place = f"layer {layer.GetDisplayName()}: {path}"
            named = (self._absolute(layer, name, variables) for name in named_clips(sets))
            meant = (clips_of_template(layer, t, self._folder) for t in templates(sets))
            for file in chain(named, *meant):
                if file:
                    self._check_clip(file, place, variables)

    def _check_clip(self, name: str, place: str, variables: Variables) -> None:
        """Checks a clip; USD opens no further layer from there, but may point into packages."""
        real = self._assets.check(place, name)
        if not self._check_file(real):
            return
        if Sdf.Layer.Find(name):
            self._anew(name)
        if self._checked[package_of(real)] and name not in self._kept:
            self._kept[name] = layer = self._opened(name, real)
            if layer is not None:
                self._check_assets(layer, self._names[layer.identifier].assets, variables)

    def _check_assets(
        self, layer: Sdf.Layer, found: Iterable[tuple[Sdf.Path, str]], variables: Variables
    ) -> None:
        """Checks packages that values point into, as USD opens these to find the file."""
        for path, name in found:
            absolute = self._absolute(layer, name, variables)
            if absolute and Ar.IsPackageRelativePath(absolute):
                self._check_file(self._assets.check(str(path), absolute))
