"""Content of a scene's text, before anything is made of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from daguerre.errors import suggest

from .place import FilePlace
from .state import Entity

#: Names that may be defined anew; each time costs a copy of all names.
MAX_REDEFINED = 1000


Key = TypeVar("Key")


class Names(Generic[Key]):
    """Definitions by name.

    Readers that hold ``current`` see later definitions, but a redefined name keeps its old
    definition for them, as in pbrt-v3.

    Args:
        what: Kind of the definitions, for messages.
    """

    def __init__(self, what: str) -> None:
        self.what = what
        self.current: dict[Key, Entity] = {}
        self._left = MAX_REDEFINED

    def define(self, key: Key, entity: Entity) -> None:
        """Adds a definition.

        Raises:
            InputError: Names are defined anew too often.
        """
        if key in self.current:
            self._left -= 1
            if self._left < 0:
                entity.place.fail(f"too many redefined {self.what}: the limit is {MAX_REDEFINED}")
            self.current = dict(self.current)
        self.current[key] = entity


@dataclass(eq=False)
class Description:
    """Content of a scene's text.

    Attributes:
        version: Version of pbrt, 3 or 4.
        camera: Camera, with the state at its directive.
        film: Film.
        pixel_filter: Pixel filter.
        lights: Lights, except area lights.
        shapes: Shapes outside of objects.
        objects: Shapes of objects, by name.
        instances: Instances of objects; ``name`` is the object's name.
        media: Media by name.
    """

    version: int = 4
    camera: Entity | None = None
    film: Entity | None = None
    pixel_filter: Entity | None = None
    lights: list[Entity] = field(default_factory=list)
    shapes: list[Entity] = field(default_factory=list)
    objects: dict[str, list[Entity]] = field(default_factory=dict)
    instances: list[Entity] = field(default_factory=list)
    media: Names[str] = field(default_factory=lambda: Names("media"))
    textures: Names[tuple[str, str]] = field(default_factory=lambda: Names("textures"))
    materials: Names[str] = field(default_factory=lambda: Names("materials"))


def named(names: Mapping[str, Entity], name: str, place: FilePlace, what: str) -> Entity:
    """Returns a definition.

    Raises:
        InputError: No definition has this name.
    """
    if name not in names:
        place.fail(f"wanted a {what} that is defined, got {name[:60]!r}{suggest(name[:60], names)}")
    return names[name]
