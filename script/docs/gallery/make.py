#!/usr/bin/env python3
"""Renders the gallery and writes its page, so that each picture stands above its own command.

    .venv/bin/python script/docs/gallery/make.py [--data FOLDER] [--only NAME] [--page]

FOLDER holds the chess sets (scenes/open_chess_set_512.glb, OpenChessSet/chess_set.usda) and the
panorama (hdri/st_peters_square_night_1k.hdr) that the repository does not ship; without it those
pictures stay as they are. --page writes the pages alone. What is shown is in pictures.py and
words.py.
"""

from __future__ import annotations

import argparse
import shlex
import subprocess
import sys
from pathlib import Path

import calibrations
import into_plate
import numpy as np
import OpenImageIO as oiio
import photograph_page
import photographs
import thumbnails
import word_page
from numpy.typing import NDArray
from pictures import GLASS, LIGHT, MOTION, NIGHT, PICTURES, Picture
from words import WORDS

ROOT = Path(__file__).resolve().parents[3]
PAGES = ROOT / "docs" / "gallery"
SCENES = (
    ["night_table.py", NIGHT],
    ["extensions.py"],
    ["motion.py"],
    ["lens_scenes.py"],
    ["solids.py"],
    ["imperfections.py"],
    ["exposure.py"],
    ["calibrated.py"],
    ["plates.py"],
)

INTRODUCTION = """# Gallery

Each picture has the command that rendered it: copy one and change it. Run the commands in a clone
of the repository, after the program that writes the scene:

```
mkdir -p out
python scenes/night_table.py out/night_table.glb
python scenes/extensions.py
python scenes/motion.py
python scenes/lens_scenes.py
python scenes/solids.py
```

`--denoise` needs the extra `denoise`, and the garden the extra `compression`
([install](../install.md#extras)). Most pictures use `--tone soft`, which rolls off highlights.
`DATA` stands for a folder with the chess sets (as glTF, and `OpenChessSet` as USD), the panorama,
pbrt's killeroos and Modern Hall for Mitsuba 3, with our file in its folder. The repository does
not ship them.
"""

ABOUT_MOTION = """## Motion

Objects that move while the shutter is open are blurred; [Motion and shutters](../motion.md)
explains how. A sheet of several pictures has a command for each.
"""

ABOUT_GLASS = """## Real lenses

These pictures are rendered through real lenses, from their prescriptions. The [lens
library](../lens-library.md) has a photograph through each of its lenses.
"""

ABOUT_LIGHT = """## Light paths

Daguerre also traces light from the lamps; [Light paths](../light-paths.md) explains how. These
pictures are not denoised.
"""

ABOUT_WORDS = """## Imperfections

[Imperfections](imperfections.md) shows spherical aberration, coma, colour, astigmatism, distortion,
vignetting, flares, bloom, halos and stars: each traced, by polynomials, and in 2D.
"""

ABOUT_PHOTOGRAPHS = """## Photographs

[From exposure to photograph](exposure.md) shows what sensors and films make of the light: the
exposure triangle, ISO 100 beside ISO 25600, raw files developed by Daguerre and by LibRaw, film.
"""

ABOUT_CALIBRATED = """## Calibrated cameras

![A desk through a phone, a fisheye, and a stereo camera with its depth.](calibrated.jpg)

The pictures show one desk through calibration files of OpenCV, ROS and Kalibr: a phone, a
190-degree fisheye, and the left camera of a stereo pair with its depth. [Calibrated
cameras](calibrated.md) has them larger, with the commands.
"""

ABOUT_PLATES = """## Into the plate

![A desk; pawns alone; the light that they take and add; the desk with the pawns.](plates.jpg)

The pictures show a plate, objects with alpha, the catchers' layer, and the composite. [Into the
plate](plates.md) has them larger, with the commands, and the difference from a true photograph.
"""

ABOUT_BLENDER = """## A lens in Blender

![Blender's default cube before a wall of lamps, through a double Gauss at f/2.](blender_lens.jpg)

This is Blender's default scene through a double Gauss at f/2 that Daguerre exported. [Take a lens
elsewhere](../export.md) has the commands, and the same scene through Blender's own camera.
"""

ABOUT_BLENDER_ENGINE = """## Blender's scenes by F12

The left half of each picture is by the render engine Daguerre in Blender, through a real lens. The
right half is by Cycles, with Blender's own camera of the same focus and f-stop. Both have 256
samples per pixel and are denoised. [The program](../../script/docs/gallery/blender_engine.py)
builds the scenes; it needs `bpy` and `daguerre[denoise]`.
"""
#: Scenes of `blender_engine.py`: what is seen, and why.
BLENDER_SHOTS = {
    "cube": (
        "Blender's default scene before a wall of far lamps, through a lens at f/0.95.",
        "It darkens toward the corners, and its rims cut the discs to cat's eyes; those of "
        "Blender's camera are round everywhere.",
    ),
    "arm": (
        "An arm of six bones curls while a rolling shutter reads it line by line, at f/1.2.",
        "The shutter opens for 1/48 s and reads from the top in 12 ms. Cycles exposes all lines at "
        "once.",
    ),
    "nodes": (
        "Painted and worn balls, whose surfaces are trees of Blender's nodes, at f/2.",
        "Colours, roughness and bumps are pictures through ramps and mixes.",
    ),
}

CREDITS = """
## Credits

The chess set is "Open Chess Set" (c) Academy Software Foundation; Moeen and Mujtaba Sayed, SideFX,
CC BY 4.0. The panorama is "St. Peter's Square Night", Poly Haven, CC0. The killeroo is a model by
headus/Rezard, from the [scenes of pbrt](https://github.com/mmp/pbrt-v4-scenes). "Modern Hall" is by
NewSee2l035, [CC BY 3.0](https://creativecommons.org/licenses/by/3.0/), as Benedikt Bitterli
[published it](https://benedikt-bitterli.me/resources/) for Mitsuba; fog, lamps and camera are
added.
"""


def run(command: str, data: Path | None) -> None:
    """Runs one command of the page, in the root of the repository."""
    program, *rest = shlex.split(command.replace("DATA", str(data)))
    own = [sys.executable] if program == "python" else [sys.executable, "-m", "daguerre.cli"]
    subprocess.run([*own, *rest], check=True, cwd=ROOT)


def pixels_of(output: str, squeeze: float) -> list[NDArray[np.uint8]]:
    """The picture, or those of a sequence, that a command wrote."""
    files = sorted(ROOT.glob(output.replace("#", "[0-9]")))
    return [shown(oiio.ImageBuf(str(file)), squeeze) for file in files]


def shown(panel: oiio.ImageBuf, squeeze: float) -> NDArray[np.uint8]:
    """The pixels of a panel, less high by the squeeze of its lens."""
    if squeeze != 1:
        size = panel.spec().width, round(panel.spec().height / squeeze)
        panel = oiio.ImageBufAlgo.resize(panel, roi=oiio.ROI(0, size[0], 0, size[1]))
    return panel.get_pixels(oiio.UINT8)[..., :3]


def render(picture: Picture, data: Path | None) -> None:
    """Renders one picture, panel by panel, and keeps it as a JPEG."""
    (ROOT / "out" / "gallery").mkdir(parents=True, exist_ok=True)
    panels = []
    for command, output in picture.commands("out/gallery"):
        for old in ROOT.glob(output.replace("#", "[0-9]")):
            old.unlink()
        run(command, data)
        panels += pixels_of(output, picture.squeeze)
    rows = [panels[k : k + picture.columns] for k in range(0, len(panels), picture.columns)]
    sheet = np.concatenate([np.concatenate(row, axis=1) for row in rows])
    pixels = oiio.ImageBuf(np.ascontiguousarray(sheet))
    pixels.specmod().attribute("Compression", "jpeg:90")
    if not pixels.write(str(PAGES / f"{picture.name}.jpg")):
        raise SystemExit(pixels.geterror())


def section(pictures: list[Picture]) -> list[str]:
    """Pictures, titles and commands of those that have been rendered."""
    parts = []
    for picture in pictures:
        if (PAGES / f"{picture.name}.jpg").exists():
            typed = "\n".join(command for command, _ in picture.commands("out"))
            shown = f"![{thumbnails.brief(picture.title)}]({picture.name}.jpg)"
            text = f"{picture.title}{scene_link(picture.scene)}"
            anchor = f'<a id="{picture.name}"></a>'
            parts.append(f"{anchor}\n\n{shown}\n\n{text}\n\n```\n{typed}\n```\n")
    return parts


def blender_shots() -> list[str]:
    """Pictures of Blender's engine and their commands, of those that have been rendered."""
    parts = []
    for scene, (title, text) in BLENDER_SHOTS.items():
        file = f"blender_{scene}.jpg"
        if (PAGES / file).exists():
            command = f"python script/docs/gallery/blender_engine.py {scene} docs/gallery/{file}"
            shown = f'<a id="blender_{scene}"></a>\n\n![{thumbnails.brief(title)}]({file})'
            parts.append(f"{shown}\n\n{title} {text}\n\n```\n{command}\n```\n")
    return [ABOUT_BLENDER_ENGINE, *parts] if parts else []


def scene_link(scene: str | tuple[str, ...]) -> str:
    """The program that makes a scene, or the first of several, where the repository has it."""
    scene = scene if isinstance(scene, str) else scene[0]
    place = Path(scene.replace("out/", "scenes/")).with_suffix(".py")
    return f" Scene: [{place}](../../{place})." if (ROOT / place).exists() else ""


def main() -> None:
    """Renders what was asked for, then writes the page."""
    every = [*PICTURES, *GLASS, *LIGHT, *MOTION]
    sheets = [*photographs.SHEETS, *calibrations.SHEETS, *into_plate.sheets()]
    names = [picture.name for picture in [*every, *WORDS, *sheets]]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path)
    parser.add_argument("--only", action="append", choices=["calibrated", "plates", *names])
    parser.add_argument("--page", action="store_true")
    given = parser.parse_args()
    if not given.page:
        for script, *rest in SCENES:
            subprocess.run([sys.executable, f"scenes/{script}", *rest], check=True, cwd=ROOT)
        for picture in every:
            wanted = not given.only or picture.name in given.only
            if wanted and (given.data or not picture.needs_data):
                render(picture, given.data and given.data.resolve())
        for word in WORDS:
            if not given.only or word.name in given.only:
                word_page.make(word, lambda command: run(command, None))
        for sheet in sheets:
            if not given.only or sheet.name in given.only:
                photograph_page.make(sheet, lambda command: run(command, None))
                into_plate.keep_figures(sheet.name)
        if not given.only or any(name.startswith("calibrated") for name in given.only):
            photograph_page.overview("calibrated", calibrations.OVERVIEW)
        if not given.only or any(name.startswith("plates") for name in given.only):
            photograph_page.overview("plates", into_plate.OVERVIEW, 900)
    page = [INTRODUCTION, *section(PICTURES), ABOUT_GLASS, *section(GLASS), ABOUT_WORDS]
    page += [ABOUT_PHOTOGRAPHS, ABOUT_CALIBRATED, ABOUT_PLATES]
    page += [ABOUT_LIGHT, *section(LIGHT), ABOUT_BLENDER]
    page += blender_shots()
    page += [ABOUT_MOTION, *section(MOTION)]
    (PAGES / "README.md").write_text("\n".join(page) + CREDITS)
    (PAGES / "imperfections.md").write_text(word_page.page())
    word_page.RECORD.write_text(word_page.record())
    (PAGES / "exposure.md").write_text(
        photograph_page.page(photographs.INTRODUCTION, photographs.SHEETS)
    )
    (PAGES / "calibrated.md").write_text(
        photograph_page.page(calibrations.INTRODUCTION, calibrations.SHEETS)
    )
    (PAGES / "plates.md").write_text(
        photograph_page.page(into_plate.INTRODUCTION, into_plate.sheets())
    )
    (PAGES.parent / "gallery.md").write_text(thumbnails.page(PAGES))


if __name__ == "__main__":
    main()
