"""``judge.html`` and the pictures of motions in few dimensions."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from folk_dancers import spaces_of
from onbeat.errors import MetricError
from onbeat.keyposes.judging import SPACES, trials
from onbeat.keyposes.lowdim import LowDimensional
from onbeat.viewer.pages.judge import FPS, LONGEST, stretches, write_judge_page
from onbeat.viewer.plots.lowdim import write_lowdim_figures
from onbeat.viewer.plots.lowdim_pictures import (
    CAPTION,
    both_sides,
    dimensions_picture,
    most_different,
    posture_picture,
    telling_frame,
)


def asked(found: LowDimensional) -> list[Any]:
    return trials([one.person for one in found.taught], np.random.default_rng(0))


def data_of(page: bytes) -> dict[str, Any]:
    (data,) = re.findall(rb'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    return json.loads(data)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("judge") / "judge.html"
    write_judge_page(path, spaces_of(3), asked(spaces_of(3)))
    return path.read_bytes()


def test_the_page_holds_all_it_needs(page: bytes):
    assert not re.findall(rb"""(?:src|href)=["']?(?!["'])|https?://""", page)
    data = data_of(page)
    assert {trial["motion"] for trial in data["trials"]} == set(data["motions"]) == {"Aiko", "Bruno", "Carla"}


def test_what_is_drawn_are_the_motions(page: bytes):
    found, data = spaces_of(3), data_of(page)
    one, (shown,) = found.taught[1], data["motions"]["Bruno"]
    times = one.start + np.arange(shown["frames"]) / FPS
    assert shown["frames"] / FPS == pytest.approx(one.end - one.start, abs=0.1)
    for name, motion in {"original": found.motions[1], **{s: found.motion(1, s) for s in SPACES}}.items():
        places = np.reshape(shown["paths"][name], (shown["frames"], -1, 3)) / 1000
        true = motion.at(times).positions[:, one.vectors.joints]
        between = [np.linalg.norm(p[:, :, None] - p[:, None], axis=-1) for p in (places, true)]
        assert np.abs(between[0] - between[1]).max() < 0.003  # all but place and facing, to whole millimetres
        assert places[..., 1].min() > -0.08
        low, high = np.array(shown["box"]).reshape(2, 2).T
        assert (places[..., :2] * 1000 >= low - 1).all()
        assert (places[..., :2] * 1000 <= high + 1).all()


def test_the_dancers_left_is_on_the_viewers_right(page: bytes):
    data = data_of(page)
    names = spaces_of(3).vectors[0].points
    places = np.reshape(data["motions"]["Aiko"][0]["paths"]["original"], (-1, len(names), 3))
    assert (places[:, names.index("left_hip"), 0] > places[:, names.index("right_hip"), 0]).mean() > 0.95


def test_repeats_show_other_stretches(page: bytes, tmp_path: Path):
    found, people = spaces_of(3), ["Aiko", "Bruno", "Carla"]
    one, (spans,) = found.taught[1], [stretches(found, 1, 3)]
    assert stretches(found, 1, 1) == [(one.start, pytest.approx(min(one.end, one.start + LONGEST)))]
    assert spans[0][0] == one.start
    starts = np.sort([start for start, _ in spans])
    assert np.diff(starts).min() > 1.0
    assert starts[0] >= found.tested[1].spans[0][0]
    assert max(end for _, end in spans) <= found.tested[1].spans[-1][1] + 1e-9
    write_judge_page(tmp_path / "judge.html", found, trials(people, np.random.default_rng(0), 3))
    data = data_of((tmp_path / "judge.html").read_bytes())
    shown = [one["paths"]["original"] for one in data["motions"]["Bruno"]]
    assert len(shown) == 3
    assert shown[0] != shown[1] != shown[2]
    assert data["key"] != data_of(page)["key"]


def test_a_dance_of_one_cycle_has_shorter_stretches():
    found = spaces_of(2)
    whole = ((found.taught[0].start, found.taught[0].end),)
    single = replace(found, tested=(replace(found.tested[0], spans=whole), *found.tested[1:]))
    spans = stretches(single, 0, 4)
    assert len({start for start, _ in spans}) == 4
    assert max(end for _, end in spans) <= single.taught[0].end + 1e-9


def test_names_cannot_end_the_script(tmp_path: Path):
    found = spaces_of(2)
    hostile = "</script><b>"
    renamed = replace(found, taught=tuple(replace(one, person=f"{hostile}{n}") for n, one in enumerate(found.taught)))
    write_judge_page(tmp_path / "judge.html", renamed, asked(renamed))
    assert hostile.encode() not in (tmp_path / "judge.html").read_bytes()


def test_the_same_trials_give_the_same_bytes(page: bytes, tmp_path: Path):
    write_judge_page(tmp_path / "judge.html", spaces_of(3), asked(spaces_of(3)))
    assert (tmp_path / "judge.html").read_bytes() == page


def test_trials_of_other_motions_are_refused(tmp_path: Path):
    with pytest.raises(MetricError, match="cannot be asked"):
        write_judge_page(tmp_path / "judge.html", spaces_of(2), asked(spaces_of(3)))
    with pytest.raises(MetricError, match="cannot be asked"):
        write_judge_page(tmp_path / "judge.html", spaces_of(2), [])


def test_pictures_stand_beside_each_other():
    found = spaces_of(3)
    which, frame = most_different(found)
    picture = posture_picture(found, which, frame, (60, 80))
    assert picture.shape == (160, 180, 3)
    left, middle, right = np.split(picture.astype(np.float64), 3, axis=1)
    assert 0 < np.abs(left - middle).mean() < np.abs(right - middle).mean()  # keyposes are nearer
    assert dimensions_picture(found, 0, telling_frame(found, 0), (60, 80)).shape == (80, 300, 3)


def test_both_sides_are_shown_each_picked_against_one_space():
    found, size = spaces_of(2), (60, 80)
    against = [most_different(found), most_different(found, "uniform", "keyposes")]
    assert against[0] != against[1]
    off = {
        name: [np.linalg.norm(found.poses(w, name)[f] - found.vectors[w].values[f]) for w, f in against]
        for name in SPACES
    }
    assert off["keyposes"][0] < off["uniform"][0]
    assert off["keyposes"][1] > off["uniform"][1]
    shown = both_sides(found, None, size)
    for picked, part in zip(against, (shown[:, :180], shown[:, -180:]), strict=True):
        assert np.array_equal(part[CAPTION:], posture_picture(found, *picked, size))
        assert part[:CAPTION].min() < 150  # how it was picked
    one = both_sides(found, [None, against[1]], size)
    assert one[CAPTION:, :180].min() == 255
    assert np.array_equal(one[CAPTION:, -180:], shown[CAPTION:, -180:])


def test_figures_are_the_same_bytes_each_time(tmp_path: Path):
    folders = [tmp_path / name for name in "ab"]
    for folder in folders:
        folder.mkdir()
        names = write_lowdim_figures(folder, spaces_of(2), 1)
    assert len(names) == 8
    assert all((folders[0] / name).read_bytes() == (folders[1] / name).read_bytes() for name in names)
