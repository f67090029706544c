"""Figures of ``bench/rooms.py``: errors of pictures, rows, ratios, and whether two scenes agree."""

from __future__ import annotations

from typing import Any

import numpy as np

OWN = "daguerre"
SAMPLERS = ("independent", "multijitter")
LUMINANCE = np.array((0.2126, 0.7152, 0.0722))
BLOCKS = 8  # across and down
SAME_MEAN, SAME_BLOCK, SAME_SHARE = 0.03, 0.05, 0.9
SIGMAS = 4.0
Picture = np.ndarray
Facts = dict[str, Any]


def errors(picture: Picture, true: Picture, noise: float) -> dict[str, float]:
    """Errors of one picture.

    Args:
        picture: Shape (H, W, 3).
        true: The converged picture.
        noise: Its error over that of the picture, as its samples say.
    """
    least = 0.01 * true.mean() ** 2
    each = ((picture - true) ** 2 / (true**2 + least)).mean(axis=2)
    ranked = np.sort(each.ravel()) / (1 + noise)
    return {
        "mean": float(ranked.mean()),
        "typical": float(ranked[: len(ranked) * 99 // 100].mean()),
        "median": float(np.median(ranked)),
    }


def row(pictures: list[Picture], said: list[Facts], true: Picture, spp: int, noise: float) -> Facts:
    """One renderer's row: medians over the seeds."""
    each = [errors(picture, true, noise) for picture in pictures]
    cpu = float(np.median([one["cpu_s"] for one in said]))
    error = {name: float(np.median([one[name] for one in each])) for name in each[0]}
    samples = true.shape[0] * true.shape[1] * spp
    made: Facts = {
        "renderer": said[0]["renderer"],
        "seeds": len(pictures),
        "cpu_s": round(cpu, 3),
        "us_per_sample": round(cpu / samples * 1e6, 3),
        "error": _short(error),
        "error_of_one_sample": _short({name: value * spp for name, value in error.items()}),
        "score": _short({name: cpu * value for name, value in error.items()}),
        "mean": [round(float(v), 5) for v in np.mean(pictures, axis=(0, 1, 2))],
    }
    for name in ("scene_cpu_s", "setup_cpu_s"):
        if name in said[0]:
            made[name] = float(np.median([one[name] for one in said]))
    if "rays" in said[0]:
        made["rays_per_sample"] = round(np.median([one["rays"] for one in said]) / samples, 3)
        made["seeds_with_light_paths"] = sum(one["light_paths"][0] > 0 for one in said)
    return made


def _short(values: dict[str, float]) -> dict[str, float]:
    return {name: float(f"{value:.5g}") for name, value in values.items()}


def ratios(rows: dict[str, Facts]) -> Facts:
    """Daguerre's scores over the lower one of Mitsuba's samplers, and which one that is."""
    made: Facts = {}
    for kind, own in rows[OWN]["score"].items():
        theirs = {name: rows[f"mitsuba_{name}"]["score"][kind] for name in SAMPLERS}
        best = min(theirs, key=lambda name: theirs[name])
        made[kind] = {"ratio": round(own / theirs[best], 3), "better": best}
    return made


def blocks(picture: Picture) -> np.ndarray:
    """Luminances of parts of a picture."""
    rows = np.array_split(picture @ LUMINANCE, BLOCKS, axis=0)
    return np.array([[cell.mean() for cell in np.array_split(r, BLOCKS, axis=1)] for r in rows])


def differences(own: list[Picture], theirs: list[Picture]) -> Facts:
    """How far the pictures of two renderers are apart, beside their noise.

    Args:
        own: Daguerre's pictures, of the same number of samples.
        theirs: Mitsuba's.
    """
    a, b = (np.array([blocks(picture) for picture in many]) for many in (own, theirs))
    noise = np.sqrt(a.var(axis=0, ddof=1) / len(a) + b.var(axis=0, ddof=1) / len(b))
    first, second = a.mean(axis=0), b.mean(axis=0)
    apart = np.abs(second - first)
    allowed = SAME_BLOCK * np.maximum(first, 0.1 * first.mean()) + SIGMAS * noise
    means_noise = float(np.sqrt((noise**2).mean() / noise.size))
    within = SAME_MEAN * first.mean() + SIGMAS * means_noise
    return {
        "mean_ratio": round(float(second.mean() / first.mean()), 4),
        "blocks_within": round(float((apart <= allowed).mean()), 3),
        "median_block": round(float(np.median(apart / np.maximum(first, 1e-9))), 4),
        "same": bool(
            abs(second.mean() - first.mean()) <= within and (apart <= allowed).mean() >= SAME_SHARE
        ),
    }
