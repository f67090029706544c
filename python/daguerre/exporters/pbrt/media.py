"""Media of pbrt: homogeneous, with one Henyey-Greenstein lobe."""

from __future__ import annotations

from daguerre.exporters.outgoing.media import PlainMedium, plain_medium
from daguerre.exporters.outgoing.surfaces import ExportedMaterial
from daguerre.files.notes import Notes
from daguerre.scene.media import Medium

from .text import Parameter, Text, floats, rgb, string

_FOG = "fog"


class Media:
    """Media of a file."""

    def __init__(self, text: Text, fog: Medium | None, notes: Notes) -> None:
        self._text, self._notes = text, notes
        self._fog = plain_medium(fog, notes)
        self._known: dict[int, tuple[str, str]] = {}

    def add_fog(self) -> None:
        """Adds the fog of the world, in which camera, lamps and meshes stand."""
        if self._fog is not None:
            self._make(_FOG, self._fog)
            self._text.line(f'MediumInterface "" "{_FOG}"')

    def names_of(self, index: int, look: ExportedMaterial) -> tuple[str, str] | None:
        """Names of the media inside and outside of a material's meshes; None: as around it.

        Media are added before their first use.
        """
        if look.inside is None and look.outside is None:
            return None
        if index not in self._known:
            inside = self._named(look.inside, f"inside-{index}", "")
            outside = self._named(look.outside, f"outside-{index}", self._around)
            self._known[index] = inside, outside
        return self._known[index]

    @property
    def _around(self) -> str:
        return "" if self._fog is None else _FOG

    def _named(self, medium: Medium | None, name: str, otherwise: str) -> str:
        plain = plain_medium(medium, self._notes)
        if plain is None:
            return otherwise
        self._make(name, plain)
        return name

    def _make(self, name: str, medium: PlainMedium) -> None:
        g = medium.lobes[0][0]
        if len(medium.lobes) > 1:
            self._notes.add(
                "phase function of several lobes is written as one lobe with the mean g"
            )
            weights = sum(weight for _, weight in medium.lobes)
            g = sum(g * weight for g, weight in medium.lobes) / weights
        parameters: list[Parameter] = [
            string("type", "homogeneous"),
            rgb("sigma_a", medium.absorption),
            rgb("sigma_s", medium.scattering),
            floats("g", g),
        ]
        if max(medium.emission) > 0:
            self._notes.add("emission of a medium is left out")
        self._text.directive("MakeNamedMedium", name, *parameters)
