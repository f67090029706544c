"""State of the graphics: the settings that shapes and lights take from earlier directives.

A state never changes: directives make new states. So opening an attribute block costs nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .parameters import Parameter, Parameters
from .place import FilePlace
from .transforms import Moving

#: Targets of ``Attribute``.
TARGETS = ("light", "material", "medium", "shape", "texture")


@dataclass(frozen=True, eq=False)
class State:
    """State at the next directive.

    Attributes:
        transform: World from local; before ``WorldBegin`` camera from world.
        active: Whether directives change the start and the end of transforms.
        reversed: Whether the sides of surfaces are exchanged.
        material: Material: a directive, or the name of a material.
        emission: Directive ``AreaLightSource``, or None.
        inside: Name of the medium inside of surfaces; empty: none.
        outside: Name of the medium outside.
        color_space: Color space of colors.
        attributes: Parameters by target of ``Attribute``.
    """

    transform: Moving = field(default_factory=Moving)
    active: tuple[bool, bool] = (True, True)
    reversed: bool = False
    material: Entity | str | None = None
    emission: Entity | None = None
    inside: str = ""
    outside: str = ""
    color_space: str = "srgb"
    attributes: Mapping[str, tuple[Parameter, ...]] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Entity:
    """Entity of the scene that a directive makes, with the state at that moment.

    Attributes:
        kind: Type of the object, such as ``trianglemesh``.
        parameters: Parameters of the directive.
        place: Place of the directive.
        state: State of the graphics.
        textures: Textures that it may name.
        materials: Materials that it may name.
        name: Name; empty: unnamed.
    """

    kind: str
    parameters: Parameters
    place: FilePlace
    state: State
    textures: Mapping[tuple[str, str], Entity] = field(default_factory=dict)
    materials: Mapping[str, Entity] = field(default_factory=dict)
    name: str = ""
