"""Pictures of the gallery: each picture with the commands that made it."""

from __future__ import annotations

from dataclasses import dataclass

NIGHT = "out/night_table.glb"
GAUSS = "--lens double-gauss-50mm-f2"
COMMON = "--res 750x500 --tone soft"


@dataclass(frozen=True)
class Picture:
    """One picture: its file, what it shows, and the arguments of `daguerre render`.

    Several flags make a sheet of as many panels, side by side in `columns`, of one scene or of a
    scene each; a command that writes `--frames` gives a panel for each. A scene that is a Python
    script makes the picture by itself. What an anamorphic lens has squeezed is stretched back by
    making the panels less high.
    """

    name: str
    title: str
    scene: str | tuple[str, ...]
    flags: str | tuple[str, ...]
    needs_data: bool = False
    columns: int = 1
    squeeze: float = 1.0

    @property
    def by_script(self) -> bool:
        """Whether a Python script makes the picture by itself."""
        return isinstance(self.scene, str) and self.scene.endswith(".py")

    def commands(self, folder: str) -> list[tuple[str, str]]:
        """Commands of each panel, and the file that comes of it; #### counts frames."""
        if self.by_script:
            output = f"{folder}/{self.name}.png"
            return [(f"python {self.scene} {output} {self.flags}".strip(), output)]
        flags = (self.flags,) if isinstance(self.flags, str) else self.flags
        scenes = (self.scene,) * len(flags) if isinstance(self.scene, str) else self.scene
        made = []
        for k, (scene, given) in enumerate(zip(scenes, flags, strict=True)):
            number = f"_{k + 1}" if len(flags) > 1 else ""
            frames = ".####" if "--frames" in given else ""
            output = f"{folder}/{self.name}{number}{frames}.png"
            common = COMMON if "--res" not in given else "--tone soft"
            common = "" if "--exposure manual" in given else common  # developed
            words = ("daguerre render", scene, given, common, f"-o {output}")
            made.append((" ".join(word for word in words if word), output))
        return made


BLOCKS = "out/lens_scenes/blocks.glb"
SMALL = "--res 600x400 --spp 48 --denoise"
#: Lamps in the window are so large that paths from the lens find them.
AT_NIGHT = "--res 750x500 --spp 24 --light-paths off --denoise"
CLOSE_UP = "--res 1800x1200 --crop left=850,top=10,right=1600,bottom=510 --spp 24 --light-paths off"

PICTURES = [
    Picture(
        "noise",
        "4 and 64 samples per pixel: a quarter of the noise.",
        BLOCKS,
        tuple(f"--lens pinhole --res 360x240 --spp {n}" for n in (4, 64)),
        columns=2,
    ),
    Picture(
        "night_table",
        "The scene of the demo through a double Gauss at f/2.",
        NIGHT,
        f"{GAUSS} --f-stop 2 --res 900x600 --spp 96 --denoise",
    ),
    Picture("pinhole", "A pinhole: everything is sharp.", NIGHT, f"--lens pinhole {AT_NIGHT}"),
    Picture(
        "focus_far",
        "A thin lens at f/2, focused far away: block C, 4 m.",
        BLOCKS,
        f"--lens thin --f-stop 2 --focus 4 {SMALL}",
    ),
    Picture(
        "focus_medium",
        "The same, focused at medium distance: block B, 1 m.",
        BLOCKS,
        f"--lens thin --f-stop 2 --focus 1 {SMALL}",
    ),
    Picture(
        "focus_close",
        "The same, focused close by: block A, 0.5 m.",
        BLOCKS,
        f"--lens thin --f-stop 2 --focus 0.5 {SMALL}",
    ),
    Picture(
        "thin",
        "The table through a thin lens at f/2, focused on the dice.",
        NIGHT,
        f"--lens thin --f-stop 2 --focus 0.64 {AT_NIGHT}",
    ),
    Picture(
        "aperture_small",
        "The double Gauss at f/16: a small aperture, deep focus.",
        NIGHT,
        f"{GAUSS} --f-stop 16 --focus 0.64 {AT_NIGHT}",
    ),
    Picture(
        "aperture_large",
        "The double Gauss at f/2: a large aperture, shallow depth of field.",
        NIGHT,
        f"{GAUSS} --f-stop 2 --focus 0.64 {AT_NIGHT}",
    ),
    Picture(
        "bokeh",
        "Bokeh close up: lamps far behind the focus take the shape of the pupil. It is round; "
        "away from the centre of the picture the rims of the lens begin to clip it.",
        NIGHT,
        f"{GAUSS} --f-stop 2 --focus 0.5 {CLOSE_UP} --denoise",
    ),
    Picture(
        "bokeh_blades",
        "The same close-up through six straight blades at f/2.8.",
        NIGHT,
        f"{GAUSS} --f-stop 2.8 --focus 0.5 --blades 6 --blade-curvature 0 {CLOSE_UP} --denoise",
    ),
    Picture(
        "chess",
        "Open chess set through the double Gauss at f/2, lit by a night panorama of a square.",
        "DATA/scenes/open_chess_set_512.glb",
        f"{GAUSS} --f-stop 2 --env DATA/hdri/st_peters_square_night_1k.hdr --spp 64 --denoise",
        needs_data=True,
    ),
]

PICTURES += [
    Picture(
        "chess_shot",
        "The Open Chess Set of USD, with MaterialX and subdivision surfaces, photographed by "
        "its stage's camera: double Gauss at f/2.8, 1/60 s at ISO 400.",
        "scenes/chess_shot.py",
        "DATA/OpenChessSet/chess_set.usda DATA/hdri/st_peters_square_night_1k.hdr",
        needs_data=True,
    ),
]

EXTENSIONS = "out/extensions"
PICTURES += [
    Picture(
        "octopus",
        "Animated skins, morph targets and colours at 3.4 s, through the double Gauss.",
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
        "map",
        "The street at the origin, and at map coordinates: 500,000 m east and 5,400,000 m north.",
        (f"{EXTENSIONS}/street.glb", f"{EXTENSIONS}/street_on_the_map.glb"),
        ("--lens wide-angle-35mm-f2 --res 450x300 --spp 48 --denoise",) * 2,
        columns=2,
    ),
    Picture(
        "underwater",
        "Under water: a bare camera; through a flat port, with the pincushion of refraction, "
        "focused at 3/4 of the distance; through a dome about the pupil, focused at 0.35 m.",
        tuple(f"out/solids/{name}.glb" for name in ("bare", "flat", "dome")),
        tuple(
            f"--lens wide-angle-35mm-f2 --focus {focus} --ev {ev} --res 360x240 --spp 96 --denoise"
            for focus, ev in ((2, 0.2), (1.51, 1), (0.35, 1))
        ),
        columns=3,
    ),
    Picture(
        "paperweight",
        "Bubbles of air and coloured glass in a ball of clear glass: solids in solids.",
        "out/solids/paperweight.glb",
        "--res 600x400 --spp 128 --denoise",
    ),
    Picture(
        "glass",
        "Cut stones and a prism with dispersion, coloured glass, a paper lantern around a bulb.",
        f"{EXTENSIONS}/glass.glb",
        SMALL,
    ),
]

SCENES = "out/motion"
DENOISED = "--spp 48 --denoise"
WIDE, FULL = f"--res 600x300 {DENOISED}", f"--res 600x400 {DENOISED}"

MOTION = [
    Picture(
        "billiards",
        'Moving objects, after "1984" by Cook, Porter and Carpenter: the 1 rests, the 9 strikes '
        "the white ball while the shutter is open, the 8 moves only in the middle of the exposure, "
        "the 4 only at its end.",
        f"{SCENES}/billiards.glb",
        f"--time 0.25 --shutter 1/24 {FULL}",
    ),
    Picture(
        "panning",
        "A car at 70 km/h, photographed at 1/60 s with a still camera and with a fast pan that "
        "follows it. In the pan the body is sharp and the wheels are blurred; far things are "
        "blurred as much as near ones.",
        f"{SCENES}/racer.glb",
        (
            f"--camera still --time 0.5 --shutter 1/60 {WIDE}",
            f"--camera pan --time 0.5 --shutter 1/60 {WIDE}",
        ),
    ),
    Picture(
        "moving_camera",
        "Moving cameras: a zoom burst from 45.5 to 52.5 mm, and a drive down the street at 8 m/s, "
        "which blurs near things and leaves far ones sharp.",
        f"{SCENES}/street.glb",
        (
            f"--camera zoom --time 0.5 --shutter 1/6 {WIDE}",
            f"--camera drive --time 0.5 --shutter 1/8 {WIDE}",
        ),
    ),
    Picture(
        "cradle",
        "Reflections and shadows of moving things: the falling ball is blurred directly, in its "
        "reflections in the board and its neighbours, and in its shadow.",
        f"{SCENES}/cradle.glb",
        f"--time 0.15 --shutter 1/30 {FULL}",
    ),
    Picture(
        "strobing",
        "Strobing. Five frames of a wheel that turns 129 degrees from frame to frame: with an "
        "instantaneous shutter the spokes are sharp and seem to creep backwards; with a shutter "
        "angle of 180 degrees they are blurred, and the eye is not fooled.",
        f"{SCENES}/racer.glb",
        (
            "--camera wheel --time 0.3 --frames 1-5 --shutter 0 --res 120x120 --spp 64 --denoise",
            "--camera wheel --time 0.3 --frames 1-5 --shutter-angle 180 --res 120x120 --spp 64 "
            "--denoise",
        ),
        columns=5,
    ),
    Picture(
        "propellers",
        "A propeller blade between two keys: 90 degrees apart, 170 degrees, 90 degrees and half as "
        "large, and 3 turns (rows), interpolated linearly, by twist, decomposed, and as a spin "
        "(columns). The blade and its tip shine in the dark. With linear interpolation points move "
        "along straight lines. A twist needs rigid matrices. Keys that are whole turns apart are "
        "the same pose, so such a rotation needs a spin.",
        "script/docs/gallery/propellers.py",
        "--spp 48",
    ),
    Picture(
        "shutters",
        "One propeller, at 24 turns a second, through four shutters: 1/4000 s; 1/250 s; lines read "
        "out from the top in 25 ms; the same from the left.",
        f"{SCENES}/plane.glb",
        tuple(
            f"--time 0.5 {shutter} --res 300x200 --spp 64 --denoise"
            for shutter in (
                "--shutter 1/4000",
                "--shutter 1/250",
                "--shutter 1/2000 --rolling top,25ms",
                "--shutter 1/2000 --rolling left,25ms",
            )
        ),
        columns=2,
    ),
    Picture(
        "focal_plane",
        "The slit of a focal-plane shutter exposes each line for 1/500 s and travels from the "
        "bottom of the picture to the top in 1/12 s, in a camera that pans at half the speed of "
        "the car: wheels lean forward and trees back, as in Lartigue's photograph of 1912.",
        f"{SCENES}/racer.glb",
        "--camera slow --time 0.53 --shutter 1/500 --shutter-type focal_plane "
        f"--rolling bottom,1/12 {FULL}",
    ),
    Picture(
        "leaf",
        "Bokeh through a shutter that opens at once, and through a leaf shutter that opens and "
        "closes gradually: it uncovers the rim of the lens for a shorter time than the centre, so "
        "discs have soft edges.",
        NIGHT,
        tuple(
            f"--lens thin --f-stop 2 --focus 0.5 --shutter 1/500 {kind} "
            "--res 900x600 --crop left=0,top=25,right=300,bottom=325 --spp 64 --denoise"
            for kind in ("--shutter-type box", "--shutter-type leaf --shutter-curve trapezoid:0.5")
        ),
        columns=2,
    ),
    Picture(
        "lamp",
        "One second of a bulb that swings and blinks five times a second: it lights its "
        "surroundings from all of its positions, and draws its path in dashes.",
        f"{SCENES}/lamp.glb",
        f"--time 0.5 --shutter 1s {FULL}",
    ),
    Picture(
        "octopus_moving",
        "Skins and morph targets: half a second of the octopus.",
        f"{EXTENSIONS}/octopus.glb",
        f"--time 1.2 --shutter 1/2 --f-stop 8 {FULL}",
    ),
    Picture(
        "chess_moving",
        "The chess set's knight jumps and its camera moves, as animated in the file.",
        "DATA/scenes/open_chess_set_512.glb",
        "--time 0.15 --shutter 1/12 --f-stop 8 --env DATA/hdri/st_peters_square_night_1k.hdr "
        f"{FULL}",
        needs_data=True,
    ),
    Picture(
        "killeroo_moving",
        "pbrt's killeroos move for one second, through a double Gauss at f/2: with the shutter "
        "open all the time; and by the slit of a focal-plane shutter, which exposes each line for "
        "1/10 s and travels from the bottom of the picture to the top in 0.9 s, so that tails are "
        "seen later than feet.",
        "DATA/killeroos/killeroo-moving.pbrt",
        tuple(
            "--lens double-gauss-50mm-f2 --f-stop 2 --sensor 30x30 --exposure manual --ev 1.5 "
            "--time 0.5 "
            f"{shutter} --res 320x320 --spp 64 --denoise"
            for shutter in (
                "--shutter 1s",
                "--shutter 0.1 --exposure-time 1 --shutter-type focal_plane --rolling bottom,0.9",
            )
        ),
        needs_data=True,
        columns=2,
    ),
    Picture(
        "modern_hall",
        "A well-known room, Modern Hall, in fog: a lamp and a string of small ones, through a "
        "Nikkor 50 mm at f/1.4. Mitsuba reads the same file, `scenes/modern_hall_in_fog.xml`, "
        "beside the room's own.",
        "DATA/modern-hall/modern_hall_in_fog.xml",
        "--lens nikon-ai-s-50mm-f1.4 --f-stop 1.4 --exposure manual --iso 2000 --wb 5000 "
        "--look filmic --res 600x400 --spp 64 --denoise",
        needs_data=True,
    ),
]

LAMPS, ARCADE = "out/lens_scenes/lamps.glb", "out/lens_scenes/arcade.glb"
DISCS = "--max-depth 1 --spp 4 --light-paths 6000000 --denoise"
ENLARGED = "--sensor 18x12 --res 375x250 --max-depth 1"
FROM_LAMPS = "--res 375x250 --max-depth 1 --spp 48"
PANEL = "--res 375x250 --spp 32 --denoise"
TABLE = "--lens canon-ts-e-90mm-f2.8-macro --f-stop 2.8 --focus-at 187,137"
ZOOM = "--camera zoom --lens nikon-af-s-70-200mm-f2.8 --f-stop 4"
THIRD = "--res 250x167 --spp 32 --denoise"
VIEW = "--lens rodenstock-grandagon-n-90mm-f4.5 --sensor 127x102 --f-stop 11 --focus 8"
LIGHTER = "--res 375x300 --spp 32 --denoise --ev 1.5"

GLASS = [
    Picture(
        "four_lenses",
        "One scene, one viewpoint, four lenses, as in Kolb, Mitchell and Hanrahan 1995: telephoto "
        "180 mm, double Gauss 50 mm, wide angle 35 mm, fisheye 16 mm.",
        ARCADE,
        tuple(
            f'--camera "one place" --lens {name} --f-stop 2.8 {PANEL} --ev 1'
            for name in (
                "zeiss-olympia-sonnar-180mm-f2.8",
                "double-gauss-50mm-f2",
                "wide-angle-35mm-f2",
                "fisheye-16mm-f2.8",
            )
        ),
        columns=2,
    ),
    Picture(
        "cat_eyes",
        "Small lamps far behind the focus take the shape of a fast lens's pupil across the frame: "
        "round in the centre, and clipped by the rims of the first and the last element toward the "
        "corners. The fringes are its lateral and axial colour.",
        LAMPS,
        f"--lens canon-50mm-f0.95 --f-stop 0.95 --res 600x400 {DISCS}",
    ),
    Picture(
        "polynomial",
        "The same bokeh from exact lenses, left, and from polynomials of degree 9 fitted to them, "
        "right: a lens at f/0.95, and six blades at f/2.8.",
        LAMPS,
        tuple(
            f"{lens} --lens-model {model} {FROM_LAMPS}"
            for lens in (
                "--lens canon-50mm-f0.95 --f-stop 0.95",
                f"{GAUSS} --f-stop 2.8 --blades 6 --blade-curvature 0 --focus 0.5",
            )
            for model in ("exact", "polynomial --degree 9")
        ),
        columns=2,
    ),
    Picture(
        "bubbles",
        "Soap-bubble bokeh and creamy bokeh: a Biotar of 1927 gives discs of light with a bright "
        "edge, a soft-focus portrait lens gives discs without one. The cause is overcorrected and "
        "undercorrected spherical aberration.",
        LAMPS,
        (
            "--lens zeiss-biotar-50mm-f1.4 --f-stop 1.4 --focus 0.6 "
            f"{ENLARGED} --spp 4 --light-paths 4000000",
            "--lens nikon-fuwatto-soft-90mm-f4.8 --f-stop 4.8 --shift 0,8.6 "
            f"{ENLARGED} --spp 4 --light-paths 4000000",
        ),
        columns=2,
    ),
    Picture(
        "tilt",
        "A lens for product photography at f/2.8, straight and tilted by 7.1 degrees: the "
        "planes of film, lens and table-top then meet in one line (Scheimpflug), and all of the "
        "table is sharp.",
        "out/lens_scenes/long_table.glb",
        tuple(f"{TABLE}{tilt} {PANEL}" for tilt in ("", " --tilt=-7.1,0")),
        columns=2,
    ),
    Picture(
        "shift",
        "A view camera: tilted up, columns lean; level, with the film shifted, they are upright.",
        ARCADE,
        (
            f'--camera "tilted up" {VIEW} {LIGHTER}',
            f"--camera level {VIEW} --shift 0,32 {LIGHTER}",
        ),
        columns=2,
    ),
    Picture(
        "anamorphic",
        "A true anamorphic lens, stretched back by its squeeze: lamps out of focus are upright "
        "ovals.",
        ARCADE,
        "--camera portrait --lens schneider-anamorphic-60mm --f-stop 2.9 --sensor 24.9x20.7 "
        "--res 750x624 --spp 24 --denoise",
        squeeze=1.9,
    ),
    Picture(
        "zoom",
        "A zoom of 41 surfaces at 72, 100, 140 and 195 mm; and at 140 mm focused at infinity and "
        "at 1.8 m: it breathes, so the field changes with focus.",
        ARCADE,
        tuple(f"{ZOOM} --zoom {mm} {THIRD}" for mm in (72, 100, 140, 195))
        + tuple(f"{ZOOM} --zoom 140 --focus {m} {THIRD}" for m in ("inf", "1.8")),
        columns=3,
    ),
    Picture(
        "soft",
        "A soft-focus lens, wide open and stopped down by two stops: a sharp picture under a veil, "
        "and the sharp picture alone.",
        ARCADE,
        tuple(
            f"--camera portrait --lens mamiya-sekor-sf-150mm-f4 --sensor 69.5x46.3 "
            f"--f-stop {n} {PANEL}"
            for n in (4, 8)
        ),
        columns=2,
    ),
]

PHOTOGRAPHER = f"{GAUSS} --f-stop 2 --res 600x338"
CAUSTICS = f"{GAUSS} --f-stop 4 --res 480x320"
LIGHT = [
    Picture(
        "night_lamps",
        "A hundred lamps of 2 mm behind a photographer's table, in equal CPU time: paths from the "
        "lens only, above, and with light paths in addition, below.",
        "out/lens_scenes/photographer.glb",
        (
            f"{PHOTOGRAPHER} --spp 48 --light-paths off",
            f"{PHOTOGRAPHER} --spp 40 --light-paths 65536",
        ),
    ),
    Picture(
        "caustics",
        "Caustics of a glass ball, a glass of wine and a brass ring on the table, in equal CPU "
        "time: paths from the lens only, left, and with bounced light paths in addition, right.",
        "out/lens_scenes/caustics.glb",
        (
            f"{CAUSTICS} --spp 120 --light-paths off",
            f"{CAUSTICS} --spp 64 --light-paths 0,100000",
        ),
        columns=2,
    ),
]
