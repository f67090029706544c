#!/usr/bin/env python3
"""Renders the gallery and writes its page, so that each picture stands above its own command.

    .venv/bin/python docs/gallery/make.py [--data FOLDER] [--only NAME] [--page]

FOLDER holds the chess set (scenes/open_chess_set_512.glb) and the panorama
(hdri/st_peters_square_night_1k.hdr) that the repository does not ship; without it those pictures
stay as they are. --page writes the page alone.
"""

from __future__ import annotations

import argparse
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import OpenImageIO as oiio

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
NIGHT = "out/night_table.glb"
GAUSS = "--lens double-gauss-50mm-f2"
COMMON = "--res 750x500 --tone soft"


@dataclass(frozen=True)
class Picture:
    """One picture: its file, what it shows, and the arguments of `daguerre render`."""

    name: str
    title: str
    scene: str
    flags: str
    needs_data: bool = False


PICTURES = [
    Picture(
        "night_table",
        "The scene of the demo through a double Gauss at f/2.",
        NIGHT,
        f"{GAUSS} --f-stop 2 --res 900x600 --spp 256",
    ),
    Picture(
        "pinhole", "A pinhole: everything is sharp.", NIGHT, "--lens pinhole --spp 64 --denoise"
    ),
    Picture(
        "focus_far",
        "A thin lens at f/2, focal plane far away: the lights of the town, 5.6 m.",
        NIGHT,
        "--lens thin --f-stop 2 --focus 5.6 --spp 64 --denoise",
    ),
    Picture(
        "focus_medium",
        "The same, focal plane at medium distance: the garland, 2.4 m.",
        NIGHT,
        "--lens thin --f-stop 2 --focus 2.4 --spp 64 --denoise",
    ),
    Picture(
        "focus_close",
        "The same, focal plane close by: dice and bearings, 0.64 m.",
        NIGHT,
        "--lens thin --f-stop 2 --focus 0.64 --spp 64 --denoise",
    ),
    Picture(
        "aperture_small",
        "The double Gauss at f/16: a small aperture, great depth.",
        NIGHT,
        f"{GAUSS} --f-stop 16 --spp 64 --denoise",
    ),
    Picture(
        "aperture_large",
        "The double Gauss at f/2: a large aperture, a shallow plane.",
        NIGHT,
        f"{GAUSS} --f-stop 2 --focus 0.64 --spp 64 --denoise",
    ),
    Picture(
        "bokeh",
        "Bokeh close up: lamps far behind the focus draw the pupil of the glass. In the middle it "
        "is round; toward the edge of the field the rims of the lens cut it to a cat's eye.",
        NIGHT,
        f"{GAUSS} --f-stop 2 --focus 0.5 --res 1800x1200 --crop 0,750,50,550 --spp 64 --denoise",
    ),
    Picture(
        "bokeh_blades",
        "The same close-up through six straight blades at f/2.8.",
        NIGHT,
        f"{GAUSS} --f-stop 2.8 --focus 0.5 --blades 6 --blade-curvature 0 "
        "--res 1800x1200 --crop 0,750,50,550 --spp 64 --denoise",
    ),
    Picture(
        "chess",
        "Open chess set through the double Gauss at f/2, lit by a night panorama of a square.",
        "DATA/scenes/open_chess_set_512.glb",
        f"{GAUSS} --f-stop 2 --env DATA/hdri/st_peters_square_night_1k.hdr --spp 64 --denoise",
        needs_data=True,
    ),
]

EXTENSIONS = "out/extensions"
SMALL = "--res 600x400 --spp 48 --denoise"
PICTURES += [
    Picture(
        "octopus",
        "Skins, morph targets and colours 3.4 s into their round, through the double Gauss.",
        f"{EXTENSIONS}/octopus.glb",
        f"{GAUSS} --time 3.4 {SMALL}",
    ),
    Picture(
        "garden",
        "Thousands of instances: grass, poppies and a hedge whose leaves let the low sun through.",
        f"{EXTENSIONS}/garden.glb",
        SMALL,
    ),
    Picture(
        "street",
        "Signs and neon tubes of thousands of emissive triangles, through a wide angle at f/2.",
        f"{EXTENSIONS}/street.glb",
        f"--lens wide-angle-35mm-f2 {SMALL}",
    ),
    Picture(
        "glass",
        "Cut stones and a prism that disperse, coloured glass, a lantern of paper around a bulb.",
        f"{EXTENSIONS}/glass.glb",
        SMALL,
    ),
]

CREDITS = """
The night table is made by [examples/night_table.py](../../examples/night_table.py), what lies in
`out/extensions` by [examples/extensions.py](../../examples/extensions.py). The chess set is "Open
Chess Set" (c) Academy Software Foundation; Moeen and Mujtaba Sayed, SideFX, CC BY 4.0.
The panorama is "St. Peter's Square Night", Poly Haven, CC0. `DATA` stands for the folder that
holds them. Pictures are shown with `--tone soft`, which rolls highlights off; the EXR stays linear.
`--denoise` needs the extra of that name: `pip install ".[denoise]"`; the garden's mosaics need
`".[compression]"`.
"""


def arguments(picture: Picture, output: str) -> str:
    """The command as it is printed under the picture."""
    common = COMMON if "--res" not in picture.flags else "--tone soft"
    return f"daguerre render {picture.scene} {picture.flags} {common} -o {output}"


def render(picture: Picture, data: Path | None) -> None:
    """Renders one picture and keeps it as a JPEG."""
    output = ROOT / "out" / f"gallery_{picture.name}.png"
    output.parent.mkdir(exist_ok=True)
    command = shlex.split(arguments(picture, str(output)).replace("DATA", str(data)))
    program = Path(sys.executable).parent / "daguerre"
    subprocess.run([str(program), *command[1:]], check=True, cwd=ROOT)
    pixels = oiio.ImageBuf(str(output))
    pixels.specmod().erase_attribute(".*")
    pixels.specmod().attribute("Compression", "jpeg:90")
    if not pixels.write(str(HERE / f"{picture.name}.jpg")):
        raise SystemExit(pixels.geterror())


def page() -> str:
    """The gallery page."""
    parts = ["# Gallery\n\nEvery picture was rendered by this program, by the command under it.\n"]
    for picture in PICTURES:
        if (HERE / f"{picture.name}.jpg").exists():
            command = arguments(picture, f"out/{picture.name}.png")
            parts.append(
                f"![{picture.title}]({picture.name}.jpg)\n\n{picture.title}\n\n```\n{command}\n```\n"
            )
    return "\n".join(parts) + CREDITS


def main() -> None:
    """Renders what was asked for, then writes the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path)
    parser.add_argument("--only", action="append", choices=[p.name for p in PICTURES])
    parser.add_argument("--page", action="store_true")
    given = parser.parse_args()
    if not given.page:
        subprocess.run([sys.executable, "examples/night_table.py", NIGHT], check=True, cwd=ROOT)
        subprocess.run([sys.executable, "examples/extensions.py"], check=True, cwd=ROOT)
        for picture in PICTURES:
            wanted = not given.only or picture.name in given.only
            if wanted and (given.data or not picture.needs_data):
                render(picture, given.data and given.data.resolve())
    (HERE / "README.md").write_text(page())


if __name__ == "__main__":
    main()
