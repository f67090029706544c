"""Executes the directives of a scene and records the objects that they define.

Shapes, materials and lights are only recorded here: pbrt-v4 may define a texture after its use, and
the version is known only at the end of the text.

Source: pbrt-v4's user's guide (file format), and its parser where the guide is silent.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from daguerre.errors import suggest

from .description import Description
from .directives import OF_V3, Directive, directives_of
from .files import Files
from .ledger import Ledger
from .lexer import Lexer
from .parameters import Parameter
from .place import FilePlace
from .state import TARGETS, Entity, State
from .transforms import Matrix, Moving, look_at, rotation, scaling, translation

#: Most blocks within blocks.
MAX_DEPTH = 10_000
#: Largest number of a matrix: matrices of objects and instances are multiplied later.
MAX_ENTRY = 1e100
#: Directives allowed only before ``WorldBegin``, and only after it.
_OPTIONS = ("Accelerator", "Camera", "Film", "Integrator", "Option", "PixelFilter", "Sampler")
_WORLD = (
    *("AreaLightSource", "AttributeBegin", "AttributeEnd", "LightSource", "Material"),
    *("MakeNamedMaterial", "NamedMaterial", "ObjectBegin", "ObjectEnd", "ObjectInstance"),
    *("ReverseOrientation", "Shape", "Texture", "Import"),
)
_ENDS = {"AttributeBegin": "AttributeEnd", "ObjectBegin": "ObjectEnd"}
_ENDS["TransformBegin"] = "TransformEnd"
#: Directives that choose how pbrt computes; Daguerre's own settings take their place.
_COMPUTING = {
    "Accelerator": "pbrt's accelerator is ignored",
    "Integrator": "pbrt's integrator is left out: Daguerre follows paths",
    "SurfaceIntegrator": "pbrt's integrator is left out: Daguerre follows paths",
    "VolumeIntegrator": "pbrt's integrator is left out: Daguerre follows paths",
    "Renderer": "pbrt's renderer is left out: Daguerre follows paths",
    "Sampler": "pbrt's sampler is left out: --spp and --noise choose samples",
    "Option": "an Option of pbrt is left out",
}


class Interpreter:
    """Reads the directives of a scene.

    Args:
        files: Files of the scene.
        ledger: Counts directives.
    """

    def __init__(self, files: Files, ledger: Ledger) -> None:
        self._files, self._ledger = files, ledger
        self.description = Description()
        self._state = State()
        self._systems: dict[str, Moving] = {}
        self._blocks: list[tuple[str, FilePlace, State]] = []
        self._in_world = False
        self._object: list[Entity] | None = None
        self._handlers: dict[str, Callable[[Directive], None]] = {
            name: getattr(self, f"_on_{name}") for name in _handled(type(self))
        }

    def read(self, path: Path) -> Description:
        """Reads a scene from its first file.

        Raises:
            InputError: The text is wrong.
        """
        lexer = self._files.first(path)
        self._run(lexer)
        self._check_blocks()
        if not self._in_world:
            lexer.place().fail("the file ends without WorldBegin")
        return self.description

    def _check_blocks(self) -> None:
        if self._blocks:
            name, place, _ = self._blocks[-1]
            place.fail(f"unterminated block: wanted {_ENDS[name]}, got the end of the file")

    def _run(self, lexer: Lexer) -> None:
        for directive in directives_of(lexer):
            self._ledger.see(directive.place)
            name = directive.name
            if name in OF_V3:
                self.description.version = 3
            if name in _OPTIONS and self._in_world:
                directive.place.fail("allowed only before WorldBegin")
            if name in _WORLD and not self._in_world:
                directive.place.fail("allowed only after WorldBegin")
            if name in _COMPUTING:
                self._ledger.note(directive.place, _COMPUTING[name])
            else:
                self._handlers[name](directive)

    def _entity(self, directive: Directive, target: str = "", name: str = "") -> Entity:
        """Makes the entity of a directive, with the current state."""
        state = self._state
        inherited = state.attributes.get(target, ())
        parameters = directive.parameters.inheriting(inherited, state.color_space)
        kind = directive.strings[-1]
        textures, materials = self.description.textures.current, self.description.materials.current
        return Entity(kind, parameters, directive.place, state, textures, materials, name)

    def _set(self, place: FilePlace, **changes: object) -> None:
        self._state = replace(self._state, **changes)  # type: ignore[arg-type]
        self._ledger.use(place)

    # Blocks -------------------------------------------------------------------------------------

    def _push(self, directive: Directive) -> None:
        if len(self._blocks) >= MAX_DEPTH:
            directive.place.fail(f"too many nested blocks: the limit is {MAX_DEPTH}")
        self._blocks.append((directive.name, directive.place, self._state))
        self._ledger.use(directive.place)

    def _pop(self, directive: Directive, begin: str) -> State:
        if not self._blocks:
            directive.place.fail(f"no matching {begin}")
        name, place, state = self._blocks[-1]
        if name != begin:
            directive.place.fail(f"wanted {_ENDS[name]}, as {place} is open, got {directive.name}")
        self._blocks.pop()
        self._ledger.use(directive.place)
        return state

    def _on_WorldBegin(self, directive: Directive) -> None:
        if self._in_world:
            directive.place.fail("appears twice")
        self._in_world = True
        self._set(directive.place, transform=Moving(), active=(True, True))
        self._systems["world"] = self._state.transform

    def _on_WorldEnd(self, directive: Directive) -> None:
        self._ledger.use(directive.place)

    def _on_AttributeBegin(self, directive: Directive) -> None:
        self._push(directive)

    def _on_AttributeEnd(self, directive: Directive) -> None:
        self._state = self._pop(directive, "AttributeBegin")

    def _on_TransformBegin(self, directive: Directive) -> None:
        self._push(directive)

    def _on_TransformEnd(self, directive: Directive) -> None:
        before = self._pop(directive, "TransformBegin")
        self._state = replace(self._state, transform=before.transform, active=before.active)

    def _on_Attribute(self, directive: Directive) -> None:
        target = directive.strings[0]
        if target not in TARGETS:
            wanted = ", ".join(TARGETS)
            directive.place.fail(
                f"target: wanted {wanted}, got {target[:40]!r}{suggest(target[:40], TARGETS)}"
            )
        given = directive.parameters.inheriting((), self._state.color_space).given
        before: tuple[Parameter, ...] = self._state.attributes.get(target, ())
        names = {parameter.name for parameter in given}
        inherited = tuple(parameter for parameter in before if parameter.name not in names)
        attributes = {**self._state.attributes, target: (*given, *inherited)}
        self._set(directive.place, attributes=attributes)

    # Transforms ---------------------------------------------------------------------------------

    def _multiply(self, directive: Directive, matrix: Matrix) -> None:
        product = self._transform().times_matrix(matrix, *self._state.active)
        for transform in (product.start, product.end):
            if not (abs(transform) <= MAX_ENTRY).all():
                directive.place.fail(f"numbers of the matrix must be at most {MAX_ENTRY:g}")
        self._set(directive.place, transform=product)

    def _replace(self, directive: Directive, matrix: Matrix) -> None:
        self._set(directive.place, transform=self._transform().set_to(matrix, *self._state.active))

    def _transform(self) -> Moving:
        return self._state.transform

    def _on_Identity(self, directive: Directive) -> None:
        self._replace(directive, np.eye(4))

    def _on_Translate(self, directive: Directive) -> None:
        self._multiply(directive, translation(directive.numbers))

    def _on_Scale(self, directive: Directive) -> None:
        self._multiply(directive, scaling(directive.numbers))

    def _on_Rotate(self, directive: Directive) -> None:
        angle, axis = float(directive.numbers[0]), directive.numbers[1:]
        self._multiply(directive, rotation(angle, axis, directive.place))

    def _on_LookAt(self, directive: Directive) -> None:
        self._multiply(directive, look_at(directive.numbers, directive.place))

    def _on_Transform(self, directive: Directive) -> None:
        self._replace(directive, directive.numbers.reshape(4, 4).T.copy())

    def _on_ConcatTransform(self, directive: Directive) -> None:
        self._multiply(directive, directive.numbers.reshape(4, 4).T)

    def _on_ActiveTransform(self, directive: Directive) -> None:
        chosen = {"All": (True, True), "StartTime": (True, False), "EndTime": (False, True)}
        word = directive.strings[0]
        if word not in chosen:
            directive.place.fail(f"wanted {', '.join(chosen)}, got {word[:40]!r}")
        self._set(directive.place, active=chosen[word])

    def _on_TransformTimes(self, directive: Directive) -> None:
        start, end = directive.numbers.tolist()
        self._set(directive.place, transform=replace(self._transform(), times=(start, end)))

    def _on_CoordinateSystem(self, directive: Directive) -> None:
        self._systems[directive.strings[0]] = self._transform()
        self._ledger.use(directive.place)

    def _on_CoordSysTransform(self, directive: Directive) -> None:
        name = directive.strings[0]
        if name not in self._systems:
            sentence = "CoordSysTransform: an undefined coordinate system is left out"
            self._ledger.note(directive.place, sentence)
            return
        self._set(directive.place, transform=self._systems[name])

    # State --------------------------------------------------------------------------------------

    def _on_ColorSpace(self, directive: Directive) -> None:
        known = ("srgb", "rec2020", "dci-p3", "aces2065-1")
        name = directive.strings[0].lower()
        if name not in known:
            directive.place.fail(f"wanted {', '.join(known)}, got {name[:40]!r}")
        self._set(directive.place, color_space=name)

    def _on_ReverseOrientation(self, directive: Directive) -> None:
        self._set(directive.place, reversed=not self._state.reversed)

    def _on_MediumInterface(self, directive: Directive) -> None:
        inside, outside = directive.strings[0], directive.strings[-1]
        self._set(directive.place, inside=inside, outside=outside)

    def _on_Material(self, directive: Directive) -> None:
        self._state = replace(self._state, material=self._entity(directive, "material"))

    def _on_NamedMaterial(self, directive: Directive) -> None:
        self._set(directive.place, material=directive.strings[0])

    def _on_AreaLightSource(self, directive: Directive) -> None:
        self._state = replace(self._state, emission=self._entity(directive, "light"))

    # Entities -----------------------------------------------------------------------------------

    def _on_Camera(self, directive: Directive) -> None:
        self._systems["camera"] = self._transform().inverse(directive.place)
        self._note_replaced(self.description.camera)
        self.description.camera = self._entity(directive)

    def _on_Film(self, directive: Directive) -> None:
        self._note_replaced(self.description.film)
        self.description.film = self._entity(directive)

    def _on_PixelFilter(self, directive: Directive) -> None:
        self._note_replaced(self.description.pixel_filter)
        self.description.pixel_filter = self._entity(directive)

    def _note_replaced(self, before: Entity | None) -> None:
        if before is not None:
            name = before.place.directive
            self._ledger.note(before.place, f"a {name} before the last one is left out")

    def _on_MakeNamedMedium(self, directive: Directive) -> None:
        name = directive.strings[0]
        self.description.media.define(name, self._entity(directive, "medium", name))

    def _on_MakeNamedMaterial(self, directive: Directive) -> None:
        name = directive.strings[0]
        self.description.materials.define(name, self._entity(directive, "material", name))

    def _on_Texture(self, directive: Directive) -> None:
        name, kind, _ = directive.strings
        kind = {"color": "spectrum"}.get(kind, kind)
        if kind not in ("float", "spectrum"):
            directive.place.fail(f"type: wanted float or spectrum, got {kind[:40]!r}")
        self.description.textures.define((kind, name), self._entity(directive, "texture", name))

    def _on_LightSource(self, directive: Directive) -> None:
        self.description.lights.append(self._entity(directive, "light"))

    def _on_Shape(self, directive: Directive) -> None:
        shapes = self.description.shapes if self._object is None else self._object
        shapes.append(self._entity(directive, "shape"))

    def _on_ObjectBegin(self, directive: Directive) -> None:
        name = directive.strings[0]
        if self._object is not None:
            directive.place.fail("objects cannot be nested")
        if name in self.description.objects:
            directive.place.fail(f"the name {name[:60]!r} appears twice")
        self._push(directive)
        self._object = self.description.objects[name] = []

    def _on_ObjectEnd(self, directive: Directive) -> None:
        self._state = self._pop(directive, "ObjectBegin")
        self._object = None

    def _on_ObjectInstance(self, directive: Directive) -> None:
        if self._object is not None:
            directive.place.fail("an object cannot contain instances")
        name = directive.strings[0]
        self.description.instances.append(self._entity(directive, "", name))

    # Files --------------------------------------------------------------------------------------

    def _on_Import(self, directive: Directive) -> None:
        """Reads a file; its changes of the state end with the file."""
        state, blocks = self._state, self._blocks
        self._blocks = []
        with self._files.imported(directive.strings[0], directive.place) as lexer:
            self._run(lexer)
        self._check_blocks()
        self._state, self._blocks = state, blocks


def _handled(kind: type) -> list[str]:
    return [name.removeprefix("_on_") for name in dir(kind) if name.startswith("_on_")]
