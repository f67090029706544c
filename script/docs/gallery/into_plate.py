"""Pictures of the page of plates: pawns that never stood on the desk, put into its photograph."""

from __future__ import annotations

import json

from photograph_page import PAGES, ROOT
from photographs import OUT, Photograph, Sheet

INTRODUCTION = """# Into the plate

Four pawns, of glass, of steel and painted, in a photograph of a desk on which there are none; and
the photograph that there would be if they had stood there
([scenes/plates.py](../../scenes/plates.py)). [Plates](../plates.md) says what each step does. Begin
with

```
python scenes/plates.py
mkdir -p out
```

The plate is a simulated shot: dusk in the window, ISO 6400, through a lens of the library, written
as a raw file. From then on nothing knows how it was made: the camera is found from the file.
`--denoise` is the extra of that name; a pixel of these pictures is a photosite, as in a crop of the
body's at 100 %.
"""
#: The sheet whose making measures, and figures of the difference, by region.
MEASURED = "plates_difference"
FIGURES = PAGES / "plates.json"
CAMERA = (
    "--lens nikon-ai-s-50mm-f1.8 --f-stop 2.8 --focus 0.76 --shutter 1/125 "
    "--sensor sony-a7r-ii --iso 6400 --res 750x500"
)
LAYERS = "python script/docs/gallery/plate_layers.py"
LAYER_TIMES = 3


def sheets() -> tuple[Sheet, ...]:
    """Plate, objects, catchers, composite, truth and difference."""
    return (_plate(), _objects(), _catchers(), _composite(), _truth(), _difference())


def _plate() -> Sheet:
    shot = (
        f"daguerre render out/plates/empty.glb {CAMERA} --spp 32 --denoise "
        f"-o {OUT}/plate.dng -o {OUT}/plate.png",
        f"daguerre match-plate {OUT}/plate.dng -o {OUT}/camera.json",
    )
    text = (
        "The photograph, and its camera: lens, stop, time and ISO by EXIF, gain and noise of the "
        "sensor by what is flat in it."
    )
    panel = Photograph("what was filmed", shot, "plate.png")
    return Sheet("plates_plate", "The plate", text, 1, (panel,))


def _objects() -> Sheet:
    commands = (
        f"daguerre render out/plates/shot.glb --like-plate {OUT}/camera.json --catcher set "
        f"--plate {OUT}/plate.dng --background transparent --aov object_id --spp 56 --denoise "
        f"-o {OUT}/object.exr",
        f"{LAYERS} objects {OUT}/object.exr {OUT}/objects.png",
    )
    text = (
        "Objects with true alpha: depth of field ends softly, the mug hides a part of the pawn "
        "behind it. Glass and steel show the photograph, which `--plate` throws onto the set. "
        "Glass covers what it refracts, so nothing of the squares is seen through it."
    )
    panel = Photograph("objects alone, over squares", commands, "objects.png")
    return Sheet("plates_objects", "The objects, with alpha", text, 1, (panel,))


def _catchers() -> Sheet:
    command = f"{LAYERS} catcher {OUT}/object.exr {OUT}/catcher.png {LAYER_TIMES}"
    text = (
        "The layer `catcher` of the same file around middle grey: light that the objects take from "
        "the set is dark, light that they add is bright, here in shares of white and "
        f"{LAYER_TIMES} times what they are. Soft shadows of window and lamp run both ways, red "
        "bleeds onto the page, glass gathers light beside its foot, the mug and the brass of the "
        "old camera mirror the pawns."
    )
    panel = Photograph(
        f"what catchers caught, x {LAYER_TIMES}, around middle grey", (command,), "catcher.png"
    )
    return Sheet("plates_catcher", "What the set catches", text, 1, (panel,))


def _composite() -> Sheet:
    command = (
        f"daguerre composite {OUT}/plate.dng {OUT}/object.exr --like-plate {OUT}/camera.json "
        f"-o {OUT}/shot.dng -o {OUT}/shot.png"
    )
    text = (
        "All of it in the plate's electrons, before its mosaic is undone; the raw file is "
        "developed afterwards as any other."
    )
    panel = Photograph("composite", (command,), "shot.png")
    return Sheet("plates_shot", "The composite", text, 1, (panel,))


def _truth() -> Sheet:
    command = (
        f"daguerre render out/plates/shot.glb {CAMERA} --seed 2 --spp 40 --denoise "
        f"-o {OUT}/truth.dng -o {OUT}/truth.png"
    )
    text = "A shot of the desk with the pawns on it, at another moment: its noise is its own."
    panel = Photograph("the whole scene, photographed", (command,), "truth.png")
    return Sheet("plates_truth", "The truth", text, 1, (panel,))


def _difference() -> Sheet:
    command = (
        f"python script/docs/gallery/plate_difference.py {OUT}/shot.dng {OUT}/truth.dng "
        f"{OUT}/object.exr out/plates/shot.glb {OUT}/camera.json sony-a7r-ii {OUT}/difference.png"
    )
    caption = "composite less truth: pixels x 2, and means of 8 x 8 pixels x 8"
    panel = Photograph(caption, (command,), "difference.png")
    return Sheet(MEASURED, "The difference", _figures(), 1, (panel,))


def keep_figures() -> None:
    """Puts the figures that were measured beside the page."""
    FIGURES.write_text((ROOT / OUT / "difference.json").read_text())


def _figures() -> str:
    """Text of the difference, with its table if it was measured."""
    text = (
        "Composite less truth as they are developed, around middle grey. Both have noise, so the "
        "difference has noise, everywhere; what is wrong would be seen as a shape. "
    )
    if not FIGURES.exists():
        return text
    rows = ["| | of the picture | light | mean | rms | rms, 8 x 8 |", "|---|---|---|---|---|---|"]
    for name, f in json.loads(FIGURES.read_text()).items():
        rows.append(
            f"| {name} | {f['share']:.0%} | {f['light']:.3f} | {f['mean']:+.3f} | "
            f"{f['rms']:.3f} | {f['rms_of_squares']:.2f} |"
        )
    return f"{text}\n\n{_OF_FIGURES}\n\n" + "\n".join(rows)


_OF_FIGURES = """\
In numbers, of the electrons of photosites that are not clipped: *light* is that of the composite
over that of the truth; *mean* and *rms* are of the difference, in units of the noise that both
shots have. Noise alone has an rms of 1, also as means of 8 x 8 photosites, where an error that a
single photosite hides stands out. *The rest* compares two renders of the empty set: what it has
above 1 is noise of rendering that denoising has left.

Glass and steel show the photograph, and it is not all that there was: lamp and page are clipped in
it, and the table mirrors them toward the camera only. That costs them light. Without `--plate`,
the set being modelled as well as here, they have that of the truth within half a per cent."""

#: The row in the gallery and at the head of the walk: pictures of the sheets, smaller.
OVERVIEW = (("plate.png", "objects.png"), ("catcher.png", "shot.png"))
