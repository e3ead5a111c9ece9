"""Putting right what was heard wrong."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from onbeat.errors import AudioError
from onbeat.music import Song, listen_samples
from onbeat.music.audio import Audio
from onbeat.music.fixes import NOTHING, Corrections
from onbeat.music.table import bar_positions
from sounds import beat_times, hat, kick, mix, piano, snare

BPM = 120.0


@cache
def band() -> tuple[np.ndarray, Audio]:
    rng = np.random.default_rng(0)
    beats = beat_times(BPM, 24.0)
    events = []
    for index, at in enumerate(beats):
        events += [(at, kick() if index % 4 == 0 else 0.5 * snare(rng)), (at + 0.25, hat(rng))]
        if index % 4 == 0:
            root = 110.0 * 2.0 ** ((0, 5, 7, 9)[index // 4 % 4] / 12)
            events += [(at, piano(root * ratio, 1.9, 0.3)) for ratio in (1.0, 2.0, 2.52, 3.0)]
    return beats, mix(24.0, events)


@cache
def heard() -> Song:
    return listen_samples(band()[1])


def put_right(**fixes: object) -> Song:
    return listen_samples(band()[1], corrections=Corrections(**fixes))


def well_formed(song: Song) -> None:
    assert (np.diff(song.beats) > 0.0).all()
    assert np.isin(song.downbeats, song.beats).all()
    for values in (song.chord_change, song.beat_strength):
        assert len(values) == len(song.beats)
        assert values.min() >= 0.0
        assert values.max() <= 1.0
    assert len(song.chord_root) == len(song.beats)
    assert Song.from_json(song.to_json()).to_json() == song.to_json()


def written(path: Path, beats: np.ndarray, places: np.ndarray | None = None) -> Path:
    rows = [f"{beat:.4f}" if places is None else f"{beat:.4f}\t{place}" for beat, place in zip(
        beats, np.zeros(len(beats), int) if places is None else places, strict=True)]  # fmt: skip
    path.write_text("\n".join(rows) + "\n")
    return path


def test_nothing_to_put_right_changes_nothing() -> None:
    assert not NOTHING
    assert Corrections(meter=3)
    assert put_right().to_json() == heard().to_json()


def test_beats_from_a_file_override_with_their_bars(tmp_path: Path) -> None:
    beats = band()[0][:30] + 0.01
    song = put_right(beats=written(tmp_path / "a.beats", beats, np.arange(30) % 3 + 1))
    np.testing.assert_allclose(song.beats, beats, atol=1e-4)
    np.testing.assert_allclose(song.downbeats, beats[::3], atol=1e-4)
    assert song.meter == 3
    assert song.tempo == pytest.approx(BPM, rel=1e-3)
    well_formed(song)


def test_beats_without_bars_keep_the_downbeats_heard(tmp_path: Path) -> None:
    beats = band()[0] + 0.012
    song = put_right(beats=written(tmp_path / "a.txt", beats))
    assert song.meter == heard().meter == 4
    near = np.abs(song.downbeats[:, None] - heard().downbeats).min(axis=1)
    assert near.max() < 0.05


def test_what_is_heard_at_the_new_beats_is_heard_anew(tmp_path: Path) -> None:
    beats = band()[0]
    song = put_right(beats=written(tmp_path / "a.beats", beats, np.arange(len(beats)) % 4 + 1))
    change = song.chord_change[1:]
    new = (np.arange(len(beats)) % 4 == 0)[1:]
    assert change[new].min() > 1.2 * change[~new].max()
    assert np.median(change[new]) > 3.0 * np.median(change[~new])
    among = put_right(beats=written(tmp_path / "b.beats", np.sort(np.concatenate([beats, beats + 0.15]))))
    assert np.median(among.beat_strength[::2]) > 2.0 * np.median(among.beat_strength[1::2])
    assert [name.partition(":")[0] for name in song.chord_root[:16:4]] == ["A", "D", "E", "F#"]


def test_taps_bring_the_beats_to_their_tempo(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    slow = band()[0][4:36:2] + 0.02 * rng.standard_normal(16)
    song = put_right(taps=written(tmp_path / "taps.txt", slow))
    assert song.tempo == pytest.approx(BPM / 2.0, rel=0.01)
    assert np.abs(song.beats[:, None] - band()[0][::2]).min(axis=1).max() < 0.03
    assert song.meter == 2
    well_formed(song)


@pytest.mark.parametrize(
    ("fix", "factor", "meter"), [("half", 0.5, 2), ("double", 2.0, 8), ("third", 1.0 / 3.0, 4), ("triple", 3.0, 12)]
)
def test_tempo_switches(fix: str, factor: float, meter: int) -> None:
    song = put_right(tempo=fix)
    assert song.tempo == pytest.approx(BPM * factor, rel=0.01)
    assert song.meter == meter
    well_formed(song)
    if factor > 1.0:
        assert np.isin(heard().beats, song.beats).all()
        np.testing.assert_array_equal(song.downbeats, heard().downbeats)
    else:
        assert np.isin(song.beats, heard().beats).all()
    if fix == "half":
        np.testing.assert_array_equal(song.downbeats, heard().downbeats)


def test_meter_keeps_the_phase_of_the_downbeats() -> None:
    song = put_right(meter=2)
    assert song.meter == 2
    assert np.isin(heard().downbeats, song.downbeats).all()
    assert set(bar_positions(song).tolist()) == {1, 2}


@pytest.mark.parametrize("offset", [1, 2, -1, 5])
def test_downbeats_come_so_many_beats_later(offset: int) -> None:
    song = put_right(downbeat_offset=offset)
    was = np.searchsorted(heard().beats, heard().downbeats)
    now = np.searchsorted(song.beats, song.downbeats)
    assert set((now - offset) % 4) == set(was % 4)
    assert abs(len(now) - len(was)) <= 1
    assert put_right(downbeat_offset=offset - 4 * (offset // 4)).downbeats.tolist() == song.downbeats.tolist()


def test_confidence_goes_with_the_beats() -> None:
    from onbeat.music.corrections import correct
    from onbeat.music.profile import Profiler

    profiler = Profiler(22050)
    for _ in profiler.watch([band()[1].samples]):
        pass
    profile = profiler.profile()
    sure = replace(heard(), confidence=np.linspace(0.2, 0.9, len(heard().beats)))
    half = correct(sure, profile, Corrections(tempo="half"), 0.0, 24.0)
    np.testing.assert_array_equal(half.confidence, sure.confidence[np.isin(sure.beats, half.beats)])
    double = correct(sure, profile, Corrections(tempo="double"), 0.0, 24.0)
    np.testing.assert_array_equal(double.confidence[::2], sure.confidence)
    np.testing.assert_array_equal(double.confidence[1::2], sure.confidence[:-1])  # the less sure of the two


def test_what_makes_no_sense_is_refused(tmp_path: Path) -> None:
    with pytest.raises(AudioError, match="beats and taps are both given"):
        Corrections(beats="a", taps="b")
    with pytest.raises(AudioError, match="expected one of half, double, third, triple"):
        Corrections(tempo="quarter")  # type: ignore[arg-type]
    with pytest.raises(AudioError, match="meter 0: expected 1 to 16"):
        Corrections(meter=0)
    with pytest.raises(AudioError, match=r"a.beats:2: 99 s lies outside of the song, which lasts from 0 to 24.00 s"):
        put_right(beats=written(tmp_path / "a.beats", np.array([1.0, 99.0])))


def test_a_song_without_beats_takes_beats_and_survives_the_rest(tmp_path: Path) -> None:
    noise = Audio((0.1 * np.random.default_rng(0).standard_normal(22050 * 6)).astype(np.float32), 22050)
    assert len(listen_samples(noise).beats) == 0
    beats = written(tmp_path / "a.beats", np.arange(0.5, 6.0, 0.5))
    assert len(listen_samples(noise, corrections=Corrections(beats=beats)).beats) == 11
    assert len(listen_samples(noise, corrections=Corrections(taps=beats)).beats) in (11, 12)
    for fixes in ({"tempo": "half"}, {"tempo": "triple"}, {"meter": 3}, {"downbeat_offset": 1}):
        assert len(listen_samples(noise, corrections=Corrections(**fixes)).beats) == 0
