"""Rules between parameters of a render: combinations that are refused."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from daguerre.camera.overscan import check_overscan
from daguerre.errors import UsageError

from .light_paths import check_highlights, check_paths
from .parameters import DEFAULT

#: Function that names a parameter in messages: by its name, or as a flag.
Named = Callable[[str], str]


def check_together(values: Mapping[str, Any], named: Named = str) -> None:
    """Checks that values can be combined.

    Args:
        values: All parameters by name.
        named: Function that names a parameter in messages.

    Raises:
        UsageError: They cannot; the message names the parameters.
    """
    flare, scatter = (check_paths(values[name], name) != 0 for name in ("flare", "scatter"))
    if values["flare_order"] != DEFAULT["flare_order"] and not flare:
        raise UsageError(f"{named('flare_order')} needs {named('flare')}")
    if not (check_highlights(values["flare_highlights"]) or flare or scatter):
        raise UsageError(
            f"{named('flare_highlights')} needs {named('flare')} or {named('scatter')}"
        )
    if values["gt_lens"] == "chief" and values["gt_rays"] is not None:
        raise UsageError(
            f"{named('gt_rays')} needs {named('gt_lens')} mean: a pixel has one chief ray"
        )
    if values["noise"] is not None and values["spp"] == 1:
        raise UsageError(f"{named('spp')}: wanted 2 .. 2^31 with {named('noise')}, got 1")
    check_overscan(values["overscan"], values["resolution"], named("overscan"))
