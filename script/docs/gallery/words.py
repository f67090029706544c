"""The lecture's list of imperfections: for each word a sheet of pictures with their commands."""

from __future__ import annotations

from ways import OUT, Panel, Ways, Word, post, render

DARK = "--max-depth 1"
STRINGS, STARRY, WHEEL, CHART, FAIR = (
    f"{OUT}/{name}.glb" for name in ("strings", "starry", "wheel", "chart", "fair")
)
WALL, RULE, DUSK = (f"{OUT}/{name}.glb" for name in ("wall", "rule", "dusk"))
ELCAN = "leica-elcan-50mm-f2"
PETZVAL = "petzval-100mm-f2.2"
MASTER = "zeiss-master-prime-100mm-f1.24"
BIOTAR = "zeiss-biotar-50mm-f1.4"
ZOOM, FISHEYE = "nikon-z-14-30mm-f4", "canon-ef-15mm-f2.8-fisheye"
HOLOGON, CANON = "zeiss-hologon-15mm-f8", "canon-50mm-f0.95"
GAUSS, SOFT = "double-gauss-50mm-f2", "nikon-fuwatto-soft-90mm-f4.8"
LAMPS = "out/lens_scenes/lamps.glb"
WEAK = "scenes/imperfections/portrait-85mm-f2-and-a-cylinder.json"


def wide(view: str) -> str:
    """Flags of a pinhole that sees a tenth more than the frame, which distortion may need."""
    return f"{view} --sensor 40x26.667"


def flat(lens: str, f_stop: float, at: str, zones: int = 9) -> tuple[str, ...]:
    """All of a lens that 2D knows of one distance, on a picture of `wide`."""
    return (
        f"distortion:model=lens,lens={lens},{at},scale=0.9,sensor=36x24,lateral_colour=0",
        f"lens-psf:lens={lens},f_stop={f_stop:g},{at},zones={zones},waves=0,sensor=36x24",
        f"vignetting:model=lens,lens={lens},f_stop={f_stop:g},{at},sensor=36x24",
    )


_NARROW = f"--sensor 18x12 --res 480x320 {DARK}"
SPHERICAL = Word(
    "spherical",
    "Spherical aberration",
    """\
Rays through the rim of the lens focus nearer than those through its centre. A soft-focus portrait
lens has much of it. Lamps far behind the focus have a bright core in a weak disc; lamps in front of
it become soap bubbles, discs with a bright rim; and the sign, in focus, is soft. The 2D depth of
field uses one flat disc for all, and its sign is sharp.""",
    (
        Ways(
            "spherical",
            STRINGS,
            f"--lens {SOFT} --focus 1.6",
            "--focus-by best --f-stop 4.8",
            f"{_NARROW} --spp 24",
            (
                "depth-of-field:f_stop=4.8,focus=1.6m",
                f"vignetting:model=lens,lens={SOFT},f_stop=4.8,focus=1.6m",
            ),
            more="--light-paths 200000",
            needs="--aov depth --gt-time mid",
        ).panels(),
    ),
)

_CORNER = f"--res 1440x960 --crop left=30,top=30,right=510,bottom=350 {DARK}"
COMA = Word(
    "coma",
    "Coma",
    """\
Off the axis each ring of the pupil images a point as a circle, and the circles are displaced: a
star gets the tail of a comet, toward the centre of the frame or away from it. The picture is the
upper left of a starry sky through an Elcan at f/2. All stars are far away, so the 2D effect can use
the lens's point spread function at each place. It would be wrong for lamps at other distances.""",
    (
        Ways(
            "coma",
            STARRY,
            f"--lens {ELCAN} --focus 200",
            "--f-stop 2",
            f"{_CORNER} --spp 16",
            flat(ELCAN, 2, "focus=200m"),
            wide=wide(f"--res 1440x960 --crop left=0,top=0,right=600,bottom=460 {DARK} --spp 48"),
            more="--light-paths 400000",
        ).panels(),
    ),
)

_CLOSE = f"--sensor 9x6 --res 480x320 {DARK}"
AXIAL = Word(
    "axial_colour",
    "Chromatic aberration along the axis",
    """\
Colours focus at different distances. Lines of light on a dark board run away from the camera; the
long one is in focus. Through this lens green focuses nearer to the lens than red and blue, so
lines in front of the focus have magenta edges, and lines behind it green ones. The 2D version
applies one depth of field each for red, green and blue, with the focus that the lens has at 650,
545 and 443 nm (script/docs/gallery/axial_colour.py). Real channels are broad, so its hues are too
strong.""",
    (
        (
            *Ways(
                "axial",
                RULE,
                f"--lens {MASTER} --focus 1.5",
                "--f-stop 1.3",
                f"{_CLOSE} --spp 48",
                (),
                more="--light-paths off",
            ).panels()[:2],
            Panel(
                "2D",
                "axial_2d",
                (
                    render(
                        RULE,
                        f"--lens {MASTER} --focus 1.5 --lens-model pinhole {_CLOSE} "
                        "--spp 48 --light-paths off --aov depth --gt-time mid",
                        "axial_pinhole",
                    ),
                    f"python script/docs/gallery/axial_colour.py {OUT}/axial_pinhole.exr "
                    f"{OUT}/axial_blurred.exr --lens {MASTER} --f-stop 1.3 --focus 1.5 "
                    "--sensor-width 9",
                    post(
                        "axial_blurred",
                        "axial_2d",
                        f"vignetting:model=lens,lens={MASTER},f_stop=1.3,focus=1.5m,sensor=9x6",
                    ),
                ),
            ),
        ),
    ),
)

_STAR = f"--res 3600x2400 --crop left={{}},top={{}},right={{}},bottom={{}} {DARK}"
LATERAL = Word(
    "lateral_colour",
    "Lateral chromatic aberration",
    """\
All colours are in focus, but the blue image is larger than the red one (or smaller). Edges that
run around the centre get a blue and a yellow side, more so toward the corner. The pictures are
stars of a test chart through a Canon 50 mm f/0.95 stopped down to f/8: above in the lower left
corner of the frame, 16 mm off the axis, and below near the centre, which has no fringes. In the
corner red is 1.2 px and blue 4.6 px from green. Polynomials of degree 9 lose some light at the edge
of the field. It is the one aberration that is easy to correct, with
`lateral-colour:...,inverse=1`.""",
    tuple(
        Ways(
            f"lateral_{where}",
            CHART,
            f"--lens {CANON} --focus 2.2",
            "--f-stop 8",
            f"{_STAR.format(*seen)} --spp 40",
            flat(CANON, 8, "focus=2.2m", 3),
            wide=wide(f"{_STAR.format(*reach)} --spp 24"),
            more="--light-paths off",
            note=f", {where}",
        ).panels()
        for where, seen, reach in (
            ("corner", (112, 1760, 592, 2080), (100, 1690, 730, 2090)),
            ("centre", (1920, 1040, 2400, 1360), (1800, 950, 2450, 1450)),
        )
    ),
    fringes=True,
)

_BOARD = f"--res 1080x720 --crop left=520,top=200,right=1000,bottom=520 {DARK} --spp 64"
CURVATURE = Word(
    "field_curvature",
    "Field curvature",
    """\
A lens images a flat chart on a curved surface, but film is flat. Few lenses have this aberration
alone; a Canon 50 mm f/0.95 stopped down to f/2 comes close. Its sagittal and tangential foci are
within 0.04 mm of each other, and 13 mm off the axis both lie 0.31 mm in front of those on the
axis. The centre of the frame is near the left edge of these pictures, and their right edge is 15
mm from it. Focused on the chart at 2.2 m, the centre is sharp, and stars far from it have grey
centres; at 2.65 m it is the other way round. No focus makes both sharp. 2D does this well, because
the whole chart is at one distance. It lacks the slightly green tint of the glass, hence the 5 % of
light.

| RMS radius of a point's image, um | on the axis | 4 mm | 8 mm | 11 mm | 13 mm | 15 mm |
|---|---|---|---|---|---|---|
| focused at 2.2 m | 4 | 9 | 25 | 36 | 38 | 30 |
| 2.3 m | 11 | 8 | 17 | 27 | 28 | 21 |
| 2.4 m | 20 | 14 | 11 | 18 | 19 | 13 |
| 2.5 m | 28 | 22 | 10 | 11 | 11 | 9 |
| 2.6 m | 35 | 29 | 14 | 8 | 5 | 11 |
| 2.7 m | 42 | 35 | 20 | 10 | 7 | 16 |""",
    tuple(
        Ways(
            f"field_curvature_{what}",
            CHART,
            f"--lens {CANON} --focus {focus}",
            "--f-stop 2",
            _BOARD,
            (
                f"distortion:model=lens,lens={CANON},focus={focus}m,scale=0.9,sensor=36x24",
                f"lens-psf:lens={CANON},f_stop=2,focus=2.2m,defocus={defocus},zones=9,waves=0,"
                "sensor=36x24",
                f"vignetting:model=lens,lens={CANON},f_stop=2,focus={focus}m,sensor=36x24",
            ),
            wide=wide(
                f"--res 1080x720 --crop left=460,top=160,right=1080,bottom=560 {DARK} --spp 48"
            ),
            more="--light-paths off",
            note=f", {what} in focus",
        ).panels()
        for what, focus, defocus in (("middle", 2.2, 0), ("edge", 2.65, -0.2133))
    ),
)

_RIM = f"--sensor 30x30 --res 420x420 {DARK} --spp 20"
ASTIGMATISM = Word(
    "astigmatism",
    "Astigmatism of a lens that is round, off its axis",
    """\
A fan of rays in the plane through the axis focuses at another distance than a fan perpendicular to
it. A flat wheel 2.2 m away faces a Petzval lens at f/2.2. Focused at 2.2 m its centre is sharp; at
2.09 m the rings are sharp up to the rim and the spokes are soft; at 2.6 m it is the other way
round. Astigmatism gives Petzval lenses their swirl. 2D does this well, because the whole wheel is
at one distance.""",
    tuple(
        Ways(
            f"astigmatism_{what}",
            WHEEL,
            f"--lens {PETZVAL} --focus {focus}",
            "--f-stop 2.2",
            _RIM,
            (
                f"lens-psf:lens={PETZVAL},f_stop=2.2,focus=2.2m,defocus={defocus},zones=9,waves=0",
                f"vignetting:model=lens,lens={PETZVAL},f_stop=2.2,focus={focus}m",
            ),
            more="--light-paths off",
            note=f", {what} in focus",
        ).panels()
        for what, focus, defocus in (("rings", 2.09, 0.2587), ("spokes", 2.6, -0.7484))
    ),
)

CYLINDER = Word(
    "cylinder",
    "Astigmatism of an element that is not radially symmetric",
    """\
The same wheel through a portrait lens behind the weakest cylinder that opticians sell, of a
quarter dioptre ([its file](../../scenes/imperfections/portrait-85mm-f2-and-a-cylinder.json)). Now
the centre is no better than the rim, and the difference is not between rings and spokes, but
between horizontal (level) and vertical (upright) lines: at 1.73 m level lines are sharp, at 3.03 m
upright ones, all over the picture. Polynomials for such a lens have the terms of two mirror planes
instead of those of rotation. A cylinder in front of the pupil also stretches the picture in one
direction by 1 %, 2 px at the rim; 2D lacks this.""",
    tuple(
        Ways(
            f"cylinder_{what}",
            WHEEL,
            f"--lens {WEAK} --focus {focus}",
            "--f-stop 2",
            _RIM.replace("30x30", "26x26"),
            (
                f"lens-psf:lens={WEAK},f_stop=2,focus=2.2m,defocus={defocus},zones=5,waves=0",
                f"vignetting:model=lens,lens={WEAK},f_stop=2,focus={focus}m",
            ),
            more="--light-paths off",
            note=f", {what} lines in focus",
        ).panels()
        for what, focus, defocus in (("level", 1.73, 0.9745), ("upright", 3.03, -0.9523))
    ),
)

_SMALL = f"--res 480x320 {DARK} --spp 32"
DISTORTION = Word(
    "distortion",
    "Radial distortion",
    """\
Chief rays land nearer to the centre than those of a pinhole (barrel), or farther away
(pincushion), so straight cornices look bent. One zoom does both: barrel at 14.5 mm, pincushion at
29 mm. A fisheye does so on purpose, to cover a field that no flat picture can hold. 2D distorts
the picture of a pinhole by the chief rays of the same lens. For the fisheye it lacks the corners,
90 degrees off the axis, where a pinhole sees nothing; and the centre is soft, because a flat
picture uses most of its pixels for the edge.""",
    tuple(
        Ways(
            f"distortion_{what}",
            WALL,
            f'--camera "{camera} mm" --lens {lens}{zoom} --focus {focus}',
            f"--f-stop {f_stop}",
            _SMALL,
            (
                f"distortion:model=lens,lens={lens},focus={focus}m{at},scale={scale},sensor=36x24",
                f"vignetting:model=lens,lens={lens},f_stop={f_stop},focus={focus}m{at},sensor=36x24",
            ),
            degree=11,
            wide=f"{_SMALL} --sensor {36 / scale:.6g}x{24 / scale:.6g}",
            more="--light-paths off",
            note=f", {what}",
        ).panels()
        for what, camera, lens, zoom, at, focus, f_stop, scale in (
            ("barrel", 15, ZOOM, " --zoom 14.5", ",zoom=14.5", 5.6, 8, 0.8),
            ("pincushion", 35, ZOOM, " --zoom 29", ",zoom=29", 13, 8, 0.95),
            ("fisheye", 8, FISHEYE, "", "", 3, 8, 0.4),
        )
    ),
    quality=78,
)

VIGNETTING = Word(
    "vignetting",
    "Vignetting",
    """\
First row: a wall through a Hologon gets darker by cos^4 of the angle. Stopping down does not help
(the lens was sold with a filter that is dark in its centre). Second row: the rims of a lens at
f/0.95 clip the pupil off the axis. This darkens the corners, and turns lamps out of focus into
cat's eyes; 2D darkens the corners but keeps the discs round. Third row: paler colours toward the
corners. A lens does not cause these, but printing and film do; Daguerre has an effect for them.""",
    (
        Ways(
            "vignetting_natural",
            WALL,
            f'--camera "15 mm" --lens {HOLOGON} --focus 5.6',
            "--f-stop 8",
            _SMALL,
            (f"vignetting:model=lens,lens={HOLOGON},f_stop=8,focus=5.6m",),
            more="--light-paths off",
            note=", cos^4 of a symmetric wide angle",
        ).panels(),
        Ways(
            "vignetting_mounts",
            LAMPS,
            f"--lens {CANON} --focus 1",
            "--f-stop 0.95",
            _SMALL,
            (
                "depth-of-field:f_stop=0.95,focus=1m",
                f"vignetting:model=lens,lens={CANON},f_stop=0.95,focus=1m",
            ),
            needs="--aov depth --gt-time mid",
            more="--light-paths 300000",
            note=", mounts cut the pupil",
        ).panels(),
        (
            Panel("traced, colours as they are", "vignetting_natural_traced"),
            Panel(
                "polynomial", none="No lens takes colour away:\nonly light that it scatters does."
            ),
            Panel(
                "2D, paler toward the corners",
                "vignetting_saturation_2d",
                (
                    post(
                        "vignetting_natural_traced",
                        "vignetting_saturation_2d",
                        "saturation-vignetting:k1=-0.8",
                    ),
                ),
            ),
        ),
    ),
)

_FLARED = f"--lens {BIOTAR} --focus inf"
_SEEN = f"--res 480x320 {DARK} --spp 32 --light-paths off"


def _flare_row(file: str, camera: str, sun: str, note: str) -> tuple[Panel, ...]:
    """Ghosts traced, by polynomials, and made up."""
    seen = f"{camera}{_FLARED}"
    return (
        Panel(
            f"traced{note}",
            f"{file}_traced",
            (render(DUSK, f"{seen} --f-stop 4 {_SEEN} --flare 400000", f"{file}_traced"),),
        ),
        Panel(
            f"polynomial{note}",
            f"{file}_polynomial",
            (
                render(
                    DUSK,
                    f"{seen} --f-stop 4 --lens-model polynomial --degree 9 {_SEEN}",
                    f"{file}_none",
                ),
                f"python script/docs/gallery/polynomial_ghosts.py {OUT}/{file}_none.exr "
                f"{OUT}/{file}_polynomial.exr --lens {BIOTAR} --f-stop 4 --sun={sun}",
            ),
        ),
        Panel(
            f"2D{note}",
            f"{file}_2d",
            (
                render(DUSK, f"{seen} --lens-model pinhole {_SEEN}", f"{file}_pinhole"),
                post(
                    f"{file}_pinhole",
                    f"{file}_2d",
                    "fake-flare:threshold=50,reflectance=0.04,ghosts=12,seed=3",
                ),
            ),
        ),
    )


FLARES = Word(
    "flares",
    "Lens flares",
    """\
The pictures show a sun in the frame, 11 degrees off the axis, through a Biotar of 1927. Its glass
is uncoated, so each surface reflects 4 %, and 45 pairs of surfaces make as many ghosts along the
line through the sun and the centre of the picture. Some are images of the round iris, some have
caustics, and their edges are coloured. The second row shows only the ghosts. In the third row the
camera is turned until the sun is at the very edge, just outside a pinhole's frame; ghosts are
still in the picture.

The polynomial ghosts follow the construction kit of Hullin, Hanika and Heidrich
(script/docs/gallery/polynomial_ghosts.py): a Taylor series of degree 7 for each pair and colour,
about the middle of its light. They include the iris but no other mounts, and take the light of
each ghost from `daguerre lens NAME --flare`; with `--polynomial 7` that command prints the error of
each series. The 2D effect uses neither lens nor sun: its ghosts are invented, and
vanish with the sun. [Scatter](../scatter.md) covers another part of flare: light that barrel,
blades and glass scatter.""",
    (
        _flare_row("flare", "", "-11,4.2", ""),
        (
            Panel("traced, ghosts alone", "flare_traced", layer="flare"),
            Panel("polynomial, ghosts alone", "flare_polynomial", layer="flare"),
            Panel("2D", none="The fake keeps no layer of its own."),
        ),
        _flare_row("flare_aside", "--camera aside ", "-21,4.41", ", sun at the edge"),
    ),
    quality=82,
)

_STARS = "--f-stop 16 --blades 6 --blade-curvature 0"
STARS = Word(
    "stars",
    "Stars",
    """\
At f/16 light diffracts at the six straight blades, and each lamp becomes a star with six spikes.
Daguerre computes the spikes with wave optics from the pupil of the lens, and adds them to the
traced picture; polynomials use the same step. The 2D effect is the same convolution on a pinhole's
picture. This sheet is exposed eight times brighter than the others, so that the spikes show.""",
    (
        Ways(
            "stars",
            FAIR,
            f"--lens {GAUSS} --focus 60",
            f"{_STARS} --diffraction",
            f"--res 480x320 {DARK} --spp 64",
            (
                f"distortion:model=lens,lens={GAUSS},focus=60m,scale=0.9,sensor=36x24",
                "diffraction:f_number=16,blades=6,sensor=36x24",
            ),
            wide=wide(f"--res 480x320 {DARK} --spp 32"),
            more="--light-paths 300000",
        ).panels(),
    ),
    exposure=8.0,
)

BLOOM = Word(
    "bloom",
    "Bloom",
    """\
A soft-focus portrait lens spreads much of the light into a wide disc on purpose: lights bloom, and
the sky between them glows. The 2D bloom is a round glow that falls off as 1 / r^3, of any strength
and width; it is not a disc, and it is the same everywhere in the frame.""",
    (
        Ways(
            "bloom",
            FAIR,
            f"--lens {SOFT} --focus 60",
            "--f-stop 4.8",
            f"--res 480x320 {DARK} --spp 8",
            (
                f"distortion:model=lens,lens={SOFT},focus=60m,scale=0.9,sensor=36x24",
                "bloom:radius=7,share=0.85",
            ),
            wide=wide(f"--res 480x320 {DARK} --spp 32"),
            more="--light-paths 2500000",
        ).panels(),
    ),
)

HALOS = Word(
    "halos",
    "Halos",
    """\
Film has halos: light passes through the emulsion, is reflected at the back of the base, and comes
back as a ring. The ring is red because the red-sensitive layer is next to the base. This happens
behind the lens, so only the darkroom has an effect for it.""",
    (
        (
            Panel(
                "traced, a sensor without halos",
                "halos_traced",
                (
                    render(
                        FAIR,
                        f"--lens {GAUSS} --f-stop 4 --focus 60 --res 960x640 "
                        f"--crop left=0,top=320,right=480,bottom=640 {DARK} "
                        "--spp 24 --light-paths 300000",
                        "halos_traced",
                    ),
                ),
            ),
            Panel("polynomial", none="Halation happens in the film,\nbehind the lens."),
            Panel(
                "2D, on film",
                "halos_2d",
                (post("halos_traced", "halos_2d", "halo:thickness=0.13,share=0.12"),),
            ),
        ),
    ),
    exposure=3.0,
)

WORDS = [SPHERICAL, COMA, AXIAL, LATERAL, CURVATURE, ASTIGMATISM, CYLINDER, DISTORTION]
WORDS += [VIGNETTING, FLARES, STARS, BLOOM, HALOS]
