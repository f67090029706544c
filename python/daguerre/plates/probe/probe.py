"""Light probes: photographs in, an environment out, in the frame and units of ``--env``."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from daguerre.doors import guarded
from daguerre.parameters.keywords import takes

from .asked import Asked
from .from_balls import grey_ball, mirror_balls
from .from_panorama import panorama
from .lost_light import sun_and_light
from .parameters import LIGHT_PROBE, ProbeKeywords
from .restore import clipped_facts, ground_illuminance
from .sun import Sun


@dataclass(frozen=True)
class LightProbe:
    """Light of a place.

    Attributes:
        image: Environment, linear Rec.709, float32, shape (H, W, 3), row 0 at the zenith, middle
            column along -z, as ``Scene.set_environment`` takes it; cd/m2 if ``absolute``.
        absolute: Whether its unit is cd/m2; else it is not known.
        sun: The sun, which is in the image; None: none was found.
        rest: The image without the sun.
        facts: Everything that was found, for JSON.
        notes: Remarks, one sentence each.
        warnings: Remarks on light that is missing.
    """

    image: NDArray[np.float32]
    absolute: bool
    sun: Sun | None
    rest: NDArray[np.float32]
    facts: dict[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def save(self, path: str | os.PathLike[str], *, with_sun: bool = True) -> None:
        """Writes the environment, ``.exr`` or ``.hdr``, whole or not at all.

        Args:
            path: The file.
            with_sun: Whether the sun is in it.

        Raises:
            UsageError: Another ending.
            OutputError: It cannot be written.
        """
        from .save import write_environment

        write_environment(path, self.image if with_sun else self.rest, self.facts)

    def save_sun(self, path: str | os.PathLike[str]) -> None:
        """Writes the sun as a directional light, ``.glb``.

        Raises:
            InputError: None was found.
            UsageError: Another ending.
            OutputError: It cannot be written.
        """
        from .save import write_sun

        write_sun(path, self.sun)


@takes(LIGHT_PROBE, ProbeKeywords)
@guarded
def light_probe(
    photographs: str | Path | Sequence[str | Path], **keywords: Unpack[ProbeKeywords]
) -> LightProbe:
    """Makes an environment of photographs of a ball, or of a panorama.

    Several photographs of one view are merged by their exposures.

    Args:
        photographs: JPEG, PNG, TIFF, EXR, HDR or raw files.
        {keywords}

    Raises:
        UsageError: A wrong parameter.
        InputError: A photograph cannot be used; the message names it.
    """
    asked = Asked.of(photographs, LIGHT_PROBE.filled(keywords, "light_probe"))
    if asked.ball == "grey":
        source = grey_ball(asked)
    else:
        source = mirror_balls(asked) if asked.ball == "mirror" else panorama(asked)
    lit = sun_and_light(asked, source)
    facts = source.facts | {
        "unit": "cd/m2" if lit.absolute else "unknown",
        "resolution": [lit.image.shape[1], lit.image.shape[0]],
        "illuminance": ground_illuminance(lit.image),
        "sun": None if lit.sun is None else lit.sun.facts(),
        "clipped": clipped_facts(source.light, source.clipped) if source.clipped.any() else None,
    }
    notes = tuple(asked.notes.sentences())
    return LightProbe(lit.image, lit.absolute, lit.sun, lit.rest, facts, notes, lit.warnings)
