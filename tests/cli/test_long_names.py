"""Names that no file can have: longer than a file system takes, or with a zero byte in a scene."""

from __future__ import annotations

from pathlib import Path

import pytest

from daguerre.cli import main

LONG = "a" * 300
STAGE = """#usda 1.0
( defaultPrim = "W" )
def Xform "W" {{
  def "r" (references = @{name}@) {{
  }}
  def Material "m" {{
    token outputs:surface.connect = </W/m/s.outputs:surface>
    def Shader "s" {{
      uniform token info:id = "UsdPreviewSurface"
      color3f inputs:diffuseColor.connect = </W/m/t.outputs:rgb>
      token outputs:surface
    }}
    def Shader "t" {{
      uniform token info:id = "UsdUVTexture"
      asset inputs:file = @{name}.png@
      color3f outputs:rgb
    }}
  }}
  def Mesh "square" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    rel material:binding = </W/m>
  }}
}}
"""


@pytest.mark.parametrize(
    "words",
    [
        "info {n}.usda",
        "info {n}.xml",
        "render s.glb --calibration {n}.yaml -o x.png",
        "render s.glb --calibration {n}.txt -o x.png",
        "render s.glb --calibration {n} -o x.png",
        "render s.glb --calibration {n}.json:left -o x.png",
        "match-plate {n}.jpg",
        "match-plate {n}.jpg -o x.json",
        "lens {n}.zmx",
        "sensor {n}.json",
        "develop {n}.dng -o x.png",
        "post {n}.exr -o x.exr --recipe {n}.json",
        "light-probe {n}.jpg -o x.exr",
    ],
)
def test_a_name_that_is_too_long_is_one_error(
    words: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(words.format(n=LONG).split()) in (2, 3, 5)
    error = capsys.readouterr().err
    assert error.count("daguerre: error:") == 1
    assert "internal error" not in error


def test_a_stage_may_name_files_that_no_file_system_has(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    file = tmp_path / "stage.usda"
    file.write_text(STAGE.format(name=LONG))
    assert main(["info", str(file)]) in (0, 3)
    said = capsys.readouterr()
    assert "internal error" not in said.err
    assert LONG[:40] in said.out + said.err
