"""Doubles of files and arrays far from 0 keep their precision."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.exporters.outgoing.placing import placements
from daguerre.files.notes import Notes
from daguerre.scene.far import recentered
from daguerre.scene.framing import bounds
from tests.support.scene.scenes import at

AWAY = np.array((500000.25, 40.0, -5400000.75))
#: Half the distance of floats 512 m from the origin of a mesh, m.
NEAR = 3.1e-5
SQUARE = np.array([(0, 0, 0), (1, 0, 0), (1, 0.001, 1), (0, 0, 1)], float)


def obj(path: Path) -> None:
    rows = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in SQUARE + AWAY]
    path.write_text("\n".join([*rows, "f 1 2 3 4", ""]))


def ply(path: Path) -> None:
    rows = [f"{x:.17g} {y:.17g} {z:.17g}" for x, y, z in SQUARE + AWAY]
    head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
    faces = (
        "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    path.write_text(head + faces + "\n".join([*rows, "4 0 1 2 3", ""]))


def pbrt(path: Path) -> None:
    numbers = " ".join(f"{x:.17g}" for x in (SQUARE + AWAY).reshape(-1))
    path.write_text(
        'Camera "perspective"\nWorldBegin\nShape "trianglemesh" '
        f'"point3 P" [{numbers}] "integer indices" [0 1 2 0 2 3]\n'
    )


def mitsuba(path: Path) -> None:
    obj(path.with_suffix(".obj"))
    path.write_text(
        '<scene version="3.0.0"><shape type="obj">'
        f'<string name="filename" value="{path.stem}.obj"/></shape></scene>'
    )


def scene_of(path: Path) -> dg.Scene:
    if path.suffix in (".obj", ".ply"):
        shape = f'<shape type="{path.suffix[1:]}"><string name="filename" value="{path.name}"/>'
        path = path.with_suffix(".xml")
        path.write_text(f'<scene version="3.0.0">{shape}</shape></scene>')
    return dg.load(path)


@pytest.mark.parametrize("write", [obj, ply, pbrt, mitsuba])
def test_vertices_of_files(write: object, tmp_path: Path) -> None:
    names = {obj: "a.obj", ply: "a.ply", pbrt: "a.pbrt", mitsuba: "a.xml"}
    path = tmp_path / names[write]  # type: ignore[index]
    write(path)  # type: ignore[operator]
    scene = scene_of(path)
    instance = scene.instances[0]
    world = scene.meshes[instance.mesh].points @ instance.transform[:3, :3].T
    world = world + instance.transform[:3, 3]
    # pbrt's axes are mirrored.
    found, wanted = (np.sort(np.abs(rows), axis=0) for rows in (world, SQUARE + AWAY))
    assert np.abs(found - wanted).max() < NEAR
    assert scene.meshes[instance.mesh].positions.dtype == np.float32


def test_curves_of_arrays() -> None:
    scene = dg.Scene()
    points = np.linspace((0, 0, 0), (0.01, 0.02, 0.03), 4) + AWAY
    mesh = scene.meshes[scene.add_curves(points, [4], 0.001, basis="bezier")]
    assert np.abs(mesh.points - points).max() < NEAR


def test_bounds_are_in_the_world() -> None:
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh(SQUARE + AWAY, [(0, 1, 2)]))
    found = bounds(scene)
    assert found is not None
    assert np.abs(found[0] - AWAY).max() < NEAR


def test_scenes_for_other_programs_have_them_in_their_place(tmp_path: Path) -> None:
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh(SQUARE + AWAY, [(0, 1, 2)]), dg.Diffuse(), at(5.0, 0, 0))
    (placed,) = placements(scene, Notes())
    matrix = placed.transforms[0]
    points = scene.meshes[placed.mesh].positions @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.abs(points - SQUARE - AWAY - (5.0, 0, 0)).max() < NEAR


@pytest.mark.parametrize(
    "rows",
    [
        SQUARE,  # near
        SQUARE * 1e6,  # as large as far
        (SQUARE - 0.5) * 1e6 + (0, 5e5, 0),  # around 0
        np.asarray(SQUARE + AWAY, np.float32),  # rounded already
        np.full((4, 3), np.inf),
        np.zeros((0, 3)),
    ],
)
def test_what_stays(rows: np.ndarray) -> None:
    positions, origin = recentered(rows)
    assert positions is rows
    assert origin == (0.0, 0.0, 0.0)
