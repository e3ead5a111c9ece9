"""``onbeat observe`` as a user runs it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from onbeat.cli.observe_input import embedded, in_repetition
from onbeat.formats import write_motion

Run = Callable[..., tuple[int, str, str]]
FILES = ("slow_1.npz", "slow_2.npz", "fast_1.npz", "fast_2.npz")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two takes of the folk dance at speeds 1.0 and 1.5, their beats beside them, keyposes beside the first."""
    place = tmp_path_factory.mktemp("takes")
    dance = embedded("folk dance", seed=3, takes=2)
    assert dance.keyposes is not None
    for take, name in zip((*dance.takes[:2], *dance.takes[4:]), FILES, strict=True):
        write_motion(take.motion, place / name)
        (place / name).with_suffix(".beats").write_text("".join(f"{beat:.4f}\n" for beat in take.beats))
    seconds = dance.takes[0].beats[0] + dance.keyposes * np.diff(dance.takes[0].beats).mean()
    (place / "slow_1.keyposes.csv").write_text("".join(f"{second:.3f}\n" for second in seconds))
    (place / "few.beats").write_text("1.0\n")
    (place / "none.csv").write_text("0.5\n999\n")
    return place


def test_without_motions_both_insights_come_out(onbeat: Run) -> None:
    _, out, _ = onbeat("observe")
    assert "Aiko, folk dance: cycles of 12 beats, 5 at 1×, 5 at 1.2×, 5 at 1.5×; 12 joints" in out
    status, out, err = onbeat("observe", "--json")
    assert (status, err) == (0, "")
    told = json.loads(out)
    slow, middle, fast, every = told["curves"]
    assert min(told["likeness"]) > 0.9
    assert abs(told["likeness_shifted"][0]) < 0.2
    assert [each["repetitions"] for each in told["curves"]] == [5, 5, 5, 15]
    # Insight 1: the fine layers go first.
    assert fast["ratio"][3] < 0.2 < middle["ratio"][3] < 0.6
    assert fast["ratio"][0] > 0.85
    assert told["layers"][3]["slope"][2] < -1.2 < told["layers"][0]["slope"][1]
    # Insight 2: the keyposes are where nothing varies.
    (score,) = told["scores"]
    assert score["f"] > score["chance"] + 1.64 * score["chance_deviation"]
    assert score["f"] > score["beat_chance"]
    assert score["precision"] > 0.75
    assert max(score["contrast"]) < 0.75
    assert len(told["beats"]) == len(every["variance"]) == len(slow["drawn_mean"][0]) == 12 * 32 + 1


def test_the_same_takes_give_the_same_bytes(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    for place in ("a", "b"):
        status, _, _ = onbeat("observe", *(folder / name for name in FILES), "-o", tmp_path / place)
        assert status == 0
    names = {f"{name}{ending}" for name in ("means", "variance", "layers") for ending in (".png", ".svg")}
    assert {path.name for path in (tmp_path / "a").iterdir()} == names | {"observe.json"}
    for path in (tmp_path / "a").iterdir():
        assert path.read_bytes() == (tmp_path / "b" / path.name).read_bytes(), path.name


def test_speeds_are_found_from_the_beats_or_given(onbeat: Run, folder: Path) -> None:
    paths = [folder / name for name in FILES]
    status, out, err = onbeat("observe", *paths, "--json")
    assert status == 0
    assert [each["speed"] for each in json.loads(out)["curves"]] == [1.0, 1.5, 0.0]
    assert "speed 1.5: 2 takes at 156 beats a minute" in err
    _, out, _ = onbeat("observe", *paths, "--json", "--speeds", "1,1.4")
    assert [each["speed"] for each in json.loads(out)["curves"]] == [1.0, 1.4, 0.0]
    _, out, _ = onbeat("observe", *paths, "--json", "--speeds", "1,1,1.3,1.6")
    told = json.loads(out)["curves"]
    assert [(each["speed"], each["repetitions"]) for each in told] == [(1, 2), (1.3, 1), (1.6, 1), (0, 4)]
    assert told[1]["variance"] == []
    assert told[1]["rms"]
    assert [len(each["slope"]) for each in json.loads(out)["layers"]] == [1] * 5


def test_keyposes_lie_beside_the_first_motion_or_are_given(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    paths = [folder / name for name in FILES]
    _, out, _ = onbeat("observe", *paths, "--json")
    assert json.loads(out)["scores"][0]["keyposes"] == pytest.approx([0, 1, 2, 4, 5, 6, 8, 10], abs=0.01)
    _, out, _ = onbeat("observe", *paths[::-1], "--json")
    assert json.loads(out)["scores"] == []
    status, _, _ = onbeat("keyposes", paths[0], "--beats", paths[0].with_suffix(".beats"), "-o", tmp_path)
    assert status == 0
    status, out, _ = onbeat("observe", *paths, "--keyposes", tmp_path / "keyposes.json", "--json")
    assert status == 0
    found = json.loads((tmp_path / "keyposes.json").read_text())["keyposes"]
    assert len(json.loads(out)["scores"][0]["keyposes"]) == len(found)


def test_cycles_of_one_take_need_no_other(onbeat: Run, folder: Path) -> None:
    status, out, err = onbeat("observe", folder / "slow_1.npz", "--cycle", "4", "--joints", "left_shoulder,Head")
    assert status == 0
    assert "cycles of 4 beats, 3 at 1×; 2 joints" in out
    assert "slope" not in out
    assert "cycles of slow_1.npz (" in err
    assert "does the dance repeat after 4 beats?" in err


def test_takes_of_different_dances_are_told(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    strange = embedded("river dance", takes=1).takes[0]
    write_motion(strange.motion, tmp_path / "river.npz")
    (tmp_path / "river.beats").write_text("".join(f"{beat:.4f}\n" for beat in strange.beats))
    status, out, err = onbeat("observe", folder / "slow_1.npz", folder / "slow_2.npz", tmp_path / "river.npz")
    assert status == 0
    assert "river.npz (0.0" in err
    assert "does not look like the others" in err
    assert "likeness of the takes: 0.3" in out
    _, _, err = onbeat("observe", folder / "slow_1.npz", tmp_path / "river.npz")
    assert "do not look like one dance" in err
    _, _, err = onbeat("observe", folder / "slow_1.npz", folder / "slow_2.npz")
    assert "look like" not in err


def test_keyposes_of_several_cycles_are_one_each() -> None:
    beats = np.array([2.02, 3.4, 7.9, 9.95, 11.45])
    assert in_repetition(beats, 2, 8.0, 8.0) == pytest.approx([(0.02 - 0.05) / 2 % 8, 1.425, 5.9])
    assert in_repetition(beats, 2, 8.0, 0.0) == pytest.approx([0.02, 1.4, 5.9, 7.95])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("slow_1.npz",), "1 repetition of the dance; give two or more takes"),
        (("slow_1.npz", "slow_1.npz"), "a motion is given twice"),
        (("nobody.npz", "slow_1.npz"), "nobody.npz"),
        (("slow_1.beats", "slow_2.npz"), "slow_1.beats"),
        (("slow_1.npz", "slow_2.npz", "--cycle", "0"), "a cycle of 0 beats"),
        (("slow_1.npz", "slow_2.npz", "--cycle", "40"), "a cycle of 40 beats is needed"),
        (("slow_1.npz", "slow_2.npz", "--speeds", "fast"), "--speeds fast"),
        (("slow_1.npz", "slow_2.npz", "--speeds", "1,0"), "speeds above 0"),
        (("slow_1.npz", "slow_2.npz", "--speeds", "1,2,3"), "3 speeds for 2 takes of 1 tempi"),
        (("slow_1.npz", "slow_2.npz", "--joints", "tail"), "no joint tail; it has Hips"),
        (("slow_1.npz", "slow_2.npz", "--joints", " , "), "give names of joints"),
        (("slow_1.npz", "slow_2.npz", "--draw", "LeftFoot"), "--draw LeftFoot is not among"),
        (("slow_1.npz", "slow_2.npz", "--beats", "few.beats"), "beats"),
        (("slow_1.npz", "slow_2.npz", "--keyposes", "none.csv"), "none.csv:2: a keypose at 999 s"),
        (("slow_1.npz", "slow_2.npz", "--keyposes", "nothing.json"), "nothing.json"),
        (("slow_1.npz", "slow_2.npz", "--seed", "-1"), "--seed -1"),
        (("--speeds", "1,2"), "--speeds without a motion"),
    ],
)
def test_what_cannot_be_is_one_clear_line(onbeat: Run, folder: Path, words: tuple[str, ...], message: str) -> None:
    paths = [folder / word if "." in word and not word[0].isdigit() else word for word in words]
    status, out, err = onbeat("observe", *paths)
    assert status == 1
    assert message in err
    assert "Traceback" not in err
    assert out == ""
