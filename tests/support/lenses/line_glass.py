"""Lenses on the normal line: tests of geometry that need the smoothest dispersion there is."""

from __future__ import annotations

from daguerre import lenses
from daguerre.lenses.json_lens import lens_of


def on_the_line(name: str) -> lenses.Lens:
    """A lens of the library; glass that only nd and Vd describe stays on Schott's normal line."""
    return lens_of({**lenses.load(name).data, "normal_line": "for a test"}, name)
