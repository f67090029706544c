"""Product data of a design from its maker: closest focus, magnification, kind of focusing."""

from __future__ import annotations

from dataclasses import dataclass

from daguerre.argument_checks import guarded
from daguerre.files.json_item import Item

from .reading import member, number, text


@guarded
@dataclass(frozen=True)
class Product:
    """How the product of a design focuses; None: not known.

    Attributes:
        closest_focus_m: Closest focus, from the sensor; of a zoom, at its long end.
        magnification: Magnification there.
        moves: Parts that move, such as ``the front group``.
        source: Where these are stated.
    """

    closest_focus_m: float | None = None
    magnification: float | None = None
    moves: str | None = None
    source: str | None = None

    def __str__(self) -> str:
        """Lists known data, such as ``closest focus 0.31 m, magnification 1x (Canon)``."""
        known = []
        if self.closest_focus_m is not None:
            known.append(f"closest focus {self.closest_focus_m:.3g} m")
        if self.magnification is not None:
            known.append(f"magnification {self.magnification:.2g}x")
        if self.moves is not None:
            known.append(f"moves {self.moves}")
        return ", ".join(known) + (f" ({self.source})" if self.source else "")


def read_product(root: Item) -> Product | None:
    """Reads the member ``product`` of a lens file; None: absent or null."""
    item = member(root, "product")
    if item is None:
        return None
    return Product(
        number(item, "closest_focus_m", above=0),
        number(item, "magnification", above=0),
        text(item, "moves"),
        text(item, "source"),
    )
