"""``daguerre lens --flare --polynomial``: ghosts as Taylor polynomials beside exact ghosts."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from daguerre.analysis.ghosts import RAYS
from daguerre.polynomial.ghosts import PolynomialGhosts

if TYPE_CHECKING:
    from daguerre.analysis.ghosts import Ghost, Ghosts
    from daguerre.plots.ghost_plot import Panels

_DRAWN = 600_000  # rays of a picture, for all ghosts together


class PolynomialReport:
    """Columns, summary and pictures of the polynomials of all ghosts."""

    head = "   error mm  of radius  centre off mm"

    def __init__(self, ghosts: Ghosts, degree: int, *, drawn: bool) -> None:
        lit = sum(ghost.light > 0 for ghost in ghosts.all)
        rays = max(RAYS, _DRAWN // max(1, lit)) if drawn else RAYS
        self.found = PolynomialGhosts(ghosts, degree, rays=rays)
        self._of = {error.ghost.surfaces: error for error in self.found.all}

    def columns(self, ghost: Ghost) -> str:
        """Errors of a ghost for its row of the list."""
        error = self._of[ghost.surfaces]
        numbers = (error.error_mm, 8), (error.error, 9), (error.shift_mm, 13)
        shown = "  ".join(f"{_number(value):>{width}}" for value, width in numbers)
        return f"   {shown}" + ("  diverges" if error.diverges else "")

    def summary(self) -> list[str]:
        """Lines that follow the list."""
        found, diverging = self.found, len(self.found.diverging)
        better = f" (degree {max(1, found.degree - 2)} is better for them)" if diverging else ""
        return [
            f"Taylor polynomials of degree {found.degree}, each about the middle of its ghost's "
            f"light, at {found.wavelength_nm:g} nm:",
            f"  median error {_number(found.median_error_mm)} mm, "
            f"{_number(found.median_error)} of the RMS radius; {diverging} of {len(found.all)} "
            f"expansions diverge{better}",
            f"  {found.rays} rays: polynomials {found.polynomial_s:.3f} CPU s after "
            f"{found.setup_s:.3f} s of set-up, exact rays {found.exact_s:.3f} s",
        ]

    def added_to(self, facts: dict[str, Any]) -> dict[str, Any]:
        """Facts of the ghosts and of their polynomials; None: the film is dark."""
        for ghost in facts["ghosts"]:
            error = self._of.get(tuple(ghost["surfaces"]))
            ghost["polynomial"] = error.facts() if error else None
        return {**facts, "polynomial": self.found.facts()}

    def panels(self) -> Panels:
        """Pictures of polynomials and exact rays, with their times."""
        found = self.found
        return [
            (f"exact rays: {found.exact_s:.2f} CPU s", found.picture(exact=True)),
            (
                f"polynomials of degree {found.degree}: {found.polynomial_s:.2f} CPU s "
                f"after {found.setup_s:.2f} s of set-up",
                found.picture(),
            ),
        ]


def _number(value: float) -> str:
    return f"{value:.2g}" if math.isfinite(value) else "-"
