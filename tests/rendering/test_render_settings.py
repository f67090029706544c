"""The record of how a picture is rendered: checked once, travels, and declared in one table."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import json
import pickle
from typing import Any, get_type_hints

import pytest

import daguerre as dg
from daguerre.camera.overscan import Overscan
from daguerre.cli import main
from daguerre.rendering.keywords import RenderKeywords, RigKeywords, SettingsKeywords
from daguerre.rendering.parameters import DEFAULT, FLAGS, TABLE
from daguerre.rendering.settings import GROUPS, names_in

RICH: dict[str, Any] = {
    "spp": 12, "noise": 0.02, "seed": 2**63, "filter": "gaussian:1.5", "resolution": [32, 20],
    "crop": (1, 2, 30, 18), "overscan": Overscan(1, 2, 3, 4), "aovs": True,
    "halves": True, "bands": 8, "cryptomatte": ("object", "asset"), "cryptomatte_ranks": 8,
    "max_depth": 5, "light_paths": (20, 3), "flare": "auto", "flare_order": 4,
    "flare_highlights": "off", "scatter": 7, "diffraction": dg.Diffraction(8, 2),
    "background": "transparent", "see_through": True,
    "gt_time": "open", "gt_lens": "mean", "gt_rays": 16, "motion": True, "strategy": "light",
    "technique": "camera", "dispersion": "end_secondary", "threads": 3,
}  # fmt: skip


def test_every_parameter_is_tried_here() -> None:
    assert set(RICH) == set(TABLE)


def test_settings_travel() -> None:
    rich = dg.RenderSettings.of(**RICH)
    for made in (
        pickle.loads(pickle.dumps(rich)),
        copy.deepcopy(rich),
        dg.RenderSettings.of(**rich.values()),
    ):
        assert made == rich
        assert hash(made) == hash(rich)
    assert rich != dg.RenderSettings()
    assert "flare_order=4" in repr(rich)
    text = json.dumps(rich.to_json())
    again = dg.RenderSettings.from_json(json.loads(text))
    assert again.with_(overscan=RICH["overscan"]) == rich
    assert json.dumps(again.to_json()) == text
    assert dg.RenderSettings.from_json({}) == dg.RenderSettings()


def test_values_have_one_form() -> None:
    rich = dg.RenderSettings.of(**RICH)
    assert rich.film.resolution == (32, 20)
    assert rich.light.flare_highlights is False
    assert rich.light.scatter == 7.0
    assert rich.diffraction == dg.Diffraction(8, 2)
    with pytest.raises(dataclasses.FrozenInstanceError):
        rich.threads = 1  # type: ignore[misc]


def test_defaults_stand_in_the_table_alone() -> None:
    assert dg.RenderSettings().values() == DEFAULT
    assert [n for kind in GROUPS.values() for n in names_in(kind)] == [
        name for name in TABLE if name != "threads"
    ]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"sampling": {"sed": 1}}, "settings: sampling: no parameter 'sed' .*'seed'"),
        ({"film": 3}, "settings: film: wanted parameters by name, got 3"),
        ({"films": {}}, "settings: no parameter 'films'"),
        ({"threads": 2000}, "threads: wanted 0 .all. .. 1024, got 2000"),
        ({"threads": None}, "threads: wanted a whole number, got None"),
        ({"light": {"diffraction": {"band": 3}}}, "settings: diffraction: no parameter 'band'"),
        ({"x" * 5000: 1}, r"settings: no parameter '.{,80}\.\.\."),
    ],
)
def test_bad_json_is_refused(data: dict[str, Any], message: str) -> None:
    with pytest.raises(dg.UsageError, match=message):
        dg.RenderSettings.from_json(data)


FACES = {
    dg.Session: SettingsKeywords,
    dg.render: RenderKeywords,
    dg.iter_render: RenderKeywords,
    dg.render_rig: RigKeywords,
}


@pytest.mark.parametrize("face", FACES)
def test_signatures_and_docstrings_show_every_parameter(face: Any) -> None:
    shown = inspect.signature(face).parameters
    assert not [p for p in shown.values() if p.kind is p.VAR_KEYWORD]
    for name in FACES[face].__annotations__:
        assert shown[name].default == DEFAULT[name]
        assert f"    {name}: " in (face.__doc__ or "")


def test_keywords_have_the_types_of_the_fields() -> None:
    fields: dict[str, Any] = {"threads": get_type_hints(dg.RenderSettings)["threads"]}
    for group in GROUPS.values():
        fields |= get_type_hints(group)
    assert get_type_hints(RenderKeywords) == fields
    with pytest.raises(TypeError, match=r"no parameter 'max_deth' .*'max_depth'"):
        dg.Session(dg.Scene(), max_deth=3)  # type: ignore[call-arg]


TOO_FAR = {
    "threads": ("2000", 2000),
    "max_depth": ("5000", 5000),
    "seed": ("-1", -1),
    "spp": ("3000000000", 3_000_000_000),
    "gt_rays": ("70000", 70000),
    "bands": ("65", 65),
    "filter": ("box:99", "box:99"),
    "light_paths": ("1,2,3", (1, 2, 3)),
    "flare": ("-1", -1),
    "flare_order": ("3", 3),
    "noise": ("1.5", 1.5),
    "gt_lens": ("thick", "thick"),
}


@pytest.mark.parametrize("name", TOO_FAR)
def test_the_flag_and_the_record_refuse_alike(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    text, value = TOO_FAR[name]
    with pytest.raises(dg.UsageError) as refused:
        dg.RenderSettings.of(**{name: value})
    flag = FLAGS.flag(name)
    assert main(["render", "none.glb", "-o", "a.exr", "--aov", "N", f"{flag}={text}"]) == 2
    said = capsys.readouterr().err.strip()
    limit = str(refused.value).removeprefix(f"{name}: ").partition("got")[0]
    assert said.startswith(f"daguerre: error: {flag}: {limit}")


def test_samples_of_a_pass_have_the_limit_of_samples(capsys: pytest.CaptureFixture[str]) -> None:
    flags = ["-o", "a.exr", "--samples", "0:3000000000"]
    assert main(["render", "none.glb", *flags]) == 2
    assert "--samples 0:3000000000: wanted 1 .. 2^31, got 3000000000" in capsys.readouterr().err
