"""Reads media: fog, smoke and cloudy liquids.

Source: pbrt-v4's user's guide ("Participating media").
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import asked_by
from daguerre.importers.volumes.density import of_nanovdb
from daguerre.scene.media import DensityGrid, Medium

from .files import Files
from .ledger import Ledger
from .parameters import Parameters
from .spectra import Color, Spectra, scaled
from .state import Entity
from .subsurface import MEASURED
from .transforms import inverse, unit_of

_ONE: Color = (1.0, 1.0, 1.0)
_MILK = MEASURED["Wholemilk"]
_MOST_CELLS = 1 << 29
#: Largest mean cosine of a lobe here.
_MOST_G = 0.999
#: Parameters of flames in a medium of NanoVDB.
_FLAMES = ("temperaturename", "temperatureoffset", "temperaturecutoff", "temperaturescale")


class Media:
    """Reads media by name, each once.

    Args:
        entity: Definitions of media.
        spectra: Spectra of the scene.
        version: Version of pbrt, 3 or 4.
        axes: Scene from world of pbrt, shape (4, 4).
        files: Files of the scene.
        ledger: Counts directives.
    """

    def __init__(
        self,
        entity: Mapping[str, Entity],
        spectra: Spectra,
        version: int,
        axes: NDArray[np.float64],
        files: Files,
        ledger: Ledger,
    ) -> None:
        self._entities, self._spectra, self._version = entity, spectra, version
        self._axes, self._unit, self._files = axes, unit_of(axes), files
        self._ledger = ledger
        self._media: dict[str, Medium | None] = {}
        self._local: dict[tuple[str, bytes], Medium] = {}
        self._bounded: set[str] = set()

    def named(self, name: str) -> Medium | None:
        """Medium of a name; None: the name is empty or not defined, or it is not supported."""
        if not name:
            return None
        if name not in self._media:
            self._media[name] = self._read(name)
        return self._media[name]

    def inside(self, name: str, shape: Entity) -> Medium | None:
        """Medium of a name as the inside of a shape: a grid is then in the shape's space.

        Args:
            name: Name of the medium.
            shape: Directive of the shape.
        """
        self._bounded.add(name)
        medium, world = self.named(name), shape.state.transform.start
        if medium is None or medium.density is None:
            return medium
        key = (name, world.tobytes())
        if key not in self._local:
            local = inverse(self._axes @ world, shape.place) @ medium.density.transform
            local[3] = (0, 0, 0, 1)
            self._local[key] = replace(medium, density=DensityGrid(medium.density.values, local))
        return self._local[key]

    def around(self, name: str) -> Medium | None:
        """Medium around a camera that fills the world; None: no medium, or shapes bound it.

        A medium inside of a shape ends at the shape; where the camera is says which it sees.
        """
        return None if name in self._bounded else self.named(name)

    def _read(self, name: str) -> Medium | None:
        entity = self._entities.get(name)
        if entity is None:
            self._ledger.notes.add(f"the medium {name[:40]!r} is not defined and left out")
            return None
        kind = entity.parameters.text("type")
        if not kind:
            entity.place.fail("type: missing, wanted a kind of medium")
        if kind not in _KINDS:
            self._ledger.note(entity.place, f"a medium of kind {kind[:40]!r} is left out")
            return None
        medium = _KINDS[kind](self, entity)
        if medium is None:
            sentence = "a medium whose file is missing is left out"
            self._ledger.note(entity.place, sentence, entity.parameters.text("filename"))
            return None
        self._ledger.use(entity.place)
        self._ledger.tell_unread(entity.parameters, entity.place, kind)
        return medium

    def _homogeneous(self, entity: Entity) -> Medium:
        absorbed, scattered = self._coefficients(entity, (_MILK[1], _MILK[0]))
        return self._medium(entity, absorbed, scattered, None)

    def _coefficients(self, entity: Entity, usual: tuple[Color, Color]) -> tuple[Color, Color]:
        preset = entity.parameters.text("preset")
        if preset and preset not in MEASURED:
            self._ledger.notes.add(f"the liquid {preset[:40]!r} is unknown")
        absorbed, scattered = usual
        if preset in MEASURED:
            scattered, absorbed = MEASURED[preset]
        found = [entity.parameters.find(name) for name in ("sigma_a", "sigma_s")]
        if preset not in MEASURED:
            absorbed = absorbed if found[0] is None else self._spectra.coefficient(found[0])
            scattered = scattered if found[1] is None else self._spectra.coefficient(found[1])
        factor = entity.parameters.number("scale", 1.0, 0.0) / self._unit
        return scaled(absorbed, factor), scaled(scattered, factor)

    def _medium(
        self, entity: Entity, absorbed: Color, scattered: Color, density: DensityGrid | None
    ) -> Medium:
        parameters = entity.parameters
        g = parameters.number("g", 0.0, -1.0, 1.0)
        light = parameters.find("Le")
        glow: Color = (0.0, 0.0, 0.0)
        strength = parameters.number("Lescale", 1.0, 0.0) if _is_number(parameters) else 1.0
        if light is not None and strength > 0:
            color = scaled(self._spectra.light(light), strength)
            pairs = zip(color, absorbed, strict=True)
            red, green, blue = (value * loss for value, loss in pairs)
            glow = (red, green, blue)
        lobes = ((float(np.clip(g, -_MOST_G, _MOST_G)), 1.0),)
        return Medium(absorbed, scattered, lobes, glow, density)

    def _grid(self, entity: Entity) -> Medium:
        parameters = entity.parameters
        size = [parameters.integer(name, 1, 1, 1 << 20) for name in ("nx", "ny", "nz")]
        count = size[0] * size[1] * size[2]
        if count > _MOST_CELLS:
            entity.place.fail(f"nx, ny, nz: wanted at most {_MOST_CELLS} cells, got {count}")
        values = parameters.numbers("density", count)
        if values is None:
            entity.place.fail("density: missing")
        if (values < 0).any():
            entity.place.fail(f"density: wanted at least 0, got {values.min():g}")
        if parameters.find("temperature") is not None:
            self._ledger.notes.add("the temperature of a medium is left out")
        low, high = parameters.point("p0", (0, 0, 0)), parameters.point("p1", (1, 1, 1))
        box = np.diag([*(high - low), 1.0])
        box[:3, 3] = low
        transform = self._axes @ entity.state.transform.start @ box
        cells = values.astype(np.float32).reshape(size[2], size[1], size[0])
        return self._dense(entity, DensityGrid(cells, transform))

    def _nanovdb(self, entity: Entity) -> Medium | None:
        """Medium of a file's grid; None: the file is missing."""
        parameters = entity.parameters
        name = parameters.text("filename")
        if not name:
            entity.place.fail("filename: missing, wanted a .nvdb file")
        path = self._files.find(name, entity.place, "filename")
        if path is None:
            return None
        if any(parameters.find(key) is not None for key in _FLAMES):
            self._ledger.notes.add("the temperature of a medium is left out")
        with asked_by(entity.place):
            found = of_nanovdb(path, parameters.text("gridname") or "density")
        transform = self._axes @ entity.state.transform.start @ found.transform
        return self._dense(entity, DensityGrid(found.values, transform))

    def _dense(self, entity: Entity, density: DensityGrid) -> Medium:
        usual = (_ONE, _ONE) if self._version == 4 else (_MILK[1], _MILK[0])
        absorbed, scattered = self._coefficients(entity, usual)
        return self._medium(entity, absorbed, scattered, density)


def _is_number(parameters: Parameters) -> bool:
    found = parameters.find("Lescale")
    return found is None or len(found.values) == 1


_KINDS: dict[str, Callable[[Media, Entity], Medium | None]] = {
    "homogeneous": Media._homogeneous,
    "uniformgrid": Media._grid,
    "heterogeneous": Media._grid,
    "nanovdb": Media._nanovdb,
}
