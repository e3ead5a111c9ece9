"""The main job: a song and a library in, a dance as long as the song out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onbeat.dance.document import DanceDocument
from onbeat.dance.make import LONGEST, Dance, danceable, make_dance
from onbeat.errors import PlanError
from onbeat.motion.features import hand_features
from onbeat.moves.library import MoveLibrary
from onbeat.music.song import Song

SECONDS = 10.0
ONE_BEAT = {"beats": [1.0], "downbeats": [], "chord_change": [0.0], "beat_strength": []}


def song_of(seconds: float, tempo: float = 100.0) -> Song:
    beats = np.arange(0.3, seconds, 60 / tempo)
    clock = np.arange(0.0, seconds, 0.1)
    return Song(seconds, tempo, 4, beats, beats[::4], np.zeros(len(beats)), clock, 0.5 + 0.3 * np.sin(clock))


@pytest.fixture(scope="module")
def few(troupe: MoveLibrary) -> MoveLibrary:
    return MoveLibrary.of(troupe.clips[:8])


@pytest.fixture(scope="module")
def dance(few: MoveLibrary) -> Dance:
    return make_dance(song_of(SECONDS), few, fps=30)


def test_the_motion_is_as_long_as_the_song(dance: Dance) -> None:
    assert len(dance.motion) == round(SECONDS * 30)
    assert dance.motion.fps == dance.document.fps == 30
    assert np.isfinite(dance.motion.rotations).all()
    assert np.isfinite(dance.motion.root_positions).all()
    assert dance.document.duration == SECONDS


def test_the_moves_of_the_document_add_up(dance: Dance, few: MoveLibrary) -> None:
    moves, plan = dance.document.moves, dance.plan.moves
    assert moves[0].at_s == 0
    assert [few.clips[move.clip].name for move in plan] == [move.clip for move in moves]
    starts = [move.at_s for move in moves]
    assert starts == sorted(starts)
    assert starts[-1] < SECONDS
    for k, move in enumerate(moves):
        # What is seen of a clip is what the warp lets pass between two joins, at the move's own rate.
        ends = np.array([move.at_s, moves[k + 1].at_s if k + 1 < len(moves) else SECONDS])
        passed = np.diff(ends if dance.warp is None else dance.warp(ends))[0] * plan[k].rate
        assert move.to_s - move.from_s == pytest.approx(passed, abs=2e-3)


def test_the_document_s_times_are_on_the_song_s_clock(dance: Dance) -> None:
    document = dance.document
    assert document.beats == pytest.approx(dance.song.beats.tolist(), abs=1e-4)
    found = hand_features(dance.motion).body_stops
    assert document.stops == pytest.approx(found.tolist(), abs=1e-4)
    assert document.stops == pytest.approx(dance.stops.tolist(), abs=1e-4)
    assert len(document.joins) == len(document.moves) - 1
    for join, move in zip(document.joins, document.moves[1:], strict=True):
        assert join.from_s < move.at_s < join.to_s
        assert 0 <= join.link_error_deg < 60
    assert DanceDocument.from_json(document.to_json()) == document


def test_no_times_or_machines_in_the_document(dance: Dance, few: MoveLibrary) -> None:
    again = make_dance(song_of(SECONDS), few, fps=30)
    assert again.document.to_json() == dance.document.to_json()
    assert again.motion.rotations.tobytes() == dance.motion.rotations.tobytes()
    assert again.motion.root_positions.tobytes() == dance.motion.root_positions.tobytes()
    assert again.found.seconds >= 0
    assert b'seconds"' not in dance.document.to_json()


def test_without_the_warp_the_plan_s_own_time_is_danced(few: MoveLibrary, dance: Dance) -> None:
    plain = make_dance(song_of(SECONDS), few, fps=30, warp=False)
    assert plain.warp is None
    assert plain.plan == dance.plan
    assert [move.at_s for move in plain.document.moves] == pytest.approx([m.at_s for m in plain.plan.moves], abs=1e-4)
    assert plain.document.metrics["warp"]["rate_max"] == 1.0
    rates = [move.rate for move in plain.plan.moves]
    seen = [plain.document.metrics["warp"][name] for name in ("playback_min", "playback_max")]
    assert seen == [min(rates), max(rates)]
    assert plain.document.metrics["beats"] == plain.document.metrics["beats_before_warp"]


def test_the_warp_brings_stops_to_beats(dance: Dance) -> None:
    metrics = dance.document.metrics
    assert metrics["beats"]["f50"] >= metrics["beats_before_warp"]["f50"]
    assert metrics["beats"]["f100"] > 0.6


def test_fast_songs_are_danced_at_half_time(few: MoveLibrary) -> None:
    fast = make_dance(song_of(8.0, tempo=200.0), few, fps=30)
    assert fast.song.tempo == pytest.approx(100.0)
    assert np.diff(fast.document.beats).min() > 0.5


def test_it_says_how_far_it_is(few: MoveLibrary) -> None:
    said: list[tuple[str, float]] = []
    make_dance(song_of(4.0), few, fps=10, step=lambda what, share: said.append((what, share)))
    assert list(dict.fromkeys(what for what, _ in said)) == ["searching", "dancing", "warping", "measuring"]
    assert all(0 <= share <= 1 for _, share in said)


@pytest.mark.parametrize(
    ("song", "options", "message"),
    [
        (song_of(LONGEST + 60), {}, "lasts 21:00 minutes; a dance lasts at most 20:00 minutes: choose a stretch"),
        (replace(song_of(3.0), **ONE_BEAT), {}, "one beat is heard"),
        (song_of(4.0), {"fps": 0.0}, "0 frames a second cannot be"),
        (song_of(4.0), {"fps": 1e9}, "frames a second cannot be"),
        (song_of(4.0), {"fps": float("nan")}, "frames a second cannot be"),
        (song_of(4.0), {"method": "knit"}, "no search method 'knit'"),
    ],
)
def test_refusals(few: MoveLibrary, song: Song, options: dict[str, float], message: str) -> None:
    with pytest.raises(PlanError, match=message):
        make_dance(song, few, **options)


@pytest.mark.parametrize("tempo", [30.0, 200.0])
def test_beats_that_are_told_are_danced_to_as_they_are(few: MoveLibrary, tempo: float) -> None:
    song = song_of(SECONDS, tempo)
    told = make_dance(song, few, fps=30, as_told=True)
    np.testing.assert_array_equal(told.song.beats, song.beats)
    assert not told.document.heard_bpm
    assert danceable(song).tempo in (60.0, 120.0, 100.0)
    assert danceable(song, as_told=True) is song
