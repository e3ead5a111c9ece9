"""The tune is singable, the chords are the key's, the form covers the bars."""

from __future__ import annotations

import numpy as np
import pytest

from onbeat.errors import AudioError
from onbeat.examples.arrangement import form, lay_grid
from onbeat.examples.harmony import Chord, Key
from onbeat.examples.score import Score
from onbeat.examples.song import demo_score
from onbeat.examples.tune import find_steps

SONGS = [(seed, meter) for seed in range(12) for meter in (3, 4)]


@pytest.fixture(params=SONGS, ids=lambda song: f"seed {song[0]}, meter {song[1]}")
def score(request: pytest.FixtureRequest) -> Score:
    seed, meter = request.param
    return demo_score(seed=seed, meter=meter)


def is_consonant(score: Score, beat: float, step: int) -> bool:
    return score.progressions.key.pitch(step) % 12 in score.chord_at(beat).tones


def test_tune_is_consonant_where_it_counts(score: Score) -> None:
    notes = [note for tune in score.tunes for note in tune]
    assert all(is_consonant(score, note.beat, note.step) for note in notes if note.beat % score.meter == 0)
    on_beats = [is_consonant(score, note.beat, note.step) for note in notes if note.beat % 1 == 0]
    assert np.mean(on_beats) > 0.7


def test_tune_can_be_sung(score: Score) -> None:
    for tune in score.tunes:
        if not tune:
            continue
        steps = np.array([note.step for note in tune])
        pitches = [score.progressions.key.pitch(int(step)) for step in steps]
        assert all(55 <= pitch <= 86 for pitch in pitches)
        assert np.ptp(steps) <= 9
        assert np.abs(np.diff(steps)).max() <= 7
        assert np.mean(np.abs(np.diff(steps)) <= 2) > 0.6
        ends = [note.beat + note.beats for note in tune]
        assert all(end <= after.beat for end, after in zip(ends[:-1], tune[1:], strict=True))


def test_tune_stays_in_its_part_and_closes_on_the_tonic(score: Score) -> None:
    for part, tune in zip(score.parts, score.tunes, strict=True):
        first, end = part.first * score.meter, (part.first + part.bars) * score.meter
        assert all(first <= note.beat < end for note in tune)
    last = next(tune for tune in reversed(score.tunes) if tune)
    assert last[-1].step % 7 == 0


def test_all_choruses_have_one_tune() -> None:
    score = demo_score()
    short, long = (
        [(note.beat - (part.first + part.bars) * 4, note.step) for note in tune]
        for part, tune in zip(score.parts, score.tunes, strict=True)
        if part.name == "chorus"
    )
    assert short == long[-len(short) :]
    assert len(long) > len(short) > 8


def test_chords_are_of_the_key(score: Score) -> None:
    key = score.progressions.key
    scale = {key.pitch(step) % 12 for step in range(7)}
    assert all(set(chord.tones) <= scale for chord in score.chords)
    assert score.chords[-1].root == key.tonic
    assert len(score.chords) == len(score.grid.beats)


def test_seeds_give_different_songs() -> None:
    songs = [demo_score(seed=seed) for seed in range(20)]
    assert len({song.progressions.key for song in songs}) >= 8
    assert len({song.progressions.key.mode for song in songs}) == 3
    assert len({tuple(song.tunes[1]) for song in songs}) == 20


@pytest.mark.parametrize("bars", [*range(1, 70), 200])
def test_form_covers_all_bars(bars: int) -> None:
    parts = form(bars)
    assert sum(part.bars for part in parts) == bars
    assert [part.first for part in parts] == np.cumsum([0] + [part.bars for part in parts[:-1]]).tolist()
    assert parts[-1].name == "outro"
    assert max(part.bars for part in parts) <= 16


def test_grid_is_as_asked() -> None:
    grid = lay_grid(60.0, 120.0, 4, 0.0)
    assert np.allclose(np.diff(grid.beats), 0.5)
    assert grid.time(0.5) == pytest.approx((grid.beats[0] + grid.beats[1]) / 2)
    with pytest.raises(AudioError, match=r"ask for 4\.3 s or more"):
        lay_grid(3.0, 120.0, 4, 0.0)
    with pytest.raises(AudioError, match="too short"):
        lay_grid(float("nan"), 120.0, 4, 0.0)


def test_chords_and_their_change() -> None:
    tonic, sixth, fifth = (Key(0, "major").chord(degree) for degree in (1, 6, 5))
    assert tonic == Chord(0, "major")
    assert sixth == Chord(9, "minor")
    assert Key(0, "major").chord(7).quality == "diminished"
    assert tonic.change_from(tonic) == 0.0
    assert sixth.change_from(tonic) == pytest.approx(1 / 3)
    assert fifth.change_from(tonic) == pytest.approx(2 / 3)


def test_steps_found_are_the_cheapest() -> None:
    """Against all sequences of three notes."""
    rng = np.random.default_rng(0)
    costs, tones = rng.uniform(0, 4, (3, 12)), np.ones((3, 12))
    leaps = np.array([1.1, 0.0, 0.45, 1.1, 1.5, 3.0, 5.0, 3.5, 9.0, 9.0, 9.0, 9.0])
    distance = leaps[np.abs(np.subtract.outer(np.arange(12), np.arange(12)))]
    total = costs[0][:, None, None] + distance[:, :, None] + costs[1][None, :, None] + distance[None] + costs[2]
    best = np.unravel_index(total.argmin(), total.shape)
    assert find_steps(costs, tones, None) == [int(index) - 2 for index in best]
