"""Pictures of the page of plates: pawns that never stood on the desk, put into its photograph."""

from __future__ import annotations

import json

from photograph_page import PAGES, ROOT
from photographs import OUT, Photograph, Sheet

INTRODUCTION = """# Into the plate

This page composites four pawns, of glass, of steel and painted, into a photograph of an empty desk,
and compares the result with a photograph that has them on it
([scenes/plates.py](../../scenes/plates.py)). [Into the plate](../plates.md) explains each step. To
make the scenes:

```
python scenes/plates.py
mkdir -p out
```

The plate is a simulated shot: dusk in the window, ISO 6400, through a lens of the library, written
as a raw file. The later steps use only that file: `match-plate` finds the camera from it.
`--denoise` needs the extra `denoise`. One pixel of these pictures is one photosite, as in a 100 %
crop.
"""
#: Figures of differences, by picture and region, and the sheets whose making measures them.
FIGURES = PAGES / "plates.json"
MEASURED = {"plates_difference": "difference", "plates_modelled": "modelled"}
CAMERA = (
    "--lens nikon-ai-s-50mm-f1.8 --f-stop 2.8 --focus 0.76 --shutter 1/125 "
    "--sensor sony-a7r-ii --exposure manual --iso 6400 --res 750x500"
)
LAYERS = "python script/docs/gallery/plate_layers.py"
LAYER_TIMES = 3


def sheets() -> tuple[Sheet, ...]:
    """Plate, objects, catchers, composite, truth and differences."""
    first = _plate(), _objects(), _catchers(), _composite(), _truth()
    return (*first, _difference(), _modelled())


def _plate() -> Sheet:
    shot = (
        f"daguerre render out/plates/empty.glb {CAMERA} --spp 32 --denoise "
        f"-o {OUT}/plate.dng -o {OUT}/plate.png",
        f"daguerre match-plate {OUT}/plate.dng -o {OUT}/camera.json",
    )
    text = (
        "The first command takes the photograph. The second finds its camera: lens, f-number, "
        "shutter time and ISO from EXIF, gain and noise of the sensor from flat areas of the "
        "picture."
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
        "Objects with true alpha: depth of field has soft edges, and the mug hides part of the "
        "pawn behind it. Glass and steel show the photograph, which `--plate` projects onto the "
        "set. Glass covers what it refracts, so none of the checkerboard shows through it."
    )
    panel = Photograph("objects alone, over squares", commands, "objects.png")
    return Sheet("plates_objects", "The objects, with alpha", text, 1, (panel,))


def _catchers() -> Sheet:
    command = f"{LAYERS} catcher {OUT}/object.exr {OUT}/catcher.png {LAYER_TIMES}"
    text = (
        "The layer `catcher` of the same file, shown around middle grey. Light that the objects "
        "block is dark and light that they add is bright, as shares of white, amplified "
        f"{LAYER_TIMES} times. Soft shadows from window and lamp run both ways, red bleeds onto "
        "the page, glass gathers light beside its foot, and the mug and the brass of the old "
        "camera mirror the pawns."
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
        "The objects are added to the plate's electrons, before demosaicing. The raw file is then "
        "developed like any other."
    )
    panel = Photograph("composite", (command,), "shot.png")
    return Sheet("plates_shot", "The composite", text, 1, (panel,))


def _truth() -> Sheet:
    command = (
        f"daguerre render out/plates/shot.glb {CAMERA} --seed 2 --spp 40 --denoise "
        f"-o {OUT}/truth.dng -o {OUT}/truth.png"
    )
    text = "A separate shot of the desk with the pawns on it: its noise is different."
    panel = Photograph("the whole scene, photographed", (command,), "truth.png")
    return Sheet("plates_truth", "The truth", text, 1, (panel,))


def _difference() -> Sheet:
    text = (
        "The composite minus the true photograph, both developed, around middle grey. Both have "
        "noise, so noise is everywhere in the difference; an error would show as a shape."
    )
    text = "\n\n".join([text, _OF_FIGURES, _OF_PLATE, *_table("difference")])
    panel = Photograph(_LESS, (_compared("shot", "object", "difference"),), "difference.png")
    return Sheet("plates_difference", "The difference", text, 1, (panel,))


def _modelled() -> Sheet:
    """The same without `--plate`: the set gives light as it is modelled."""
    commands = (
        f"daguerre render out/plates/shot.glb --like-plate {OUT}/camera.json --catcher set "
        f"--background transparent --aov object_id --spp 28 --denoise -o {OUT}/alone.exr",
        f"daguerre composite {OUT}/plate.dng {OUT}/alone.exr --like-plate {OUT}/camera.json "
        f"-o {OUT}/modelled.dng",
        _compared("modelled", "alone", "modelled"),
    )
    text = (
        "Without `--plate` the objects see the modelled set, which here matches the real one, so "
        "they have the light of the true photograph. The remaining difference in glass and steel "
        "is in fine reflections, of which both renders have few samples."
    )
    panel = Photograph(_LESS, commands, "modelled.png")
    title = "The difference without the photograph as light"
    return Sheet("plates_modelled", title, "\n\n".join([text, *_table("modelled")]), 1, (panel,))


def _compared(shot: str, objects: str, to: str) -> str:
    return (
        f"python script/docs/gallery/plate_difference.py {OUT}/{shot}.dng {OUT}/truth.dng "
        f"{OUT}/{objects}.exr out/plates/shot.glb {OUT}/camera.json sony-a7r-ii {OUT}/{to}.png"
    )


def keep_figures(sheet: str) -> None:
    """Puts the figures that a sheet measured, if it does, beside the page."""
    if sheet in MEASURED:
        name = MEASURED[sheet]
        known = _known() | {name: json.loads((ROOT / OUT / f"{name}.json").read_text())}
        FIGURES.write_text(json.dumps(known, indent=1) + "\n")


def _known() -> dict[str, dict[str, dict[str, float]]]:
    return json.loads(FIGURES.read_text()) if FIGURES.exists() else {}


def _table(name: str) -> list[str]:
    """The figures of a difference, if it was measured."""
    if name not in _known():
        return []
    rows = ["| | of the picture | light | mean | rms | rms, 8 x 8 |", "|---|---|---|---|---|---|"]
    for region, f in _known()[name].items():
        rows.append(
            f"| {region} | {f['share']:.0%} | {f['light']:.3f} | {f['mean']:+.3f} | "
            f"{f['rms']:.3f} | {f['rms_of_squares']:.2f} |"
        )
    return ["\n".join(rows)]


_LESS = "composite less truth: pixels x 2, and means of 8 x 8 pixels x 8"
_OF_FIGURES = """\
The figures are for the electrons of photosites that are not clipped. *light* is the light of the
composite, divided by that of the true photograph. *mean* and *rms* describe the difference, in
units of the noise of both shots. Pure noise has an rms of 1. So do its means over 8 x 8 photosites,
which reveal errors that are invisible in a single photosite. *the rest* compares two renders of the
set where pawns change nothing: its excess over 1 is rendering noise that the denoiser left."""
_OF_PLATE = """\
The set matches the light of the true photograph to 0.2 %: shadows, reflections, colour bleeding.
Objects lit by the plate are a little dark, because the plate clips the lamp, and because it records
only the light that glossy things such as the table send toward the camera. (With a set without
gloss and a plate without clipping the red pawn has 1.000 of its light.) The next picture does not
use the plate as light."""

#: The row in the gallery and at the head of the walk: pictures of the sheets, smaller.
OVERVIEW = (("plate.png", "objects.png"), ("catcher.png", "shot.png"))
