"""``onbeat recognise pupil`` as a user runs it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from taught_steps import write_steps

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_steps(tmp_path_factory.mktemp("steps"))


def test_a_pupil_is_measured_against_a_master(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    files = folder / "Aiko claps.npz", folder / "Bruno claps.npz"
    status, out, err = onbeat("recognise", "pupil", *files, "-o", tmp_path / "lesson", "--json")
    assert (status, err) == (0, "")
    document = json.loads(out)
    shares = [row["share"] for row in document["elements"]]
    assert shares == sorted(shares, reverse=True)
    assert shares[0] == 1
    assert document["segments"][0]["pupil"]["file"].endswith("Bruno claps.npz")
    page, figure = (tmp_path / "lesson" / name for name in ("pupil.html", "pupil.png"))
    assert b'"compared":{"name":"Aiko claps"' in page.read_bytes()
    first = page.read_bytes(), figure.read_bytes()
    status, out, _ = onbeat("recognise", "pupil", *files, "-o", tmp_path / "lesson")
    assert out.splitlines()[0].split() == ["part", "cm", "of", "the", "worst", "late"]
    assert (page.read_bytes(), figure.read_bytes()) == first
    _, out, _ = onbeat("recognise", "pupil", files[0], files[0], "--json")
    assert max(row["cm"] for row in json.loads(out)["elements"]) == 0


def test_a_pupil_is_compared_step_by_step(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    files = folder / "Aiko claps.npz", folder / "Bruno claps.npz"
    (tmp_path / "a.csv").write_text(f"file,from,to\n{files[0]},1,2.5\n{files[0]},3,4.5\n")
    (tmp_path / "b.csv").write_text(f"file,from,to\n{files[1]},1,2.5\n{files[1]},3,4.5\n")
    status, out, _ = onbeat(
        "recognise", "pupil", tmp_path / "a.csv", tmp_path / "b.csv", "--json", "-o", tmp_path / "x"
    )
    assert status == 0
    assert [one["pupil"]["from"] for one in json.loads(out)["segments"]] == [1, 3]
    status, _, err = onbeat("recognise", "pupil", tmp_path / "a.csv", files[1])
    assert status == 1
    assert "has 2 segments" in err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("Aiko claps.npz", "Bruno claps.npz", "--band", "2"), "a band of 2.0"),
        (("Aiko claps.npz", "nobody.npz"), "nobody.npz"),
        (("Aiko claps.npz", "Bruno claps.npz", "--span", "0"), "--span 0"),
        (("bare.csv", "tried.csv"), "has 1 segment, "),
    ],
)
def test_what_cannot_be_compared_is_one_clear_line(
    onbeat: Run, folder: Path, words: tuple[str, ...], message: str
) -> None:
    paths = [folder / word if word.endswith((".npz", ".csv")) else word for word in words]
    status, out, err = onbeat("recognise", "pupil", *paths)
    assert status == 1
    assert message in err
    assert out == ""


def test_what_may_not_be_the_same_step_is_asked_about(onbeat: Run, folder: Path, tmp_path: Path) -> None:
    for name, end in (("long", 3.0), ("short", 1.5)):
        (tmp_path / f"{name}.csv").write_text(f"file,from,to\n{folder / 'Aiko claps.npz'},1,{end}\n")
    status, _, err = onbeat("recognise", "pupil", tmp_path / "long.csv", tmp_path / "short.csv")
    assert status == 0
    assert "are both the same step?" in err
