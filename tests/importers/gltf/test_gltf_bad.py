"""Bad glTF beyond the catalogue in ``bad_files``: allowed folders, random damage."""

from __future__ import annotations

import json

import numpy as np
import pytest

from daguerre.errors import InputError
from daguerre.importers.gltf import reader as gltf
from tests.bad_files.bases import full, moving
from tests.bad_files.uris import LEAVING, surroundings
from tests.support.formats.make_gltf import CORNERS, triangle


def test_the_undamaged_file_is_read(tmp_path):
    scene = gltf.read(full().glb(tmp_path / "a.glb"))
    assert scene.warnings == []
    assert len(scene.textures) == len(scene.cameras) == len(scene.lights) == 1


@pytest.mark.parametrize("keep", np.linspace(0, 0.999, 25))
def test_truncated_anywhere(tmp_path, keep):
    path = full().glb(tmp_path / "a.glb")
    path.write_bytes(path.read_bytes()[: int(keep * path.stat().st_size)])
    wanted = "header" if keep else "empty file"
    with pytest.raises(InputError, match=rf"a\.glb: {wanted}"):
        gltf.read(path)


@pytest.mark.parametrize("make", [full, moving])
def test_random_damage_never_escapes(tmp_path, make):
    """Whatever the bytes: a scene or an InputError, nothing else."""
    good = make().glb(tmp_path / "a.glb").read_bytes()
    rng = np.random.default_rng(7)
    outcomes = {True: 0, False: 0}
    for _ in range(800):
        data = bytearray(good)
        for place in rng.integers(12, len(data), rng.integers(1, 5)):
            data[place] = rng.integers(256)
        (tmp_path / "b.glb").write_bytes(data)
        try:
            gltf.read(tmp_path / "b.glb")
            outcomes[True] += 1
        except InputError:
            outcomes[False] += 1
    assert min(outcomes.values()) > 8


@pytest.mark.parametrize("uri", [uri for uri in LEAVING if "secret" in uri and "server" not in uri])
def test_allowed_folders_widen_and_others_do_not(tmp_path, uri):
    b = triangle()
    scene = surroundings(tmp_path, "secret.bin", bytes(b.binary))
    path = b.gltf(scene / "a.gltf")
    document = json.loads(path.read_text())
    document["buffers"][0]["uri"] = uri.format(up=tmp_path)
    path.write_text(json.dumps(document))
    with pytest.raises(InputError, match="leaves the scene's folder"):
        gltf.read(path, allow_dirs=[tmp_path / "elsewhere"])
    if uri.startswith(("../..", "..;", "..%2f..", "/proc")):
        return  # the way out leads elsewhere
    assert len(gltf.read(path, allow_dirs=[tmp_path]).meshes) == 1


def test_a_mesh_of_many_views_of_the_same_bytes(tmp_path):
    """Equal primitives share one mesh, so a small file cannot ask for gigabytes."""
    b = triangle()
    b.json["meshes"][0]["primitives"] *= 3000
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert len(scene.meshes) == 1
    assert len(scene.instances) == 3000
    assert scene.meshes[0].positions.tolist() == CORNERS
