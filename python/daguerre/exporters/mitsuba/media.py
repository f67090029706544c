"""Media of Mitsuba: homogeneous, with Henyey-Greenstein lobes."""

from __future__ import annotations

from daguerre.exporters.outgoing.media import PlainMedium, plain_medium
from daguerre.exporters.outgoing.surfaces import ExportedMaterial
from daguerre.files.notes import Notes
from daguerre.scene.media import Medium

from .scene_xml import Element, add, add_rgb, add_value


class Media:
    """Media of a file.

    Attributes:
        used: Whether the scene has a medium, so that the integrator must sample media.
    """

    def __init__(self, fog: Medium | None, notes: Notes) -> None:
        self._notes = notes
        self._fog = plain_medium(fog, notes)
        self.used = False

    def add_fog(self, root: Element, sensor: Element) -> None:
        """Adds the fog of the world, in which the camera stands."""
        if self._fog is None:
            return
        self._add(root, self._fog, id="fog")
        add(sensor, "ref", name="medium", id="fog")

    def add_sides(self, shape: Element, look: ExportedMaterial) -> None:
        """Adds the media on both sides of a shape; glass keeps the fog out."""
        inside = plain_medium(look.inside, self._notes)
        if inside is not None:
            self._add(shape, inside, name="interior")
        outside = plain_medium(look.outside, self._notes)
        if outside is not None:
            self._add(shape, outside, name="exterior")
        elif self._fog is not None and (look.clear or inside):
            add(shape, "ref", name="exterior", id="fog")

    def _add(self, parent: Element, medium: PlainMedium, **attributes: str) -> None:
        self.used = True
        element = add(parent, "medium", type="homogeneous", **attributes)
        total = medium.extinction
        # A colour may be no more than 1, and ``scale`` multiplies it.
        most = max(total) or 1.0
        if max(medium.emission) > 0:
            self._notes.add("emission of a medium is left out")
        add_rgb(element, "sigma_t", [value / most for value in total])
        add_value(element, "float", "scale", float(most))
        pairs = zip(medium.scattering, total, strict=True)
        add_rgb(element, "albedo", [s / t if t > 0 else 0.0 for s, t in pairs])
        _add_phase(element, medium.lobes)


def _add_phase(parent: Element, lobes: tuple[tuple[float, float], ...]) -> None:
    """Adds a lobe, or a blend of the first lobe with the rest."""
    (g, weight), *rest = lobes
    if not rest:
        phase = add(parent, "phase", type="hg")
        add_value(phase, "float", "g", float(g))
        return
    blend = add(parent, "phase", type="blendphase")
    others = sum(weight for _, weight in rest)
    add_value(blend, "float", "weight", others / (weight + others))
    _add_phase(blend, ((g, weight),))
    _add_phase(blend, tuple(rest))
