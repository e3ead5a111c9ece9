"""Given choreographies: their beats on the music's, their bars on its bars."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from onbeat.errors import PlanError
from onbeat.live.choice.choreography import Choreography, Repertoire
from onbeat.live.choice.timeline import Ahead


def ahead(period: float, first: int = 10, at: float = 5.0) -> Ahead:
    numbers = first + np.arange(30)
    return Ahead(first, at + 0.05 + np.arange(30) * period, numbers % 4 + 1, 4, 0.0)


def steps(name: str = "steps", period: float = 0.5, duration: float = 20.0, clip: int = 0) -> Choreography:
    return Choreography(name, clip, duration, np.arange(0.7, duration, period))


def danced(repertoire: Repertoire, period: float, seconds: float = 40.0):
    """Pieces with their seconds, and beats with theirs, on a timeline that begins at 5 s."""
    coming, at, pieces, beats = ahead(period), 5.0, [], []
    coming = Ahead(10, 5.05 + np.arange(200) * period, (10 + np.arange(200)) % 4 + 1, 4, 0.0)
    choice = repertoire.begin(at, coming)
    while at < 5 + seconds:
        for number, second in choice.beats:
            beats.append((number, at + second))
        for piece in choice.pieces:
            pieces.append((at, piece))
            at += piece.lasts
        choice = repertoire.go_on(at, coming, 2.0)
    return pieces, beats, coming


@pytest.mark.parametrize("period", [0.5, 0.45, 0.62, 1.0, 0.27])
def test_every_beat_of_the_dance_is_on_one_of_the_music_while_the_tempo_stays(period):
    repertoire = Repertoire([steps(duration=90.0)])
    _, beats, coming = danced(repertoire, period)
    assert len(beats) > 20
    numbers = [number for number, _ in beats]
    assert numbers == sorted(set(numbers))
    apart = [abs(second - coming.times[number - 10]) for number, second in beats]
    assert max(apart) < 0.02


def test_bars_begin_on_bars():
    dance = steps(duration=60.0)
    pieces, beats, coming = danced(Repertoire([dance]), 0.5, 20)
    clip_seconds = []
    for number, second in beats:
        at, piece = max((p for p in pieces if p[0] <= second + 1e-9), key=lambda p: p[0])
        clip_seconds.append((coming.positions[number - 10], piece.from_s + (second - at) * piece.rate))
    downs = [second for position, second in clip_seconds if position == 1]
    assert downs
    assert all(round((second - 0.7) / 0.5) % 4 == 0 for second in downs)


def test_a_dance_that_is_over_gives_way_to_the_next_and_goes_round():
    two = Repertoire([steps("one", duration=8.0), steps("two", duration=8.0, clip=1)])
    pieces, beats, _ = danced(two, 0.5, 40)
    clips = [piece.clip for _, piece in pieces]
    changes = [a for a, b in itertools.pairwise(clips) if a != b]
    assert changes[:3] == [0, 1, 0]
    seconds = [second for _, second in beats]
    assert np.diff(seconds).min() > 0.2


def test_one_that_is_asked_for_is_danced_next_and_others_are_told():
    two = Repertoire([steps("one"), steps("two", clip=1)])
    assert two.ask("two")
    assert two.begin(5.0, ahead(0.5)).pieces[0].clip == 1
    assert not two.ask("three")
    assert two.ask("")
    assert two.begin(5.0, ahead(0.5)).pieces[0].clip == 0


def test_keyposes_are_put_on_the_beats_where_they_are_near():
    dance = Choreography("keyed", 0, 10.0, np.arange(0.5, 10, 0.5), 4, np.array([0.52, 1.45, 2.7]))
    marks = dance.marks()
    assert marks[:2] == pytest.approx([0.52, 1.0])
    assert 1.45 in marks
    assert np.diff(marks).min() > 0.1


@pytest.mark.parametrize("beats", [[], [1.0], [2.0, 1.0], [11.0, 12.0]])
def test_a_dance_without_beats_is_refused(beats):
    with pytest.raises(PlanError, match="two or more"):
        Choreography("none", 0, 10.0, np.array(beats))


@pytest.mark.parametrize("period", [0.01, 7.0])
def test_beats_that_are_none_of_a_dance_are_refused(period):
    with pytest.raises(PlanError, match="apart"):
        Choreography("odd", 0, 30.0, np.arange(0.5, 30, period))


def test_a_dance_shorter_than_a_bar_is_danced_too():
    short = Choreography("short", 0, 1.6, np.array([0.2, 0.7, 1.2]))
    pieces, beats, _ = danced(Repertoire([short]), 0.5, 12)
    assert len(pieces) > 4
    assert np.diff([second for _, second in beats]).min() > 0.05
