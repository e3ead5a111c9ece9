"""``onbeat recognise`` as a user runs it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from onbeat.examples.dancers import DANCERS
from onbeat.examples.performer import perform
from onbeat.examples.repertoire import CLAPS, STAR, SWAY
from onbeat.formats import write_motion

Run = Callable[..., tuple[int, str, str]]
HEAD = "file,from,to,task,person,cycle\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three dancers, two steps, three cycles: two to learn from, one to try; and a step that nobody taught."""
    place, rng = tmp_path_factory.mktemp("steps"), np.random.default_rng(0)
    rows: dict[str, list[str]] = {"taught": [], "tried": [], "other": []}
    for dancer in DANCERS[:3]:
        for figure in (CLAPS, SWAY, STAR):
            clip = perform(dancer, [figure], 1.0, 3, rng, 30.0)
            name = f"{dancer.name} {figure.name}.npz"
            write_motion(clip.motion, place / name)
            for cycle in range(3):
                start, end = clip.beats[2 + 4 * cycle], clip.beats[5 + 4 * cycle]
                row = f"{name},{start:.3f},{end:.3f},{figure.name},{dancer.name},{cycle}"
                rows["other" if figure is STAR else "tried" if cycle == 2 else "taught"].append(row)
    (place / "bare.csv").write_text("file,from,to\nAiko claps.npz,1,2\n")
    for name, lines in rows.items():
        (place / f"{name}.csv").write_text(HEAD + "\n".join(lines) + "\n")
    return place


@pytest.fixture(scope="module")
def model(folder: Path) -> Path:
    """Learned once."""
    from onbeat.cli.recognise import train_command

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
