"""A frame with an open shutter is the mean of still frames over the same time, whatever moves.

Each case must fail to be that with the blur left out: otherwise it would show nothing.
"""

from __future__ import annotations

import pytest

from tests.support.formats import motion_files
from tests.support.pictures.blur import blurred, disagreement, frozen, mean_of_stills
from tests.support.scene import motion_scenes

BATCHES = 6
MOMENTS = 12
SAMPLES = 12


@pytest.mark.parametrize("name", motion_scenes.ALL)
def test_blur_is_the_mean_of_still_frames(name):
    case = motion_scenes.ALL[name]()
    wanted = mean_of_stills(case, BATCHES, MOMENTS, SAMPLES)
    assert disagreement(blurred(case, BATCHES, MOMENTS * SAMPLES), wanted) == []
    assert disagreement(frozen(case, BATCHES, MOMENTS * SAMPLES), wanted) != []


@pytest.mark.slow
@pytest.mark.parametrize("name", motion_scenes.SLOW)
def test_blur_is_the_mean_of_still_frames_through_a_traced_lens(name):
    case = motion_scenes.SLOW[name]()
    wanted = mean_of_stills(case, BATCHES, MOMENTS, SAMPLES)
    assert disagreement(blurred(case, BATCHES, MOMENTS * SAMPLES), wanted) == []
    assert disagreement(frozen(case, BATCHES, MOMENTS * SAMPLES), wanted) != []


@pytest.mark.parametrize("name", motion_files.ALL)
def test_what_a_file_animates_is_blurred(name, tmp_path):
    case = motion_files.file_case(name, tmp_path)
    wanted = mean_of_stills(case, BATCHES, MOMENTS, SAMPLES)
    assert disagreement(blurred(case, BATCHES, MOMENTS * SAMPLES), wanted) == []
    assert disagreement(frozen(case, BATCHES, MOMENTS * SAMPLES), wanted) != []
