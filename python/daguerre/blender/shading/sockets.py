"""Inputs of one Blender node as values of shading."""

from __future__ import annotations

from daguerre.shading.channels import Texel, Value, broadcast, numbers_of
from daguerre.shading.evaluate import Arguments, constant
from daguerre.shading.materialx.graph import Constant, Link


class Sockets:
    """Reads the sockets and properties of a node.

    A socket linked to an unsupported node has the value that it shows without the link. Values that
    are not finite are an ``InputError``.
    """

    def __init__(self, given: Arguments) -> None:
        self.given = given
        self.math = given.context.math

    def value(self, name: str, size: int = 3) -> Value:
        """Value of a socket with one or three channels; zeros if it has none."""
        found = self.linked(name)
        if found is None:
            kept = self.given.node.inputs.get(f"={name}", self.given.node.inputs.get(name))
            found = (0.0,)
            if isinstance(kept, Constant) and not isinstance(kept.value, str):
                found = constant(kept, self.given.context, self.given.node.place)
        return broadcast(found, size) if size > 1 else found[:1]

    def linked(self, name: str) -> Value | None:
        """Value of a link to a socket; None: there is none, or its node is not supported."""
        found = self.given.node.inputs.get(name)
        return self.given.given(name) if isinstance(found, Link) else None

    def is_linked(self, name: str) -> bool:
        """Whether something is linked to a socket."""
        return isinstance(self.given.node.inputs.get(name), Link)

    def one(self, name: str) -> Value:
        """Value of a socket with one channel."""
        return self.value(name, 1)

    def numbers(self, name: str, size: int = 3) -> tuple[float, ...]:
        """Numbers of a socket; a picture is replaced by its mean, with a note."""
        found = self.value(name, size)
        numbers = numbers_of(found)
        if numbers is not None:
            return numbers
        self.note(f"the mean of the picture in {name!r} is used")
        return tuple(_mean(channel) for channel in found)

    def number(self, name: str) -> float:
        """A constant number of a socket."""
        return self.numbers(name, 1)[0]

    def text(self, name: str, default: str = "") -> str:
        """Property of the node as a text."""
        return self.given.text(f".{name}", default)

    def flag(self, name: str) -> bool:
        """Property of the node that is on or off."""
        return bool(self.text(name))

    def setting(self, name: str, default: float) -> float:
        """Property of the node that is a number."""
        found = self.table(name)
        return found[0] if found else default

    def table(self, name: str) -> tuple[float, ...]:
        """Row of a curve or ramp; a property that is a number has one entry."""
        found = self.given.node.inputs.get(f".{name}")
        numbers = found.value if isinstance(found, Constant) else ()
        return numbers if isinstance(numbers, tuple) else ()

    def note(self, sentence: str) -> None:
        """Adds a note that begins with the name of the node's kind."""
        self.given.context.notes.add(f"{self.kind}: {sentence}")

    @property
    def kind(self) -> str:
        """Name of the node's kind without its prefix, such as "BsdfPrincipled"."""
        return self.given.node.kind.removeprefix("ShaderNode")


def _mean(channel: object) -> float:
    if isinstance(channel, Texel):
        return channel.mean()
    return channel if isinstance(channel, float) else 0.0
