"""Panels of the extension drawn into a stand-in for Blender's layout."""

from __future__ import annotations

from types import MethodType, SimpleNamespace
from typing import Any


class Layout:
    """Remembers what a panel draws, in order."""

    def __init__(self) -> None:
        self.drawn: list[tuple[str, Any]] = []

    def label(self, *, text: str = "", icon: str = "NONE") -> None:
        self.drawn.append(("label", text))

    def prop(self, group: Any, name: str, **more: Any) -> None:
        assert name in group.bl_rna.properties, name
        self.drawn.append(("prop", name))

    def template_icon(self, *, icon_value: int, scale: float = 1.0) -> None:
        self.drawn.append(("icon", icon_value))

    def operator(self, name: str, **more: Any) -> SimpleNamespace:
        self.drawn.append(("operator", name))
        return SimpleNamespace()

    def column(self, **more: Any) -> Layout:
        return self

    split = row = box = column

    @property
    def texts(self) -> list[str]:
        """All labels."""
        return [text for kind, text in self.drawn if kind == "label"]


def drawn(panel: Any, context: Any) -> Layout:
    """Draws a panel, whose class Blender alone can make objects of."""
    stand_in = SimpleNamespace(layout=Layout())
    for one in reversed(panel.__mro__):
        if not one.__module__.startswith("daguerre"):
            continue
        for name, value in vars(one).items():
            if callable(value) or name == "rows":
                bound = MethodType(value, stand_in) if callable(value) else value
                setattr(stand_in, name, bound)
    stand_in.group = panel.group
    stand_in.draw(context)
    return stand_in.layout
