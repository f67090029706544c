"""Pictures of the page of calibrated cameras: one desk through files of four cameras."""

from __future__ import annotations

from photographs import OUT, Photograph, Sheet

INTRODUCTION = """# Calibrated cameras

See one desk ([scenes/calibrated.py](../../scenes/calibrated.py)) through calibration files of
OpenCV, ROS and Kalibr. [Projections](../projections.md) and [calibration
files](../calibration-files.md) explain them. Every ray is traced through the camera model; nothing
is warped afterwards. To make the scene:

```
python scenes/calibrated.py
mkdir -p out
```

The scene has the light of a bright day, so the commands meter it with `--exposure auto`. They need
the extras `calibration` and `denoise`; `depth_map.py` and `coco_boxes.py` need the extra `plot`.
"""
SCENE = "daguerre render out/calibrated/desk.glb"
FILES = "scenes/calibrated"
DRAWN = "--spp 32 --denoise --exposure auto"
PHONE = f"--camera phone --calibration {FILES}/phone.yaml --pixel-pitch 1.4 --f-stop 1.8 --focus 1"


def _phone() -> Sheet:
    command = (
        f"{SCENE} {PHONE} --shutter 1/250 --rolling top,16ms --time 0.5 --res 25% {DRAWN} "
        f"-o {OUT}/phone.png"
    )
    caption = "phone: OpenCV, Brown-Conrady, 3.8 mm f/1.8"
    text = (
        "[phone.yaml](../../scenes/calibrated/phone.yaml), 4032 x 3024 photosites of 1.4 um, "
        "rendered at a quarter of the size. The rail and the edge of the desk are curved by the "
        "barrel distortion that a phone's software would correct later."
    )
    shot = Photograph(caption, (command,), "phone.png")
    return Sheet("calibrated_phone", "A phone", text, 1, (shot,))


def _truth() -> Sheet:
    given = f"{SCENE} {PHONE} --shutter 1/250 --rolling top,16ms --time 0.5 --res 20%"
    out = f"{OUT}/known"
    first = (
        f"{given} {DRAWN} -o {out}.exr -o {out}.png --coco {out}.json "
        f"--categories {FILES}/categories.json",
        f"{given} --export-stmap-undistort {out}_undistort.exr",
    )
    boxes = f"python script/docs/gallery/coco_boxes.py {out}.json {out}.png {out}_boxes.png"
    straight = (
        f"daguerre post {out}.exr -o {out}_straight.exr --effect stmap:file={out}_undistort.exr",
        f"daguerre develop {out}_straight.exr -o {out}_straight.png",
    )
    text = (
        "Boxes and masks ([ground truth](../ground-truth.md#boxes-and-masks)) follow the lens and "
        "the time of each row. Right: the picture straightened by the camera's own map "
        "([STMaps](../plates.md#stmaps)), as a phone or Nuke would do it; the rail is straight."
    )
    shots = (
        Photograph("what is where: a COCO file", (boxes,), "known_boxes.png"),
        Photograph("straightened by an STMap", straight, "known_straight.png"),
    )
    return Sheet("calibrated_truth", "Labels, and the picture undistorted", text, 2, shots, first)


def _shutters() -> Sheet:
    shots = []
    crop = "--crop left=320,top=430,right=740,bottom=830"
    common = f"{PHONE} --shutter 1/2000 --time 0.5 --res 50% {crop}"
    for name, title, flag in (
        ("global", "all rows at once", ""),
        ("rolling", "rolling, 16 ms", " --rolling top,16ms"),
    ):
        file = f"fan_{name}.png"
        command = f"{SCENE} {common}{flag} --spp 48 --denoise --exposure auto -o {OUT}/{file}"
        shots.append(Photograph(title, (command,), file))
    text = (
        "The fan turns 45 times a second, and keeps turning while the phone reads its rows from "
        "the top, so each row of the distorted picture shows it at another time."
    )
    return Sheet("calibrated_shutters", "The phone's rolling shutter", text, 2, tuple(shots))


def _fisheye() -> Sheet:
    command = (
        f"{SCENE} --camera fisheye --calibration {FILES}/fisheye.yaml --pixel-pitch 3 --f-stop 2.4 "
        f"--ev 0.7 --res 900x900 {DRAWN} -o {OUT}/fisheye.png"
    )
    text = (
        "[fisheye.yaml](../../scenes/calibrated/fisheye.yaml), Kannala-Brandt: it sees the "
        "window and the bookcase at its sides, and a little of the room behind it. The picture "
        "ends where the polynomial stops increasing."
    )
    shot = Photograph("fisheye: ROS, equidistant, 190 degrees", (command,), "fisheye.png")
    return Sheet("calibrated_fisheye", "A fisheye of 190 degrees", text, 1, (shot,))


def _stereo() -> Sheet:
    pair = (
        f"{SCENE} --camera rig --calibration {FILES}/stereo.yaml:all --pixel-pitch 3 --f-stop 2.2 "
        f"--focus 1 --res 50% --aov depth --gt-time mid {DRAWN} "
        f"-o {OUT}/stereo.{{camera}}.exr -o {OUT}/stereo.{{camera}}.png"
    )
    shots = []
    for camera, side in (("cam0", "left"), ("cam1", "right")):
        shots.append(Photograph(f"{side}: {camera} of Kalibr's chain", (), f"stereo.{camera}.png"))
    for camera, side in (("cam0", "left"), ("cam1", "right")):
        file = f"depth.{camera}.png"
        program = "python script/docs/gallery/depth_map.py"
        command = f"{program} {OUT}/stereo.{camera}.exr {OUT}/{file} 0.4 1.3"
        shots.append(Photograph(f"depth, {side}", (command,), file))
    text = (
        "[stereo.yaml](../../scenes/calibrated/stereo.yaml): two cameras 0.12 m apart. One command "
        "renders both and builds the scene once. Depth is exact for each pixel: along the axis of "
        "its camera, in the middle of the exposure."
    )
    return Sheet("calibrated_stereo", "A stereo rig and its depth", text, 2, tuple(shots), (pair,))


SHEETS = (_phone(), _truth(), _shutters(), _fisheye(), _stereo())
#: The row in the gallery: pictures of the sheets, smaller.
OVERVIEW = (("phone.png", "fisheye.png"), ("stereo.cam0.png", "depth.cam0.png"))
