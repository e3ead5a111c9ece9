"""``onbeat recognise`` as a user runs it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from onbeat.examples.dancers import DANCERS
from onbeat.examples.performer import perform
from onbeat.examples.repertoire import CLAPS, SWAY
from onbeat.formats import write_markers, write_motion
from onbeat.motion import Markers
from onbeat.motion.mirror import mirrored
from taught_steps import HEAD, write_steps

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_steps(tmp_path_factory.mktemp("steps"))


@pytest.fixture(scope="module")
def model(folder: Path) -> Path:
    """Learned once."""
    from onbeat.cli.recognise_train import train_command

    train_command([folder / "taught.csv"], output=folder / "model.npz")
    return folder / "model.npz"


def test_steps_and_dancers_are_known_again(onbeat: Run, folder: Path, model: Path) -> None:
    status, out, err = onbeat("recognise", "evaluate", model, folder / "tried.csv", "--json")
    assert (status, err) == (0, "")
    document = json.loads(out)
    assert document["task"]["right"] == document["task"]["of"] == 6
    assert document["person"]["right"] >= 5
    _, out, _ = onbeat("recognise", "evaluate", model, folder / "tried.csv")
    assert "task: 6 of 6 right" in out


def test_a_known_step_by_somebody_new_is_told_as_perhaps_it(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    head, *lines = (folder / "taught.csv").read_text().splitlines()
    lines += (folder / "other.csv").read_text().splitlines()[1:]
    people = tmp_path / "few.csv"
    few = [f"{folder}/{line}" for line in lines if "Bruno" not in line]
    people.write_text("\n".join((head, *few)) + "\n")
    status, out, _ = onbeat("recognise", "train", people, "-o", tmp_path / "m.npz")
    assert status == 0
    assert "a known task by somebody new is called perhaps known (100% of them by the right name" in out
    status, out, err = onbeat("recognise", tmp_path / "m.npz", folder / "tried.csv")
    assert status == 0
    told = [line for line in out.splitlines() if line.startswith("Bruno")]
    assert "perhaps claps" in told[0]
    assert ", by somebody new" in told[0]
    assert '"perhaps": too far for a repetition' in err
    assert "times too far)" in out
    _, out, _ = onbeat("recognise", tmp_path / "m.npz", folder / "tried.csv", "--json")
    rows = json.loads(out)["segments"]
    (row,) = (row for row in rows if row["file"].endswith("Bruno claps.npz"))
    assert (row["perhaps"], row["task"]["known"], row["task"]["across"][0]["name"]) == ("task", False, "claps")
    one = tmp_path / "one.csv"
    one.write_text("\n".join((head, *(line for line in few if "Aiko" in line))) + "\n")
    _, out, _ = onbeat("recognise", "train", one, "-o", tmp_path / "m.npz")
    assert "a known task by somebody new is called new (to have it told teach 3 tasks or more" in out


def test_all_matches_are_listed_with_their_chances(onbeat: Run, folder: Path, model: Path) -> None:
    status, out, _ = onbeat("recognise", model, folder / "tried.csv", "--json")
    assert status == 0
    row = json.loads(out)["segments"][0]
    assert row["task"]["matches"][0]["name"] == "claps"
    assert {match["name"] for match in row["person"]["matches"]} == {"Aiko", "Bruno", "Carla"}
    assert sum(match["probability"] for match in row["person"]["matches"]) <= 1.001


def test_a_motion_file_is_taken_whole_or_cut_at_its_keyposes(onbeat: Run, folder: Path, model: Path) -> None:
    status, out, _ = onbeat("recognise", model, folder / "Aiko claps.npz", "--json")
    assert status == 0
    assert len(json.loads(out)["segments"]) == 1
    status, out, _ = onbeat("recognise", model, folder / "Aiko claps.npz", "--span", 3, "--json")
    assert status == 0
    assert len(json.loads(out)["segments"]) > 3


def test_the_same_labels_give_the_same_model(onbeat: Run, folder: Path, model: Path, tmp_path: Path) -> None:
    status, out, _ = onbeat("recognise", "train", folder / "taught.csv", "-o", tmp_path / "again.npz")
    assert status == 0
    assert "2 tasks and 3 persons from 12 segments" in out
    assert (tmp_path / "again.npz").read_bytes() == model.read_bytes()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("model.npz", "nobody.csv"), "nobody.csv"),
        (("Aiko claps.npz", "tried.csv"), "Aiko claps.npz"),
        (("model.npz", "Aiko claps.npz", "--span", "0"), "--span 0"),
        (("model.npz", "Aiko claps.npz", "--span", "99"), "has no 100 keyposes in a row"),
        (("train", "taught.csv", "-o", "x.npz", "--seed", "-1"), "--seed -1"),
        (("train", "bare.csv", "-o", "x.npz"), "none of a known task or person"),
        (("evaluate", "model.npz", "bare.csv"), "no task and no person in"),
    ],
)
def test_what_cannot_be_is_one_clear_line(
    onbeat: Run, folder: Path, model: Path, words: tuple[str, ...], message: str
) -> None:
    paths = [folder / word if word.endswith((".npz", ".csv")) else word for word in words]
    status, out, err = onbeat("recognise", *paths)
    assert status == 1
    assert message in err
    assert "Traceback" not in err
    assert out == ""


def test_a_model_may_take_left_and_right_for_one(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    status, out, _ = onbeat(
        "recognise", "train", folder / "taught.csv", "-o", tmp_path / "m.npz", "--mirrored", "joined"
    )
    assert status == 0
    assert "left and right joined" in out
    for side in ("", " mirrored"):
        file = tmp_path / f"sway{side}.npz"
        clip = perform(DANCERS[1], [SWAY], 1.0, 1, np.random.default_rng(4), 30.0).motion
        write_motion(mirrored(clip) if side else clip, file)
    _, out, _ = onbeat("recognise", tmp_path / "m.npz", tmp_path / "sway.npz", tmp_path / "sway mirrored.npz", "--json")
    rows = json.loads(out)["segments"]
    assert rows[0]["task"]["matches"] == rows[1]["task"]["matches"]
    assert rows[0]["task"]["matches"][0]["name"] == "sway"


def test_whole_dances_are_cut_at_their_keyposes_to_learn_from(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    rng = np.random.default_rng(8)
    rows = []
    for dancer in DANCERS[:2]:
        for figure in (CLAPS, SWAY):
            clip = perform(dancer, [figure], 1.0, 4, rng, 30.0)
            write_motion(clip.motion, tmp_path / f"{dancer.name} {figure.name}.npz")
            rows.append(f"{dancer.name} {figure.name}.npz,,,{figure.name},{dancer.name},0")
            beats = "".join(f"{beat:.6f}\n" for beat in clip.beats)
            (tmp_path / f"{dancer.name} {figure.name}.beats").write_text(beats)
    (tmp_path / "dances.csv").write_text(HEAD + "\n".join(rows) + "\n")
    cut = ("--span", 2, "--cycle", 4)
    status, out, err = onbeat("recognise", "train", tmp_path / "dances.csv", "-o", tmp_path / "m.npz", *cut)
    assert status == 0, err
    assert "2 persons" in out
    assert "no beats given" not in err  # the beats beside each file are taken
    status, out, _ = onbeat("recognise", "evaluate", tmp_path / "m.npz", tmp_path / "dances.csv", *cut, "--json")
    assert status == 0
    document = json.loads(out)
    names = set(document["task"]["confusion"])
    assert {"claps/1", "sway/1"} <= names
    assert names <= {f"{figure}/{place}" for figure in ("claps", "sway") for place in (1, 2, 3, 4)}
    assert document["task"]["right"] >= 0.9 * document["task"]["of"]


def test_confusion_matrices_are_drawn_the_same_each_time(
    onbeat: Run, folder: Path, model: Path, tmp_path: Path
) -> None:
    for place in ("a", "b"):
        status, _, err = onbeat("recognise", "evaluate", model, folder / "tried.csv", "-o", tmp_path / place)
        assert (status, err) == (0, "")
    for name in ("task.png", "task.svg", "person.png", "person.svg"):
        drawn = (tmp_path / "a" / name).read_bytes()
        assert len(drawn) > 2000
        assert drawn == (tmp_path / "b" / name).read_bytes()


def test_a_stream_gives_a_line_for_each_segment(onbeat: Run, folder: Path, model: Path) -> None:
    file = folder / "Bruno sway.npz"
    status, out, _ = onbeat("recognise", model, file, "--span", 3, "--stream")
    assert status == 0
    lines = [json.loads(line) for line in out.splitlines()]
    _, out, _ = onbeat("recognise", model, file, "--span", 3, "--json")
    offline = json.loads(out)["segments"]
    assert abs(len(lines) - len(offline)) <= 2
    for line in lines:
        same = min(offline, key=lambda row: abs(row["to"] - line["to"]))
        if abs(same["to"] - line["to"]) + abs(same["from"] - line["from"]) < 1e-3:
            assert line["task"]["matches"][0]["name"] == same["task"]["matches"][0]["name"]


def test_markers_of_a_whole_body_are_recognised_as_it_is(
    onbeat: Run, folder: Path, model: Path, tmp_path: Path
) -> None:
    clip = perform(DANCERS[0], [CLAPS], 1.0, 1, np.random.default_rng(4), 60.0)
    few = ("hips", "knee")
    write_motion(clip.motion, tmp_path / "claps.c3d")
    status, out, err = onbeat("recognise", model, tmp_path / "claps.c3d", "--json")
    assert status == 0, err
    assert json.loads(out)["segments"][0]["task"]["matches"][0]["name"] == "claps"
    write_markers(Markers(few, np.zeros((30, 2, 3)), 30.0), tmp_path / "few.trc")
    status, _, err = onbeat("recognise", model, tmp_path / "few.trc")
    assert status == 1
    assert "leave the file out" in err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("model.npz", "Aiko claps.npz", "--stream"), "--stream goes through one motion file"),
        (("model.npz", "Aiko claps.npz", "--stream", "--span", "2", "--json"), "lines of JSON already"),
        (("train", "taught.csv", "-o", "x.npz", "--cycle", "8"), "--cycle 8"),
        (("train", "taught.csv", "-o", "x.npz", "--span", "2", "--cycle", "0"), "--cycle 0"),
        (("train", "beyond.csv", "-o", "x.npz", "--span", "2"), "the motion lasts"),
        (("train", "taught.csv", "-o", "x.npz", "--span", "40"), "has no 41 keyposes in a row"),
    ],
)
def test_what_cannot_be_cut_is_one_clear_line(
    onbeat: Run, folder: Path, model: Path, words: tuple[str, ...], message: str
) -> None:
    paths = [folder / word if word.endswith((".npz", ".csv")) else word for word in words]
    status, out, err = onbeat("recognise", *paths)
    assert status == 1
    assert message in err
    assert out == ""


def test_files_that_cannot_be_used_are_told_and_the_others_answered(
    onbeat: Run, folder: Path, model: Path, tmp_path: Path
) -> None:
    (tmp_path / "broken.bvh").write_text("HIERARCHY")
    good, lists = folder / "Aiko claps.npz", tmp_path / "list.csv"
    lists.write_text(HEAD + f"{good},,,,,0\nbroken.bvh,,,,,0\n{good},0.1,1.0,,,0\n")
    _, alone, _ = onbeat("recognise", model, good, "--json")
    status, out, err = onbeat("recognise", model, tmp_path / "broken.bvh", good, tmp_path / "none.npz", lists, "--json")
    assert status == 0
    document = json.loads(out)
    assert document["segments"][:2] == json.loads(alone)["segments"] * 2
    assert [row["to"] for row in document["segments"][2:]] == [1.0]
    assert len(document["problems"]) == 2
    assert [line.startswith("onbeat: left out ") for line in err.splitlines()] == [True, True]
    assert "broken.bvh" in err
    assert "none.npz" in err
    status, out, err = onbeat("recognise", model, tmp_path / "broken.bvh", tmp_path / "none.npz")
    assert (status, out) == (1, "")
    assert "none of 2 files can be recognised; " in err
