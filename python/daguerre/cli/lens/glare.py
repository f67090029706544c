"""``daguerre lens --veiling-glare``: light on a black patch in a white world."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.cli import console

if TYPE_CHECKING:
    from daguerre.analysis import Bench


def show_glare(bench: Bench, *, json: bool) -> int:
    """Prints the veiling glare index and its parts."""
    from daguerre.analysis.glare import VeilingGlare

    glare = VeilingGlare(bench)
    if json:
        from json import dumps

        facts = {"name": bench.lens.name, "f_stop": bench.f_stop, "veiling_glare": glare.facts()}
        console.show(dumps(facts, indent=2))
        return 0
    console.show(
        f"{bench.lens.name}, f/{bench.f_stop:.3g}: a black patch of {glare.patch_mm:.3g} mm on the "
        "film, in the middle of a white world"
    )
    console.show(f"veiling glare index  {glare.index:.3g} %")
    for name, value, error in (
        ("ghosts", glare.ghosts, glare.ghosts_error),
        ("scatter", glare.scatter, glare.scatter_error),
    ):
        console.show(
            f"  {name:<17}  {100 * value:.3g} +- {100 * error:.1g} % of the picture's light"
        )
    return 0
