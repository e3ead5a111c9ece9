"""``keyposes.html``: the page holds the keyposes, their numbers and beats, and the energy they were found in."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from folk_dancers import dancers
from onbeat.keyposes.extract import Options, find_keyposes
from onbeat.motion import Markers, Motion
from onbeat.viewer.contract import CurveData, unpack_curve, unpack_path
from onbeat.viewer.pages.content import page_data
from onbeat.viewer.pages.keyposes import dotted, write_keypose_page
from onbeat.viewer.pages.page import render_page


def data_in(page: bytes) -> dict[str, Any]:
    (found,) = re.findall(rb'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    return json.loads(found)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    clip = dancers(1)[0]
    found = find_keyposes(clip.motion, clip.beats)
    path = tmp_path_factory.mktemp("page") / "keyposes.html"
    write_keypose_page(path, found, clip.motion, title="Folk", downbeats=clip.beats[1::4], cycle=16)
    return data_in(path.read_bytes())


def test_the_page_holds_the_keyposes(page: dict[str, Any]):
    clip = dancers(1)[0]
    found = find_keyposes(clip.motion, clip.beats)
    assert np.allclose([one["time"] for one in page["keyposes"]], found.times, atol=1e-4)
    assert [one["beat"] for one in page["keyposes"]] == (found.beats + 1).tolist()
    assert [one["source"] for one in page["keyposes"]] == list(found.sources)
    assert page["title"] == "Folk"
    assert page["tempo"] == pytest.approx(104.0)


def test_beats_and_downbeats_are_those_given(page: dict[str, Any]):
    clip = dancers(1)[0]
    assert np.allclose(page["beats"], clip.beats, atol=1e-4)
    assert set(page["downbeats"]) <= set(page["beats"])  # to the digit: so the page finds them
    assert np.allclose(page["downbeats"], clip.beats[1::4], atol=1e-4)


def test_keyposes_of_one_beat_of_the_cycle_have_one_number(page: dict[str, Any]):
    numbers: dict[int, set[int]] = {}
    for one in page["keyposes"]:
        numbers.setdefault(one["beat"] % 16, set()).add(one["number"])
    assert all(len(found) == 1 for found in numbers.values())


def test_the_energy_is_that_which_was_looked_at(page: dict[str, Any]):
    clip = dancers(1)[0]
    found = find_keyposes(clip.motion, clip.beats)
    world = unpack_curve(CurveData(**page["energy"]["world"]))
    there = np.interp(np.arange(len(world)) / page["energy"]["world"]["rate"], found.energy.times, found.energy.world)
    assert np.abs(world * max(found.energy.world.max(), found.energy.local.max()) - there).max() < 0.02
    count = np.isfinite(found.candidates["local"]).sum()
    assert len(page["energy"]["local_candidates"]) == count


def test_where_the_bodys_frame_is_not_known_there_is_no_local_energy(tmp_path: Path):
    clip = dancers(1)[0]
    found = find_keyposes(clip.motion, clip.beats)
    alone = replace(
        found, energy=replace(found.energy, local=np.zeros(0)), candidates={"global": found.candidates["global"]}
    )
    write_keypose_page(tmp_path / "page.html", alone, clip.motion)
    energy = data_in((tmp_path / "page.html").read_bytes())["energy"]
    assert (energy["local"]["base64"], energy["local_candidates"]) == ("", [])
    assert unpack_curve(CurveData(**energy["world"])).max() == 1.0


def test_where_a_pose_faces_is_told(swinger: Motion):
    found = find_keyposes(swinger, np.arange(0.0, 3.9, 0.5))
    facing = [one.facing for one in page_data(swinger, keyposes=found).keyposes]
    assert np.allclose(np.diff(np.unwrap(facing)), np.pi / 2 * np.diff(found.times), atol=0.2)


def test_a_dance_page_takes_keyposes_and_does_without(swinger: Motion):
    found = find_keyposes(swinger, np.arange(0.0, 3.9, 0.5))
    told = data_in(render_page(swinger, keyposes=found))
    assert [one["number"] for one in told["keyposes"]] == list(range(1, len(found) + 1))
    assert np.allclose(told["beats"], found.song_beats)
    plain = data_in(render_page(swinger))
    assert (plain["keyposes"], plain["energy"], plain["beats"]) == ([], None, [])


def test_markers_are_shown_as_dots_where_no_body_fits(tmp_path: Path):
    swing = 0.2 * np.cos(2 * np.pi * np.arange(90) / 30)
    positions = np.random.default_rng(3).uniform(0, 1.6, (5, 3)) + swing[:, None, None]
    positions[20:30, 3] = np.nan
    positions[:, 4] = np.nan
    markers = Markers(["middle", "b", "c", "d", "never"], positions, 30.0)
    motion, shape = dotted(markers)
    seen = np.isfinite(positions[:, 3, 0])
    assert motion.skeleton.names == ("middle_", "middle", "b", "c", "d")
    assert np.allclose(motion.positions[seen, 1:], positions[seen, :4])
    assert len(shape) == 4
    found = find_keyposes(markers, np.arange(0.0, 2.9, 0.5), options=Options(order="global"))
    write_keypose_page(tmp_path / "dots.html", found, markers)
    page = data_in((tmp_path / "dots.html").read_bytes())
    assert len(page["capsules"]) == 4
    assert len(page["keyposes"]) > 2
    places = unpack_path(page_data(motion, shape=shape).path, len(page["joints"]))
    columns = [page["joints"].index(name) for name in ("middle", "b", "c")]
    assert np.abs(places[:, columns] - positions[:, :3]).max() < 1e-3


def test_the_same_keyposes_give_the_same_bytes(tmp_path: Path, swinger: Motion):
    found = find_keyposes(swinger, np.arange(0.0, 3.9, 0.5))
    for name in ("a", "b"):
        write_keypose_page(tmp_path / name, found, swinger)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
