"""Wrong command lines: each error is one line that says what was meant and what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from daguerre.cli import main

GAUSS = ("--lens", "double-gauss-50mm-f2")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scene, a frame with its pictures, and a text."""
    made = tmp_path_factory.mktemp("wrong")
    assert main(["chart", "slanted-edge", "-o", str(made / "s.glb")]) == 0
    names = [f"-o{made / name}" for name in ("f.exr", "x.png", "x.jpg")]
    assert main(["render", str(made / "s.glb"), "--res", "8x6", "--spp", "1", *names, "-q"]) == 0
    (made / "t.txt").write_text("hello")
    return made


RENDER = [
    ((), "nothing to write: name a picture with -o NAME.exr"),
    (("-o", "a.png", "--aov", "depth"), "--aov needs an .exr output (-o NAME.exr)"),
    (("-o", "a.png", "--samples", "0:2"), "--samples needs an .exr output (-o NAME.exr)"),
    (("-o", "a.png", "--overscan", "8"), "--overscan needs an .exr output (-o NAME.exr)"),
    (("-o", "a.png", "--noisy", "b.png"), "--noisy needs --denoise"),
    (("-o", "a.png", "--gt-time", "mid"), "--gt-time needs ground truth to write"),
    (("-o", "a.png", "--gt-rays", "4"), "--gt-rays needs --gt-lens mean"),
    (("-o", "a.png", "--flare-order", "4"), "--flare-order needs --flare"),
    (("-o", "a.png", "--raymap-frame", "world"), "--raymap-frame needs --export-raymap"),
    (("-o", "a.png", "--export-raymap", "b.png"), "b.png: wanted a name ending in .exr for a map"),
    (("-o", "a.png", "--scatter-barrel", "0.1", *GAUSS), "need --scatter"),
    (("-o", "a.png", "--plate-scale", "2"), "--plate-scale needs --plate"),
    (("-o", "a.png", "--env-lux", "9"), "--env-lux needs an environment: --env or --sky"),
    (("-o", "a.png", "--env-scale", "2"), "--env-scale and --env-rotation need --env"),
    (("-o", "a.png", "--pixel-pitch", "3"), "--pixel-pitch needs --calibration"),
    (
        (
            "-o",
            "a.####.png",
        ),
        "# stands for the frame number and needs --frames",
    ),
    (
        (
            "-o",
            "{camera}.png",
        ),
        "and needs --camera, --calibration or --stereo",
    ),
    (("-o", "a.exr", "--exposure", "on"), "--exposure: wanted light, manual, auto, A, S, P"),
    (("-o", "a.png", "--look", "pretty"), "develop: look (--look): wanted one of neutral"),
    (("-o", "a.png", "--flare", "9"), "flare (--flare): wanted a lens with surfaces"),
    (
        ("-o", "a.png", "--lens", "pinhole", "--f-stop", "2"),
        "f_stop (--f-stop): a pinhole has none",
    ),
    (("-o", "a.png", "--lens-model", "exact"), "lens_model (--lens-model): exact needs a lens"),
    (("-o", "a.png", "--f-stop", "0"), "for a pinhole, set lens to pinhole"),
    (("-o", "a.png", "--f-stop", "1/2"), "2.8, f/2.8 or f2.8; got '1/2' (did you mean f/2?)"),
    (("-o", "a.png", "--f-stop", "1:1.8"), "got '1:1.8' (did you mean f/1.8?)"),
    (("-o", "a.png", "--f-stop", "1/250"), "2.8, f/2.8 or f2.8; got '1/250'\n"),
    (("-o", "a.png", "--f-stop", "f/"), "2.8, f/2.8 or f2.8; got 'f/'\n"),
    (("-o", "a.png", "--exposure-f-stop", "1/4"), "got '1/4' (did you mean f/4?)"),
    (("-o", "a.png", "--t-stop", "1/2", *GAUSS), "T/2.8 or T2.8; got '1/2' (did you mean T/2?)"),
]

OPENINGS = [
    ("--f-stop", "1.4", "error: double-gauss-50mm-f2: f_stop: wanted 2 or more, as"),
    ("--t-stop", "1.4", "error: double-gauss-50mm-f2: t_stop: wanted 2.04 or more, as"),
    ("--zoom", "70", "error: double-gauss-50mm-f2: zoom: wanted 50.01 mm"),
    ("--focus", "0.02", "error: double-gauss-50mm-f2: "),
]

OTHERS = [
    ("render s.glb -o a.png --cluster tcp://10.0.0.9:1", 2, "--insecure-cluster allows tcp://"),
    ("develop x.png -o a.png", 3, "x.png is already developed: develop reads .exr frames"),
    ("develop x.jpg -o a.png", 3, "x.jpg is already developed: develop reads .exr frames"),
    ("develop s.glb -o a.png", 3, "s.glb is a scene: develop reads .exr frames"),
    ("develop t.txt -o a.png", 3, "t.txt: wanted a camera raw file; LibRaw cannot read this one"),
    (
        "develop f.exr -o f.exr",
        2,
        "f.exr: cannot write: this command reads this file; choose another output name",
    ),
    ("develop f.exr -o a.dng", 2, "-o a.dng: f.exr has no raw data; add --sensor NAME"),
    ("develop f.exr -o a.png --iso 0", 2, "--iso: wanted a number above 0, got 0"),
    ("develop f.exr -o a.png --demosaic magic", 2, "demosaic (--demosaic): wanted one of"),
    ("develop f.exr -o a.png --wb purple", 2, "develop: wb (--wb): wanted as-shot, auto"),
    ("post x.png -o a.exr --effect glare", 2, "wanted a scene-linear .exr, got .png: other"),
    ("post f.exr -o a.exr --effect glare:share=1,share=1", 2, "share: wanted once, got twice"),
    ("post f.exr -o a.exr --effect vignetting:model=lens", 2, "model=lens needs a lens, such as"),
    ("post f.exr -o a.exr --effect star:f_number=1/2", 2, "f_number: wanted an f-stop such as"),
    ("merge f.exr -o a.png --keep-sums", 2, "--keep-sums needs an .exr output (-o NAME.exr)"),
    ("lens double-gauss-50mm-f2 --degree 5", 2, "--degree needs --export FILE"),
    ("lens double-gauss-50mm-f2 --ghost 1,2", 2, "--ghost needs --flare ANGLE"),
    ("lens double-gauss-50mm-f2 --polynomial 3", 2, "--polynomial needs --flare ANGLE"),
    ("lens double-gauss-50mm-f2 --flare 9 --polynomial 0", 2, "--polynomial: wanted 1 .. 15"),
    ("lens double-gauss-50mm-f2 --flare 9 --polynomial 16", 2, "--polynomial: wanted 1 .. 15"),
    (
        "lens double-gauss-50mm-f2 --flare 9 --polynomial 3 --cover-glass 2,1",
        2,
        "--polynomial expands the lens alone: leave out --cover-glass",
    ),
    ("lens double-gauss-50mm-f2 --through-focus", 2, "--through-focus needs --psf"),
    ("calibrate double-gauss-50mm-f2 --format ros", 2, "--format needs -o FILE"),
    ("export-scene s.glb -o a.pbrt --camera camera,b", 2, "--camera NAME chooses one"),
    ("composite x.jpg f.exr -o x.jpg", 2, "x.jpg: cannot write: this command reads this file"),
    ("composite x.jpg f.exr -o a.png --resume", 2, "--resume needs --frames"),
    ("light-probe x.jpg -o x.exr --circle 1,2,3", 2, "--circle needs --ball mirror or --ball grey"),
    ("light-probe x.jpg -o a.exr --ev many", 2, "--ev: wanted numbers such as -4,-2,0; got 'many'"),
    ("light-probe x.jpg -o a.exr --ev 1,2", 2, "--ev: wanted 1, one for each photograph, got 2"),
    ("light-probe x.jpg -o a.exr --ball glass", 2, "light_probe: ball (--ball): wanted mirror"),
    ("view s.glb --host 0.0.0.0", 2, "--host 0.0.0.0 needs --token"),
    ("scheduler --host 0.0.0.0", 2, "give --ca, --cert and --key, or --insecure-cluster"),
]

#: Commands that read a file FILE.SUFFIX, whose suffix may choose the format.
READERS = [
    ("render {} -o a.png --dry-run", "glb"),
    ("render s.glb -o a.png --env {} --dry-run", "hdr"),
    ("render s.glb -o a.png --plate {} --background plate --dry-run", "jpg"),
    ("render s.glb -o a.png --like-plate {} --dry-run", "json"),
    ("render s.glb -o a.png --aperture-image {} --dry-run", "png"),
    ("view {}", "glb"),
    ("info {}", "glb"),
    ("merge {} -o a.exr", "exr"),
    ("develop {} -o a.png", "exr"),
    ("post {} -o a.exr --effect glare", "exr"),
    ("post f.exr -o a.exr --recipe {}", "json"),
    ("export-camera {} -o a.usda", "glb"),
    ("export-scene {} -o a.pbrt", "glb"),
    ("match-plate {}", "jpg"),
    ("light-probe {} -o a.exr", "jpg"),
    ("composite {} f.exr -o a.png", "jpg"),
    ("composite x.jpg {} -o a.png", "exr"),
    ("scheduler --ca {0} --cert {0} --key {0}", "pem"),
]


def _said(
    line: list[str], code: int, folder: Path, monkeypatch: pytest.MonkeyPatch, capfd: object
) -> str:
    monkeypatch.chdir(folder)
    capfd.readouterr()  # type: ignore[attr-defined]
    assert main(line) == code
    err: str = capfd.readouterr().err  # type: ignore[attr-defined]
    assert err.startswith("daguerre: error: "), err
    assert err.count("\n") == 1, err
    return err


@pytest.mark.parametrize(("arguments", "said"), RENDER)
def test_flags_of_render(folder, monkeypatch, capfd, arguments, said):
    line = ["render", "s.glb", "--res", "8x6", *arguments, "--dry-run"]
    assert said in _said(line, 2, folder, monkeypatch, capfd)


@pytest.mark.parametrize(("flag", "value", "said"), OPENINGS)
def test_limits_of_a_lens_name_no_path(folder, monkeypatch, capfd, flag, value, said):
    line = ["render", "s.glb", "-o", "a.png", *GAUSS, flag, value, "--dry-run"]
    told = _said(line, 3, folder, monkeypatch, capfd)
    assert said in told
    assert "/library/" not in told


@pytest.mark.parametrize(("line", "code", "said"), OTHERS)
def test_other_commands(folder, monkeypatch, capfd, line, code, said):
    assert said in _said(line.split(), code, folder, monkeypatch, capfd)


@pytest.mark.parametrize(("line", "suffix"), READERS)
def test_missing_files_and_folders_have_one_wording(folder, monkeypatch, capfd, line, suffix):
    (folder / f"folder.{suffix}").mkdir(exist_ok=True)
    for name, fault in (("no", "no such file"), ("folder", "wanted a file, got a folder")):
        words = line.format(f"{name}.{suffix}").split()
        said = _said(words, 3, folder, monkeypatch, capfd)
        assert f"error: {name}.{suffix}: {fault}\n" in said


def test_a_view_that_does_not_exist_costs_no_render(folder, monkeypatch, capfd):
    pytest.importorskip("PyOpenColorIO")
    line = ["render", "s.glb", "-o", "a.png", "--look", "ocio:none", "--dry-run"]
    said = _said(line, 2, folder, monkeypatch, capfd)
    assert "develop: look (--look): wanted ocio: and a view of 'ACES" in said
