"""The conductor: dances to music, rests without, changes when asked, and keeps its anchors on the beats."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.live.choice.choreography import Choreography, Repertoire
from onbeat.live.conductor import KNOWN, Conductor, Rest
from steady_beats import Books, heard


def conductor() -> tuple[Conductor, Books]:
    line = Books()
    dances = [Choreography(name, k, 30.0, np.arange(0.7, 30, 0.5)) for k, name in enumerate(("one", "two"))]
    return Conductor(line, Repertoire(dances), Rest(2, 12.0)), line


def go(conductor: Conductor, begin: float, end: float, period: float = 0.5, hearing: str = "music") -> None:
    """Conduct every tenth of a second, the timeline going as the music does."""
    for k in range(round(begin * 10), round(end * 10)):
        conductor.conduct(heard(k / 10, period, hearing), k / 10, k / 10)


def shown(line: Books, time: float) -> int:
    return line.showing(time)[0]


def test_without_music_it_rests_for_ever():
    lead, line = conductor()
    go(lead, 0, 60, hearing="nothing")
    assert lead.resting
    assert {move[1] for move in line.moves} == {2}
    assert line.end >= 60 + KNOWN - 0.2


def test_with_music_it_dances_and_its_beats_are_on_the_musics():
    lead, line = conductor()
    go(lead, 0, 12)
    assert not lead.resting
    assert shown(line, 11.0) == 0
    music, dance = lead.expected(heard(11.9, 0.5), 11.9, 11.9)
    assert len(music) >= 4
    assert np.abs(music - dance).max() < 0.02  # as the timeline goes with the music here


def test_when_the_music_ends_it_comes_to_rest_soon_and_dances_again_with_it():
    lead, line = conductor()
    go(lead, 0, 10)
    go(lead, 10, 16, hearing="nothing")
    assert lead.resting
    assert shown(line, 12.0) == 2
    go(lead, 16, 24)
    assert shown(line, 20.0) in (0, 1)


def test_a_break_is_danced_through_but_nothing_begins_in_one():
    lead, _ = conductor()
    go(lead, 0, 3, hearing="held")
    assert lead.resting
    go(lead, 3, 8)
    go(lead, 8, 14, hearing="held")
    assert not lead.resting


def test_another_choreography_comes_on_a_downbeat():
    lead, line = conductor()
    go(lead, 0, 8)
    assert lead.command("play", "two") is None
    go(lead, 8, 14)
    change = next(move[0] for move in line.moves if move[1] == 1)
    assert (change - 0.1) / 2.0 == pytest.approx(round((change - 0.1) / 2.0), abs=1e-6)
    assert 8 < change < 11.5


def test_what_is_not_there_cannot_be_asked_for():
    lead, _ = conductor()
    assert "nothing is called 'three'" in (lead.command("play", "three") or "")


def test_it_rests_when_told_to_though_there_is_music():
    lead, line = conductor()
    go(lead, 0, 6)
    lead.command("rest")
    go(lead, 6, 12)
    assert lead.resting
    lead.command("dance")
    go(lead, 12, 18)
    assert shown(line, 17.0) != 2


def test_when_the_tempo_changes_the_same_seconds_stay_on_the_same_beats():
    lead, _ = conductor()
    go(lead, 0, 10)
    before = dict(lead.anchors.seconds)
    lead.conduct(heard(10.0, 0.55, offset=0.1 - 20 * 0.05), 10.0, 10.0)
    after = lead.anchors.seconds
    assert all(after[beat] == second for beat, second in before.items() if beat in after)


def test_a_dance_called_resting_is_a_dance():
    line = Books()
    lead = Conductor(line, Repertoire([Choreography("resting", 0, 30.0, np.arange(0.7, 30, 0.5))]), Rest(2, 12.0))
    go(lead, 0, 12)
    assert not lead.resting
    assert len(line.moves) < 20


def test_a_hundred_changes_leave_the_timeline_rising():
    lead, line = conductor()
    rng = np.random.default_rng(0)
    for k in range(1200):
        if k % 12 == 0:
            lead.command(rng.choice(["next", "rest", "dance"]))
        period = 0.5 + 0.05 * np.sin(k / 40)
        lead.conduct(heard(k / 10, period, "music" if k % 300 < 250 else "nothing"), k / 10, k / 10)
        music, dance = lead.expected(heard(k / 10, period), k / 10, k / 10)
        assert (np.diff(music) > 0).all()
        assert (np.diff(dance) > 0).all()
    starts = [move[0] for move in line.moves]
    assert starts == sorted(starts)
