"""One photograph of the arcade through each lens, wide open: small, and kept while it is true."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from PIL import ExifTags, Image
from place import Place

import daguerre as dg
from daguerre.rendering.denoise import denoise

#: Samples per pixel, and deepest path; raise the number when pictures should be made anew.
SPP, DEPTH, EDITION = 16, 4, 2
QUALITY = 85


def take(at: Place, scene: dg.Scene, scene_key: str, path: Path) -> bool:
    """Takes the photograph unless it is there already; whether it was taken."""
    key = _key(at, scene_key)
    if path.exists() and Image.open(path).getexif().get(ExifTags.Base.ImageDescription) == key:
        return False
    transform = np.eye(4)
    transform[2, 3] = at.distance_m
    camera = dg.Camera(
        transform=transform,
        lens=at.lens,
        sensor_size=at.film_mm,
        f_stop=at.f_stop,
        focus_distance=at.distance_m,
    )
    frame = dg.render(scene, camera, spp=SPP, resolution=at.resolution, max_depth=DEPTH, aovs=True)
    if find_spec("mitsuba_oidn"):
        frame = denoise(frame)
    path.parent.mkdir(parents=True, exist_ok=True)
    image = oiio.ImageBuf(np.ascontiguousarray(frame.display("soft")[..., :3]))
    if at.size != at.resolution:
        image = oiio.ImageBufAlgo.resize(image, roi=oiio.ROI(0, at.size[0], 0, at.size[1]))
    about = Image.Exif()
    about[ExifTags.Base.ImageDescription] = key
    shown = Image.fromarray(image.get_pixels(oiio.UINT8))
    shown.save(path, quality=QUALITY, method=6, exif=about)
    return True


def scene_key(path: Path) -> str:
    """Hash of a scene file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _key(at: Place, scene: str) -> str:
    """Hash of all that the picture depends on, but for the program."""
    facts = [at.f_stop, at.film_mm, at.distance_m, at.resolution, at.size, at.focal_length_mm]
    facts += [at.lens.data, scene, SPP, DEPTH, EDITION, dataclasses.asdict(at.lens.nominal)]
    return hashlib.sha256(json.dumps(facts, sort_keys=True).encode()).hexdigest()[:32]
