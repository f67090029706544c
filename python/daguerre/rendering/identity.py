"""Identity of a picture: hashes that its passes share, and metadata of its files."""

from __future__ import annotations

import hashlib
import json
import platform
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera.exposure import without_exposure
from daguerre.frame.seen_by import sensor_metadata
from daguerre.setup.body import scatter_facts
from daguerre.setup.metadata import camera_metadata, facts_of

from .adaptive import Round
from .light_paths import show_plan
from .light_plan import LightPlan
from .parameters import DEFAULT
from .pixels import parse_filter
from .prepare import Prepared
from .settings import RenderSettings


class Drawn(Protocol):
    """A picture that is being drawn: the part of a session that its identity needs."""

    prepared: Prepared
    light_plan: LightPlan
    settings: RenderSettings
    ranges: list[tuple[int, int]]
    round: Round | None

    @property
    def key(self) -> dict[str, str]:
        """Facts that passes must share."""

    @property
    def bad_samples(self) -> tuple[int, list[tuple[int, int, int]]]:
        """Number of dropped samples, and the first of them."""

    def sample_counts(self) -> NDArray[np.uint32]:
        """Number of samples drawn of each pixel, shape (H, W)."""


def key(session: Drawn) -> dict[str, str]:
    """Key that passes must share to be added: hashes of scene, camera, settings, build."""
    prepared = session.prepared
    return {
        "scene": prepared.built.hash,
        "camera": _hash_json(without_exposure(facts_of(prepared.setup))),
        "settings": _hash_json(_settings_facts(session)),
        "build": f"{build()} {prepared.core_scene.intersector}",
    }


def build() -> str:
    """Version, processor and SIMD target, on which the bits of a picture depend."""
    return f"{_core.__version__} {platform.machine()} {_core.simd_target()}"


def metadata(session: Drawn) -> dict[str, Any]:
    """Camera and picture facts, in the names and units of the EXR attributes."""
    prepared, plan, (bad, places) = session.prepared, session.light_plan, session.bad_samples
    settings, truth = session.settings, session.settings.truth
    out: dict[str, Any] = {
        "time": prepared.scene.time,
        **camera_metadata(prepared.camera, prepared.setup, prepared.size[0]),
        "seed": settings.sampling.seed,
        **_sample_facts(session),
        "resolution": prepared.size,
        "crop": prepared.crop,
        "overscan": str(prepared.overscan) if prepared.overscan else None,
        "filter": parse_filter(settings.sampling.filter)[0],
        "light_paths": show_plan(plan.light_paths),
        "flare": f"{plan.flare:.17g}" if plan.flare else None,
        "scatter": f"{plan.scatter:.17g}" if plan.scatter else None,
        "lens_scatter": scatter_facts(prepared.camera) if plan.scatter else None,
        "diffraction": settings.diffraction.words if settings.diffraction else None,
        "pupils": prepared.pupils,
        "bands": settings.film.bands or None,
        "mattes": prepared.mattes,
        "world_origin": list(prepared.built.origin) if any(prepared.built.origin) else None,
        "background": settings.backdrop.background,
        **sensor_metadata(prepared.sensor),
        "scene_hash": session.key["scene"],
        "bad_samples": bad,
        "bad_sample_places": [list(place) for place in places],
        "gt_time": truth.moment,
        "gt_lens": truth.gt_lens if truth.moment else None,
        "gt_rays": truth.rays if truth.moment and truth.gt_lens == "mean" else None,
        "version": _core.__version__,
        "intersector": prepared.core_scene.intersector,
    }
    return {name: value for name, value in out.items() if value is not None}


def _settings_facts(session: Drawn) -> dict[str, Any]:
    """Settings that passes must share; features that are off are omitted, so that hashes stay."""
    prepared, plan, settings = session.prepared, session.light_plan, session.settings
    light, reference = settings.light, settings.reference
    kind, radius = parse_filter(settings.sampling.filter)
    out: dict[str, Any] = {
        "resolution": list(prepared.size),
        "crop": list(prepared.crop),
        "seed": settings.sampling.seed,
        "filter": kind,
        "filter_radius": radius,
        "max_depth": light.max_depth,
        "aovs": settings.film.aovs,
        "strategy": reference.strategy,
        "dispersion": reference.dispersion,
        "light_paths": list(plan.light_paths),
        "technique": reference.technique,
    }
    if plan.flare:
        out |= {"flare": plan.flare, "flare_order": light.flare_order}
    if plan.scatter:
        out |= {"scatter": plan.scatter, "scatters": scatter_facts(prepared.camera)}
    if plan.flare or plan.scatter:
        out |= {"flare_highlights": light.flare_highlights}
    if prepared.pupils is not None:
        out["pupils"] = _hash_json(prepared.pupils)
    if prepared.sensor is not None:
        out["sensor"] = prepared.sensor.hash
    if settings.film.halves:
        out["halves"] = True
    if settings.film.cryptomatte:
        out["objects"] = True
    if settings.film.bands:
        out["bands"] = settings.film.bands
    if any(prepared.built.origin):
        out["world_origin"] = list(prepared.built.origin)
    if prepared.overscan:
        out["overscan"] = str(prepared.overscan)
    if settings.backdrop.background != DEFAULT["background"]:
        out["background"] = settings.backdrop.background
    if settings.backdrop.see_through:
        out["see_through"] = True
    return out


def _sample_facts(session: Drawn) -> dict[str, Any]:
    """Samples per pixel; for adaptive sampling their mean and bounds, and the noise reached."""
    if session.round is None:
        return {"samples": sum(b - a for a, b in session.ranges)}
    counts = session.sample_counts()
    return {
        "samples": float(counts.mean()),
        "samples_min": int(counts.min()),
        "samples_max": int(counts.max()),
        "noise": session.round.noise if session.round.complete else None,
    }


def _hash_json(value: object) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()
