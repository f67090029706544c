"""Content of a scene's text, before anything is made of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from daguerre.errors import suggest

from .place import FilePlace
from .state import Made

#: Names that may be defined anew; each time costs a copy of all names.
MAX_REDEFINED = 1000


Key = TypeVar("Key")


class Names(Generic[Key]):
    """Definitions by name.

    Readers that hold ``now`` see later definitions, but a redefined name keeps its old definition
    for them, as in pbrt-v3.

    Args:
        what: Kind of the definitions, for messages.
    """

    def __init__(self, what: str) -> None:
        self.what = what
        self.now: dict[Key, Made] = {}
        self._left = MAX_REDEFINED

    def define(self, key: Key, made: Made) -> None:
        """Adds a definition.

        Raises:
            InputError: Names are defined anew too often.
        """
        if key in self.now:
            self._left -= 1
            if self._left < 0:
                made.place.fail(f"too many redefined {self.what}: the limit is {MAX_REDEFINED}")
            self.now = dict(self.now)
        self.now[key] = made


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
    camera: Made | None = None
    film: Made | None = None
    pixel_filter: Made | None = None
    lights: list[Made] = field(default_factory=list)
    shapes: list[Made] = field(default_factory=list)
    objects: dict[str, list[Made]] = field(default_factory=dict)
    instances: list[Made] = field(default_factory=list)
    media: Names[str] = field(default_factory=lambda: Names("media"))
    textures: Names[tuple[str, str]] = field(default_factory=lambda: Names("textures"))
    materials: Names[str] = field(default_factory=lambda: Names("materials"))


def named(names: Mapping[str, Made], name: str, place: FilePlace, what: str) -> Made:
    """Returns a definition.

    Raises:
        InputError: No definition has this name.
    """
    if name not in names:
        place.fail(f"wanted a {what} that is defined, got {name[:60]!r}{suggest(name[:60], names)}")
    return names[name]
