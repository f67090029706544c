"""Rule that gives a glass its dispersion; ``glass_rules`` has their order."""

from __future__ import annotations

from dataclasses import dataclass

from daguerre.argument_checks import guarded

_SHOWN = {
    "formula": "formula in the file",
    "theta_gF": "nd, Vd and theta_gF",
    "line": "normal line",
    "constant": "no dispersion",
}


@guarded
@dataclass(frozen=True)
class DispersionRule:
    """Rule that gives a glass its dispersion.

    Attributes:
        rule: ``formula``, ``theta_gF``, ``catalogue`` (a name alone), ``name``, ``numbers``,
            ``line`` or ``constant``.
        glass: Glass of a catalogue, such as ``N-BK7``; empty: none.
        maker: Maker of that glass.
        note: Remark for users; empty: none.
    """

    rule: str
    glass: str = ""
    maker: str = ""
    note: str = ""

    def __str__(self) -> str:
        if not self.glass:
            return _SHOWN[self.rule]
        shown = f"{self.glass} ({self.maker})"
        return f"{shown} by nd and Vd" if self.rule == "numbers" else shown
