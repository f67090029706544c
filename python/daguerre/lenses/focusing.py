"""Says how a lens focuses, and where that differs from the product of its design."""

from __future__ import annotations

from dataclasses import dataclass

from .errors import LensError
from .focus import closest_focus_m, focused, path_of
from .lens import Lens
from .setting import LensSetting

#: Magnification below which the kind of focusing hardly matters: framings differ by less than this.
FAR = 0.02
#: Ratio up to which magnifications count as equal: makers round them.
ALIKE = 1.15
#: The nearest focus is passed by this factor, so that rounding does not refuse it.
_NEAREST = 1.0001


@dataclass(frozen=True)
class Focusing:
    """How a lens focuses at its zoom.

    Attributes:
        gaps: Surfaces after which a gap changes; empty: the whole lens moves.
        fitted: Whether the travel is fitted to the product's closest focus.
        closest_focus_m: Closest focus, from the sensor; None: unknown.
        magnification: Magnification there.
    """

    gaps: tuple[int, ...]
    fitted: bool
    closest_focus_m: float | None
    magnification: float | None

    def __str__(self) -> str:
        """Describes it in words, such as ``groups move (gaps 4, 14), to 0.38 m at 0.21x``."""
        gaps = ", ".join(map(str, self.gaps))
        moves = f"groups move (gaps {gaps})" if self.gaps else "the whole lens moves"
        if self.closest_focus_m is not None and self.magnification is not None:
            moves += f", to {_at(self.closest_focus_m, self.magnification)}"
        return moves + (", fitted to the product's closest focus" if self.fitted else "")


def focusing(lens: Lens) -> Focusing:
    """Returns how a lens focuses at its zoom."""
    path = path_of(lens)
    gaps: tuple[int, ...] = ()
    if path is not None:
        gaps = tuple(sorted({i for step in path.changes for i, mm in step.items() if mm}))
    fitted = path is not None and (path.fitted or len(path.changes) > path.printed)
    try:
        distance_m, magnification = closest(lens)
    except LensError:
        return Focusing(gaps, fitted, None, None)
    return Focusing(gaps, fitted, distance_m, magnification)


def closest(lens: Lens, least_m: float = 0.0) -> tuple[float, float]:
    """Closest focus from the sensor, m, but no nearer than ``least_m``; magnification there."""
    distance = max(_NEAREST * closest_focus_m(lens, from_sensor=True), least_m)
    found = focused(lens, LensSetting(focus_m=distance, focus_from="sensor"))
    back = found.lens.first_order().back_focal_point
    return distance, abs((back - found.film_z_mm) / found.efl_mm)


def whole_lens_note(lens: Lens, magnification: float) -> str | None:
    """Note on a lens that focuses as a whole although its product does not; None: no need.

    Args:
        lens: Lens at its zoom.
        magnification: Its magnification at the focus that is set.
    """
    product = lens.product
    if product is None or abs(magnification) < FAR or path_of(lens) is not None:
        return None
    moves = f"; the product moves {product.moves}" if product.moves else ""
    stated_m, stated = product.closest_focus_m, product.magnification
    if stated_m is None or stated is None:
        return f"{lens.name} focuses as a whole{moves}" if moves else None
    distance, ours = closest(lens, stated_m)
    if distance > stated_m:
        return (
            f"{lens.name} focuses as a whole, to {_at(distance, ours)}, "
            f"its product to {_at(stated_m, stated)}{moves}"
        )
    if max(ours, stated) <= ALIKE * min(ours, stated):
        return None
    return (
        f"{lens.name} focuses as a whole: magnification at {stated_m:.3g} m from the sensor is "
        f"{ours:.2g}x, the product's {stated:.2g}x{moves}"
    )


def _at(distance_m: float, magnification: float) -> str:
    return f"{distance_m:.3g} m from the sensor at {magnification:.2g}x"
