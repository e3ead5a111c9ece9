"""``onbeat recognise style`` as a user runs it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from onbeat.formats import read_motion
from taught_steps import write_steps

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_steps(tmp_path_factory.mktemp("steps"))


def test_a_step_in_anothers_style_is_a_motion_that_plays(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    labels = (folder / "taught.csv").read_text().splitlines()
    held = [f"{folder}/{row}" if "," in row and "file" not in row else row for row in labels]
    held = [row for row in held if "Bruno sway" not in row]
    (tmp_path / "held.csv").write_text("\n".join(held) + "\n")
    words = ("recognise", "style", tmp_path / "held.csv", "--task", "sway", "--person")
    status, out, err = onbeat(*words, "Bruno", "-o", tmp_path / "made.bvh")
    assert status == 0, err
    assert "Bruno never danced sway in the labels" in out
    assert len(read_motion(tmp_path / "made.bvh")) > 10
    status, out, _ = onbeat(*words, "Aiko", "-o", tmp_path / "made.html")
    assert "the mean of what the labels have" in out
    assert (tmp_path / "made.html").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("labels", "task", "person", "message"),
    [
        ("taught.csv", "waltz", "Aiko", "no task 'waltz' in the labels; there are claps, sway"),
        ("taught.csv", "sway", "Nobody", "no person 'Nobody' in the labels; there are Aiko, Bruno, Carla"),
        ("Aiko claps.npz", "sway", "Aiko", "learned from label files"),
        ("bare.csv", "sway", "Aiko", "none has both a task and a person"),
    ],
)
def test_who_or_what_is_not_known_is_one_clear_line(
    onbeat: Run, folder: Path, tmp_path: Path, labels: str, task: str, person: str, message: str
) -> None:
    words = ("--task", task, "--person", person, "-o", tmp_path / "x.bvh")
    status, out, err = onbeat("recognise", "style", folder / labels, *words)
    assert status == 1
    assert message in err
    assert out == ""
