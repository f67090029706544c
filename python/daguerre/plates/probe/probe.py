"""Light probes: environments from photographs, in the frame and units of ``--env``."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.files.value import BriefRecord
from daguerre.parameters.keywords import takes

from .asked import Asked
from .from_balls import grey_ball, mirror_balls
from .from_panorama import panorama
from .lost_light import sun_and_light
from .parameters import LIGHT_PROBE, ProbeKeywords
from .restore import clipped_facts, ground_illuminance
from .sun import Sun


@dataclass(frozen=True, repr=False)
class LightProbe(BriefRecord):
    """A light probe.

    Attributes:
        image: Environment, linear Rec.709, float32, shape (H, W, 3), row 0 at the zenith, middle
            column along -z, as for ``Scene.set_environment``; cd/m2 if ``absolute``.
        absolute: Whether the unit is cd/m2; else it is unknown.
        sun: Sun, which is part of ``image``; None: no sun was found.
        rest: Environment without the sun.
        facts: All results, for JSON.
        notes: Notes, one sentence each.
        warnings: Warnings about missing light.
    """

    image: NDArray[np.float32]
    absolute: bool
    sun: Sun | None
    rest: NDArray[np.float32]
    facts: dict[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def save(self, path: str | os.PathLike[str], *, with_sun: bool = True) -> None:
        """Writes the environment atomically.

        Args:
            path: Path of the file, ``.exr`` or ``.hdr``.
            with_sun: Whether to include the sun.

        Raises:
            UsageError: The path has another suffix.
            OutputError: The file cannot be written.
        """
        from .save import write_environment

        write_environment(path, self.image if with_sun else self.rest, self.facts)

    def save_sun(self, path: str | os.PathLike[str]) -> None:
        """Writes the sun as a directional light.

        Args:
            path: Path of the file, ``.glb``.

        Raises:
            InputError: No sun was found.
            UsageError: The path has another suffix.
            OutputError: The file cannot be written.
        """
        from .save import write_sun

        write_sun(path, self.sun)


@takes(LIGHT_PROBE, ProbeKeywords)
@guarded
def light_probe(
    photographs: str | Path | Sequence[str | Path], **keywords: Unpack[ProbeKeywords]
) -> LightProbe:
    """Makes an environment from photographs of a ball, or of a panorama.

    Several photographs of one view are merged by their exposures.

    Args:
        photographs: Paths of JPEG, PNG, TIFF, EXR, HDR or raw files.
        {keywords}

    Raises:
        UsageError: A parameter is wrong.
        InputError: A photograph cannot be used; the message has its path.
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
