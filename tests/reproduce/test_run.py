"""Papers one after the other, and what is written."""

from __future__ import annotations

from pathlib import Path

import pytest

import onbeat.reproduce.run as run
from made_results import RESULT, MadePaper
from onbeat.errors import OnbeatError
from onbeat.reproduce.data import Data


def test_files_of_ones_own_go_with_one_paper(tmp_path: Path):
    with pytest.raises(OnbeatError, match="go with one paper, not with P1, P2, P3"):
        run.reproduce([], Data(songs=(tmp_path / "song.wav",)))


def test_it_is_told_which_paper_is_done(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(run, "paper", MadePaper)
    told: list[tuple[str, float, str]] = []
    results = run.reproduce(["p3", "P1"], Data(seed=4), lambda *step: told.append(step))
    assert [(one.key, one.our_data) for one in results] == [("P1", "seed 4"), ("P3", "seed 4")]
    assert ("P3", 0.5, "half of it") in told


def test_everything_is_written_and_the_same_again(tmp_path: Path):
    written = run.write_results(tmp_path / "new" / "a", [RESULT])
    names = {path.relative_to(tmp_path / "new" / "a").as_posix() for path in written}
    assert names == {"p1.html", "p1_fig_5.svg", "study/study.html", "results.json", "index.html"}
    again = run.write_results(tmp_path / "b", [RESULT])
    assert [path.read_bytes() for path in written] == [path.read_bytes() for path in again]
