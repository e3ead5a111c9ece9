"""``retimed.html``: both dances are on the music's clock, and what lies between them is what is coloured."""

from __future__ import annotations

import base64
import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from onbeat.errors import OnbeatError
from onbeat.examples import embedded_song
from onbeat.limits.learned import learned_limits
from onbeat.limits.limits import Limits
from onbeat.motion import Motion
from onbeat.motion.joint_angles import JointAngles
from onbeat.music.song import Song
from onbeat.retime.lock import TimeMap, lock
from onbeat.retime.retime import Retimed, retime
from onbeat.retime.sources import Table, source_of
from onbeat.viewer.contract import CurveData, PathData, unpack_curve, unpack_path
from onbeat.viewer.pages.retime import on_music_clock, retime_page, write_retime_page
from onbeat.viewer.plots.retime_curves import over_limits

BEATS = np.arange(8) * 0.5
KEYPOSES = np.arange(0.5, 4.0, 1.0)


def data_in(page: bytes) -> dict[str, Any]:
    (found,) = re.findall(rb'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    return json.loads(found)


@pytest.fixture(scope="module")
def result(swinger: Motion) -> Retimed:
    return retime(source_of(swinger), TimeMap.steady(1.4), learned_limits([swinger]), BEATS, KEYPOSES)


@pytest.fixture(scope="module")
def page(result: Retimed, swinger: Motion) -> dict[str, Any]:
    return data_in(retime_page(result, swinger))


def shown(page: dict[str, Any], body: dict[str, Any], joint: str) -> np.ndarray:
    path = PathData(**body["path"])
    return unpack_path(path, len(body["joints"]))[:, body["joints"].index(joint)]


def test_the_original_is_at_its_own_time_at_each_second_of_the_music(
    page: dict[str, Any], result: Retimed, swinger: Motion
):
    wrist = swinger.skeleton.index("LeftHand")
    times = np.arange(page["frames"]) / page["fps"]
    wanted = swinger.at(np.minimum(1.4 * times, (len(swinger) - 1) / swinger.fps)).positions[:, wrist]
    assert shown(page, page["compared"]["body"], "LeftHand") == pytest.approx(wanted, abs=1e-3)
    danced = result.dance
    assert isinstance(danced, Motion)
    assert shown(page, page, "LeftHand") == pytest.approx(danced.positions[:, wrist], abs=1e-3)


def test_the_colours_are_what_lies_between_both(page: dict[str, Any]):
    heat = page["compared"]["heat"]
    levels = np.frombuffer(base64.b64decode(heat["base64"]), np.uint8).reshape(page["frames"], -1)
    hand = page["joints"].index("LeftHand")
    apart = 100 * np.linalg.norm(
        shown(page, page, "LeftHand") - shown(page, page["compared"]["body"], "LeftHand"), axis=1
    )
    assert apart.max() > 0.5
    told = levels[:, hand] * heat["most"] / 254
    assert told == pytest.approx(np.minimum(apart, heat["most"]), abs=heat["most"] / 100)
    assert unpack_curve(CurveData(**page["motion_intensity"])).max() == 1.0


def test_beats_and_keyposes_are_where_they_are_now(page: dict[str, Any], result: Retimed):
    inside = BEATS[page["duration"] >= BEATS / 1.4] / 1.4
    assert page["beats"] == pytest.approx(inside, abs=1e-4)
    assert page["tempo"] == pytest.approx(120 * 1.4, rel=1e-3)
    assert [one["time"] for one in page["keyposes"]] == pytest.approx(result.measures.keyposes, abs=1e-4)
    assert [(one["number"], one["beat"]) for one in page["keyposes"]] == [(1, 2), (2, 4), (3, 6), (4, 8)]
    assert {one["source"] for one in page["keyposes"]} == {"kept"}


def test_both_have_their_names(page: dict[str, Any]):
    compared = page["compared"]
    assert compared["captions"] == ["retimed (qp)", "original"]
    assert (compared["who"], compared["name"]) == ("original", "the original")
    assert (page["title"], page["method"]) == ("swinger", "qp")


def test_figures_tell_what_was_over_and_is_not_now(page: dict[str, Any], result: Retimed):
    told = {metric["name"]: metric["value"] for metric in page["metrics"]}
    wished = int(over_limits(result, result.demand.wish).sum())
    assert wished > 0
    assert told["joints over limits, original"] == f"{wished} of {len(result.source.joints)}"
    assert told["joints over limits, retimed"] == f"0 of {len(result.source.joints)}"
    assert told["keyposes inside the limits"] == "4 of 4"
    assert told["speed"] == "1.4×"


def test_a_keypose_that_is_out_of_reach_is_told(swinger: Motion):
    slow = Limits("slow", tuple(swinger.skeleton.names), -np.inf, np.inf, 0.5)
    found = retime(source_of(swinger), TimeMap.steady(1.0), slow, BEATS, BEATS)
    words = {one["source"] for one in data_in(retime_page(found, swinger))["keyposes"]}
    assert "out of reach" in words


def test_a_dance_that_begins_later_waits_in_its_first_pose(swinger: Motion):
    limits = learned_limits([swinger])
    late = retime(source_of(swinger), lock(1.5 + BEATS / 1.2, BEATS), limits, BEATS, KEYPOSES)
    assert late.start == pytest.approx(1.5)
    shown_, wished = on_music_clock(late, swinger)
    assert len(shown_) == len(wished) == 90 + len(late.dance)
    assert np.allclose(wished.positions[:91], swinger.positions[0], atol=0.02)
    assert np.allclose(shown_.positions[:90], shown_.positions[90])
    times = np.arange(90, len(wished)) / swinger.fps
    assert np.allclose(wished.positions[90:], swinger.at(late.warp(times)).positions)


def test_a_song_brings_its_downbeats_its_tempo_and_its_sound(swinger: Motion):
    song, samples, rate = embedded_song(seconds=9.0)
    found = retime(source_of(swinger), lock(song.beats[:8], BEATS), learned_limits([swinger]), BEATS, KEYPOSES)
    page = data_in(retime_page(found, swinger, song, (samples, rate), "Swing"))
    assert page["title"] == "Swing"
    assert page["tempo"] == song.tempo
    assert set(page["downbeats"]) <= set(page["beats"])
    assert page["downbeats"] == pytest.approx(song.downbeats[: len(page["downbeats"])], abs=0.005)
    assert page["audio"]["seconds"] == pytest.approx(9.0, abs=0.1)


def test_without_beats_and_keyposes_there_is_a_page(result: Retimed, swinger: Motion):
    bare = replace(result, beats=np.zeros(0))
    page = data_in(retime_page(bare, swinger, Song(2.0, 0.0, 4, [], [], [], [0, 1], [0, 0])))
    assert (page["beats"], page["downbeats"], page["tempo"]) == ([], [], 0.0)
    assert {one["beat"] for one in page["keyposes"]} == {1}


def test_the_same_result_gives_the_same_bytes(result: Retimed, swinger: Motion, tmp_path: Path):
    write_retime_page(tmp_path / "a.html", result, swinger)
    assert (tmp_path / "a.html").read_bytes() == retime_page(result, swinger)


def test_what_has_no_body_has_no_page(swinger: Motion, result: Retimed):
    table = Table(JointAngles(("elbow",), np.sin(np.arange(60))[:, None], 60.0, "arm"))
    angles = retime(table, TimeMap.steady(1.0), Limits("arm", ("elbow",), -2, 2, 99.0), BEATS[:3], np.zeros(0))
    with pytest.raises(OnbeatError, match=r"arm is a table of angles and has no body to show; .* a figure of both"):
        retime_page(angles, swinger)
    other = replace(result, dance=swinger)
    stranger = Motion(swinger.skeleton.__class__(("top",), [-1], [[0, 0, 0]]), np.ones((2, 1, 4)), np.zeros((2, 3)), 60)
    with pytest.raises(OnbeatError, match="the original has 1 joints and the retimed dance"):
        retime_page(other, stranger)
