"""Draws the section of a lens with the rays of one ghost."""

from __future__ import annotations

from daguerre.analysis.ghosts import Ghost, Ghosts

from .lens_section import RAY_WIDTH, Drawing, Line, section

_COLOR = "#c0392b"


def ghost_section(ghosts: Ghosts, ghost: Ghost) -> Drawing:
    """Draws the lens with the rays of a ghost instead of the image's rays."""
    bench = ghosts.bench
    plain = section(bench.lens, bench.film_z, bench.field_mm)
    shapes = [s for s in plain.shapes if not (isinstance(s, Line) and s.width == RAY_WIDTH)]
    for points in ghosts.paths(ghost):
        section_points = [(float(p[2]), float(p[1])) for p in points]
        shapes.append(Line(section_points, _COLOR, RAY_WIDTH))
    far, near = ghost.surfaces[0], ghost.surfaces[1]
    title = f"{bench.lens.name}: ghost of surfaces {far} and {near}, {ghosts.angle_deg:g} deg"
    return Drawing(title, plain.left, plain.right, plain.top, shapes)
