"""Which beat of the dance is on which of the music."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.music.song import Song
from onbeat.retime.meeting import meet, wanted_time


@pytest.mark.parametrize(("period", "fold"), [(0.5, 1), (0.36, 1), (0.25, 2), (0.125, 4), (1.0, 0.5), (2.0, 0.25)])
def test_tempi_an_octave_apart_are_folded(period, fold):
    met = meet(np.arange(40) * 0.5, np.arange(60) * period)
    assert met.fold == fold


def test_beat_k_is_on_beat_k_from_the_first_on():
    rng = np.random.default_rng(0)
    music, dance = np.cumsum(rng.uniform(0.45, 0.55, 40)), np.cumsum(rng.uniform(0.48, 0.52, 30))
    met = meet(dance, music, first=3)
    assert np.abs(met.warp.inverse(dance) - music[3:33]).max() < 0.006
    assert np.array_equal(met.music, music[3:33])


def test_a_song_that_ends_first_has_as_many_beats_as_it_has():
    met = meet(np.arange(40) * 0.5, np.arange(10) * 0.5)
    assert len(met.music) == len(met.dance) == 10


@pytest.mark.parametrize(
    ("dance", "music", "first"), [([0.0], [0, 1], 0), ([0, 1], [0.0], 0), ([0, 1], [0, 1], 1), ([0, 1], [0, 1], 7)]
)
def test_less_than_two_beats_that_meet_are_refused(dance, music, first):
    with pytest.raises(PlanError, match="beat"):
        meet(np.array(dance, dtype=float), np.array(music, dtype=float), first)


def test_a_song_is_danced_to_from_its_first_downbeat_until_its_end():
    beats = np.arange(0.3, 12.0, 0.4)
    song = Song(12.0, 150.0, 4, beats, beats[2::4], np.zeros(len(beats)), [0.0, 12.0], [0.5, 0.5])
    wanted = wanted_time(np.arange(20) * 0.5, song=song)
    assert wanted.until == 12.0
    assert wanted.warp.inverse(np.array([0.0, 0.5])) == pytest.approx(beats[2:4], abs=0.006)
    with pytest.raises(PlanError, match=r"a speed of 1.2 and a song: give one of them"):
        wanted_time(np.arange(20) * 0.5, 1.2, song)
