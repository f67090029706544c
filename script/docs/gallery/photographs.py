"""Pictures of the page of photographs: sheets of exposed pictures, each with its commands."""

from __future__ import annotations

from dataclasses import dataclass

INTRODUCTION = """# From exposure to photograph

See what camera bodies and films make of the light in a frame. [Exposure](../exposure.md),
[sensors](../sensors.md), [developing](../developing.md) and [film stocks](../film-stocks.md)
explain how. To make the scenes:

```
python scenes/night_table.py out/night_table.glb
python scenes/exposure.py
mkdir -p out
```

`--denoise` (extra `denoise`) removes rendering noise, so that only the sensor's noise is left. One
pixel of these pictures is one photosite, as in a 100 % crop.
"""
OUT = "out/gallery"
GAUSS = "--lens double-gauss-50mm-f2"
BODY = "sony-a7r-ii"


@dataclass(frozen=True)
class Photograph:
    """A picture of a sheet.

    Attributes:
        caption: Above it.
        commands: That make it; the last one writes `file`.
        file: In `OUT`.
    """

    caption: str
    commands: tuple[str, ...]
    file: str


@dataclass(frozen=True)
class Sheet:
    """Pictures side by side.

    Attributes:
        name: Name of the file.
        title: Below it on the page.
        text: Caption.
        first: Commands before all others.
        columns: In each row.
        photographs: Row by row.
    """

    name: str
    title: str
    text: str
    columns: int
    photographs: tuple[Photograph, ...]
    first: tuple[str, ...] = ()


def _night() -> Sheet:
    scene = (
        f"daguerre render out/night_table.glb {GAUSS} --f-stop 2 --exposure manual --ev 1.5 "
        f"--res 600x400 --spp 128 --denoise --sensor {BODY}"
    )
    shots, settings = [], (("100", "1"), ("25600", "1/250"))
    for iso, time in settings:
        file = f"{OUT}/night_{iso}"
        shots.append(f"{scene} --iso {iso} --shutter {time} -o {file}.exr")
    photographs = []
    for iso, time in settings:
        file = f"{OUT}/night_{iso}"
        title = f"ISO {iso}, {time} s"
        photographs += [
            Photograph(
                f"{title}: developed by Daguerre",
                (
                    f"daguerre develop {file}.exr --sensor {BODY} -o {file}.dng",
                    f"daguerre develop {file}.dng -o {file}.png",
                ),
                f"night_{iso}.png",
            ),
            Photograph(
                f"{title}: the DNG by LibRaw",
                (f"python script/docs/gallery/by_libraw.py {file}.dng {file}_libraw.png",),
                f"night_{iso}_libraw.png",
            ),
        ]
    text = (
        "The second row has 256 times the ISO and 1/250 of the exposure time, so it shows photon "
        "noise and read noise. Left: developed by Daguerre; right: by LibRaw from the same DNG."
    )
    return Sheet(
        "night_iso",
        "The night table, ISO 100 for a second and ISO 25600 for a 250th",
        text,
        2,
        tuple(photographs),
        tuple(shots),
    )


def _triangle() -> Sheet:
    scene = (
        f"daguerre render out/exposure/pinwheels.glb --sky 57,60,69 --time 0.3 {GAUSS} "
        f"--res 420x280 --spp 128 --denoise --sensor {BODY} --exposure manual"
    )
    middle = {"f-stop": "4", "shutter": "1/125", "iso": "1600"}
    sides = {
        "f-stop": ("8", "4", "2"),
        "shutter": ("1/500", "1/125", "1/30"),
        "iso": ("400", "1600", "6400"),
    }
    photographs = []
    for side, values in sides.items():
        for k, value in enumerate(values):
            chosen = middle | {side: value}
            flags = " ".join(f"--{name} {setting}" for name, setting in chosen.items())
            file = f"triangle_{side}_{k + 1}.png"
            caption = f"f/{chosen['f-stop']}, {chosen['shutter']} s, ISO {chosen['iso']}"
            photographs.append(Photograph(caption, (f"{scene} {flags} -o {OUT}/{file}",), file))
    text = (
        "Each row changes one setting by two stops either way: f-number, shutter time, ISO. All "
        "three change the brightness; the f-number also changes depth of field, the shutter time "
        "motion blur, and the ISO noise."
    )
    return Sheet("exposure_triangle", "The exposure triangle", text, 3, tuple(photographs))


def _film() -> Sheet:
    stocks = (
        ("generic-colour-negative-400", "colour negative"),
        ("generic-reversal-100", "reversal"),
        ("generic-panchromatic-400", "black and white"),
        ("generic-tungsten-800-no-backing", "tungsten negative without its backing"),
    )
    ev = {"400": "-2", "100": "0", "800": "-3"}
    photographs = []
    for name, title in stocks:
        iso = next(word for word in name.split("-") if word.isdigit())
        file = f"film_{name}.png"
        command = (
            f"daguerre develop {OUT}/night_100.exr --stock {name} --ev {ev[iso]} -o {OUT}/{file}"
        )
        photographs.append(Photograph(title, (command,), file))
    text = (
        "The one-second exposure of the night table on four films ([film](../film-stocks.md)): "
        "prints and a slide. Without a backing, light comes back from the base as red haloes."
    )
    return Sheet("film", "Four films", text, 2, tuple(photographs))


SHEETS = (_night(), _triangle(), _film())
