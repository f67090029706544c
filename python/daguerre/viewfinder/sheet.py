"""A picture as it goes to pages, and answers about its points."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

from .drawn import Drawn
from .glass import glass_at
from .image import Image, value_at
from .messages import Probe
from .show import Show
from .sight import distance_at


@dataclass(frozen=True)
class Sheet:
    """A picture as it goes to pages: its number, and its head and pixels as bytes."""

    number: int
    drawn: Drawn
    bytes: bytes

    @classmethod
    def of(cls, number: int, drawn: Drawn, image: Image, show: Show, *, denoised: bool) -> Sheet:
        """Packs a picture: the length of its head, the head as JSON, the pixels."""
        head = {
            "picture": number,
            "turn": drawn.request.number,
            "size": image.size,
            "kind": image.kind,
            "samples": drawn.samples,
            "rests": drawn.rests,
            "whole": drawn.whole,
            "denoised": denoised,
            "previews": show.denoised is None,
            "panels": [panel.name for panel in drawn.panels],
            "main": drawn.main,
            "part": image.part,
            "divided": bool(drawn.panels) and drawn.request.beside is not None,
            "histogram": image.histogram,
            "tint": image.tint,
        }
        text = json.dumps(head).encode()
        return cls(number, drawn, len(text).to_bytes(4, "little") + text + image.bytes)

    def value(self, probe: Probe) -> dict[str, Any] | None:
        """Values under the pointer; None: no pixel is there."""
        if probe.part >= max(1, len(self.drawn.panels)):
            return None
        x, y, drawn = probe.x, probe.y, self.drawn
        shown = drawn.panels[probe.part] if drawn.panels else drawn
        width, height = drawn.request.shot.settings.film.resolution
        own, (left, top, *_) = shown.session.prepared.setup.resolution, shown.session.crop
        found = value_at(shown.frame, x * own[0] // width - left, y * own[1] // height - top)
        distance = distance_at(
            shown.session, (x + 0.5) * own[0] / width, (y + 0.5) * own[1] / height
        )
        return found and {
            **found,
            "picture": self.number,
            "samples": drawn.samples,
            "distance_m": distance if math.isfinite(distance) else None,
        }

    def section(self, x: float, y: float) -> dict[str, Any]:
        """Glass with the rays of a point of the picture, as a drawing."""
        width, height = self.drawn.request.shot.settings.film.resolution
        own = self.drawn.session.prepared.setup.resolution
        found = glass_at(self.drawn.session, x * own[0] / width, y * own[1] / height)
        return found | {"x": x, "y": y}
