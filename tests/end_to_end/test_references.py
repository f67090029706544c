"""Renders against pictures of an independent renderer (references/*.json, see make_references.py).

Every scene must agree, and must stop to agree when the picture is 2 % too bright or when one thing
of the scene is wrong. A failure leaves picture, reference and error map in out/test-failures/.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from tests.references import in_daguerre, scenes
from tests.support.pictures.statistical import Reference, batch_means, differences

FOLDER = Path(__file__).parents[1] / "references"
FAILURES = Path(__file__).parents[2] / "out" / "test-failures"
BATCHES = 10
SAMPLES = 64

FAULTS: dict[str, list[dict[str, Any]]] = {
    "metals": [{"lamp": 4 * 1.02}, {"alpha": 0.3}, {"reflectance": 0.75}],
    "glass": [{"ior": 1.47}, {"alpha": 0.4}, {"sky": 0.5 * 1.02}],
    "bulbs": [{"luminance": 30 * 1.02}, {"radius": 0.255}],
    "defocus": [{"focus": 3.1}, {"aperture": 570.0}],
    "environment": [{"turn": 1.0}, {"mirrored": True}, {"peak": 42.0}],
    "punctual": [{"point": 6 * 1.02}, {"outer": 31.0}, {"sun": 0.8 * 1.02}],
    "caustic": [{"lamp": 4 * 1.02}, {"radius": 0.92}, {"reflectance": 0.85}],
}


def reference(name: str) -> Reference:
    """The stored picture of a scene."""
    data = json.loads((FOLDER / f"{name}.json").read_text())
    width, height = data["size"]
    mean, variance = (
        np.array(data[key], np.float64).reshape(height, width, 1)
        for key in ("mean", "variance_of_mean")
    )
    return Reference(mean, variance, data["batches"], data["spp"])


def batches(name: str, **parameters: Any) -> NDArray[np.float64]:
    """Independent pictures of Daguerre, (BATCHES, H, W, 3)."""
    scene = scenes.ALL[name](**parameters)
    return batch_means(
        in_daguerre.build(scene),
        in_daguerre.camera(scene),
        BATCHES,
        SAMPLES,
        resolution=scene.size,
        filter="box",
        max_depth=scene.max_depth,
    )


def disagreement(pictures: NDArray[np.float64], name: str) -> list[str]:
    """Differences from the reference; empty: none."""
    return differences(pictures, reference(name), BATCHES * SAMPLES)


def leave_behind(name: str, pictures: NDArray[np.float64], wanted: Reference) -> Path:
    """Writes picture, reference and error map (standard errors); returns the folder."""
    FAILURES.mkdir(parents=True, exist_ok=True)
    mean = pictures.mean(axis=0)
    spread = np.sqrt(pictures.var(axis=0, ddof=1) / len(pictures) + wanted.variance) + 1e-9
    score = (mean - wanted.mean) / spread
    for what, image in (
        ("picture", mean),
        ("reference", np.broadcast_to(wanted.mean, mean.shape)),
        ("error", score),
    ):
        dg.Frame(np.ascontiguousarray(image, np.float32)).save(FAILURES / f"{name}-{what}.exr")
        shown = image if what != "error" else np.clip(0.2 + score / 50, 0, 1)
        dg.Frame(np.ascontiguousarray(shown, np.float32)).save(FAILURES / f"{name}-{what}.png")
    return FAILURES


def test_every_scene_has_a_reference_and_a_planted_fault() -> None:
    stored = {path.stem for path in FOLDER.glob("*.json")}
    assert stored == set(scenes.ALL) == set(FAULTS)


@pytest.mark.parametrize("name", scenes.ALL)
def test_picture_agrees_with_the_reference(name: str) -> None:
    pictures = batches(name)
    wrong = disagreement(pictures, name)
    assert not wrong, f"{wrong}; pictures in {leave_behind(name, pictures, reference(name))}"
    assert disagreement(pictures * 1.02, name), "2 % more light goes unnoticed"
    assert disagreement(pictures[:, :, ::-1], name), "a mirrored picture goes unnoticed"


@pytest.mark.parametrize(
    ("name", "fault"),
    [(name, fault) for name, faults in FAULTS.items() for fault in faults],
    ids=lambda value: value if isinstance(value, str) else "-".join(value),
)
def test_a_planted_fault_is_caught(name: str, fault: dict[str, Any]) -> None:
    assert disagreement(batches(name, **fault), name)


def test_a_failure_leaves_its_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(f"{__name__}.FAILURES", tmp_path / "left")
    pictures = np.random.default_rng(1).random((4, 32, 48, 3))
    folder = leave_behind("bulbs", pictures, reference("bulbs"))
    assert len(list(folder.glob("bulbs-*.exr"))) == len(list(folder.glob("bulbs-*.png"))) == 3
